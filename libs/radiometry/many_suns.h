// Turns a path into what it shows under each of many collimated suns by itself: all of them are asked at every node of
// one path. With the path's own start in the direction of a real sun this gives, by reciprocity, what many viewers see
// under that sun at little more than the cost of one (the scene's models have to be reciprocal, its means over a whole
// period).
//
// Assumes: no media, no air; nothing else shines.
// Based on: H. von Helmholtz's reciprocity as in C. Borner et al., J. Quant. Spectrosc. 57, 1997; local estimates of
// photons at every collision, e.g. J. M. Marchuk et al., "The Monte Carlo methods in atmospheric optics", 1980.
#pragma once
#include <vector>

#include "radiometry/lost_light.h"
#include "radiometry/pipeline.h"
#include "radiometry/wave.h"

namespace suite {

class ManySuns {
 public:
  // lost: null where no light can be lost.
  ManySuns(const Surface& surface, std::unique_ptr<LostLight> lost) : surface_(surface), lost_(std::move(lost)) {}

  // Adds path p's band radiances under suns[i] of unit spectral irradiance (W/(m2 um), normal to the beam) to
  // sums[i * bands], and of what was scattered once to sums[(suns + i) * bands] when `single`. Returns false, with
  // nothing added, when a radiance is no finite number >= 0. What is lost of them on smooth surfaces is added to
  // `missing` in the same way; empty = is not asked for.
  bool add(Wave& wave, size_t p, std::span<const Dir> suns, const BandProjection& projection, bool single,
           std::span<double> sums, std::span<double> missing, TraceStatistics& statistics);

 private:
  // Radiance under each sun, bins each: all of it, and what was scattered once.
  struct Radiance {
    std::vector<float> all, once;
    bool good() const;
    void project(const BandProjection& projection, size_t bins, bool single, std::span<double> sums) const;
  };
  void look(const Node& node, std::span<const Dir> suns, const Ray& ray, bool lost, TraceStatistics& statistics);
  const Surface& surface_;
  std::unique_ptr<LostLight> lost_;
  std::vector<Ray> rays_;
  std::vector<size_t> sun_;
  std::vector<double> distance_;
  std::vector<uint8_t> blocked_;
  std::vector<float> weight_;
  Radiance seen_, missed_;
};

}  // namespace suite
