#include "sensor/detectors/cmos.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/variates.h"

namespace suite {

namespace {

constexpr uint64_t kPixel = 0x636d6f73ull, kColumn = 0x636f6c75ull, kOffset = 0x6f666673ull, kRow = 0x726f7773ull;

class Cmos final : public ArrayDetector {
 public:
  Cmos(const DetectorSpec& spec, const CmosKeys& keys, CmosProducts products)
      : d_(spec), keys_(keys), counts_(products == CmosProducts::dn_and_electrons) {}

  ArrayReading read(const ArrayLight& light) const override {
    ArrayReading out = empty_reading(light.size(), true, counts_);
    std::vector<double> of_row(light.rows), of_column;
    for (uint32_t r = 0; r < light.rows; ++r)
      of_row[r] = keys_.row_noise * deviate(kRow, hash_of(light.array, light.read_out, r));
    for (uint32_t c = 0; c < light.columns; ++c)
      of_column.push_back(column(light, c < light.size() ? light.sites[c].column : c));
    for (size_t i = 0; i < light.size(); ++i) {
      const Character c = character_of(d_, light.sites[i]);
      if (c.hot) out.dn[i] = most_counts(d_);
      if (c.dead || c.hot) continue;
      Pcg32 random(hash_of(d_.seed, kNoiseStream), light.key(i));
      double charge = poisson(collected(d_, c, light.electrons[i], light.exposure), random);
      const bool full = d_.full_well > 0 && charge > d_.full_well;
      if (full) charge = d_.full_well;
      if (light.lines) charge += keys_.column_noise * normal(random);  // each row is a read-out
      charge += own_noise(light.sites[i], random) + of_row[i / light.columns] + of_column[i % light.columns];
      const Converted converted = convert(d_, charge);
      out.dn[i] = converted.counts;
      out.clipped[i] = full || converted.clipped;
      if (counts_) out.counts[i] = std::clamp(std::round((converted.counts - d_.bias) * d_.gain), 0.0, 65535.0);
    }
    return out;
  }

  // That of the median pixel.
  DetectorNoise noise(double exposure, double) const override {
    return {d_.dark_current * exposure + keys_.read_median * keys_.read_median +
                keys_.column_noise * keys_.column_noise + keys_.row_noise * keys_.row_noise + d_.gain * d_.gain / 12,
            1};
  }

 private:
  double deviate(uint64_t stream, uint64_t key) const {
    Pcg32 random(hash_of(d_.seed, stream), key);
    return normal(random);
  }
  double column(const ArrayLight& light, uint32_t c) const {
    double sum = 0;
    if (keys_.column_noise > 0 && !light.lines)
      sum += keys_.column_noise * deviate(kColumn, hash_of(light.array, light.read_out, c));
    if (keys_.column_offset > 0) sum += keys_.column_offset * deviate(kOffset, hash_of(light.array, c));
    return sum;
  }
  // Read noise and telegraph steps of a pixel. What the pixel is comes from its own stream, what it does from `random`.
  double own_noise(const DetectorSite& site, Pcg32& random) const {
    Pcg32 own(hash_of(d_.seed, kPixel), site.number);
    double noise = keys_.read_median * std::exp(keys_.read_deviation * normal(own)) * normal(random);
    if (keys_.trapped > 0 && own.uniform() < keys_.trapped) {
      const double amplitude = exponential_variate(keys_.amplitude, own);
      const bool before = random.uniform() < keys_.duty, after = random.uniform() < keys_.duty;
      noise += amplitude * (double(after) - double(before));
    }
    return noise;
  }

  DetectorSpec d_;
  CmosKeys keys_;
  bool counts_;
};

}  // namespace

CmosKeys read_cmos(const Params& p, double read_noise) {
  CmosKeys k;
  k.read_median = read_noise;
  if (const auto noise = p.find("read_noise_e")) {
    if (noise->kind() == Params::Kind::map) {
      k.read_median = noise->number_in("median", 1e-6, 1e6, "electrons");
      const double mean = noise->number_in("mean", 1e-6, 1e6, "electrons");
      if (mean < k.read_median)
        throw noise->at("mean").error(strf("the mean is below the median of %g electrons", k.read_median),
                                      "of a log-normal distribution it is not");
      k.read_deviation = std::sqrt(2 * std::log(mean / k.read_median));
    } else {
      k.read_median = noise->as_number_in(0, 1e6, "electrons");
    }
  }
  k.column_noise = p.number_in("column_noise_e", 0, 1e6, "electrons", 0);
  k.row_noise = p.number_in("row_noise_e", 0, 1e6, "electrons", 0);
  k.column_offset = p.number_in("column_offset_e", 0, 1e6, "electrons", 0);
  if (const auto telegraph = p.find("telegraph")) {
    k.trapped = telegraph->number_in("share", 0, 1, "(of the pixels)");
    k.amplitude = telegraph->number_in("amplitude_e", 0, 1e6, "electrons");
    k.duty = telegraph->number_in("duty", 0, 1, "(share of the time)", 0.5);
  }
  return k;
}

std::shared_ptr<const ArrayDetector> make_cmos(const DetectorSpec& d, const CmosKeys& keys, CmosProducts products) {
  return std::make_shared<Cmos>(d, keys, products);
}

}  // namespace suite
