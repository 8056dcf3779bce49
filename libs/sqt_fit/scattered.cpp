#include "sqt_fit/scattered.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite::sqt {

namespace {

constexpr size_t kDimensions = 4, kNeighbours = 8, kView = 2;  // kView: the coordinate of views of isotropic data
constexpr double kScatteredSame = 1e-6;                        // closer coordinates are of one place
using Point = std::array<double, kDimensions>;

// Balanced k-d tree over points, implicit: the middle of every range splits it along the widest side of that range.
class NearestTree {
 public:
  explicit NearestTree(std::vector<Point> points)
      : points_(std::move(points)), order_(points_.size()), axis_(points_.size()) {
    for (size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<uint32_t>(i);
    build(0, order_.size());
  }
  struct Found {
    double distance2;
    uint32_t index;
  };
  const Point& point(uint32_t index) const { return points_[index]; }
  // The nearest min(kNeighbours, size) points, unordered; returns how many.
  size_t nearest(const Point& at, std::array<Found, kNeighbours>& found) const {
    size_t count = 0;
    search(0, order_.size(), at, found, count);
    return count;
  }

 private:
  void build(size_t begin, size_t end) {
    if (end - begin < 2) return;
    Point low, high;
    low.fill(INFINITY), high.fill(-INFINITY);
    for (size_t i = begin; i < end; ++i)
      for (size_t d = 0; d < kDimensions; ++d) {
        low[d] = std::min(low[d], points_[order_[i]][d]);
        high[d] = std::max(high[d], points_[order_[i]][d]);
      }
    size_t axis = 0;
    for (size_t d = 1; d < kDimensions; ++d)
      if (high[d] - low[d] > high[axis] - low[axis]) axis = d;
    const size_t middle = (begin + end) / 2;
    std::nth_element(order_.begin() + static_cast<ptrdiff_t>(begin), order_.begin() + static_cast<ptrdiff_t>(middle),
                     order_.begin() + static_cast<ptrdiff_t>(end), [&](uint32_t a, uint32_t b) {
                       return points_[a][axis] != points_[b][axis] ? points_[a][axis] < points_[b][axis] : a < b;
                     });
    axis_[middle] = static_cast<uint8_t>(axis);
    build(begin, middle);
    build(middle + 1, end);
  }
  void search(size_t begin, size_t end, const Point& at, std::array<Found, kNeighbours>& found, size_t& count) const {
    if (begin >= end) return;
    const size_t middle = (begin + end) / 2;
    const Point& p = points_[order_[middle]];
    double d2 = 0;
    for (size_t d = 0; d < kDimensions; ++d) d2 += (p[d] - at[d]) * (p[d] - at[d]);
    if (count < kNeighbours || d2 < found[0].distance2) {  // found is a heap, farthest first
      auto farther = [](const Found& a, const Found& b) { return a.distance2 < b.distance2; };
      if (count == kNeighbours)
        std::pop_heap(found.begin(), found.end(), farther);
      else
        ++count;
      found[count - 1] = {d2, order_[middle]};
      std::push_heap(found.begin(), found.begin() + static_cast<ptrdiff_t>(count), farther);
    }
    const double side = at[axis_[middle]] - p[axis_[middle]];
    const bool lower_first = side < 0;
    if (lower_first)
      search(begin, middle, at, found, count);
    else
      search(middle + 1, end, at, found, count);
    if (count < kNeighbours || side * side < found[0].distance2) {
      if (lower_first)
        search(middle + 1, end, at, found, count);
      else
        search(begin, middle, at, found, count);
    }
  }
  std::vector<Point> points_;
  std::vector<uint32_t> order_;
  std::vector<uint8_t> axis_;
};

// Weights of points that lie `away` (1: the farthest), so that what is linear in the coordinates comes out as it is:
// the value at 0 of the plane that fits best under the weights given, with slopes that little speaks for held down. Sum
// 1 afterwards.
void make_linear(std::span<double> weight, const std::array<Point, kNeighbours>& away, size_t dimensions) {
  const size_t n = dimensions + 1;
  constexpr double kHeld = 1e-3;
  std::array<std::array<double, kDimensions + 2>, kDimensions + 1> m{};  // normal equations, right side last
  double sum = 0;
  for (const double w : weight) sum += w;
  const auto term = [&](size_t i, size_t k) { return k == 0 ? 1.0 : away[i][k - 1]; };
  for (size_t i = 0; i < weight.size(); ++i)
    for (size_t a = 0; a < n; ++a)
      for (size_t b = 0; b < n; ++b) m[a][b] += weight[i] / sum * term(i, a) * term(i, b);
  for (size_t a = 1; a < n; ++a) m[a][a] += kHeld;
  m[0][n] = 1;
  // Elimination without pivots: the matrix is symmetric and positive.
  for (size_t a = 0; a < n; ++a)
    for (size_t b = a + 1; b < n; ++b) {
      const double by = m[b][a] / m[a][a];
      for (size_t c = a; c <= n; ++c) m[b][c] -= by * m[a][c];
    }
  std::array<double, kDimensions + 1> x{};
  for (size_t a = n; a-- > 0;) {
    x[a] = m[a][n];
    for (size_t b = a + 1; b < n; ++b) x[a] -= m[a][b] * x[b];
    x[a] /= m[a][a];
  }
  for (size_t i = 0; i < weight.size(); ++i) {
    double factor = 0;
    for (size_t k = 0; k < n; ++k) factor += x[k] * term(i, k);
    weight[i] *= factor / sum;
  }
}

class Scattered final : public Function {
 public:
  explicit Scattered(const Samples& s) : info_(s.info) {
    const size_t channels = info_.wavelength_um.size();
    if (s.out.size() != s.in.size() || s.value.size() != s.in.size() * channels || channels == 0)
      throw Error("scattered samples: the numbers of directions and values do not fit");
    for (size_t side = 0; side < 2; ++side) {
      std::vector<Sample> list;
      for (size_t i = 0; i < s.in.size(); ++i)
        if (counts(s, i) && side_of(s.in[i]) == side) list.push_back({coordinates(s.out[i], s.in[i]), i});
      if (!list.empty()) keep(std::move(list), s, side);
    }
    if (slices_[0].empty() && slices_[1].empty())
      throw Error("scattered samples: none of them is valid", "every channel of a sample needs a finite value");
  }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    const size_t side = side_of(in);
    const bool nothing = surface() && (!(out.z > 0) || in.z == 0 || (in.z < 0 && info_.domain == Domain::hemisphere));
    std::fill(f.begin(), f.end(), nothing ? std::nan("") : 0.0);
    if (nothing || slices_[side].empty()) return;
    const Point at = coordinates(out, in);
    const std::vector<Slice>& slices = slices_[side];
    const auto above = std::upper_bound(slices.begin(), slices.end(), at[kView],
                                        [](double view, const Slice& slice) { return view < slice.view; });
    if (above == slices.begin() || above == slices.end())  // beyond the views the last one holds
      return add(above == slices.begin() ? slices.front() : slices.back(), at, side, 1, f);
    const Slice& below = *(above - 1);
    const double t = (at[kView] - below.view) / (above->view - below.view);
    add(below, at, side, 1 - t, f);
    add(*above, at, side, t, f);
  }

 private:
  struct Sample {
    Point at;
    size_t index;
  };
  bool counts(const Samples& s, size_t i) const {
    const size_t channels = info_.wavelength_um.size();
    for (size_t c = 0; c < channels; ++c)
      if (!std::isfinite(s.value[i * channels + c])) return false;
    return !surface() || (s.out[i].z > 0 && s.in[i].z != 0);
  }
  // Samples of one view of isotropic data, or all samples.
  struct Slice {
    double view;                  // coordinate kView
    NearestTree tree;             // bilateral places stand on both sides of the plane of the view
    std::vector<uint32_t> place;  // of each point of the tree
  };

  // Samples of one place become their mean: the two sides of bilateral data that are measured on both, above all, would
  // else fill the neighbourhood with half as many places.
  void keep(std::vector<Sample> list, const Samples& s, size_t side) {
    const size_t channels = info_.wavelength_um.size();
    const auto cell = [](const Sample& sample) {
      std::array<long long, kDimensions> k{};
      for (size_t d = 0; d < kDimensions; ++d) k[d] = std::llround(sample.at[d] / kScatteredSame);
      std::swap(k[0], k[kView]);  // the view first
      return k;
    };
    std::stable_sort(list.begin(), list.end(), [&](const Sample& a, const Sample& b) { return cell(a) < cell(b); });
    std::vector<Point> places;
    for (size_t first = 0, last = 0; first < list.size(); first = last) {
      std::vector<double> sum(channels, 0);
      for (; last < list.size() && cell(list[last]) == cell(list[first]); ++last)
        for (size_t c = 0; c < channels; ++c) sum[c] += s.value[list[last].index * channels + c];
      for (const double v : sum) values_[side].push_back(static_cast<float>(v / static_cast<double>(last - first)));
      places.push_back(list[first].at);
    }
    const std::vector<size_t> ends = views(places);
    for (size_t first = 0, k = 0; k < ends.size(); first = ends[k++])
      slices_[side].push_back(slice(std::span(places).subspan(first, ends[k] - first), first));
    sliced_[side] = ends.size() > 1;
  }

  // Where the views of places in their order end. An instrument's tables have few views with many places each: these
  // are interpolated by themselves, for places that stand far apart within a view have nearer ones in other views, of
  // which a plane through the nearest would be one. One slice for everything else.
  std::vector<size_t> views(const std::vector<Point>& places) const {
    constexpr size_t kPlacesOfAView = 24;
    std::vector<size_t> ends;
    size_t first = 0;
    for (size_t i = 1; i <= places.size(); ++i) {
      if (i < places.size() && places[i][kView] - places[i - 1][kView] <= 2 * kScatteredSame) continue;
      if (!surface() || !info_.isotropic || i - first < kPlacesOfAView) return {places.size()};
      ends.push_back(i), first = i;
    }
    return ends;
  }

  Slice slice(std::span<const Point> places, size_t first) const {
    std::vector<Point> points;
    std::vector<uint32_t> place;
    for (size_t i = 0; i < places.size(); ++i) {
      Point at = places[i];
      points.push_back(at), place.push_back(static_cast<uint32_t>(first + i));
      if (!surface() || !info_.isotropic || !info_.bilateral || at[1] <= kScatteredSame) continue;
      at[1] = -at[1];
      points.push_back(at), place.push_back(static_cast<uint32_t>(first + i));
    }
    const double view = places.front()[kView];
    return {view, NearestTree(std::move(points)), std::move(place)};
  }

  // Adds `share` times what a slice says.
  void add(const Slice& slice, Point at, size_t side, double share, std::span<double> f) const {
    if (sliced_[side]) at[kView] = slice.view;
    const size_t dimensions = sliced_[side] ? 2 : all_dimensions();
    std::array<NearestTree::Found, kNeighbours> found;
    const size_t count = slice.tree.nearest(at, found);
    // Weights fall to zero at the farthest of the neighbours, so that the function is continuous as neighbours change.
    double farthest = 0;
    for (size_t i = 0; i < count; ++i) farthest = std::max(farthest, found[i].distance2);
    farthest = std::sqrt(farthest) * 1.0001 + 1e-12;
    std::array<double, kNeighbours> weight;
    std::array<Point, kNeighbours> away;
    for (size_t i = 0; i < count; ++i) {
      const double d = std::sqrt(found[i].distance2) + 1e-9;
      weight[i] = std::pow((farthest - d) / (farthest * d), 2) + 1e-12;
      const Point& p = slice.tree.point(found[i].index);
      for (size_t k = 0; k < dimensions; ++k) away[i][k] = (p[k] - at[k]) / farthest;
    }
    make_linear(std::span(weight).first(count), away, dimensions);
    for (size_t c = 0; c < f.size(); ++c) {
      double sum = 0, low = INFINITY, high = -INFINITY;
      for (size_t i = 0; i < count; ++i) {
        const double v = values_[side][size_t{slice.place[found[i].index]} * f.size() + c];
        sum += weight[i] * v, low = std::min(low, v), high = std::max(high, v);
      }
      f[c] += share * std::clamp(sum, low, high);
    }
  }
  bool surface() const { return info_.quantity == Quantity::bsdf; }
  // Of the coordinates, those that are not 0 in any case.
  size_t all_dimensions() const {
    return info_.quantity == Quantity::phase ? 1 : info_.quantity == Quantity::bsdf && !info_.isotropic ? 4 : 3;
  }
  size_t side_of(Dir in) const { return surface() && in.z < 0 ? 1 : 0; }
  Point coordinates(Dir out, Dir in) const {
    if (info_.quantity == Quantity::phase) return {3 * angle_between(out, in), 0, 0, 0};
    if (info_.quantity == Quantity::intensity) return {in.x, in.y, in.z, 0};
    if (in.z < 0) in.z = -in.z;
    const Vec3 sum = out + in;
    const double len = length(sum);
    const Dir h = len > 1e-12 ? sum / len : Dir{0, 0, 1};
    // The view counts half: shapes change slowly with it once the lobe stands still.
    if (!info_.isotropic) return {h.x, h.y, 0.5 * out.x, 0.5 * out.y};
    const double r = std::hypot(out.x, out.y);
    const double c = r > 1e-9 ? out.x / r : 1, s = r > 1e-9 ? out.y / r : 0;
    const double x = c * h.x + s * h.y, y = c * h.y - s * h.x;
    return {x, info_.bilateral ? std::fabs(y) : y, 0.5 * polar_angle(out), 0};
  }
  Info info_;
  std::vector<Slice> slices_[2];  // of each side, by view
  bool sliced_[2] = {false, false};
  std::vector<float> values_[2];  // [place][channel]
};

}  // namespace

std::shared_ptr<const Function> interpolate(const Samples& samples) { return std::make_shared<Scattered>(samples); }

}  // namespace suite::sqt
