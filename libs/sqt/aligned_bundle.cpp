// The runtime of the aligned method; see aligned.h. Tables are in aligned_tables.h, here they are asked.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "sqt/aligned.h"
#include "sqt/aligned_tables.h"
#include "sqt/planes.h"
#include "sqt/polar_profile.h"
#include "sqt/portable_math.h"
#include "sqt/theta_grid.h"

namespace suite::sqt {

namespace {

constexpr size_t kStride = AlignedSheet::kStride;
// log2 of the scale that stands for a total of zero.
constexpr float kNothing = -90;

class AlignedBundle final : public Bundle {
 public:
  AlignedBundle(AlignedData data, Info info)
      : Bundle(std::move(info)),
        layout_(std::move(data.layout)),
        totals_(std::move(data.totals)),
        views_(layout_.theta),
        fine_(totals_.theta),
        tables_(layout_, std::move(data.sheets)),
        planar_(surface() && info_.function.isotropic) {
    for (const double um : info_.function.wavelength_um)
      channel_magnitude_.push_back(
          static_cast<size_t>(std::lower_bound(totals_.magnitude_um.begin(), totals_.magnitude_um.end(), um) -
                              totals_.magnitude_um.begin()));
    find_polar();
  }

  void value(Dir out, Dir in, std::span<double> f) const override {
    const Query& q = ask(out, in);
    if (!q.leaf) {
      std::fill(f.begin(), f.end(), 0.0);
      return;
    }
    const Place fine = place(fine_, q.up);
    for (size_t c = 0; c < f.size(); c += kTogether)
      values_at(q, fine, c, f.subspan(c, std::min(kTogether, f.size() - c)));
  }
  double value(Dir out, Dir in, size_t channel) const override {
    const Query& q = ask(out, in);
    return q.leaf ? value_at(q, place(fine_, q.up), channel) : 0;
  }
  double total(Dir out, size_t channel) const override {
    if (!faces(out)) return 0;
    const size_t k = channel_magnitude_[channel];
    if (planar_) {
      const size_t m = totals_.magnitude_um.size();
      const ThetaGrid::At at = fine_.locate(fast_acos(std::fabs(out.z)));
      const size_t next = std::min(at.low + 1, fine_.size() - 1);
      const double W = (1 - at.t) * totals_.magnitudes[at.low * m + k] + at.t * totals_.magnitudes[next * m + k];
      return totals_.delta.empty() ? W : W + delta_total(place(fine_, at), channel);
    }
    const Place at = place(fine_, upright(out));
    return fine_total(at, k) + (totals_.delta.empty() ? 0 : delta_total(at, channel));
  }
  void magnitude(Dir out, std::span<double> W) const override {
    if (!faces(out)) {
      std::fill(W.begin(), W.end(), 0.0);
      return;
    }
    const Place at = place(fine_, upright(out));
    for (size_t k = 0; k < W.size(); ++k) W[k] = fine_total(at, k);
    if (!totals_.delta.empty())
      for (size_t c = 0; c < channels(); ++c) W[channel_magnitude_[c]] += delta_total(at, c);
  }

  std::optional<Dir> sample(Dir out, Vec2 u, double lobe_u, size_t channel) const override {
    if (!faces(out)) return std::nullopt;
    const Dir up = upright(out);
    const Place at = place(views_, up);
    // Choose the slice by its blending weight, the side of mirrored data, the leaf by its mass, the point of the leaf
    // uniformly. The side before the leaf: so neighbours in lobe_u are neighbours in direction, and stratified numbers
    // stay stratified (choosing it within the leaf cost a factor of 2 to 6 in the error of 64 to 1024 Sobol samples).
    double rest = lobe_u;
    int b = 0;
    while (b < at.count - 1 && rest >= at.weight[b]) rest -= at.weight[b++];
    rest = std::clamp(rest / at.weight[b], 0.0, 0x1.fffffep-1);
    const size_t column = channel * layout_.views() + at.view[b];
    if (tables_.empty(column)) return std::nullopt;
    const bool mirrored = layout_.half_stored && rest >= 0.5;
    if (layout_.half_stored) rest = std::min(2 * rest - mirrored, 0x1.fffffep-1);
    const AlignedTables::Draw drawn = tables_.draw(column, rest);
    size_t s = tables_.sheets().size() - 1;
    while (drawn.leaf < tables_.sheets()[s].first) --s;
    const AlignedTables::Sheet& sheet = tables_.sheets()[s];
    const size_t leaf = drawn.leaf - sheet.first;
    // Whoever draws asks for value and density next.
    const auto* const row =
        reinterpret_cast<const char*>(numbers(&sheet.plane[leaf * layout_.width() * kStride], at.view[0], 0));
    for (size_t line = 0; line < 4; ++line) __builtin_prefetch(row + 64 * line);
    __builtin_prefetch(&sheet.inverse_area[leaf]);
    Dir d = direction_fast(point_in(sheet.tree.cell(leaf), u));
    if (mirrored) d.y = -d.y;
    const LobeMap lobe = map(up, s);
    if (layout_.upper_only && lobe.cosine(d) <= 0) return std::nullopt;
    const Dir in = lobe.incident(d);
    if (layout_.upper_only && (s == 0 ? in.z <= 0 : in.z >= 0)) return std::nullopt;  // rounding
    return back(out, in);
  }
  double pdf(Dir out, Dir in, size_t channel) const override {
    const Query& q = ask(out, in);
    return q.leaf ? density(q, channel) : 0;
  }
  void pdf(Dir out, Dir in, std::span<double> p) const override {
    const Query& q = ask(out, in);
    for (size_t c = 0; c < p.size(); ++c) p[c] = q.leaf ? density(q, c) : 0;
  }
  std::optional<DeltaLobe> delta(Dir out, size_t channel) const override {
    if (totals_.delta.empty() || !faces(out)) return std::nullopt;
    const Dir mirror = {-out.x, -out.y, out.z};
    const Dir in = totals_.delta_kind == Dirac::mirror ? mirror : totals_.delta_kind == Dirac::retro ? out : -out;
    return DeltaLobe{in, delta_total(place(fine_, upright(out)), channel)};
  }

  std::vector<Cell> cells(size_t view, size_t channel) const override {
    std::vector<Cell> out;
    const Bundle::View& v = info_.views[view];
    const Place at = place(fine_, dir_from_angles(v.theta, v.phi));
    const size_t column = channel * layout_.views() + view;
    for (size_t s = 0; s < tables_.sheets().size(); ++s) {
      const AlignedTables::Sheet& sheet = tables_.sheets()[s];
      for (size_t i = 0; i < sheet.tree.size(); ++i) {
        const int16_t* p = numbers(&sheet.plane[i * layout_.width() * kStride], view, channel);
        const CellId id = sheet.tree.cell(i);
        const float value = view == 0 && !polar_.empty()
                                ? polar_.log2(s, PolarProfile::locate(1 - center_of(id).z), channel)
                                : sheet.scale.value(p[0]);
        const double g = portable_exp2(value + static_cast<float>(scale(at, channel))),
                     mass = tables_.probability(column, p[3]);
        if (!layout_.half_stored || mirrored(id) == id) {
          out.push_back({id, static_cast<int>(s), g, mass});
        } else {
          out.push_back({id, static_cast<int>(s), g, 0.5 * mass});
          out.push_back({mirrored(id), static_cast<int>(s), g, 0.5 * mass});
        }
      }
    }
    return out;
  }
  Dir incident(size_t view, const Cell& cell, Vec2 u) const override {
    const Dir up = dir_from_angles(info_.views[view].theta, info_.views[view].phi);
    return back(up, map(up, static_cast<size_t>(cell.sheet)).incident(direction_in(cell.id, u)));
  }

 private:
  // Slices around a view and their blending weights.
  struct Place {
    size_t view[4];
    double weight[4];
    int count;
  };
  struct Query {
    Place at;
    Dir up;
    const int16_t* leaf;  // numbers of the leaf, [view][channel]
    LogScale scale;
    float dx, dy;
    double to_density;  // from the leaf's probability
    int first;          // slices before it are the polar one, in the profile's place
    size_t sheet;
    PolarProfile::At polar;
  };

  // The slice along the normal, with its total.
  void find_polar() {
    std::vector<LogScale> scales;
    for (const AlignedTables::Sheet& sheet : tables_.sheets()) scales.push_back(sheet.scale);
    polar_ =
        polar_profile(layout_, planar_ && totals_.theta.front() == 0, scales, [this](size_t s, Dir d) -> LeafPlace {
          const AlignedTables::Sheet& sheet = tables_.sheets()[s];
          Query q;
          if (!find_leaf(sheet, face_point_fast(d), q)) return {};
          return {q.leaf, kStride, q.dx, q.dy};
        });
    const auto weight = polar_weight(layout_);
    for (size_t c = 0; c < channels(); ++c)
      if (totals_.log2_scale[c] > kNothing)
        polar_.set_integral(c, weight, totals_.magnitudes[channel_magnitude_[c]] / std::exp2(totals_.log2_scale[c]));
  }
  // The leaf, and where in it the point is; false where there is none.
  bool find_leaf(const AlignedTables::Sheet& sheet, FacePoint p, Query& q, size_t* index = nullptr) const {
    const Tree::Found found = sheet.tree.find(p);
    if (found.leaf < 0) return false;
    const size_t leaf = static_cast<size_t>(found.leaf);
    const double cells = static_cast<double>(1u << found.order), x = p.x * cells, y = p.y * cells;
    q.dx = static_cast<float>(x - std::floor(x) - 0.5);
    q.dy = static_cast<float>(y - std::floor(y) - 0.5);
    q.leaf = &sheet.plane[leaf * layout_.width() * kStride];
    if (index) *index = leaf;
    return true;
  }

  bool surface() const { return layout_.cosine_weighted; }
  bool faces(Dir out) const { return !surface() || out.z > 0 || (out.z < 0 && layout_.sheets == 2); }
  // The view in the slices' own frame: isotropic slices lie at azimuth 0; data of both sides are seen from the front.
  Dir upright(Dir out) const {
    if (!surface()) return {0, 0, 1};
    const double z = std::fabs(out.z);
    if (!planar_) return {out.x, out.y, z};
    return {std::sqrt(std::max(0.0, 1 - z * z)), 0, z};
  }
  Frame frame(Dir out) const {
    if (info_.function.quantity == Quantity::phase) return Frame::around(out);
    if (!planar_) return {};
    const double r2 = out.x * out.x + out.y * out.y;
    if (!(r2 > 1e-30)) return {};
    const double inverse = 1 / std::sqrt(r2), c = out.x * inverse, s = out.y * inverse;
    return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
  }
  Dir back(Dir out, Dir in) const {
    Dir d = frame(out).to_world(in);
    if (surface() && out.z < 0) d.z = -d.z;
    return d;
  }
  LobeMap map(Dir up, size_t sheet) const { return {layout_.frame, up, sheet == 1}; }

  static Place place(const ThetaGrid& grid, const ThetaGrid::At& at) {
    return {{at.low, std::min(at.low + 1, grid.size() - 1)}, {1 - at.t, at.t}, 2};
  }
  [[gnu::always_inline]] Place place(const ThetaGrid& grid, Dir up) const {  // a call copies nine numbers
    const ThetaGrid::At at = grid.locate(fast_acos(up.z));
    const size_t phi_count = layout_.phi_count, next = std::min(at.low + 1, grid.size() - 1);
    if (phi_count == 1) return place(grid, at);
    double turn = azimuth(up) / (2 * kPi);
    turn = (turn - std::floor(turn)) * static_cast<double>(phi_count);
    const double t = turn - std::floor(turn);
    const size_t j = static_cast<size_t>(turn) % phi_count, k = (j + 1) % phi_count;
    return {{at.low * phi_count + j, at.low * phi_count + k, next * phi_count + j, next * phi_count + k},
            {(1 - at.t) * (1 - t), (1 - at.t) * t, at.t * (1 - t), at.t * t},
            4};
  }
  double fine_total(const Place& at, size_t k) const {
    double W = 0;
    for (int b = 0; b < at.count; ++b)
      W += at.weight[b] * totals_.magnitudes[at.view[b] * totals_.magnitude_um.size() + k];
    return W;
  }
  double delta_total(const Place& at, size_t c) const {
    double W = 0;
    for (int b = 0; b < at.count; ++b) W += at.weight[b] * totals_.delta[at.view[b] * channels() + c];
    return W;
  }
  double scale(const Place& at, size_t c) const {
    double s = 0;
    for (int b = 0; b < at.count; ++b) s += at.weight[b] * totals_.log2_scale[at.view[b] * channels() + c];
    return s;
  }

  // The answer for a pair of directions; no leaf where there is nothing. Values and densities of one pair are asked for
  // one after the other, so each thread keeps its last answer.
  const Query& ask(Dir out, Dir in) const {
    struct Asked {
      uint64_t bundle = 0;
      Dir out, in;
      Query answer;
    };
    thread_local Asked last;
    // Bit by bit: -0 and 0 are other azimuths.
    const auto same = [](const Dir& a, const Dir& b) { return std::memcmp(&a, &b, sizeof(Dir)) == 0; };
    static_assert(sizeof(Dir) == 3 * sizeof(double));
    if (last.bundle == number_ && same(last.in, in) && same(last.out, out)) return last.answer;
    last.bundle = number_, last.out = out, last.in = in;
    if (!query(out, in, last.answer)) last.answer.leaf = nullptr;
    return last.answer;
  }
  static uint64_t next_number() {
    static std::atomic<uint64_t> count = 0;
    return ++count;
  }

  // The leaf of a pair of directions and where in it they fall; false where there is nothing.
  bool query(Dir out, Dir in, Query& q) const {
    if (!faces(out)) return false;
    if (surface() && out.z < 0) in.z = -in.z;
    const size_t s = surface() && layout_.sheets == 2 && in.z < 0 ? 1 : 0;
    if (surface() && (s == 0 ? !(in.z > 0) : !(in.z < 0))) return false;
    FacePoint p;
    double stretch = 1, cosine = 1;  // from the pole of the divided sphere
    q.up = upright(out);
    if (planar_ && layout_.frame != LobeFrame::direct) {
      // Half or retro frame of an isotropic surface: the sum of both directions, neither turned to the slice's azimuth
      // (only its angle to `out` counts) nor normalised.
      const double side = layout_.frame == LobeFrame::retro ? -1 : 1;
      const bool normal = q.up.x < 1e-15;
      const double ox = normal ? 1 : out.x, oy = normal ? 0 : out.y;
      const double hx = in.x + side * out.x, hy = in.y + side * out.y, hz = std::fabs(in.z) + q.up.z;
      const double along = hx * ox + hy * oy, across = hy * ox - hx * oy, flat = hx * hx + hy * hy;
      const double inverse2 = 1 / (flat + hz * hz), inverse = std::sqrt(inverse2);
      // Strictly inside the stored half: at azimuth pi the symmetry plane itself belongs to cells that are not stored.
      const double reach = 1e-9 * (normal ? 1 : q.up.x);
      p = face_point_fast(along, layout_.half_stored ? std::max(std::fabs(across), reach) : across, hz * inverse,
                          flat * inverse2);
      stretch = 4 * std::fabs(side * (hx * out.x + hy * out.y) + hz * q.up.z) * inverse;
      cosine = hz * inverse;
    } else {
      const LobeMap m = map(q.up, s);
      Dir d = m.cell_direction(frame(out).to_local(in));
      if (layout_.half_stored) d.y = std::max(std::fabs(d.y), 1e-9);
      p = face_point_fast(d);
      stretch = m.stretch(d);
      cosine = d.z;
    }
    const AlignedTables::Sheet& sheet = tables_.sheets()[s];
    size_t leaf = 0;
    if (!find_leaf(sheet, p, q, &leaf)) return false;
    q.scale = sheet.scale;
    q.to_density = sheet.inverse_area[leaf] / stretch;
    q.at = place(views_, q.up);
    q.first = q.at.view[0] == 0 && !polar_.empty() ? 1 : 0;
    if (q.first) q.sheet = s, q.polar = PolarProfile::locate(std::max(0.0, 1 - cosine));
    return true;
  }
  // Of a leaf, those of a view and a channel.
  const int16_t* numbers(const int16_t* leaf, size_t view, size_t channel) const {
    return leaf + (view * layout_.channels + channel) * kStride;
  }
  double value_at(const Query& q, const Place& fine, size_t channel) const {
    float l = static_cast<float>(scale(fine, channel));
    if (l <= kNothing) return 0;
    using Four = float __attribute__((vector_size(16)));
    using Numbers = int16_t __attribute__((vector_size(8)));
    Four plane{};
    for (int b = q.first; b < q.at.count; ++b)
      plane += static_cast<float>(q.at.weight[b]) *
               __builtin_convertvector(load<Numbers>(numbers(q.leaf, q.at.view[b], channel)), Four);
    float number = plane[0] + q.dx * plane[1] + q.dy * plane[2];
    if (q.first) number += static_cast<float>(q.at.weight[0]) * polar_.number(q.sheet, q.polar, channel);
    return portable_exp2(l + q.scale.value(number));
  }
  // The same of up to kTogether channels from `first` on, to the same bits.
  void values_at(const Query& q, const Place& fine, size_t first, std::span<double> f) const {
    std::array<const int16_t*, 4> rows;
    const int count = q.at.count - q.first;
    for (int b = 0; b < count; ++b) rows[b] = numbers(q.leaf, q.at.view[b + q.first], first);
    EightFloats plane = planes(std::span(rows).first(count), q.at.weight + q.first, q.dx, q.dy);
    if (q.first) plane += static_cast<float>(q.at.weight[0]) * polar_.numbers(q.sheet, q.polar, first);
    std::array<float, kTogether> scales{}, values;
    for (size_t k = 0; k < f.size(); ++k) scales[k] = static_cast<float>(scale(fine, first + k));
    const auto s = load<EightFloats>(scales.data());
    const EightFloats value = portable_exp2(s + (static_cast<float>(q.scale.offset) + plane * q.scale.unit()));
    store(values.data(), s <= kNothing ? EightFloats{} : value);
    std::copy_n(values.begin(), f.size(), f.begin());
  }
  double density(const Query& q, size_t channel) const {
    double p = 0;
    const size_t first = channel * layout_.views();
    for (int b = 0; b < q.at.count; ++b) {
      const size_t column = first + q.at.view[b];
      p += q.at.weight[b] * tables_.probability(column, numbers(q.leaf, q.at.view[b], channel)[3]);
    }
    return p * q.to_density;
  }

  AlignedLayout layout_;
  AlignedTotals totals_;
  ThetaGrid views_, fine_;
  AlignedTables tables_;
  PolarProfile polar_;                     // in the place of the first slice; empty where it is not the normal's
  bool planar_;                            // a surface seen in the plane of its normal and `out`
  const uint64_t number_ = next_number();  // of this bundle among all that there ever were
  std::vector<size_t> channel_magnitude_;
};

}  // namespace

std::shared_ptr<const Bundle> make_bundle(AlignedData data) {
  check_aligned(data);
  Bundle::Info info;
  info.function = data.function;
  info.method = "aligned";
  const char* frames[] = {"half", "retro", "direct", "forward"};
  info.frame = frames[static_cast<size_t>(data.layout.frame)];
  info.magnitude_um = data.totals.magnitude_um;
  info.delta = data.totals.delta_kind;
  info.delta_core = data.totals.delta_core;
  info.mueller = data.mueller;
  for (const double theta : data.layout.theta)
    for (size_t j = 0; j < data.layout.phi_count; ++j)
      info.views.push_back({theta, 2 * kPi * static_cast<double>(j) / static_cast<double>(data.layout.phi_count)});
  for (const AlignedSheet& s : data.sheets) {
    info.leaves += s.stored;
    for (const CellId id : s.leaves) info.max_order = std::max(info.max_order, id.order());
  }
  return std::make_shared<AlignedBundle>(std::move(data), std::move(info));
}

}  // namespace suite::sqt
