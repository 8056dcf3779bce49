#include "correction/air_kernel.h"

#include <algorithm>
#include <cmath>

#include "air/column.h"
#include "air/phase_grid.h"
#include "base/parallel.h"
#include "math/sampling.h"
#include "math/vec.h"

namespace suite {

namespace {

constexpr double kFlattest = 1e-6;  // cosine: flatter flights are taken as this flat
constexpr double kLight = 0.05;     // weight below which half of the photons end

// Phase functions of all bins at phase_cosines(): [kind][cosine][bin], 1/sr.
using PhaseValues = std::vector<std::vector<std::vector<float>>>;

PhaseValues phase_values(const AirColumn& column) {
  PhaseValues values;
  for (const AirColumn::Kind& kind : column.kinds) {
    std::vector<std::vector<float>>& rows = values.emplace_back();
    for (const double cosine : phase_cosines()) {
      std::vector<float>& row = rows.emplace_back(column.bins);
      const std::span<float> all(row);
      const bool one = kind.phase->spectrally_uniform();
      kind.phase->eval(cosine, one ? all.first(1) : all);
      if (one) std::ranges::fill(row, row[0]);
    }
  }
  return values;
}

// Cosines of one phase function, linear between those of the grid.
class Turns {
 public:
  Turns(const std::vector<std::vector<float>>& rows, size_t bin) {
    const std::span<const double> cosines = phase_cosines();
    values_.resize(cosines.size());
    upto_.assign(cosines.size(), 0.0);
    for (size_t i = 0; i < cosines.size(); ++i) values_[i] = std::max(0.0, double{rows[i][bin]});
    for (size_t i = 1; i < cosines.size(); ++i)
      upto_[i] = upto_[i - 1] + 0.5 * (values_[i - 1] + values_[i]) * (cosines[i] - cosines[i - 1]);
  }
  double draw(double u) const {
    const std::span<const double> cosines = phase_cosines();
    const double wanted = u * upto_.back();
    const auto found = static_cast<size_t>(std::ranges::upper_bound(upto_, wanted) - upto_.begin());
    const size_t i = std::clamp<size_t>(found, 1, upto_.size() - 1) - 1;
    const double width = cosines[i + 1] - cosines[i], rest = wanted - upto_[i];
    const double a = values_[i], slope = (values_[i + 1] - values_[i]) / width;
    // a s + slope s^2 / 2 = rest, in the form without cancellation.
    const double root = std::sqrt(std::max(0.0, a * a + 2 * slope * rest));
    const double step = a + root > 0 ? 2 * rest / (a + root) : 0.5 * width;
    return std::clamp(cosines[i] + std::min(step, width), -1.0, 1.0);
  }

 private:
  std::vector<double> values_, upto_;
};

// Uniform numbers of one photon.
class Draws {
 public:
  explicit Draws(uint64_t key) : key_(key) {}
  double next() { return unit_double(hash_of(key_, ++count_)); }

 private:
  uint64_t key_, count_ = 0;
};

struct Photon {
  double depth, height;  // vertical depth and height above the ground
  double x = 0, y = 0;   // m
  Dir way{0, 0, -1};
  double weight = 1;
};

// The air of one bin over the ground, and walks in it.
class BinWalks {
 public:
  BinWalks(const AirColumn& column, const PhaseValues& phases, size_t bin) : bin_(bin) {
    const std::span<const double> heights = column.shells.heights();
    for (size_t l = column.ground; l <= column.layers(); ++l) heights_.push_back(heights[l] - heights[column.ground]);
    depths_.push_back(0);
    for (size_t l = column.ground; l < column.layers(); ++l) add_layer(column, l, heights[l + 1] - heights[l]);
    for (const auto& rows : phases) turns_.emplace_back(rows, bin);
  }

  double depth_at(double height) const {
    const size_t l = layer_of(heights_, height);
    const double share = (height - heights_[l]) / (heights_[l + 1] - heights_[l]);
    return depths_[l] + std::clamp(share, 0.0, 1.0) * (depths_[l + 1] - depths_[l]);
  }
  double top() const { return heights_.back(); }

  // score(distance, share) for every part of a photon's light that reaches the ground.
  template <class Score>
  void walk(double height, double first, Draws& draws, Score&& score) const {
    Photon p{depth_at(height), height, 0, 0, {0, 0, -1}, 1};
    for (bool straight = true; p.weight > 0; straight = false) {
      const double flat = std::max(std::fabs(p.way.z), kFlattest);
      const double whole = (p.way.z < 0 ? p.depth : depths_.back() - p.depth) / flat, passed = std::exp(-whole);
      if (p.way.z < 0 && !straight) {
        const double far = p.height / flat;
        score(std::hypot(p.x + p.way.x * far, p.y + p.way.y * far), p.weight * passed);
      }
      p.weight *= -std::expm1(-whole);
      if (!(p.weight > 0)) return;
      const double u = straight ? first : draws.next();
      fly(p, -std::log1p(u * std::expm1(-whole)), flat);
      scatter(p, draws);
      if (p.weight < kLight) p.weight = draws.next() < 0.5 ? 2 * p.weight : 0;
    }
  }

 private:
  static size_t layer_of(const std::vector<double>& edges, double at) {
    const auto above = static_cast<size_t>(std::ranges::upper_bound(edges, at) - edges.begin());
    return std::clamp<size_t>(above, 1, edges.size() - 1) - 1;
  }
  void add_layer(const AirColumn& column, size_t l, double thickness) {
    const double extinction = double{column.extinction[l * column.bins + bin_]};
    depths_.push_back(depths_.back() + extinction * thickness);
    double scattered = 0;
    std::vector<double>& shares = shares_.emplace_back();
    for (const AirColumn::Kind& k : column.kinds)
      shares.push_back(scattered += double{k.scattering[l * column.bins + bin_]});
    albedos_.push_back(extinction > 0 ? std::min(1.0, scattered / extinction) : 0);
  }
  // Along its way by a slant depth.
  void fly(Photon& p, double slant, double flat) const {
    const double from = p.height;
    p.depth = std::clamp(p.depth + (p.way.z < 0 ? -slant : slant) * flat, 0.0, depths_.back());
    const size_t l = layer_of(depths_, p.depth);
    const double whole = depths_[l + 1] - depths_[l], share = whole > 0 ? (p.depth - depths_[l]) / whole : 0;
    p.height = heights_[l] + share * (heights_[l + 1] - heights_[l]);
    const double far = std::fabs(p.height - from) / flat;
    p.x += p.way.x * far, p.y += p.way.y * far;
  }
  void scatter(Photon& p, Draws& draws) const {
    const size_t l = layer_of(depths_, p.depth);
    p.weight *= albedos_[l];
    if (!(p.weight > 0)) return;
    const std::vector<double>& shares = shares_[l];
    const double which = draws.next() * shares.back();
    size_t kind = 0;
    while (kind + 1 < shares.size() && which >= shares[kind]) ++kind;
    const double cosine = turns_[kind].draw(draws.next());
    // scattered_direction() takes and gives directions that point away from the place.
    p.way = scattered_direction(-p.way, cosine, draws.next());
  }

  size_t bin_;
  std::vector<double> heights_, depths_;     // of levels from the ground
  std::vector<double> albedos_;              // of layers
  std::vector<std::vector<double>> shares_;  // [layer][kind], running sums
  std::vector<Turns> turns_;
};

void check_kernel(const AirColumn& column, double scene_height, std::span<const double> heights,
                  const KernelSpec& spec) {
  for (size_t i = 0; i < spec.radii.size(); ++i)
    if (!(spec.radii[i] > (i ? spec.radii[i - 1] : 0)))
      throw Error(strf("radii of an adjacency kernel do not ascend at %g m", spec.radii[i]),
                  "give positive, ascending ones");
  if (spec.radii.empty()) throw Error("an adjacency kernel has no radii", "give at least one");
  if (spec.photons < 64 || spec.photons > 10000000)
    throw Error(strf("%u photons of an adjacency kernel", spec.photons), "give 64 to 1e7");
  const double ground = column.shells.heights()[column.ground];
  for (const double h : heights)
    if (!(h - scene_height > ground))
      throw Error(strf("a sensor %g m above sea level is not above the ground (%g m)", h, ground + scene_height));
}

}  // namespace

std::vector<AirKernel> air_kernel(const AirSpec& air, const SpectralState& state, std::span<const double> heights,
                                  const KernelSpec& spec) {
  const AirColumn column = bake_column(air, state);
  check_kernel(column, air.height_of_scene(), heights, spec);
  const double ground = column.shells.heights()[column.ground] + air.height_of_scene();
  const PhaseValues phases = phase_values(column);
  std::vector<AirKernel> out(heights.size());
  for (AirKernel& k : out) {
    k.direct.assign(state.size(), 0.0);
    for (auto& batch : k.rings) batch.assign(spec.radii.size() + 1, std::vector<double>(state.size(), 0.0));
  }
  const uint32_t each = (spec.photons + kKernelBatches - 1) / kKernelBatches;
  parallel_for(0, state.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const BinWalks walks(column, phases, i);
      for (size_t h = 0; h < heights.size(); ++h) {
        const double height = std::min(heights[h] - ground, walks.top());
        out[h].direct[i] = std::exp(-walks.depth_at(height));
        for (uint32_t n = 0; n < kKernelBatches * each; ++n) {
          Draws draws(hash_of(spec.seed, i, n));
          auto& rings = out[h].rings[n / each];
          walks.walk(height, (n % each + draws.next()) / each, draws, [&](double r, double share) {
            const auto ring = static_cast<size_t>(std::ranges::upper_bound(spec.radii, r) - spec.radii.begin());
            rings[ring][i] += share / each;
          });
        }
      }
    }
  });
  return out;
}

}  // namespace suite
