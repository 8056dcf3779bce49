// Places in the air that paths go back to, to be scattered there (light/air_vertices.h, techniques/air_residual.h):
// where they are and what they do, for the spaces that have them.
#pragma once
#include <cmath>
#include <utility>
#include <vector>

#include "light/air_vertices.h"
#include "optics/phase_function.h"
#include "transport/space_nothing.h"
#include "transport/surfaces_any.h"

namespace suite {

class AirPlaces {
 public:
  explicit AirPlaces(const SpaceContext& c)
      : air_(*c.environment.atmosphere),
        vertices_(*air_.vertices()),
        knots_(c.optics.state().knots.size()),
        at_(c.width),
        scratch_(c.optics.state().size()) {
    for (const auto& light : c.environment.lights)
      if (const auto beam = light->beam())
        beams_.push_back(beam->direction);
      else if (light->nature().far && !light->nature().delta)
        lit_from_outside_ = true;
  }

  // Whether something shines outside that the even field does not know: no beam.
  bool lit_from_outside() const { return lit_from_outside_; }
  void start(uint32_t p) { at_[p].here = false; }
  // Whether path p stands at one; its next flight leaves it.
  bool here(uint32_t p) const { return at_[p].here; }
  bool leave(uint32_t p) { return std::exchange(at_[p].here, false); }
  Vec3 place(uint32_t p) const { return at_[p].place; }

  // AirVertices::about_chances.
  AirVertices::PerKnot chances(Vec3 from, Dir d, double length) const {
    return vertices_.about_chances(from, d, length);
  }
  // Puts path p to a place on a way, drawn for a knot; returns it. through: what the air on the way there leaves of
  // light. Nothing where nothing scatters. u: in [0, 1).
  std::optional<AirVertices::Place> go_to(uint32_t p, Vec3 from, Dir d, double length, double u, int knot,
                                          std::span<float> through) {
    const auto drawn = vertices_.draw(from, d, length, u, static_cast<size_t>(knot));
    if (!drawn) return std::nullopt;
    air_.transmittance(from, d, drawn->distance, through);
    at_[p] = {from + d * drawn->distance, drawn->layer, true};
    return drawn;
  }

  // Scattering there, as in a medium of density 1 (media/space_field.h); but a share of directions is drawn towards the
  // beams, so that places further on, whose forward peak would see a missing beam, are not met by rare chance.
  void densities(uint32_t p, Dir out, Dir in, std::span<float> density) const {
    const PhaseFunction& phase = *medium(p).phase;
    phase.pdf(scattering_cosine(out, in), density);
    if (beams_.empty()) return;
    const auto n = static_cast<float>(beams_.size());
    float towards[kMaxKnots], sum[kMaxKnots] = {};
    for (const Dir& beam : beams_) {
      phase.pdf(dot(in, beam), {towards, density.size()});
      for (size_t k = 0; k < density.size(); ++k) sum[k] += towards[k] / n;
    }
    for (size_t k = 0; k < density.size(); ++k) density[k] += kTowards * (sum[k] - density[k]);
  }
  Factor evaluate(uint32_t p, double cosine, std::span<float> v) const {
    medium(p).phase->eval(cosine, v);
    for (size_t i = 0; i < v.size(); ++i) v[i] *= medium(p).scattering[i];
    return {1, v.data()};
  }
  // who: chooses between both.
  bool sample(uint32_t p, Dir out, int knot, Vec2 u, double who, std::span<float> dense, Continuation& on) const {
    const double cosine = medium(p).phase->sample(u.x, knot);
    Dir towards = out;
    if (!beams_.empty() && who < kTowards)
      towards = -beams_[static_cast<size_t>(who / kTowards * static_cast<double>(beams_.size()))];
    on.in = scattered_direction(towards, cosine, u.y);
    densities(p, out, on.in, {on.density, knots_});
    on.dirac = false;
    on.weight = evaluate(p, scattering_cosine(out, on.in), dense);
    return true;
  }

  // How far off the place is that go_to() would draw, m; infinite: nothing scatters.
  double distance_to(Vec3 from, Dir d, double length, double u, int knot) const {
    const auto drawn = vertices_.draw(from, d, length, u, static_cast<size_t>(knot));
    return drawn ? drawn->distance : std::numeric_limits<double>::infinity();
  }

  // AirVertices::to_ground, even.
  double to_ground(Vec3 from, Dir d) const { return vertices_.to_ground(from, d); }
  void even(Vec3 from, Dir d, std::span<float> scratch, std::span<float> radiance) const {
    vertices_.even(from, d, scratch, radiance);
  }
  // A flight of `length` (m, finite) from such a place: what it does to light, and what the scene's end of it is to be
  // less by (AirVertices::beyond).
  void beyond(Vec3 from, Dir d, double length, std::span<float> through, std::span<float> more) {
    vertices_.beyond(from, d, length, through, more, scratch_);
  }

 private:
  static constexpr float kTowards = 0.25f;
  struct At {
    Vec3 place;
    size_t layer = 0;
    bool here = false;
  };
  const BakedMedium& medium(uint32_t p) const { return vertices_.medium(at_[p].layer); }

  const Atmosphere& air_;
  const AirVertices& vertices_;
  size_t knots_;
  std::vector<Dir> beams_;  // towards their sources
  bool lit_from_outside_ = false;
  std::vector<At> at_;
  std::vector<float> scratch_;
};

}  // namespace suite
