// What a surface sends on of the sun, told for all moments at once from how much of its element the sun shines on then:
// no ray is asked. It is not true where the element is lit in parts or does not scatter evenly; what single joins to
// the sun find less what was told for their moments is added (a control variate: J. M. Hammersley, D. C. Handscomb,
// Monte Carlo methods, 1964, section 5.5), so that all of it together is unbiased, whatever was told.
#pragma once
#include <array>

#include "heat/sunlight.h"
#include "surface/surface.h"

namespace suite {

class ToldSun {
 public:
  // suns: by moment, z to the middle of the sun; both are kept as references. points: that looked at the sun from each
  // face, of which Sunlight::lit tells.
  ToldSun(const SunCourse& course, const std::vector<Frame>& suns, std::vector<uint32_t> sunny, uint32_t points);

  const std::vector<uint32_t>& sunny() const { return sunny_; }  // moments with the sun up
  // lit, beyond: the share (of 255) of the element that is lit on the side that is looked at, and on the other one, by
  // sunny moment; null: dark, or not known. T: a weight by bin. told, by sunny moment: the sum over the bins of weight,
  // w(out, sun) and the beam's spectrum, times the share that is lit.
  void tell(const Interaction& at, Dir out, std::span<const float> T, const uint8_t* lit, const uint8_t* beyond,
            std::span<float> told);
  // How often the sun is to be asked where such a share of the points was lit: in proportion to what the answers
  // scatter by, the least for no work (J. Arvo, D. Kirk, "Particle transport and image synthesis", SIGGRAPH 1990).
  double asked(uint8_t lit) const { return asked_[lit]; }

 private:
  // A moment at which the surface is asked how it scatters; straight between them, over the cosine.
  struct Knot {
    uint32_t sunny;
    bool known[2];
    float sends[2];  // of the same side, of the other one; for the cosine 1
  };
  bool fill(size_t side);
  void add(const Vec3& normal, size_t side, const uint8_t* lit, std::span<float> told) const;

  const SunCourse& course_;
  const std::vector<Frame>& suns_;
  std::vector<uint32_t> sunny_;
  std::vector<float> x_, y_, z_, along_;  // by sunny moment: to the sun; how far between its knots
  std::vector<Knot> knots_;
  std::vector<float> w_;
  std::array<double, 256> asked_;
};

}  // namespace suite
