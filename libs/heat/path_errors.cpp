#include "heat/path_errors.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "math/sampling.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr size_t kTogether = 256;
constexpr double kBase = 300;  // K, about which differences are followed: they may be negative, temperatures not

// Means over the parts of the span.
class Parts {
 public:
  explicit Parts(size_t moments) : moments_(moments) { SUITE_CHECK(moments >= kHeatParts); }
  size_t part(size_t moment) const { return std::min(kHeatParts - size_t{1}, moment * kHeatParts / moments_); }
  template <class Value>
  std::vector<double> means(const Value& value) const {
    std::vector<double> sum(kHeatParts, 0), count(kHeatParts, 0);
    for (size_t k = 0; k < moments_; ++k) sum[part(k)] += value(k), count[part(k)] += 1;
    for (size_t p = 0; p < kHeatParts; ++p) sum[p] /= count[p];
    return sum;
  }

 private:
  size_t moments_;
};

double cube(double T) { return T * T * T; }

constexpr double kLeft = 1e-4;  // of a step's search along the surface: errors need no more

class Errors {
 public:
  explicit Errors(const SolvedSurfaces& s)
      : s_(s),
        blocks_(s.exchange.blocks),
        moments_(s.history.moments),
        parts_(moments_),
        faces_(s.exchange.faces()),
        slope_(faces_ * kHeatParts) {
    weather_by_part();
    for (const SurfaceGroup& group : s_.groups)
      parallel_for(0, group.front_rows.size(), kTogether,
                   [&](size_t begin, size_t end) { slopes(group, begin, end - begin); });
  }

  std::vector<float> of_paths() {
    const auto n = static_cast<double>(blocks_);
    begin(blocks_, 1 / (n * (n - 1)));
    loads_by_block();
    every_face([this](size_t f) { add_uneven_sky(f), take_mean(f); });
    return follow(s_.neighbours);
  }
  std::vector<float> of_size() {
    begin(Sunlight::kContrasts, 1.0 / Sunlight::kContrasts);
    every_face([this](size_t f) { spread_of(f); });
    return follow({});
  }

 private:
  // What is followed: so many deviations of each face, whose answers' squares are summed with a weight.
  void begin(size_t cases, double weight) {
    cases_ = cases, weight_ = weight;
    deviation_.assign(faces_ * cases * kHeatParts, 0.0f);
  }
  template <class Fill>
  void every_face(const Fill& fill) const {
    parallel_for(0, faces_, 64, [&](size_t begin, size_t end) {
      for (size_t f = begin; f < end; ++f) fill(f);
    });
  }

  std::vector<float> follow(const SurfaceNeighbours& neighbours) const {
    std::vector<float> out(faces_ * kHeatParts, 0.0f);
    const std::vector<SurfacePart> parts = surface_parts(s_.groups, faces_, neighbours);
    parallel_for(0, parts.size(), 1, [&](size_t begin, size_t end) {
      for (size_t p = begin; p < end; ++p)
        group_of(parts[p], 0).layers.empty() ? massless(parts[p], out) : conduct(parts[p], out);
    });
    return out;
  }
  const SurfaceGroup& group_of(const SurfacePart& part, size_t i) const { return s_.groups[part.members[i].group]; }
  uint32_t front(const SurfacePart& part, size_t i) const {
    return group_of(part, i).front_rows[part.members[i].element];
  }
  uint32_t back(const SurfacePart& part, size_t i) const {
    return group_of(part, i).back_rows[part.members[i].element];
  }

  void weather_by_part() {
    const auto& w = s_.weather;
    direct_ = parts_.means([&](size_t k) { return w.direct[k]; });
    diffuse_ = parts_.means([&](size_t k) { return w.diffuse[k] / kPi; });
    below_ = parts_.means([&](size_t k) { return s_.ground_albedo * w.global[k] / kPi; });
    uneven_.resize(kSkyPatches * kHeatParts);
    for (size_t patch = 0; patch < kSkyPatches; ++patch) {
      const std::vector<double> L = parts_.means([&](size_t k) { return double{w.sky[k][patch]}; });
      for (size_t p = 0; p < kHeatParts; ++p) uneven_[patch * kHeatParts + p] = L[p] - diffuse_[p];
    }
  }

  // Blocks are kept for an even sky; where it is brighter or darker than that, paths count by where they met it. Each
  // of n paths brings y = pi a (L - even) with the probability w / (pi a) of the patch, w its weight: the variance of
  // their mean is (sum w y - (sum w (L - even))^2) / n, as if paths were independent, which they are less than that.
  // Every block gets a deviation of that size with a random sign, the same through the day.
  void add_uneven_sky(size_t f) {
    constexpr uint64_t kPurpose = 0x736b79;
    const auto& sun = s_.sun;
    const double most = kPi * double{sun.absorptance[f]}, paths = s_.exchange.paths;
    const float* w = &sun.sky[f * kSkyPatches];
    for (size_t p = 0; p < kHeatParts; ++p) {
      double square = 0, mean = 0;
      for (size_t k = 0; k < kSkyPatches; ++k) {
        const double y = uneven_[k * kHeatParts + p];
        square += most * double{w[k]} * y * y, mean += double{w[k]} * y;
      }
      const double deviation = std::sqrt(std::max(0.0, square - mean * mean) / paths);
      for (size_t b = 0; b < blocks_; ++b)
        deviation_[(f * blocks_ + b) * kHeatParts + p] +=
            static_cast<float>(hash_of(kPurpose, f, b) & 1 ? deviation : -deviation);
    }
  }

  // Loads of every face by each block's paths alone, of what all emit: means over the parts. One block's exchange after
  // the other, as all at once would be the most that is held of anything.
  void loads_by_block() {
    const size_t outsides = s_.loads.outside.size() / moments_;
    std::vector<double> emits, received(faces_ * kHeatParts);
    emits.reserve((faces_ + outsides) * kHeatParts);
    for (uint32_t end = 0; end < faces_ + outsides; ++end) {
      const std::vector<double> means = parts_.means([&](size_t m) { return emitted(end, m); });
      emits.insert(emits.end(), means.begin(), means.end());
    }
    for (uint32_t b = 0; b < blocks_; ++b) {
      s_.exchange.block(b).matrix(outsides).receive(emits, kHeatParts, received);
      parallel_for(0, faces_, 64, [&](size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) put_loads(f, b, &received[f * kHeatParts]);
      });
    }
  }

  void put_loads(size_t f, size_t b, const double* received) {
    const auto& sun = s_.sun;
    const double per_part = static_cast<double>(moments_ - 1) / kHeatParts;
    for (size_t p = 0; p < kHeatParts; ++p)
      deviation_[(f * blocks_ + b) * kHeatParts + p] =
          static_cast<float>(s_.exchange.emissivity[f] * received[p] +
                             double{sun.beam_of_block[(f * blocks_ + b) * kHeatParts + p]} / per_part * direct_[p] +
                             double{sun.diffuse_of_block[f * blocks_ + b]} * diffuse_[p] +
                             double{sun.below_of_block[f * blocks_ + b]} * below_[p]);
  }

  // Leaves each block's minus the mean of all.
  void take_mean(size_t f) {
    for (size_t p = 0; p < kHeatParts; ++p) {
      const auto of = [&](size_t b) -> float& { return deviation_[(f * blocks_ + b) * kHeatParts + p]; };
      double mean = 0;
      for (size_t b = 0; b < blocks_; ++b) mean += double{of(b)} / static_cast<double>(blocks_);
      for (size_t b = 0; b < blocks_; ++b) of(b) = static_cast<float>(double{of(b)} - mean);
    }
  }

  void spread_of(size_t f) {
    const double per_part = static_cast<double>(moments_ - 1) / kHeatParts;
    for (size_t c = 0; c < cases_; ++c)
      for (size_t p = 0; p < kHeatParts; ++p) {
        const size_t at = (f * cases_ + c) * kHeatParts + p;
        deviation_[at] = static_cast<float>(double{s_.sun.beam_spread[at]} / per_part * direct_[p]);
      }
  }

  double emitted(uint32_t end, size_t m) const {
    if (end >= faces_) return s_.loads.outside[(end - faces_) * moments_ + m];
    const double T = s_.history.kelvin_at(end, m);
    return kStefanBoltzmann * T * cube(T);
  }

  double air(const std::vector<double>& values, size_t part) const {
    const double t = s_.loads.begin + (static_cast<double>(part) + 0.5) / kHeatParts *
                                          (s_.weather.moments.back() - s_.weather.moments.front());
    const auto& times = s_.loads.air.times;
    const auto k = std::min(static_cast<size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin()),
                            times.size() - 1);
    return values[k];
  }

  // W/(m2 K) that a face gives back, by part.
  void slopes(const SurfaceGroup& group, size_t first, size_t n) {
    const auto of = [&](uint32_t face, const FaceTraits& traits) {
      const std::vector<double> T = parts_.means([&](size_t m) { return s_.history.kelvin_at(face, m); });
      for (size_t p = 0; p < kHeatParts; ++p) {
        FaceWeather w;
        w.air_kelvin = air(s_.loads.air.kelvin, p), w.wind = air(s_.loads.air.wind, p);
        w.vapour_pressure = air(s_.loads.air.vapour_pressure, p), w.pressure = s_.loads.air.pressure;
        slope_[face * kHeatParts + p] = static_cast<float>(balance_at(traits, w, T[p]).linear +
                                                           4 * traits.emissivity * kStefanBoltzmann * cube(T[p]));
      }
    };
    for (size_t i = first; i < first + n; ++i) {
      of(group.front_rows[i], group.front_of(i));
      if (!group.back_rows.empty()) of(group.back_rows[i], group.back_of(i));
    }
  }

  double deviation(uint32_t face, size_t block, size_t part) const {
    return double{deviation_[(face * cases_ + block) * kHeatParts + part]};
  }
  double slope(uint32_t face, size_t part) const { return double{slope_[face * kHeatParts + part]}; }

  void add(std::vector<float>& out, uint32_t face, size_t part, double kelvin) const {
    float& to = out[face * kHeatParts + part];
    to = static_cast<float>(std::sqrt(double{to} * double{to} + kelvin * kelvin * weight_));
  }

  void massless(const SurfacePart& part, std::vector<float>& out) const {
    const bool open = !group_of(part, 0).back_rows.empty();
    for (size_t i = 0; i < part.members.size(); ++i) {
      const uint32_t above = front(part, i), below = open ? back(part, i) : kNone;
      for (size_t b = 0; b < cases_; ++b)
        for (size_t p = 0; p < kHeatParts; ++p) {
          double flux = deviation(above, b, p), loss = slope(above, p);
          if (open) flux += deviation(below, b, p), loss += slope(below, p);
          if (!(loss > 0)) continue;
          add(out, above, p, flux / loss);
          if (open) add(out, below, p, flux / loss);
        }
    }
  }

  void conduct(const SurfacePart& part, std::vector<float>& out) const {
    const SurfaceGroup& group = group_of(part, 0);
    const size_t n = part.members.size();
    const bool open = !group.back_rows.empty();
    const double length = s_.weather.moments.back() - s_.weather.moments.front();
    const std::vector<double> steps(kHeatParts, length / kHeatParts);
    for (size_t b = 0; b < cases_; ++b) {
      std::vector<SlabLayer> layers = group.layers;
      for (SlabLayer& layer : layers) layer.heat_generation = 0;
      SlabBatch batch(layers, n, {60, open, part.neighbours, kLeft});
      batch.start(0, kBase);
      const auto line = [&](FaceLines& lines, size_t i, double slope, double flux) {
        lines.linear[i] = {slope, slope};
        lines.constant[i] = {flux + slope * kBase, flux + slope * kBase};
        lines.quartic[i] = 0;
      };
      const BatchLoads loads = [&](double begin, double, const SlabBatch&, FaceLines& top, FaceLines& bottom) {
        const auto p = std::min(kHeatParts - size_t{1}, static_cast<size_t>(begin / length * kHeatParts + 0.5));
        for (size_t i = 0; i < n; ++i) {
          const uint32_t above = front(part, i), below = open ? back(part, i) : kNone;
          line(top, i, slope(above, p), deviation(above, b, p));
          open ? line(bottom, i, slope(below, p), deviation(below, b, p))
               : line(bottom, i, back_balance(group_of(part, i).behind).linear, 0);
        }
      };
      // The second period, from which the slow part of what the first one left is removed.
      PeriodicOptions past;
      past.enough = 2, past.harmonics = false;
      std::vector<double> tops(kHeatParts * n), bottoms(kHeatParts * n);
      find_periodic(batch, 0, steps, loads, past, [&](size_t step) {
        const size_t p = std::min(step, kHeatParts - size_t{1});
        for (size_t i = 0; i < n; ++i) tops[p * n + i] = batch.top(i), bottoms[p * n + i] = batch.bottom(i);
      });
      for (size_t p = 0; p < kHeatParts; ++p)
        for (size_t i = 0; i < n; ++i) {
          add(out, front(part, i), p, tops[p * n + i] - kBase);
          if (open) add(out, back(part, i), p, bottoms[p * n + i] - kBase);
        }
    }
  }

  const SolvedSurfaces& s_;
  size_t blocks_, moments_;
  Parts parts_;
  size_t faces_;
  size_t cases_ = 0;
  double weight_ = 0;
  std::vector<float> deviation_, slope_;
  std::vector<double> direct_, diffuse_, below_;
  std::vector<double> uneven_;  // [patch][part]: radiance of the sky less that of an even one, W/(m2 sr)
};

}  // namespace

LinearErrors linear_errors(const SolvedSurfaces& solved) {
  Errors errors(solved);
  return {errors.of_paths(), errors.of_size()};
}

}  // namespace suite
