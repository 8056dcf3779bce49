#include "air/parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace suite {

namespace {

// Multiples of the vertical column at which the transmittance of the points is held to that of the parts: long paths,
// and the short ones that opaque parts are seen from, high up (where the column above is a small share) and near by.
constexpr std::array kPaths = {1e-5, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0};
constexpr size_t kColumnPath = 8;  // the column itself
using PerPath = std::array<double, kPaths.size()>;

// A group of parts of neighbouring depth: sums over them.
struct Group {
  double weight = 0, logs = 0;  // logs: of w ln depth
  PerPath through{};            // of w exp(-path depth)
};

constexpr double kLeastDepth = 1e-6, kMostPath = 2;

// The path on which a group's transmittance is kept: its mean free path, or twice the column.
double kept_path(double weight, double logs) { return std::min(kMostPath, std::exp(-logs / weight)); }

// Sum over paths of the squared error of a group's light when one depth stands for all of its parts; added to
// `difference`.
double misfit(const Group& low, const Group& high, PerPath* difference = nullptr) {
  const double weight = high.weight - low.weight;
  if (!(weight > 0)) return 0;
  const double path = kept_path(weight, high.logs - low.logs);
  // The depth over the kept path is between those of its neighbours.
  size_t i = 0;
  while (i + 1 < kPaths.size() && kPaths[i + 1] < path) ++i;
  const auto depth_at = [&](size_t j) {
    return -std::log(std::max((high.through[j] - low.through[j]) / weight, 1e-300));
  };
  double depth = depth_at(i) / kPaths[i];
  if (path > kPaths[i] && i + 1 < kPaths.size()) {
    const double s = (path - kPaths[i]) / (kPaths[i + 1] - kPaths[i]);
    depth = ((1 - s) * depth_at(i) + s * depth_at(i + 1)) / path;
  }
  double sum = 0;
  for (size_t j = 0; j < kPaths.size(); ++j) {
    const double d = weight * std::exp(-kPaths[j] * depth) - (high.through[j] - low.through[j]);
    sum += d * d;
    if (difference) (*difference)[j] += d;
  }
  return sum;
}

// Where to cut 0..n into `count` groups so that the sum of misfits is least: dynamic programming over the last cut.
std::vector<size_t> best_cuts(size_t count, const std::vector<std::vector<double>>& cost) {
  const size_t n = cost.size();
  std::vector<std::vector<double>> best(count + 1, std::vector<double>(n + 1, std::numeric_limits<double>::infinity()));
  std::vector<std::vector<size_t>> from(count + 1, std::vector<size_t>(n + 1, 0));
  best[0][0] = 0;
  for (size_t c = 1; c <= count; ++c)
    for (size_t end = c; end <= n; ++end)
      for (size_t begin = c - 1; begin < end; ++begin) {
        const double total = best[c - 1][begin] + cost[begin][end];
        if (total < best[c][end]) best[c][end] = total, from[c][end] = begin;
      }
  std::vector<size_t> cuts = {n};
  for (size_t c = count; c > 0; --c) cuts.push_back(from[c][cuts.back()]);
  std::reverse(cuts.begin(), cuts.end());
  return cuts;
}

double worst_of(const std::vector<Group>& sums, const std::vector<size_t>& cuts) {
  PerPath difference{};
  for (size_t c = 0; c + 1 < cuts.size(); ++c) misfit(sums[cuts[c]], sums[cuts[c + 1]], &difference);
  double worst = 0;
  for (const double d : difference) worst = std::max(worst, std::abs(d));
  return worst;
}

}  // namespace

double mean_between(double a, double b) {
  if (!(a > 0 && b > 0) || std::abs(a - b) < 1e-4 * (a + b)) return (a + b) / 2;
  return (b - a) / std::log(b / a);
}

Column::Column(std::span<const AirLevel> levels) {
  for (size_t i = 0; i + 1 < levels.size(); ++i) thickness_.push_back(levels[i + 1].height - levels[i].height);
}

double Column::depth(std::span<const float> absorption) const {
  double sum = 0;
  for (size_t i = 0; i < thickness_.size(); ++i) {
    // The mean of an exponential to third order in the ratio; what follows is only sorted and compared by it.
    const double a = static_cast<double>(absorption[i]), b = static_cast<double>(absorption[i + 1]);
    sum += thickness_[i] * (2 * std::sqrt(a * b) + (a + b) / 2) / 3;
  }
  return sum;
}

Parts::Parts(const GasPoints& points, size_t levels) : levels_(levels), weight_(points.weight) {
  absorption_.resize(points.absorption.size());
  for (size_t i = 0; i < levels; ++i)
    for (size_t g = 0; g < count(); ++g) absorption_[g * levels + i] = points.absorption[i * count() + g];
}

void Parts::add(double weight, std::span<const float> absorption) {
  weight_.push_back(weight);
  absorption_.insert(absorption_.end(), absorption.begin(), absorption.end());
}

void Parts::append(const Parts& other) {
  weight_.insert(weight_.end(), other.weight_.begin(), other.weight_.end());
  absorption_.insert(absorption_.end(), other.absorption_.begin(), other.absorption_.end());
}

void Parts::add_to_all(std::span<const float> absorption) {
  for (size_t p = 0; p < count(); ++p)
    for (size_t i = 0; i < levels_; ++i) absorption_[p * levels_ + i] += absorption[i];
}

Parts Parts::times(const GasPoints& points) const {
  Parts out(levels_);
  const Parts other(points, levels_);
  out.weight_.reserve(count() * other.count());
  out.absorption_.resize(count() * other.count() * levels_);
  float* to = out.absorption_.data();
  for (size_t p = 0; p < count(); ++p)
    for (size_t q = 0; q < other.count(); ++q) {
      out.weight_.push_back(weight_[p] * other.weight_[q]);
      const float *a = absorption_.data() + p * levels_, *b = other.absorption_.data() + q * levels_;
      for (size_t i = 0; i < levels_; ++i) *to++ = a[i] + b[i];
    }
  return out;
}

std::vector<double> Parts::depths(const Column& column) const {
  std::vector<double> depth(count());
  for (size_t p = 0; p < count(); ++p) depth[p] = std::max(column.depth(absorption(p)), kLeastDepth);
  return depth;
}

std::vector<float> Parts::joined(size_t first, size_t last, std::span<const double> depth) const {
  std::vector<float> out(levels_, 0.0f);
  if (last == first + 1) {
    std::copy_n(absorption(first).begin(), levels_, out.begin());
    return out;
  }
  double weight = 0, logs = 0;
  for (size_t p = first; p < last; ++p) weight += weight_[p], logs += weight_[p] * std::log(depth[p]);
  if (!(weight > 0)) return out;
  // -ln of the group's light over the kept path is the integral of its mean absorption among the light that is left;
  // so is each level's share of it. Gauss points of four along the path.
  constexpr double at[] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263},
                   quadrature[] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
  const double path = kept_path(weight, logs);
  std::vector<double> share(last - first, 0.0);
  for (size_t q = 0; q < std::size(at); ++q) {
    double left = 0;
    for (size_t p = first; p < last; ++p) left += weight_[p] * std::exp(-at[q] * path * (depth[p] - depth[first]));
    for (size_t p = first; p < last; ++p)
      share[p - first] += quadrature[q] * weight_[p] * std::exp(-at[q] * path * (depth[p] - depth[first])) / left;
  }
  std::vector<double> sum(levels_, 0.0);
  for (size_t p = first; p < last; ++p)
    for (size_t i = 0; i < levels_; ++i) sum[i] += share[p - first] * static_cast<double>(absorption_[p * levels_ + i]);
  for (size_t i = 0; i < levels_; ++i) out[i] = static_cast<float>(sum[i]);
  return out;
}

Parts Parts::sorted(const Column& column, std::vector<double>& depth) const {
  const std::vector<double> mine = depths(column);
  std::vector<size_t> order(count());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return mine[a] < mine[b]; });
  Parts out(levels_);
  depth.clear();
  for (const size_t p : order) {
    if (!(weight_[p] > 0)) continue;
    out.add(weight_[p], absorption(p));
    depth.push_back(mine[p]);
  }
  return out;
}

// Bins even in the logarithm of the depth, from 1e-4 to 1e6; what is beyond is one.
Parts Parts::gathered(const Column& column, size_t most) const {
  std::vector<double> depth;
  const Parts from = sorted(column, depth);
  const auto bin = [&](double d) {
    const double s = (std::log10(std::clamp(d, 1e-4, 1e6)) + 4) / 10;
    return static_cast<int>(s * static_cast<double>(most));
  };
  Parts out(levels_);
  for (size_t first = 0, last = 0; first < from.count(); first = last) {
    double weight = 0;
    for (; last < from.count() && bin(depth[last]) == bin(depth[first]); ++last) weight += from.weight(last);
    out.add(weight, from.joined(first, last, depth));
  }
  return out;
}

GasPoints Parts::reduced(const Column& column, const GasReduction& reduction) const {
  std::vector<double> depth;
  const Parts from = (count() > kPartsOfInterval ? gathered(column, kPartsOfInterval) : *this).sorted(column, depth);
  const size_t n = from.count();
  std::vector<Group> sums(n + 1);
  for (size_t p = 0; p < n; ++p) {
    const double w = from.weight(p);
    sums[p + 1] = sums[p];
    sums[p + 1].weight += w;
    sums[p + 1].logs += w * std::log(depth[p]);
    for (size_t j = 0; j < kPaths.size(); ++j) sums[p + 1].through[j] += w * std::exp(-kPaths[j] * depth[p]);
  }
  std::vector<size_t> cuts = {0, n};
  const size_t most = std::min(n, static_cast<size_t>(reduction.most));
  const double taken = 1 - sums[n].through[kColumnPath] / sums[n].weight;
  if (most > 1 && taken >= reduction.thin && worst_of(sums, cuts) > reduction.error) {
    std::vector<std::vector<double>> cost(n, std::vector<double>(n + 1, 0.0));
    for (size_t a = 0; a < n; ++a)
      for (size_t b = a + 1; b <= n; ++b) cost[a][b] = misfit(sums[a], sums[b]);
    for (size_t c = 2; c <= most; ++c) {
      cuts = best_cuts(c, cost);
      if (worst_of(sums, cuts) <= reduction.error) break;
    }
  }
  GasPoints out;
  out.absorption.resize(levels_ * (cuts.size() - 1));
  for (size_t c = 0; c + 1 < cuts.size(); ++c) {
    out.weight.push_back(sums[cuts[c + 1]].weight - sums[cuts[c]].weight);
    const std::vector<float> k = from.joined(cuts[c], cuts[c + 1], depth);
    for (size_t i = 0; i < levels_; ++i) out.absorption[i * (cuts.size() - 1) + c] = k[i];
  }
  const double total = std::accumulate(out.weight.begin(), out.weight.end(), 0.0);
  for (double& w : out.weight) w /= total;
  return out;
}

}  // namespace suite
