// The runtime of the aligned method; see aligned.h.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "sqt/aligned.h"
#include "sqt/lattice.h"
#include "sqt/portable_math.h"
#include "sqt/theta_grid.h"
#include "sqt/tree.h"

namespace suite::sqt {

namespace {

// Leaves are divided at least to this order for sampling, so that cosine and stretch vary little within one.
constexpr int kSampleOrder = 4;
// A cell within reach of the horizon keeps this much of its mass when cut away, so that neighbouring views can draw it.
constexpr double kHorizonFloor = 1e-3;

// log2 of the scale that stands for a total of zero.
constexpr float kNothing = -90;

struct Sheet {
  Tree tree;
  std::vector<float> plane;         // [leaf][view][channel]{value, slope x, slope y}
  std::vector<float> inverse_area;  // 1/sr of one copy of the leaf (its mirror image counted in)
  std::vector<float> side;          // cells along a face at the order of the leaf
  size_t first = 0;                 // index of the first leaf among all sheets
};

// Divides coarse leaves; the planes go on.
void refine(AlignedSheet& sheet, const Region& region, size_t width) {
  AlignedSheet fine;
  std::vector<uint32_t> from;  // stored leaf of every fine one
  for (size_t i = 0; i < sheet.leaves.size(); ++i) {
    const CellId id = sheet.leaves[i];
    const int extra = std::max(0, kSampleOrder - id.order());
    for (uint32_t k = 0; k < (1u << (2 * extra)); ++k) {
      const CellId part = CellId::of(id.order() + extra, (id.index() << (2 * extra)) + k);
      if (extra && !region.holds(part)) continue;  // across the symmetry plane or below the horizon
      fine.leaves.push_back(part);
      from.push_back(static_cast<uint32_t>(i));
    }
  }
  fine.plane.resize(fine.leaves.size() * width * 3);
  for (size_t n = 0; n < fine.leaves.size(); ++n) {
    const CellId id = sheet.leaves[from[n]], part = fine.leaves[n];
    const float* p = &sheet.plane[from[n] * width * 3];
    float* q = &fine.plane[n * width * 3];
    if (part == id) {
      std::copy_n(p, width * 3, q);
      continue;
    }
    const uint32_t side = 1u << (part.order() - id.order());
    const float scale = 1 / static_cast<float>(side);
    const CellXY at = xy_of(part);
    const float dx = (static_cast<float>(at.x % side) + 0.5f) * scale - 0.5f,
                dy = (static_cast<float>(at.y % side) + 0.5f) * scale - 0.5f;
    for (size_t j = 0; j < 3 * width; j += 3) {
      q[j] = p[j] + dx * p[j + 1] + dy * p[j + 2];
      q[j + 1] = p[j + 1] * scale;
      q[j + 2] = p[j + 2] * scale;
    }
  }
  sheet = std::move(fine);
}

// Points of a leaf at which its weight is looked up.
int points_of(CellId id) { return id.order() >= 6 ? 1 : 4; }

// Integral of |cos| stretch (or 1) over a leaf for one view, kept above a floor near the horizon.
double leaf_weight(const AlignedLayout& layout, const LobeMap& map, CellId id, const Dir* points) {
  const double area = cell_solid_angle(id.order());
  if (!layout.cosine_weighted && !map.reflects()) return area;
  const int count = points_of(id);
  // As far below the horizon as a point may be while a part of its leaf is above: the cosine changes by at most twice
  // the angle, and a leaf reaches about 0.8 of its width from its middle.
  const double reach = 2 * std::sqrt(area);
  double sum = 0;
  for (int k = 0; k < count; ++k) {
    const double cosine = map.cosine(points[k]);
    if (layout.upper_only && cosine < -reach) continue;
    sum += map.stretch(points[k]) *
           (layout.cosine_weighted ? std::max(kHorizonFloor, layout.upper_only ? cosine : std::fabs(cosine)) : 1.0);
  }
  return area * sum / count;
}

class AlignedBundle final : public Bundle {
 public:
  AlignedBundle(AlignedData data, Info info)
      : Bundle(std::move(info)), layout_(std::move(data.layout)), totals_(std::move(data.totals)) {
    views_ = ThetaGrid(layout_.theta);
    fine_ = ThetaGrid(totals_.theta);
    for (const double um : info_.function.wavelength_um)
      channel_magnitude_.push_back(
          static_cast<size_t>(std::lower_bound(totals_.magnitude_um.begin(), totals_.magnitude_um.end(), um) -
                              totals_.magnitude_um.begin()));
    size_t first = 0;
    for (AlignedSheet& s : data.sheets) {
      stored_.push_back(s.leaves);
      refine(s, {layout_.upper_only, layout_.half_stored}, layout_.width());
      Sheet sheet{Tree(s.leaves), std::move(s.plane), {}, {}, first};
      for (const CellId id : s.leaves) {
        sheet.inverse_area.push_back(static_cast<float>(1 / (cell_solid_angle(id.order()) * copies(id))));
        sheet.side.push_back(static_cast<float>(1u << id.order()));
      }
      first += s.leaves.size();
      sheets_.push_back(std::move(sheet));
    }
    leaves_ = first;
    build_tables();
  }

  void value(Dir out, Dir in, std::span<double> f) const override {
    Query q;
    if (!query(out, in, q)) {
      std::fill(f.begin(), f.end(), 0.0);
      return;
    }
    for (size_t c = 0; c < f.size(); ++c) f[c] = value_at(q, c);
  }
  double value(Dir out, Dir in, size_t channel) const override {
    Query q;
    return query(out, in, q) ? value_at(q, channel) : 0;
  }
  double total(Dir out, size_t channel) const override {
    if (!faces(out)) return 0;
    if (totals_.phi_count == 1) {
      const size_t m = totals_.magnitude_um.size();
      const ThetaGrid::At at = fine_.locate(surface() ? fast_acos(std::fabs(out.z)) : 0);
      const float* low = &totals_.magnitudes[at.low * m + channel_magnitude_[channel]];
      return at.t > 0 ? (1 - at.t) * low[0] + at.t * low[m] : low[0];
    }
    return fine_total(place(fine_, totals_.phi_count, upright(out)), channel_magnitude_[channel]);
  }
  void magnitude(Dir out, std::span<double> W) const override {
    const bool lit = faces(out);
    const Place at = place(fine_, totals_.phi_count, upright(out));
    for (size_t k = 0; k < W.size(); ++k) W[k] = lit ? fine_total(at, k) : 0;
  }

  std::optional<Dir> sample(Dir out, Vec2 u, double lobe_u, size_t channel) const override {
    if (!faces(out)) return std::nullopt;
    const Dir up = upright(out);
    const Place at = place(views_, layout_.phi_count, up);
    // Choose the slice by its blending weight, the leaf by its mass, the point of the leaf uniformly.
    double rest = lobe_u;
    int b = 0;
    while (b < at.count - 1 && rest >= at.weight[b]) rest -= at.weight[b++];
    rest = std::clamp(rest / at.weight[b], 0.0, 0x1.fffffep-1);
    const Table& table = tables_[at.view[b] * channels() + channel];
    if (table.cumulative.empty()) return std::nullopt;
    const uint32_t target = static_cast<uint32_t>(rest * 0x1p32);
    const size_t leaf = table.find(target);
    const double within = (rest * 0x1p32 - table.cumulative[leaf]) / table.mass(leaf);
    size_t s = sheets_.size() - 1;
    while (leaf < sheets_[s].first) --s;
    Dir d = direction_in(sheets_[s].tree.cell(leaf - sheets_[s].first), u);
    if (layout_.half_stored && within >= 0.5) d.y = -d.y;
    const Dir in = map(up, s).incident(d);
    if (layout_.upper_only && (s == 0 ? in.z <= 0 : in.z >= 0)) return std::nullopt;
    return back(out, in);
  }
  double pdf(Dir out, Dir in, size_t channel) const override {
    Query q;
    return query(out, in, q) ? density(q, channel) : 0;
  }
  void pdf(Dir out, Dir in, std::span<double> p) const override {
    Query q;
    const bool there = query(out, in, q);
    for (size_t c = 0; c < p.size(); ++c) p[c] = there ? density(q, c) : 0;
  }
  std::optional<DeltaLobe> delta(Dir, size_t) const override { return std::nullopt; }

  std::vector<Cell> cells(size_t view, size_t channel) const override {
    std::vector<Cell> out;
    const Bundle::View& v = info_.views[view];
    const Dir up = dir_from_angles(v.theta, v.phi);
    const Place at = place(fine_, totals_.phi_count, up);
    const Table& table = tables_[view * channels() + channel];
    for (size_t s = 0; s < sheets_.size(); ++s)
      for (size_t i = 0; i < sheets_[s].tree.size(); ++i) {
        const double g = portable_exp2(sheets_[s].plane[(i * layout_.width() + view * channels() + channel) * 3] +
                                       static_cast<float>(scale(at, channel)));
        const double mass = table.cumulative.empty() ? 0 : table.mass(i + sheets_[s].first) * 0x1p-32;
        const CellId id = sheets_[s].tree.cell(i);
        if (copies(id) == 1) {
          out.push_back({id, static_cast<int>(s), g, mass});
        } else {
          out.push_back({id, static_cast<int>(s), g, 0.5 * mass});
          out.push_back({mirrored(id), static_cast<int>(s), g, 0.5 * mass});
        }
      }
    return out;
  }
  Dir incident(size_t view, const Cell& cell, Vec2 u) const override {
    const Dir up = dir_from_angles(info_.views[view].theta, info_.views[view].phi);
    return back(up, map(up, static_cast<size_t>(cell.sheet)).incident(direction_in(cell.id, u)));
  }

 private:
  // Cumulative masses of the leaves in units of 2^-32; exact integers, so that pdf is what sample does.
  struct Table {
    std::vector<uint32_t> cumulative;  // cumulative[i] = sum before leaf i; empty when nothing scatters
    std::vector<uint32_t> guide;       // first leaf to try for each 1/256th
    double mass(size_t leaf) const {
      return (leaf + 1 < cumulative.size() ? static_cast<double>(cumulative[leaf + 1]) : 0x1p32) - cumulative[leaf];
    }
    size_t find(uint32_t target) const {
      size_t low = guide[target >> 24], high = guide[(target >> 24) + 1] + 1;
      while (low + 1 < high) {
        const size_t mid = (low + high) / 2;
        if (cumulative[mid] <= target)
          low = mid;
        else
          high = mid;
      }
      return low;
    }
  };
  struct Place {
    size_t view[4];
    double weight[4];
    int count;
  };
  struct Query {
    Place at, fine;
    const Sheet* sheet;
    size_t leaf;
    float dx, dy;
    double stretch;
  };

  double copies(CellId id) const { return layout_.half_stored && mirrored(id) != id ? 2 : 1; }
  bool surface() const { return layout_.cosine_weighted; }
  bool faces(Dir out) const { return !surface() || out.z > 0 || (out.z < 0 && layout_.sheets == 2); }
  // The view in the slices' own frame: isotropic slices lie at azimuth 0; data of both sides are seen from the front.
  Dir upright(Dir out) const {
    if (!surface()) return {0, 0, 1};
    const double z = std::fabs(out.z);
    if (!info_.function.isotropic) return {out.x, out.y, z};
    return {std::sqrt(std::max(0.0, 1 - z * z)), 0, z};
  }
  Frame frame(Dir out) const {
    if (info_.function.quantity == Quantity::phase) return Frame::around(-out);
    if (!surface() || !info_.function.isotropic) return {};
    const double r2 = out.x * out.x + out.y * out.y;
    if (!(r2 > 1e-30)) return {};
    const double r = std::sqrt(r2);
    return {{out.x / r, out.y / r, 0}, {-out.y / r, out.x / r, 0}, {0, 0, 1}};
  }
  Dir back(Dir out, Dir in) const {
    Dir d = frame(out).to_world(in);
    if (surface() && out.z < 0) d.z = -d.z;
    return d;
  }
  LobeMap map(Dir up, size_t sheet) const { return {layout_.frame, up, sheet == 1}; }

  static Place place(const ThetaGrid& grid, size_t phi_count, Dir up) {
    return place(grid, phi_count, up, fast_acos(up.z));
  }
  static Place place(const ThetaGrid& grid, size_t phi_count, Dir up, double theta) {
    const ThetaGrid::At at = grid.locate(theta);
    const size_t next = std::min(at.low + 1, grid.size() - 1);
    if (phi_count == 1) {
      if (at.t <= 0) return {{at.low}, {1}, 1};
      if (at.t >= 1) return {{next}, {1}, 1};
      return {{at.low, next}, {1 - at.t, at.t}, 2};
    }
    double turn = azimuth(up) / (2 * kPi);
    turn = (turn - std::floor(turn)) * static_cast<double>(phi_count);
    const double t = turn - std::floor(turn);
    const size_t j = static_cast<size_t>(turn) % phi_count, k = (j + 1) % phi_count;
    Place p{{}, {}, 0};
    const size_t view[4] = {at.low * phi_count + j, at.low * phi_count + k, next * phi_count + j, next * phi_count + k};
    const double weight[4] = {(1 - at.t) * (1 - t), (1 - at.t) * t, at.t * (1 - t), at.t * t};
    for (int i = 0; i < 4; ++i)
      if (weight[i] > 0) p.view[p.count] = view[i], p.weight[p.count++] = weight[i];
    return p;
  }
  double fine_total(const Place& at, size_t k) const {
    double W = 0;
    for (int b = 0; b < at.count; ++b)
      W += at.weight[b] * totals_.magnitudes[at.view[b] * totals_.magnitude_um.size() + k];
    return W;
  }
  double scale(const Place& at, size_t c) const {
    double s = 0;
    for (int b = 0; b < at.count; ++b) s += at.weight[b] * totals_.log2_scale[at.view[b] * channels() + c];
    return s;
  }

  bool query(Dir out, Dir in, Query& q) const {
    if (!faces(out)) return false;
    if (surface() && out.z < 0) in.z = -in.z;
    const size_t s = surface() && layout_.sheets == 2 && in.z < 0 ? 1 : 0;
    if (surface() && (s == 0 ? !(in.z > 0) : !(in.z < 0))) return false;
    const Dir up = upright(out);
    const LobeMap m = map(up, s);
    Dir d = m.cell_direction(frame(out).to_local(in));
    // Strictly inside the stored half: at azimuth pi the symmetry plane itself belongs to cells that are not stored.
    if (layout_.half_stored) d.y = std::max(std::fabs(d.y), 1e-9);
    const FacePoint p = face_point_fast(d);
    q.sheet = &sheets_[s];
    const int leaf = q.sheet->tree.leaf(p);
    if (leaf < 0) return false;
    q.leaf = static_cast<size_t>(leaf);
    const double n = q.sheet->side[q.leaf];
    const double x = p.x * n, y = p.y * n;
    q.dx = static_cast<float>(x - std::floor(x) - 0.5);
    q.dy = static_cast<float>(y - std::floor(y) - 0.5);
    q.stretch = m.stretch(d);
    const double theta = fast_acos(up.z);
    q.at = place(views_, layout_.phi_count, up, theta);
    q.fine = place(fine_, totals_.phi_count, up, theta);
    return true;
  }
  double value_at(const Query& q, size_t channel) const {
    const float* leaf = &q.sheet->plane[q.leaf * layout_.width() * 3];
    float l = static_cast<float>(scale(q.fine, channel));
    if (l <= kNothing) return 0;
    for (int b = 0; b < q.at.count; ++b) {
      const float* p = leaf + (q.at.view[b] * channels() + channel) * 3;
      l += static_cast<float>(q.at.weight[b]) * (p[0] + q.dx * p[1] + q.dy * p[2]);
    }
    return portable_exp2(l);
  }

  double density(const Query& q, size_t channel) const {
    double p = 0;
    for (int b = 0; b < q.at.count; ++b) {
      const Table& table = tables_[q.at.view[b] * channels() + channel];
      if (!table.cumulative.empty()) p += q.at.weight[b] * table.mass(q.leaf + q.sheet->first);
    }
    return p * 0x1p-32 * q.sheet->inverse_area[q.leaf] / q.stretch;
  }

  void build_tables() {
    tables_.resize(layout_.views() * channels());
    std::vector<std::vector<Dir>> points(sheets_.size());
    std::vector<float> weight_of_area;  // copies of every leaf
    for (size_t s = 0; s < sheets_.size(); ++s)
      for (const CellId id : sheets_[s].tree.cells()) {
        const int n = points_of(id), side = n == 1 ? 1 : 2;
        weight_of_area.push_back(static_cast<float>(copies(id)));
        for (int k = 0; k < n; ++k)
          points[s].push_back(direction_in(id, {(k % side + 0.5) / side, (k / side + 0.5) / side}));
      }
    parallel_for(0, layout_.views(), 1, [&](size_t begin, size_t end) {
      std::vector<float> weight(leaves_);
      std::vector<double> sum(leaves_ + 1);
      for (size_t v = begin; v < end; ++v) {
        const Bundle::View& view = info_.views[v];
        for (size_t s = 0; s < sheets_.size(); ++s) {
          const LobeMap m(layout_.frame, dir_from_angles(view.theta, view.phi), s == 1);
          const Dir* point = points[s].data();
          for (size_t i = 0; i < sheets_[s].tree.size(); ++i) {
            const CellId id = sheets_[s].tree.cell(i);
            weight[sheets_[s].first + i] =
                static_cast<float>(leaf_weight(layout_, m, id, point) * weight_of_area[sheets_[s].first + i]);
            point += points_of(id);
          }
        }
        for (size_t c = 0; c < channels(); ++c)
          build_table(tables_[v * channels() + c], v * channels() + c, weight, sum);
      }
    });
  }
  void build_table(Table& table, size_t column, std::span<const float> weight, std::span<double> sum) const {
    sum[0] = 0;
    for (const Sheet& s : sheets_) {
      const float* p = s.plane.data() + column * 3;
      for (size_t i = 0; i < s.tree.size(); ++i, p += layout_.width() * 3)
        sum[s.first + i + 1] =
            sum[s.first + i] + weight[s.first + i] * portable_exp2(p[0]) * mean_exp2(p[1]) * mean_exp2(p[2]);
    }
    if (!(sum.back() > 0)) return;
    const double scale = 0x1p32 / sum.back();
    table.cumulative.resize(leaves_);
    for (size_t i = 0; i < leaves_; ++i)
      table.cumulative[i] = static_cast<uint32_t>(std::min(4294967295.0, sum[i] * scale));
    table.guide.resize(257);
    size_t at = 0;
    for (uint64_t g = 0; g < 257; ++g) {
      while (at + 1 < leaves_ && table.cumulative[at + 1] <= (g << 24)) ++at;
      table.guide[g] = static_cast<uint32_t>(at);
    }
  }

  AlignedLayout layout_;
  AlignedTotals totals_;
  ThetaGrid views_, fine_;
  std::vector<std::vector<CellId>> stored_;
  std::vector<Sheet> sheets_;
  size_t leaves_ = 0;
  std::vector<Table> tables_;
  std::vector<size_t> channel_magnitude_;
};

void check(const AlignedData& d) {
  auto require = [](bool condition, const char* what) {
    if (!condition) throw Error(std::string("inconsistent SQT data: ") + what);
  };
  const AlignedLayout& l = d.layout;
  const AlignedTotals& t = d.totals;
  require(l.channels > 0 && l.channels == d.function.wavelength_um.size(), "number of channels");
  require(!l.theta.empty() && l.phi_count > 0 && t.phi_count > 0 && !t.theta.empty(), "no views");
  for (size_t i = 1; i < l.theta.size(); ++i) require(l.theta[i] > l.theta[i - 1], "view angles do not ascend");
  for (size_t i = 1; i < t.theta.size(); ++i) require(t.theta[i] > t.theta[i - 1], "angles of totals do not ascend");
  for (size_t i = 1; i < t.magnitude_um.size(); ++i)
    require(t.magnitude_um[i] > t.magnitude_um[i - 1], "wavelengths of totals do not ascend");
  for (const double um : d.function.wavelength_um)
    require(std::binary_search(t.magnitude_um.begin(), t.magnitude_um.end(), um), "a wavelength has no total");
  require(t.magnitudes.size() == t.theta.size() * t.phi_count * t.magnitude_um.size(), "number of totals");
  require(t.log2_scale.size() == t.theta.size() * t.phi_count * l.channels, "number of scales");
  for (const float m : t.magnitudes) require(std::isfinite(m) && m >= 0, "a total is negative or not finite");
  for (const float s : t.log2_scale) require(std::isfinite(s) && std::fabs(s) <= 200, "a scale is not finite");
  require(d.sheets.size() == static_cast<size_t>(l.sheets) && (l.sheets == 1 || l.sheets == 2), "number of sheets");
  for (const AlignedSheet& s : d.sheets) {
    require(!s.leaves.empty() && s.plane.size() == s.leaves.size() * l.width() * 3, "number of leaf values");
    for (const float v : s.plane) require(std::isfinite(v), "a leaf value is not finite");
  }
}

}  // namespace

std::vector<float> fit_scale(const AlignedLayout& layout, const std::vector<AlignedSheet>& sheets,
                             const AlignedTotals& totals, const std::vector<double>& wavelength_um) {
  const size_t channels = layout.channels, count = totals.theta.size() * totals.phi_count;
  const ThetaGrid grid(layout.theta);
  std::vector<float> scale(count * channels, 0.0f);
  parallel_for(0, count, 1, [&](size_t begin, size_t end) {
    std::vector<float> sum(channels);
    for (size_t t = begin; t < end; ++t) {
      const double phi = 2 * kPi * static_cast<double>(t % totals.phi_count) / static_cast<double>(totals.phi_count);
      const double theta = totals.theta[t / totals.phi_count];
      const ThetaGrid::At at = grid.locate(theta);
      const size_t next = std::min(at.low + 1, grid.size() - 1),
                   j = t % totals.phi_count;  // same azimuths in both grids
      const size_t low_view = at.low * layout.phi_count + j, high_view = next * layout.phi_count + j;
      const float w1 = static_cast<float>(at.t), w0 = 1 - w1;
      std::vector<double> integral(channels, 0.0);
      for (size_t s = 0; s < sheets.size(); ++s) {
        const LobeMap map(layout.frame, dir_from_angles(theta, phi), s == 1);
        for (size_t i = 0; i < sheets[s].leaves.size(); ++i) {
          const CellId id = sheets[s].leaves[i];
          // Near the horizon the cosine changes within a leaf, and what lies below does not count: look more closely.
          const double width = std::sqrt(cell_solid_angle(id.order()));
          const double above = layout.cosine_weighted ? map.cosine(direction_in(id, {0.5, 0.5})) : 1;
          if (layout.upper_only && above < -2 * width) continue;
          const int closer = std::clamp(static_cast<int>(6 * width / std::max(std::fabs(above), width)), 1, 4);
          const int usual = id.order() >= 7 ? 1 : id.order() == 6 ? 2 : 1 << std::max(2, 7 - id.order());
          const int side = closer * usual;
          const double area =
              cell_solid_angle(id.order()) / (side * side) * (layout.half_stored && mirrored(id) != id ? 2 : 1);
          const float* leaf = &sheets[s].plane[i * layout.width() * 3];
          const float inverse_side = 1.0f / static_cast<float>(side);
          for (int k = 0; k < side * side; ++k) {
            const double ux = (k % side + 0.5) / side, uy = (k / side + 0.5) / side;
            const Dir d = direction_in(id, {ux, uy});
            const double cosine = map.cosine(d);
            if (layout.upper_only && !(cosine > 0)) continue;
            const double weight = area * map.stretch(d) * (layout.cosine_weighted ? std::fabs(cosine) : 1.0);
            const float dx = static_cast<float>(ux - 0.5), dy = static_cast<float>(uy - 0.5);
            for (size_t c = 0; c < channels; ++c) {
              const float* a = leaf + (low_view * channels + c) * 3;
              const float* b = leaf + (high_view * channels + c) * 3;
              const float gx = w0 * a[1] + w1 * b[1], gy = w0 * a[2] + w1 * b[2];
              integral[c] += weight * portable_exp2(w0 * a[0] + w1 * b[0] + dx * gx + dy * gy) *
                             mean_exp2(gx * inverse_side) * mean_exp2(gy * inverse_side);
            }
          }
        }
      }
      for (size_t c = 0; c < channels; ++c) {
        const size_t k = static_cast<size_t>(
            std::lower_bound(totals.magnitude_um.begin(), totals.magnitude_um.end(), wavelength_um[c]) -
            totals.magnitude_um.begin());
        const double W = totals.magnitudes[t * totals.magnitude_um.size() + k];
        scale[t * channels + c] = W > 0 && integral[c] > 0
                                      ? static_cast<float>(std::clamp(std::log2(W / integral[c]), -100.0, 100.0))
                                      : -100.0f;
      }
    }
  });
  return scale;
}

std::shared_ptr<const Bundle> make_bundle(AlignedData data) {
  check(data);
  Bundle::Info info;
  info.function = data.function;
  info.method = "aligned";
  const char* frames[] = {"half", "retro", "direct", "forward"};
  info.frame = frames[static_cast<size_t>(data.layout.frame)];
  info.magnitude_um = data.totals.magnitude_um;
  for (const double theta : data.layout.theta)
    for (size_t j = 0; j < data.layout.phi_count; ++j)
      info.views.push_back({theta, 2 * kPi * static_cast<double>(j) / static_cast<double>(data.layout.phi_count)});
  for (const AlignedSheet& s : data.sheets) {
    info.leaves += s.leaves.size();
    for (const CellId id : s.leaves) info.max_order = std::max(info.max_order, id.order());
  }
  return std::make_shared<AlignedBundle>(std::move(data), std::move(info));
}

}  // namespace suite::sqt
