#include "correction/lut_bands.h"

#include <algorithm>

#include "math/vec.h"

namespace suite {

namespace {

constexpr double kLutBandsMicrowatts = 0.1;  // uW/(cm2 nm) in W/(m2 um)

class Means {
 public:
  Means(std::span<const float> sun, const BandProjection& bands) : sun_(sun), bands_(bands), bins_(sun.size()) {
    for (size_t i = 0; i < bins_.size(); ++i) bins_[i] = double{sun[i]};
    sunlight_ = mean();
  }
  // Weighted by response alone.
  template <class Value>
  std::vector<double> plain(Value&& value) {
    for (size_t i = 0; i < bins_.size(); ++i) bins_[i] = value(i);
    return mean();
  }
  // By response and sunlight.
  template <class Value>
  std::vector<double> sunlit(Value&& value) {
    std::vector<double> m = plain([&](size_t i) { return double{sun_[i]} * value(i); });
    for (size_t b = 0; b < m.size(); ++b) m[b] /= sunlight_[b];
    return m;
  }

 private:
  std::vector<double> mean() {
    std::vector<double> m(bands_.bands());
    bands_.apply(bins_, m);
    return m;
  }
  std::span<const float> sun_;
  const BandProjection& bands_;
  std::vector<double> bins_, sunlight_;
};

}  // namespace

LutValues lut_values(const CorrectionBins& c, std::span<const float> sun, double sun_cosine,
                     const BandProjection& bands) {
  Means means(sun, bands);
  const auto down_diffuse = [&](size_t i) { return std::max(0.0, c.down_total[i] - c.down_direct[i]); };
  const auto up_diffuse = [&](size_t i) { return std::max(0.0, c.up_total[i] - c.up_direct[i]); };
  const auto both_ways = [&](size_t i) { return c.down_total[i] * c.up_total[i]; };
  const auto of = [](LutKey key) { return static_cast<size_t>(key); };
  LutValues v;
  v[of(LutKey::path_reflectance)] = means.sunlit([&](size_t i) { return kPi * c.path[i] / sun_cosine; });
  v[of(LutKey::down_direct)] = means.sunlit([&](size_t i) { return c.down_direct[i]; });
  v[of(LutKey::down_diffuse)] = means.sunlit(down_diffuse);
  v[of(LutKey::up_direct)] = means.sunlit([&](size_t i) { return c.up_direct[i]; });
  v[of(LutKey::up_diffuse)] = means.sunlit(up_diffuse);
  v[of(LutKey::emission_up)] = means.plain([&](size_t i) { return kLutBandsMicrowatts * c.emission_up[i]; });
  v[of(LutKey::emission_down)] = means.plain([&](size_t i) { return kLutBandsMicrowatts * c.emission_down[i]; });
  v[of(LutKey::direct_direct)] = means.sunlit([&](size_t i) { return c.down_direct[i] * c.up_direct[i]; });
  v[of(LutKey::diffuse_direct)] = means.sunlit([&](size_t i) { return down_diffuse(i) * c.up_direct[i]; });
  v[of(LutKey::direct_diffuse)] = means.sunlit([&](size_t i) { return c.down_direct[i] * up_diffuse(i); });
  v[of(LutKey::diffuse_diffuse)] = means.sunlit([&](size_t i) { return down_diffuse(i) * up_diffuse(i); });
  // Where nothing comes down and up again any weight serves.
  std::vector<double> albedo = means.sunlit([&](size_t i) { return both_ways(i) * c.spherical_albedo[i]; });
  const std::vector<double> weight = means.sunlit(both_ways),
                            plain = means.sunlit([&](size_t i) { return c.spherical_albedo[i]; });
  for (size_t b = 0; b < albedo.size(); ++b) albedo[b] = weight[b] > 1e-12 ? albedo[b] / weight[b] : plain[b];
  v[of(LutKey::spherical_albedo)] = std::move(albedo);
  return v;
}

}  // namespace suite
