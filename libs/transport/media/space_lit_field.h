// Media in air whose light knows the scene: bodies and voxels as in space_field.h, and what the scene makes of the even
// field of the air around and within them, shadows of the media included.
//
// With L the radiance in the scene and E that over the even ground (light/air_vertices.h), flights through media bring
// what the air sends in the even field, dimmed by all that lies on the way. Left over is what the air scatters of
// D = L - E: a path that has ended goes back to one place in the air on its way (techniques/air_residual.h), is
// scattered there, and brings D.
//   Places: drawn over the whole way of a flight, boundary to boundary, and kept where the flight has come that far:
//     with probability exp(-t_h(x)) at hero wavelength h, t the scattering depth of the media. The weights of the
//     one-sample balance heuristic take that in.
//   D of a flight on which there is no medium, from such a place: as in space_lit_air.h, nothing but what its end sends
//     less E there.
//   D of another one: L by a flight as from everywhere else, less E where it begins.
//   Beams: E has them at the place already; they count where they are missing, 1 - (transmittance of the media), or
//     wholly behind a surface.
// The air fills bodies of index 1, clouds and leaves, but none that refract (media/air_light.h): there are no places in
// those.
#pragma once
#include <optional>
#include <vector>

#include "transport/air_places.h"
#include "transport/media/space_field.h"

namespace suite {

class LitFieldSpace : public FieldSpace {
 public:
  static constexpr bool kGoesBack = true;
  explicit LitFieldSpace(const SpaceContext& context);

  void start(uint32_t p, const LivePath& live);
  Flight fly(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, const Ray& ray, double length, bool ends,
             std::span<float> through, std::span<float> emitted);
  void put(uint32_t p, const Around& around);

  // As LitAirSpace.
  AirVertices::PerKnot chances(const LivePath& live, double length) const {
    return places_.chances(live.origin, live.direction, length);
  }
  void remember(uint32_t p) { flights_of_[p].remembered = flights_of_[p].around; }
  // Whether the last flight of path p, which began as `live`, has come to the place that go_to() would draw.
  bool reaches(uint32_t p, const LivePath& live, double length, double u) const;
  std::optional<AirVertices::PerKnot> go_to(uint32_t p, LivePath& live, double length, double u,
                                            std::span<float> through);
  bool in_air(uint32_t event) const { return event < flights_of_.size() && places_.here(event); }
  bool lacks(const Ray& ray, double distance, size_t i, bool blocked, std::span<float> transmission);

  // Scattering there or at an event in media.
  Vec3 place(uint32_t event) const { return in_air(event) ? places_.place(event) : FieldSpace::place(event); }
  void densities(uint32_t event, Dir out, Dir in, std::span<float> density) const;
  Factor evaluate(uint32_t event, double cosine, std::span<float> v);
  // No flights aside begin in the air (techniques/side_vertex.h).
  double asymmetry(uint32_t event) const { return in_air(event) ? 0 : FieldSpace::asymmetry(event); }
  bool sample(uint32_t p, const LivePath& live, Vec2 u, double who, std::span<float> dense, Continuation& on);

 private:
  // What flights from a place bring, until they have met a surface or been scattered: boundaries are passed.
  enum class Brings : uint8_t {
    all,         // L: it comes from no such place
    difference,  // D
    rest         // L, E having been taken off; beams are those of the place
  };
  struct OfPath {
    Brings brings = Brings::all;
    double reach = 0;                // m, of the last flight: where it was scattered, or infinite
    MediumStack around, remembered;  // bodies around the last flight, and the one that is remembered
  };
  bool is_clear(const LivePath& live, double length, uint32_t medium);
  Flight fly_clear(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, double length, double gap, bool ends,
                   std::span<float> through, std::span<float> emitted);
  Flight fly_difference(uint32_t p, LivePath& live, PathRecord& record, Hit& hit, double length, double gap, bool ends,
                        std::span<float> through, std::span<float> emitted);

  AirPlaces places_;
  std::vector<OfPath> flights_of_;  // [path]
  std::vector<float> even_, scratch_;
};

}  // namespace suite
