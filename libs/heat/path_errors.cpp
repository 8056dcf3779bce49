#include "heat/path_errors.h"
#include "heat/part_means.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr size_t kTogether = 256;
constexpr double kBase = 300;  // K, about which differences are followed: they may be negative, temperatures not

double cube(double T) { return T * T * T; }

constexpr double kLeft = 1e-4;  // of a step's search along the surface: errors need no more

class Errors {
 public:
  Errors(const SolvedSurfaces& s, LoadErrors&& loads)
      : s_(s),
        of_loads_(std::move(loads)),
        blocks_(s.exchange.blocks),
        moments_(s.history.moments),
        parts_(moments_),
        faces_(s.exchange.faces()),
        slope_(faces_ * kHeatParts) {
    for (const SurfaceGroup& group : s_.groups)
      parallel_for(0, group.front_rows.size(), kTogether,
                   [&](size_t begin, size_t end) { slopes(group, begin, end - begin); });
  }

  std::vector<float> of_size() {
    followed_ = &of_loads_.spread, cases_ = Sunlight::kContrasts, weight_ = 1.0 / Sunlight::kContrasts;
    std::vector<float> out = follow({});
    of_loads_.spread = {};
    return out;
  }
  std::vector<float> of_paths() {
    const auto n = static_cast<double>(blocks_);
    add_infrared();
    followed_ = &of_loads_.of_block, cases_ = blocks_, weight_ = 1 / (n * n);
    return follow(s_.neighbours);
  }

 private:
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

  // What every face receives by the halves of its blocks, of what all emit.
  void add_infrared() {
    const size_t ends = faces_ + s_.loads.outside.size() / moments_;
    std::vector<float> emits(ends * kHeatParts), receives(faces_ * kHeatParts);
    parallel_for(0, ends, 64, [&](size_t begin, size_t end) {
      for (size_t k = begin; k < end; ++k) {
        std::ranges::copy(parts_.means([&](size_t m) { return emitted(static_cast<uint32_t>(k), m); }),
                          &emits[k * kHeatParts]);
        if (k < faces_)
          std::ranges::copy(parts_.means([&](size_t m) { return s_.history.received.at(k, m); }),
                            &receives[k * kHeatParts]);
      }
    });
    if (s_.exchange.rows.intervals == 1) return add_infrared(s_.exchange, emits, receives, {});
    for (size_t k = 0; k < s_.exchange.rows.intervals; ++k)
      add_infrared(s_.exchange.in_interval(k), emits, receives,
                   parts_.means([&](size_t m) { return double{s_.loads.shares[k][m]}; }));
  }
  // share: of each part, which it tells; empty = all.
  void add_infrared(const ExchangePaths& exchange, std::span<const float> emits, std::span<const float> receives,
                    const std::vector<double>& share) {
    exchange.halves(emits, receives, kHeatParts, [&](size_t f, std::span<const float> of_blocks) {
      std::array<float, kHeatParts> row{};
      for (uint32_t b = 0; b < blocks_; ++b) {
        of_loads_.of_block.get(f * blocks_ + b, row);
        for (size_t p = 0; p < kHeatParts; ++p)
          row[p] += static_cast<float>(exchange.emissivity[f] * (share.empty() ? 1 : share[p])) *
                    of_blocks[b * kHeatParts + p];
        of_loads_.of_block.set(f * blocks_ + b, row);
      }
    });
  }

  // W/m2 that a face's loads are off by in every case: [case][part].
  std::vector<float> deviations(uint32_t face) const {
    std::vector<float> out(cases_ * kHeatParts);
    for (size_t c = 0; c < cases_; ++c) followed_->get(face * cases_ + c, {&out[c * kHeatParts], kHeatParts});
    return out;
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

  double slope(uint32_t face, size_t part) const { return double{slope_[face * kHeatParts + part]}; }

  void add(std::vector<float>& out, uint32_t face, size_t part, double kelvin) const {
    float& to = out[face * kHeatParts + part];
    to = static_cast<float>(std::sqrt(double{to} * double{to} + kelvin * kelvin * weight_));
  }

  void massless(const SurfacePart& part, std::vector<float>& out) const {
    const bool open = !group_of(part, 0).back_rows.empty();
    for (size_t i = 0; i < part.members.size(); ++i) {
      const uint32_t above = front(part, i), below = open ? back(part, i) : kNone;
      const std::vector<float> off = deviations(above), off_below = open ? deviations(below) : std::vector<float>{};
      for (size_t b = 0; b < cases_; ++b)
        for (size_t p = 0; p < kHeatParts; ++p) {
          double flux = double{off[b * kHeatParts + p]}, loss = slope(above, p);
          if (open) flux += double{off_below[b * kHeatParts + p]}, loss += slope(below, p);
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
    std::vector<std::vector<float>> off, off_below;
    for (size_t i = 0; i < n; ++i) {
      off.push_back(deviations(front(part, i)));
      if (open) off_below.push_back(deviations(back(part, i)));
    }
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
          line(top, i, slope(above, p), double{off[i][b * kHeatParts + p]});
          open ? line(bottom, i, slope(below, p), double{off_below[i][b * kHeatParts + p]})
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
  LoadErrors of_loads_;
  size_t blocks_, moments_;
  PartMeans parts_;
  size_t faces_;
  // What is followed: so many deviations of each face, whose answers' squares are summed with a weight.
  const CompactRows* followed_ = nullptr;
  size_t cases_ = 0;
  double weight_ = 0;
  std::vector<float> slope_;
};

}  // namespace

LinearErrors linear_errors(const SolvedSurfaces& solved, LoadErrors&& loads) {
  Errors errors(solved, std::move(loads));
  LinearErrors out;
  out.size = errors.of_size();
  out.paths = errors.of_paths();
  return out;
}

}  // namespace suite
