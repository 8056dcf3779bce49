// The kernel for states in which everything a path can meet is an opaque Lambert surface at no temperature that shows,
// lit by a sun and a uniform sky at most: fields, canopies of opaque leaves, cities in the reflective range. It draws
// the same sample points, makes the same decisions and has the same expectation as path_generator.h with
// path_processor.h, but keeps no record of the path, calls no model, and turns several paths into radiance in one pass
// over the wavelengths. Images of both kernels agree to the rounding of the order in which numbers are multiplied.
//
// A path is a chain of steps; with rho the reflectance at step n, q the probability of having survived there, and
// pi s the irradiance of the sun that arrives, shared with continuations that could have met its disk,
//   L_n = rho_n (s_n E_sun + L_{n+1} / q_n),   L behind the last step = sky or disk, where the path left the scene.
#pragma once
#include <span>
#include <vector>

#include "math/sampling.h"
#include "radiometry/pipeline.h"

namespace suite {

class MatteKernel {
 public:
  // Whether the kernel can stand in for the general one: only opaque Lambert materials without varying maps or
  // blackbody radiance, no media, lamps, moon, air or Earth, no sky but a uniform one, one knot, the standard method
  // with explicit sources, and the plan's counts.
  static bool serves(const Surface& surface, const Optics& optics, const Environment& environment,
                     const PipelineOptions& options);
  // Keeps references. record: in the wave, for truth. width: paths that run together.
  MatteKernel(const Surface& surface, const Optics& optics, const Environment& environment,
              const PipelineOptions& options, bool record, size_t width);

  // Starts path p (< width) with a sensor ray that is no receiver. sample: index within the stream.
  void start(Wave& wave, size_t p, const SensorRay& ray, const SampleStream& stream, uint32_t sample);
  // Completes all started paths.
  void complete(Wave& wave, RunStatistics& statistics);

  // Of a completed path: throughput cut at the maximum number of nodes.
  double truncated(size_t p) const { return lanes_[p].truncated; }
  // Radiance at one bin, W/(m2 sr um); NaN when that at some bin could be anything but finite and not negative.
  float radiance(size_t p, size_t bin) const;
  // Radiance at all bins.
  void spectrum(size_t p, std::span<float> radiance) const;
  // sums[k] += radiance of each of the paths, in their order, for all bins.
  void add(std::span<const uint32_t> paths, double* sums) const;

 private:
  // A Lambert material or a source: one value per bin, padded with zeros to whole vectors, and the largest of them.
  struct Spectrum {
    std::vector<float> value;
    float most = 0;
  };
  struct Step {
    const float* rho;
    float most, sun, bounce;  // the largest rho; s and 1 / q of the formula above
  };
  struct Lane {
    SampleStream stream{0, 0, 0};
    uint32_t sample = 0, draw = 0;
    int size = 0;  // steps
    Vec3 origin;
    Dir direction;
    double time = 0, throughput = 1, density = 0;  // at the reference; of the last direction, 0 = the sensor's
    double truncated = 0;
    float weight = 1, sky = 0, disk = 0;  // the sensor's; of what arrives from outside the scene
  };
  // The surface that an active path has met.
  struct Place {
    Dir shading;
    const Spectrum* rho;
  };

  Spectrum padded(const float* values) const;
  void meet(Wave& wave, int depth, TraceStatistics& statistics);
  void light(Wave& wave, int depth, TraceStatistics& statistics);
  void go_on(int depth);
  bool arrive(Wave& wave, uint32_t p, const Hit& hit, Place& place);
  void record(Wave& wave, uint32_t p, const Hit& hit, Dir normal, uint32_t material) const;
  void escape(Lane& lane) const;
  double scatter(Lane& lane, Dir in, const Place& at, const Hit& hit);
  Step* steps(size_t p) { return &steps_[p * static_cast<size_t>(options_.max_nodes)]; }
  const Step* steps(size_t p) const { return &steps_[p * static_cast<size_t>(options_.max_nodes)]; }

  const Surface& surface_;
  const Optics& optics_;
  const Environment& environment_;
  const PipelineOptions options_;
  const bool record_, disk_;  // disk_: there is a sun that is one
  const size_t bins_, reference_bin_;
  const std::span<const TracedObject> objects_;
  const std::span<const Mesh> meshes_;
  std::vector<Spectrum> materials_;  // by material
  Spectrum sun_, sky_;
  std::vector<Lane> lanes_;
  std::vector<Step> steps_;  // [path][step]
  // Of the current stage; [i] belongs to path active_[i].
  std::vector<uint32_t> active_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<Place> places_;
  std::vector<std::array<double, 4>> numbers_;  // where a disk and the continuation share them
  std::vector<double> x_, y_, z_;               // the points of the continuations, then their directions
  std::vector<uint32_t> asked_;                 // which i have a ray towards the sun
  std::vector<double> reach_;
  std::vector<uint8_t> blocked_;
  Interaction interaction_;
};

}  // namespace suite
