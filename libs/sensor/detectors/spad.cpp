// Single-photon avalanche diodes: a pixel counts an avalanche and is blind after it.
//
// Frames of one bit: a pixel clicks once in a frame with 1 - exp(-n / frames); a click may trigger each of its four
// neighbours in the same frame, and that one its own. Running freely: each count is followed by a dead time that is not
// lengthened by light; a count triggers a neighbour that is not blind. quantum_efficiency is that of detection.
// Based on: G. F. Knoll, "Radiation Detection and Measurement", chapter 4 (dead times); E. R. Fossum, "Modeling the
// performance of single-bit and multi-bit quanta image sensors", IEEE J. Electron Devices Soc. 1, 2013 (1-bit frames).
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/interrupt.h"
#include "math/variates.h"
#include "sensor/detectors/detectors.h"

namespace suite {

namespace {

struct SpadKeys {
  uint32_t frames = 0;   // of one bit, that share the exposure; 0 = counts freely
  double dead = 0;       // s, of those that count freely
  double crosstalk = 0;  // probability that a click triggers one neighbour
};

constexpr double kManyCounts = 4096;
constexpr double kSpadGrace = 0.5;  // s, that a read-out may take to its end when a signal came

class Spad final : public ArrayDetector {
 public:
  Spad(const DetectorSpec& spec, const SpadKeys& keys) : d_(spec), keys_(keys) {}

  ArrayReading read(const ArrayLight& light) const override {
    std::vector<double> mean(light.size(), 0);
    std::vector<uint8_t> blind(light.size(), 0);  // dead, or always full
    ArrayReading out = empty_reading(light.size(), false, true);
    for (size_t i = 0; i < light.size(); ++i) {
      const Character c = character_of(d_, light.sites[i]);
      blind[i] = c.dead || c.hot;
      if (c.hot) out.counts[i] = most();
      if (!blind[i]) mean[i] = collected(d_, c, light.electrons[i], light.exposure);
    }
    const ArrayReading counted = keys_.frames ? framed(light, mean, blind) : free(light, mean, blind);
    for (size_t i = 0; i < light.size(); ++i) {
      if (blind[i]) continue;
      out.counts[i] = std::min(counted.counts[i], most());
      out.clipped[i] = counted.counts[i] > most();
    }
    return out;
  }
  // At a low rate; where counts saturate the noise is larger.
  DetectorNoise noise(double exposure, double) const override { return {d_.dark_current * exposure, 1}; }

 private:
  double most() const { return keys_.frames ? keys_.frames : most_counts(d_); }

  // Calls with each neighbour on the same chip, if it is one that reads at the same time.
  template <class Call>
  void neighbours(const ArrayLight& light, size_t i, const Call& call) const {
    const size_t n = light.columns, column = i % n;
    const auto reach = [&](bool there, size_t j) {
      if (there && light.sites[j].chip == light.sites[i].chip) call(j);
    };
    reach(column > 0, i - 1);
    reach(column + 1 < n, i + 1);
    if (light.lines) return;
    reach(i >= n, i - n);
    reach(i + n < light.size(), i + n);
  }

  ArrayReading framed(const ArrayLight& light, const std::vector<double>& mean,
                      const std::vector<uint8_t>& blind) const {
    ArrayReading out = empty_reading(light.size(), false, true);
    std::vector<double> click(light.size());
    for (size_t i = 0; i < light.size(); ++i) click[i] = -std::expm1(-mean[i] / keys_.frames);
    if (keys_.crosstalk == 0) {  // frames are alike
      for (size_t i = 0; i < light.size(); ++i) {
        Pcg32 random(hash_of(d_.seed, kNoiseStream), light.key(i));
        out.counts[i] = binomial(keys_.frames, click[i], random);
      }
      return out;
    }
    std::vector<uint8_t> fired(light.size());
    std::vector<size_t> waiting;
    for (uint32_t f = 0; f < keys_.frames; ++f) {
      stop_point(kSpadGrace);
      Pcg32 random(hash_of(d_.seed, kNoiseStream, f), hash_of(light.array, light.read_out, light.sites[0].number));
      for (size_t i = 0; i < light.size(); ++i)
        if ((fired[i] = !blind[i] && random.uniform() < click[i])) waiting.push_back(i);
      while (!waiting.empty()) {
        const size_t from = waiting.back();
        waiting.pop_back();
        neighbours(light, from, [&](size_t j) {
          if (random.uniform() < keys_.crosstalk && !fired[j] && !blind[j]) fired[j] = 1, waiting.push_back(j);
        });
      }
      for (size_t i = 0; i < light.size(); ++i) out.counts[i] += fired[i];
    }
    return out;
  }

  // Counts of a Poisson process of this mean with a dead time, armed at the start of the exposure.
  double renewed(double mean, double exposure, Pcg32& random) const {
    if (keys_.dead == 0) return poisson(mean, random);
    if (!(mean > 0)) return 0;
    const double rate = mean / exposure, blind = 1 + rate * keys_.dead;
    if (mean / blind > kManyCounts) {  // the renewal process is normal then (Knoll, chapter 4)
      const double counts = mean / blind + std::sqrt(mean / (blind * blind * blind)) * normal(random);
      return std::max(0.0, std::round(counts));
    }
    double counts = 0;
    for (double t = exponential_variate(1 / rate, random); t < exposure; ++counts)
      t += keys_.dead + exponential_variate(1 / rate, random);
    return counts;
  }

  ArrayReading free(const ArrayLight& light, const std::vector<double>& mean, const std::vector<uint8_t>& blind) const {
    ArrayReading out = empty_reading(light.size(), false, true);
    std::vector<double> fresh(light.size()), next(light.size(), 0);
    std::vector<Pcg32> random;
    for (size_t i = 0; i < light.size(); ++i) {
      random.emplace_back(hash_of(d_.seed, kNoiseStream), light.key(i));
      fresh[i] = out.counts[i] = renewed(mean[i], light.exposure, random[i]);
    }
    // A trigger finds its neighbour armed with the share of time that it was not blind in the mean.
    for (bool any = keys_.crosstalk > 0; any;) {
      any = false;
      for (size_t i = 0; i < light.size(); ++i)
        if (fresh[i] > 0)
          neighbours(light, i, [&](size_t j) {
            if (blind[j]) return;
            const double armed = std::max(0.0, 1 - out.counts[j] * keys_.dead / light.exposure);
            next[j] += binomial(static_cast<uint32_t>(std::min(fresh[i], 4e9)), keys_.crosstalk * armed, random[i]);
          });
      for (size_t i = 0; i < light.size(); ++i) {
        any = any || next[i] > 0;
        out.counts[i] += next[i];
        fresh[i] = next[i], next[i] = 0;
      }
    }
    return out;
  }

  DetectorSpec d_;
  SpadKeys keys_;
};

std::shared_ptr<const ArrayDetector> make_spad(const Params& p, DetectorSpec& d) {
  read_pixels(p, "dark_rate_hz", d);
  SpadKeys k;
  if (const auto frames = p.find("frames")) {
    k.frames = static_cast<uint32_t>(frames->as_integer(1, 65535));
    if (const auto dead = p.find("dead_time_ns"))
      throw dead->error("frames of one bit count once in a frame: a dead time does nothing", "frames or dead_time_ns");
  } else {
    k.dead = p.number_in("dead_time_ns", 0, 1e12, "ns, or frames: N") * 1e-9;
    d.bits = static_cast<int>(p.integer("bits", 1, 16, 16));
  }
  // With a quarter every click would make another one in the mean.
  k.crosstalk = p.number_in("crosstalk", 0, 0.2, "(probability for each of four neighbours)", 0);
  return std::make_shared<Spad>(d, k);
}

}  // namespace

ArrayDetectorRow spad_row() {
  return {"spad", "single-photon avalanche diodes: 1-bit frames, or counts with a dead time (Fossum 2013, Knoll)",
          "counts", make_spad};
}

}  // namespace suite
