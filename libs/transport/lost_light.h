// Unresolved specular transport: light of sources that only an explicit sample finds (collimated, small disks, points)
// where it has to pass a smooth refracting surface. The surface stops the straight line towards the source, because it
// bends the light, and a path that it has bent meets a small disk almost never.
//
// How much is missing is estimated along the straight line: where nothing stops it but smooth transmitting surfaces,
// the explicit sample counts with their transmittances. These are taken from the thinner side, air's, which the line
// runs in as light comes, and from where there is always a way in; and without the factor n^2 of radiance, which the
// light gives back by filling less solid angle. That is what really arrives where flat interfaces lie parallel to the
// surface that is lit, because the flux through them is; elsewhere it is as large as light that is bent, but arrives
// somewhere else (caustics, total reflection). What interfaces reflect to and fro between them comes to that, where
// light is asked for through them (refracted/unfound.h).
//
// The estimate is no part of the radiance. It makes the standard error larger and flags the problem
// (Accumulators::shortfall, quality_unresolved). Light that a mirror sends, also that of a refracting surface, is not
// estimated.
// Based on: Born & Wolf, section 1.5 (transmittance, flux); the explicit samples of shares.h.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "surface/surface.h"
#include "transport/options.h"
#include "transport/trace_request.h"

namespace suite {

class LostLight {
 public:
  // An explicit sample that continuations meet with a larger probability than this is not of a small source: they find
  // it often enough for their own error to tell.
  static constexpr double kOftenMet = 0.05;

  // Whether something of the material passes smooth surfaces in one direction (Dirac transmission).
  static bool refracts(const BakedMaterial& material);
  // The materials of the state that do.
  static std::vector<uint32_t> refracting(const Scene& scene, const Optics& optics);

  // Whether a state shows any, and sources are asked for explicitly at all.
  static bool possible(const Scene& scene, const Optics& optics, const PipelineOptions& options) {
    return options.explicit_sources && !refracting(scene, optics).empty();
  }

  // Keeps references.
  LostLight(const Surface& surface, const Optics& optics);

  // Looks along rays, of which only those with wanted[i] are followed. rays, distance: as Tracer::occluded.
  void begin(std::span<const Ray> rays, std::span<const double> distance, std::span<const uint8_t> wanted);
  // The next request, to be served before the next call; false when all is known.
  bool next(TraceRequest& request);
  // Share of its light that passes along ray i, 0 where something else stops it.
  double passes(size_t ray) const { return passes_[ray]; }

  // What passes the surface at a hit of a ray towards the light; 0 where it is not smooth and transmitting. Of models
  // with more lobes than two exact in the mean over Ray::draw.
  double through(const Hit& hit, const Ray& ray);

 private:
  struct Passed {
    ScatterModel::Sample drawn;
    Dir out;
    double chance;  // of drawing that
  };
  static std::optional<Passed> draw(const ScatterModel& model, Dir out, uint64_t key);
  void take();
  const Surface& surface_;
  std::vector<bool> refracts_;  // per material
  size_t reference_bin_;
  std::vector<double> passes_;
  int round_ = 0;
  // Of the rays that are still on their way.
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<double> left_;
  std::vector<size_t> owner_;
  Interaction at_;
  std::vector<float> there_, back_;
};

}  // namespace suite
