// The scale that gives the decoded trees of the aligned method the totals of the data; see aligned.h.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "sqt/polar_profile.h"
#include "sqt/portable_math.h"
#include "sqt/theta_grid.h"
#include "sqt/tree.h"
#include "sqt_fit/aligned_fit.h"

namespace suite::sqt {

namespace {

constexpr size_t kStride = AlignedSheet::kStride;

// Coarse leaves are looked at in parts of this order, so that only those near the horizon need many points.
constexpr int kPartOrder = 5;

// A square part of a leaf, all of it if it is fine enough: its cell, its lower corner and its width in the leaf.
struct LeafPart {
  CellId id;
  double x, y, width;
};

constexpr size_t kLanes = 8;
using FourDoubles = double __attribute__((vector_size(32)));
using FourFloats = float __attribute__((vector_size(16)));
size_t whole_lanes(size_t points) { return (points + kLanes - 1) / kLanes * kLanes; }

// Points of a part on a square grid, and where they are in the leaf; offsets are filled up to whole lanes.
struct LeafGrid {
  int side = 0;
  std::vector<double> x, y, z;  // directions, filled up like the offsets
  std::vector<float> dx, dy;
  std::vector<float> profile;  // log2 of the profile along the normal there, [channel][point]; empty: not asked yet
  void fill(const LeafPart& part, int n) {
    side = n;
    const size_t all = whole_lanes(points());
    for (std::vector<double>* v : {&x, &y, &z}) v->assign(all, 0.0);
    directions_in(part.id, n, x.data(), y.data(), z.data());
    dx.assign(all, 0.0f), dy.assign(all, 0.0f), profile.clear();
    for (int k = 0; k < n * n; ++k) {
      const double ux = (k % n + 0.5) / n, uy = (k / n + 0.5) / n;
      dx[static_cast<size_t>(k)] = static_cast<float>(part.x + ux * part.width - 0.5);
      dy[static_cast<size_t>(k)] = static_cast<float>(part.y + uy * part.width - 0.5);
    }
  }
  size_t points() const { return static_cast<size_t>(side * side); }
  void ask(const PolarProfile& polar, size_t sheet, size_t channels) {
    std::vector<PolarProfile::At> at;
    for (size_t k = 0; k < points(); ++k) at.push_back(PolarProfile::locate(1 - z[k]));
    profile.assign(channels * dx.size(), 0);
    for (size_t c = 0; c < channels; ++c)
      for (size_t k = 0; k < at.size(); ++k) profile[c * dx.size() + k] = polar.log2(sheet, at[k], c);
  }
};

// One view of the totals: its map on either sheet, and the slices it lies between.
struct TotalView {
  LobeMap map[2];
  size_t low, high;
  float w0, w1;
};

std::vector<TotalView> total_views(const AlignedLayout& layout, const AlignedTotals& totals) {
  const ThetaGrid grid(layout.theta);
  std::vector<TotalView> views;
  for (const double theta : totals.theta)
    for (size_t j = 0; j < totals.phi_count; ++j) {  // same azimuths in both grids
      const double phi = 2 * kPi * static_cast<double>(j) / static_cast<double>(totals.phi_count);
      const Dir out = dir_from_angles(theta, phi);
      const ThetaGrid::At at = grid.locate(theta);
      const size_t next = std::min(at.low + 1, grid.size() - 1);
      const float w1 = static_cast<float>(at.t);
      views.push_back({{{layout.frame, out, false}, {layout.frame, out, true}},
                       at.low * layout.phi_count + j,
                       next * layout.phi_count + j,
                       1 - w1,
                       w1});
    }
  return views;
}

// Adds a leaf's share of the integral of f |cos| to every view: integral[view][channel].
class LeafIntegral {
 public:
  LeafIntegral(const AlignedLayout& layout, LogScale scale, const PolarProfile& polar,
               const std::vector<TotalView>& views)
      : layout_(layout), scale_(scale), polar_(polar), views_(views) {}

  void add(CellId id, size_t sheet, const int16_t* leaf, std::vector<double>& integral) {
    const double copies = layout_.half_stored && mirrored(id) != id ? 2 : 1;
    const int extra = std::max(0, kPartOrder - id.order());
    const uint32_t side = 1u << extra;
    for (uint32_t k = 0; k < side * side; ++k) {
      const CellId part = CellId::of(id.order() + extra, (id.index() << (2 * extra)) + k);
      const CellXY at = xy_of(part);
      const double width = 1.0 / side;
      add({part, width * (at.x % side), width * (at.y % side), width}, copies, sheet, leaf, integral);
    }
  }

 private:
  void add(const LeafPart& part, double copies, size_t sheet, const int16_t* leaf, std::vector<double>& integral) {
    const int order = part.id.order();
    const double width = std::sqrt(cell_solid_angle(order));
    const int usual = order >= 7 ? 1 : order == 6 ? 2 : 4;
    const Dir center = center_of(part.id);
    for (LeafGrid& g : grids_) g.side = 0;
    for (size_t t = 0; t < views_.size(); ++t) {
      const LobeMap& map = views_[t].map[sheet];
      // Near the horizon the cosine changes within a part, and what lies below does not count: look more closely.
      const double above = layout_.cosine_weighted ? map.cosine(center) : 1;
      if (layout_.upper_only && above < -2 * width) continue;
      // Between the profile along the normal, which is smooth, and planes, which jump, always.
      const bool polar = views_[t].low == 0 && !polar_.empty();
      const int closer = polar ? 4 : std::clamp(static_cast<int>(6 * width / std::max(std::fabs(above), width)), 1, 4);
      LeafGrid& grid = grids_[static_cast<size_t>(closer - 1)];
      if (!grid.side) grid.fill(part, closer * usual);
      if (!weigh(grid, map)) continue;
      if (polar && grid.profile.empty()) grid.ask(polar_, sheet, layout_.channels);
      const double area = cell_solid_angle(order) * copies;
      if (polar)
        add_polar(grid, part.width, area, views_[t], leaf, &integral[t * layout_.channels]);
      else
        add(grid, part.width, area, views_[t], leaf, &integral[t * layout_.channels]);
    }
  }
  // What the points count for; false: nothing.
  bool weigh(const LeafGrid& grid, const LobeMap& map) {
    weight_.resize(grid.dx.size());
    FourDoubles any{};
    for (size_t k = 0; k < grid.x.size(); k += 4) {
      const auto [cosine, stretch] = map.cosine_and_stretch(
          load<FourDoubles>(&grid.x[k]), load<FourDoubles>(&grid.y[k]), load<FourDoubles>(&grid.z[k]));
      FourDoubles weight = layout_.cosine_weighted ? stretch * (cosine < 0 ? -cosine : cosine) : stretch;
      if (layout_.upper_only) weight = cosine > 0 ? weight : FourDoubles{};
      any += weight;
      store(&weight_[k], __builtin_convertvector(weight, FourFloats));
    }
    // What fills up the lanes is not summed.
    return any[0] + any[1] + any[2] + any[3] > 0;
  }
  // Sum of weight times 2^log2(k) over the points, in their order; log2 gives eight.
  float sum_of(size_t points, const auto& log2) const {
    float sum = 0;
    for (size_t k = 0; k < points; k += kLanes) {
      const EightFloats f = load<EightFloats>(&weight_[k]) * portable_exp2(log2(k));
      if (points - k >= kLanes)
        for (size_t i = 0; i < kLanes; ++i) sum += f[i];
      else
        for (size_t i = 0; i < points - k; ++i) sum += f[i];
    }
    return sum;
  }
  // Between the profile along the normal and the slice above.
  void add_polar(const LeafGrid& grid, double width, double area, const TotalView& view, const int16_t* leaf,
                 double* integral) const {
    const size_t views = layout_.views(), points = grid.points();
    const float to_slope = view.w1 * scale_.unit() * static_cast<float>(width / grid.side);
    for (size_t c = 0; c < layout_.channels; ++c) {
      const int16_t* b = leaf + (c * views + view.high) * kStride;
      const float value = b[0], gx = b[1], gy = b[2];
      const float* const profile = &grid.profile[c * grid.dx.size()];
      const float sum = sum_of(points, [&](size_t k) {
        const EightFloats number = value + load<EightFloats>(&grid.dx[k]) * gx + load<EightFloats>(&grid.dy[k]) * gy;
        return view.w0 * load<EightFloats>(profile + k) +
               view.w1 * (static_cast<float>(scale_.offset) + number * scale_.unit());
      });
      integral[c] += static_cast<double>(sum * mean_exp2(to_slope * gx) * mean_exp2(to_slope * gy)) * area /
                     static_cast<double>(points);
    }
  }
  void add(const LeafGrid& grid, double width, double area, const TotalView& view, const int16_t* leaf,
           double* integral) const {
    const size_t views = layout_.views(), channels = layout_.channels, points = grid.points();
    const float spacing = static_cast<float>(width / grid.side);
    for (size_t c = 0; c < channels; ++c) {
      const int16_t* a = leaf + (c * views + view.low) * kStride;
      const int16_t* b = leaf + (c * views + view.high) * kStride;
      const float unit = scale_.unit();
      const float v = scale_.value(view.w0 * a[0] + view.w1 * b[0]), gx = unit * (view.w0 * a[1] + view.w1 * b[1]),
                  gy = unit * (view.w0 * a[2] + view.w1 * b[2]);
      const float sum = sum_of(points, [&](size_t k) {
        return v + load<EightFloats>(&grid.dx[k]) * gx + load<EightFloats>(&grid.dy[k]) * gy;
      });
      integral[c] += static_cast<double>(sum * mean_exp2(gx * spacing) * mean_exp2(gy * spacing)) * area /
                     static_cast<double>(points);
    }
  }
  const AlignedLayout& layout_;
  LogScale scale_;
  const PolarProfile& polar_;
  const std::vector<TotalView>& views_;
  std::array<LeafGrid, 4> grids_;
  std::vector<float> weight_;
};

// The profile that a bundle of these sheets makes of its first slice.
PolarProfile profile_of(const AlignedLayout& layout, bool isotropic, const std::vector<AlignedSheet>& sheets) {
  std::vector<Tree> trees;
  std::vector<LogScale> scales;
  for (const AlignedSheet& sheet : sheets) trees.emplace_back(sheet.leaves), scales.push_back(sheet.scale);
  return polar_profile(layout, isotropic, scales, [&](size_t s, Dir d) -> LeafPlace {
    const FacePoint p = face_point_fast(d);
    const Tree::Found found = trees[s].find(p);
    if (found.leaf < 0) return {};
    const double cells = static_cast<double>(1u << found.order), x = p.x * cells, y = p.y * cells;
    return {&sheets[s].plane[static_cast<size_t>(found.leaf) * layout.width() * kStride], layout.views() * kStride,
            static_cast<float>(x - std::floor(x) - 0.5), static_cast<float>(y - std::floor(y) - 0.5)};
  });
}

}  // namespace

std::vector<float> fit_scale(const AlignedLayout& layout, const Function::Info& function,
                             const std::vector<AlignedSheet>& sheets, const AlignedTotals& totals) {
  const std::vector<double>& wavelength_um = function.wavelength_um;
  const PolarProfile polar = profile_of(layout, function.isotropic, sheets);
  const size_t channels = layout.channels;
  const std::vector<TotalView> views = total_views(layout, totals);
  std::vector<double> integral(views.size() * channels, 0.0);
  constexpr size_t kBlock = 64;  // leaves; sums over blocks are added in order, so threads do not matter
  for (size_t s = 0; s < sheets.size(); ++s) {
    const AlignedSheet& sheet = sheets[s];
    const size_t blocks = (sheet.leaves.size() + kBlock - 1) / kBlock;
    std::vector<std::vector<double>> partial(blocks);
    parallel_for(0, blocks, 1, [&](size_t begin, size_t end) {
      LeafIntegral leaf_integral(layout, sheet.scale, polar, views);
      for (size_t b = begin; b < end; ++b) {
        partial[b].assign(integral.size(), 0.0);
        for (size_t i = b * kBlock; i < std::min(sheet.leaves.size(), (b + 1) * kBlock); ++i)
          leaf_integral.add(sheet.leaves[i], s, &sheet.plane[i * layout.width() * kStride], partial[b]);
      }
    });
    for (const std::vector<double>& part : partial)
      for (size_t j = 0; j < part.size(); ++j) integral[j] += part[j];
  }
  std::vector<float> scale(integral.size());
  for (size_t t = 0; t < views.size(); ++t)
    for (size_t c = 0; c < channels; ++c) {
      const size_t k = static_cast<size_t>(
          std::lower_bound(totals.magnitude_um.begin(), totals.magnitude_um.end(), wavelength_um[c]) -
          totals.magnitude_um.begin());
      const double W = totals.magnitudes[t * totals.magnitude_um.size() + k], I = integral[t * channels + c];
      scale[t * channels + c] =
          W > 0 && I > 0 ? static_cast<float>(std::clamp(std::log2(W / I), -100.0, 100.0)) : -100.0f;
    }
  return scale;
}

}  // namespace suite::sqt
