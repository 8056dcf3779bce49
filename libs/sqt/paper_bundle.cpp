// The runtime of the paper's trees; see paper.h.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sqt/paper.h"
#include "sqt/polar_profile.h"
#include "sqt/theta_grid.h"
#include "sqt/tree.h"

namespace suite::sqt {

namespace {

// A tree ready to be asked. Leaves coarser than kSampleOrder are divided, so that within a cell the cosine is nearly
// constant and w / pdf stays near its mean.
constexpr int kSampleOrder = 4;

enum class Weighting { none, upper_side, both_sides };  // of the values: none or |cos in|

struct Slice {
  Tree tree;
  std::vector<float> value;        // f
  std::vector<double> cumulative;  // of the masses; back() is the total mass of the unscaled slice
  double mass() const { return cumulative.empty() ? 0 : cumulative.back(); }
};

// What a leaf of value 1 weighs.
double leaf_weight(CellId id, Weighting weighting) {
  return weighting == Weighting::none ? cell_solid_angle(id.order())
                                      : cosine_integral(id, weighting == Weighting::both_sides);
}

Slice make_slice(std::span<const PaperLeaf> leaves, Weighting weighting) {
  Slice s;
  std::vector<CellId> cells;
  for (const PaperLeaf& leaf : leaves) {
    const int extra = weighting != Weighting::none ? std::max(0, kSampleOrder - leaf.id.order()) : 0;
    for (uint32_t k = 0; k < (1u << (2 * extra)); ++k) {
      cells.push_back(CellId::of(leaf.id.order() + extra, (leaf.id.index() << (2 * extra)) + k));
      s.value.push_back(leaf.value);
    }
  }
  s.tree = Tree(cells);
  double sum = 0;
  for (size_t i = 0; i < cells.size(); ++i)
    s.cumulative.push_back(sum += s.value[i] * leaf_weight(cells[i], weighting));
  return s;
}

class PaperBundle final : public Bundle {
 public:
  PaperBundle(PaperData data, Info info) : Bundle(std::move(info)), data_(std::move(data)) {
    std::vector<double> theta;
    for (size_t v = 0; v < data_.views.size(); v += data_.phi_count) theta.push_back(data_.views[v].theta);
    grid_ = ThetaGrid(std::move(theta));
    for (const auto& leaves : data_.slices) slices_.push_back(make_slice(leaves, weighting()));
    // Totals of the channels are the magnitudes at their wavelengths.
    for (const double um : info_.function.wavelength_um)
      channel_magnitude_.push_back(static_cast<size_t>(
          std::lower_bound(data_.magnitude_um.begin(), data_.magnitude_um.end(), um) - data_.magnitude_um.begin()));
    find_polar();
  }

  void value(Dir out, Dir in, std::span<double> f) const override {
    for (size_t c = 0; c < f.size(); ++c) f[c] = value(out, in, c);
  }
  double value(Dir out, Dir in, size_t channel) const override {
    if (outside(out, in)) return 0;
    double f = 0;
    const FacePoint p = face_point(to_frame(out, in));
    for (const auto& [view, weight] : blend(out)) {
      if (weight <= 0) continue;
      f += weight * (view == 0 && !polar_.empty() ? polar_value(in, channel) : slice_value(view, p, channel));
    }
    return f;
  }
  double total(Dir out, size_t channel) const override {
    if (below(out)) return 0;
    double W = 0;
    for (const auto& [view, weight] : blend(out))
      if (weight > 0) W += weight * view_total(view, channel);
    return W;
  }
  void magnitude(Dir out, std::span<double> W) const override {
    std::fill(W.begin(), W.end(), 0.0);
    if (below(out)) return;
    for (const auto& [view, weight] : blend(out))
      for (size_t k = 0; k < W.size(); ++k) W[k] += weight * data_.magnitudes[view * data_.magnitude_um.size() + k];
  }
  std::optional<Dir> sample(Dir out, Vec2 u, double lobe_u, size_t channel) const override {
    const double W = total(out, channel);
    if (!(W > 0)) return std::nullopt;
    // Choose the slice by its share of the total, then the leaf by its mass, then a uniform point of the leaf.
    double rest = lobe_u * W;
    const auto blended = blend(out);
    for (size_t b = 0; b < blended.size(); ++b) {
      const double part = blended[b].weight * view_total(blended[b].view, channel);
      const Slice& s = slice(blended[b].view, channel);
      if (part <= 0 || s.mass() <= 0 || (rest >= part && b + 1 < blended.size())) {
        rest -= std::max(0.0, part);
        continue;
      }
      const double at = std::clamp(rest / part, 0.0, 1.0) * s.mass();
      const auto i = static_cast<size_t>(std::upper_bound(s.cumulative.begin(), s.cumulative.end() - 1, at) -
                                         s.cumulative.begin());
      const Dir in = from_frame(out, direction_in(s.tree.cell(i), u));
      if (outside(out, in)) return std::nullopt;
      return in;
    }
    return std::nullopt;
  }
  double pdf(Dir out, Dir in, size_t channel) const override {
    const double W = total(out, channel);
    if (!(W > 0) || outside(out, in)) return 0;
    double p = 0;
    const FacePoint point = face_point(to_frame(out, in));
    for (const auto& [view, weight] : blend(out)) {
      const Slice& s = slice(view, channel);
      const int leaf = s.tree.leaf(point);
      if (weight <= 0 || leaf < 0 || s.mass() <= 0) continue;
      const auto i = static_cast<size_t>(leaf);
      const double mass = s.cumulative[i] - (i ? s.cumulative[i - 1] : 0);
      p += weight * view_total(view, channel) / W * mass / s.mass() / cell_solid_angle(s.tree.cell(i).order());
    }
    return p;
  }
  void pdf(Dir out, Dir in, std::span<double> p) const override {
    for (size_t c = 0; c < p.size(); ++c) p[c] = pdf(out, in, c);
  }
  std::optional<DeltaLobe> delta(Dir, size_t) const override { return std::nullopt; }

  std::vector<Cell> cells(size_t view, size_t channel) const override {
    std::vector<Cell> out;
    const double mass = slice(view, channel).mass();
    const double scale = mass > 0 ? view_total(view, channel) / mass : 0;
    for (const PaperLeaf& leaf : data_.slices[view * channels() + channel]) {
      const double part = leaf.value * leaf_weight(leaf.id, weighting());
      out.push_back({leaf.id, 0, leaf.value * scale, mass > 0 ? part / mass : 0});
    }
    return out;
  }
  Dir incident(size_t view, const Cell& cell, Vec2 u) const override {
    return from_frame(dir_from_angles(data_.views[view].theta, data_.views[view].phi), direction_in(cell.id, u));
  }

 private:
  struct Blend {
    size_t view;
    double weight;
  };
  bool hemisphere() const { return info_.function.domain == Domain::hemisphere; }
  Weighting weighting() const {
    if (!cosine_weighted()) return Weighting::none;
    return hemisphere() ? Weighting::upper_side : Weighting::both_sides;
  }
  // f of a slice, in its frame.
  double slice_value(size_t view, FacePoint p, size_t channel) const {
    const Slice& s = slice(view, channel);
    const int leaf = s.tree.leaf(p);
    if (leaf < 0 || !(s.mass() > 0)) return 0;
    return s.value[static_cast<size_t>(leaf)] * view_total(view, channel) / s.mass();
  }
  double polar_value(Dir in, size_t channel) const {
    const size_t sheet = in.z < 0 ? 1 : 0;
    const float l = polar_.log2(sheet, PolarProfile::locate(1 - std::fabs(in.z)), channel);
    return l < -100 ? 0 : std::exp2(static_cast<double>(l));
  }
  // The first slice of an isotropic surface, seen along the normal, with its total (polar_profile.h).
  void find_polar() {
    if (!cosine_weighted() || !info_.function.isotropic || data_.phi_count != 1 || grid_[0] != 0) return;
    polar_ = {channels(), info_.function.bilateral, std::vector<LogScale>(hemisphere() ? 1 : 2),
              [this](size_t sheet, Dir d, std::span<float> f) {
                if (sheet == 1) d.z = -d.z;
                const FacePoint p = face_point(d);
                for (size_t c = 0; c < f.size(); ++c) f[c] = static_cast<float>(slice_value(0, p, c));
              }};
    for (size_t c = 0; c < channels(); ++c)
      polar_.set_integral(
          c, [](double below) { return 1 - below; }, view_total(0, c));
  }
  // Data of both sides are seen from the front: the back is taken to scatter as the front does.
  bool below(Dir out) const { return cosine_weighted() && (hemisphere() ? out.z <= 0 : out.z == 0); }
  bool turned_over(Dir out) const { return cosine_weighted() && out.z < 0; }
  bool outside(Dir out, Dir in) const { return below(out) || (hemisphere() && in.z <= 0); }
  const Slice& slice(size_t view, size_t channel) const { return slices_[view * channels() + channel]; }
  double view_total(size_t view, size_t channel) const {
    return data_.magnitudes[view * data_.magnitude_um.size() + channel_magnitude_[channel]];
  }
  // Isotropic slices are stored for the view azimuth 0; phase functions for a view along +z; intensities as they are.
  Frame frame(Dir out) const {
    if (info_.function.quantity == Quantity::phase) return Frame::around(out);
    const double r = std::hypot(out.x, out.y);
    if (!info_.function.isotropic || info_.function.quantity == Quantity::intensity || !(r > 0)) return {};
    return {{out.x / r, out.y / r, 0}, {-out.y / r, out.x / r, 0}, {0, 0, 1}};
  }
  Dir to_frame(Dir out, Dir in) const {
    if (turned_over(out)) in.z = -in.z;
    return frame(out).to_local(in);
  }
  Dir from_frame(Dir out, Dir d) const {
    Dir in = frame(out).to_world(d);
    if (turned_over(out)) in.z = -in.z;
    return in;
  }
  std::array<Blend, 4> blend(Dir out) const {
    const ThetaGrid::At at = grid_.locate(Dir{out.x, out.y, cosine_weighted() ? std::fabs(out.z) : out.z});
    const size_t up = std::min(at.low + 1, grid_.size() - 1), n = data_.phi_count;
    if (n == 1) return {{{at.low, 1 - at.t}, {up, at.t}, {0, 0}, {0, 0}}};
    double turn = azimuth(out) / (2 * kPi);
    turn = (turn - std::floor(turn)) * static_cast<double>(n);
    const size_t j = static_cast<size_t>(turn) % n, k = (j + 1) % n;
    const double t = turn - std::floor(turn);
    return {{{at.low * n + j, (1 - at.t) * (1 - t)},
             {at.low * n + k, (1 - at.t) * t},
             {up * n + j, at.t * (1 - t)},
             {up * n + k, at.t * t}}};
  }

  PaperData data_;
  ThetaGrid grid_;
  std::vector<Slice> slices_;
  std::vector<size_t> channel_magnitude_;
  PolarProfile polar_;  // in the place of the first slice; empty where it is not the normal's
};

void check(const PaperData& d) {
  const size_t channels = d.function.wavelength_um.size();
  auto require = [](bool condition, const char* what) {
    if (!condition) throw Error(std::string("inconsistent SQT data: ") + what);
  };
  require(channels > 0, "no wavelength");
  require(!d.views.empty() && d.phi_count > 0 && d.views.size() % d.phi_count == 0, "views and azimuths do not fit");
  require(d.slices.size() == d.views.size() * channels, "number of slices");
  require(d.magnitudes.size() == d.views.size() * d.magnitude_um.size(), "number of totals");
  for (size_t v = d.phi_count; v < d.views.size(); v += d.phi_count)
    require(d.views[v].theta > d.views[v - d.phi_count].theta, "view angles do not ascend");
  for (size_t k = 1; k < d.magnitude_um.size(); ++k)
    require(d.magnitude_um[k] > d.magnitude_um[k - 1], "wavelengths of totals do not ascend");
  for (const double um : d.function.wavelength_um)
    require(std::binary_search(d.magnitude_um.begin(), d.magnitude_um.end(), um), "a wavelength has no total");
  for (const float m : d.magnitudes) require(std::isfinite(m) && m >= 0, "a total is negative or not finite");
  for (const auto& slice : d.slices) {
    // Disjoint: in depth-first order every cell begins where or after the one before ends.
    uint64_t end = 0;
    for (const PaperLeaf& leaf : slice) {
      require(leaf.id.code >= 4 && leaf.id.order() <= kMaxOrder && leaf.id.index() < cell_count(leaf.id.order()),
              "a cell does not exist");
      const int shift = 2 * (kMaxOrder - leaf.id.order());
      const uint64_t begin = static_cast<uint64_t>(leaf.id.index()) << shift;
      require(begin >= end, "cells overlap or are out of order");
      end = begin + (uint64_t{1} << shift);
      require(std::isfinite(leaf.value) && leaf.value >= 0, "a value is negative or not finite");
    }
  }
}

// Slices at the normal are one, whatever their azimuth: the first stands for all.
void join_polar_slices(PaperData& data) {
  if (data.function.quantity != Quantity::bsdf || data.views.front().theta != 0) return;
  const size_t channels = data.function.wavelength_um.size(), magnitudes = data.magnitude_um.size();
  for (size_t j = 1; j < data.phi_count; ++j) {
    for (size_t c = 0; c < channels; ++c) data.slices[j * channels + c] = data.slices[c];
    std::copy_n(data.magnitudes.begin(), magnitudes, data.magnitudes.begin() + static_cast<ptrdiff_t>(j * magnitudes));
  }
}

}  // namespace

std::shared_ptr<const Bundle> make_bundle(PaperData data) {
  check(data);
  join_polar_slices(data);
  Bundle::Info info;
  info.function = data.function;
  info.method = "paper";
  info.frame = "incident";
  info.magnitude_um = data.magnitude_um;
  info.views = data.views;
  info.mueller = data.mueller;
  for (const auto& slice : data.slices) {
    info.leaves += slice.size();
    for (const PaperLeaf& leaf : slice) info.max_order = std::max(info.max_order, leaf.id.order());
  }
  return std::make_shared<PaperBundle>(std::move(data), std::move(info));
}

}  // namespace suite::sqt
