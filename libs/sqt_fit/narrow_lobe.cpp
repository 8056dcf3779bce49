#include "sqt_fit/narrow_lobe.h"

#include <algorithm>
#include <cmath>

#include "sqt/cell.h"

namespace suite::sqt {

namespace {

constexpr size_t kRings = 160, kAzimuths = 12;
constexpr double kInnermost = 1e-8;    // rad; what lies closer to the axis counts as constant
constexpr double kSignificant = 1e-4;  // part of the total below which a lobe is left alone
constexpr double kCoreWidths = 4;      // cells
constexpr double kNarrowWidths = 0.5;  // cells

// Half vectors of a kind: the pole is the lobe's axis.
Dir fold(Dirac kind, Dir out) { return kind == Dirac::retro ? Dir{-out.x, -out.y, out.z} : out; }
Dir incident(Dirac kind, Dir out, Dir h) {
  const Dir o = fold(kind, out);
  Dir in = h * (2 * dot(h, o)) - o;
  if (kind == Dirac::through) in.z = -in.z;
  return in;
}
Dir half(Dirac kind, Dir out, Dir in) {
  if (kind == Dirac::through) in.z = -in.z;
  return normalized(in + fold(kind, out));
}
Dir polar(double theta, double phi) {
  const double s = std::sin(theta);
  return {s * std::cos(phi), s * std::sin(phi), std::cos(theta)};
}

class Levelled final : public Function {
 public:
  Levelled(std::shared_ptr<const Function> function, Dirac kind, double core)
      : function_(std::move(function)), kind_(kind), core_(core) {}
  const Info& info() const override { return function_->info(); }
  Dirac dirac() const override { return kind_; }
  double dirac_core() const override { return core_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    const Dir h = half(kind_, out, in);
    const bool side = kind_ == Dirac::through ? in.z < 0 : in.z > 0;
    if (side && h.x * h.x + h.y * h.y < core_ * core_ && h.z > 0)
      level(out, std::atan2(h.y, h.x), f);
    else
      function_->value(out, in, f);
  }
  void dirac_total(Dir out, std::span<double> W) const override { excess(out, core_, W); }

  // What stands out of the level within `reach` of the axis, times |cos|, per channel.
  void excess(Dir out, double reach, std::span<double> W) const {
    const size_t channels = W.size();
    std::vector<double> f(channels), base(channels);
    std::fill(W.begin(), W.end(), 0.0);
    const double step = std::log(reach / kInnermost) / static_cast<double>(kRings);
    for (size_t a = 0; a < kAzimuths; ++a) {
      const double phi = 2 * kPi * (static_cast<double>(a) + 0.5) / kAzimuths;
      level(out, phi, base);
      for (size_t r = 0; r < kRings; ++r) {
        const double inner = r ? kInnermost * std::exp(step * static_cast<double>(r)) : 0,
                     outer = kInnermost * std::exp(step * static_cast<double>(r + 1));
        const Dir h = polar(std::sqrt(0.5 * (inner * inner + outer * outer)), phi), in = incident(kind_, out, h);
        if (!(kind_ == Dirac::through ? in.z < 0 : in.z > 0)) continue;
        function_->value(out, in, f);
        const double area = kPi * (outer * outer - inner * inner) / kAzimuths;
        const double weight = area * 4 * std::fabs(dot(h, fold(kind_, out))) * std::fabs(in.z);
        for (size_t c = 0; c < channels; ++c)
          if (std::isfinite(f[c]) && f[c] > base[c]) W[c] += weight * (f[c] - base[c]);
      }
    }
  }

 private:
  // The function just outside the core.
  void level(Dir out, double phi, std::span<double> f) const {
    const Dir in = incident(kind_, out, polar(core_, phi));
    const bool side = kind_ == Dirac::through ? in.z < 0 : in.z > 0;
    if (side) function_->value(out, in, f);
    for (double& v : f)
      if (!side || !std::isfinite(v) || v < 0) v = 0;
  }

  std::shared_ptr<const Function> function_;
  Dirac kind_;
  double core_;
};

}  // namespace

NarrowLobe split_narrow_lobe(std::shared_ptr<const Function> function, int finest_order) {
  NarrowLobe found;
  const Function::Info& info = function->info();
  if (info.quantity != Quantity::bsdf || function->dirac() != Dirac::none) return found;
  const double width = std::sqrt(cell_solid_angle(finest_order));
  std::vector<double> all(info.wavelength_um.size()), narrow(all.size());
  for (const Dirac kind : {Dirac::mirror, Dirac::retro, Dirac::through}) {
    if (kind == Dirac::through && info.domain != Domain::sphere) continue;
    const auto levelled = std::make_shared<Levelled>(function, kind, kCoreWidths * width);
    double largest = 0;
    for (const double theta : {5 * kDegree, 30 * kDegree, 60 * kDegree, 75 * kDegree})
      for (const double phi : {0.2, 1.5}) {
        const Dir out = dir_from_angles(theta, phi);
        levelled->excess(out, kCoreWidths * width, all);
        levelled->excess(out, kNarrowWidths * width, narrow);
        for (size_t c = 0; c < all.size(); ++c)
          if (all[c] > kSignificant && narrow[c] > 0.5 * all[c]) largest = std::max(largest, all[c]);
      }
    if (largest > found.largest) {
      found.rest = levelled, found.largest = largest, found.core = kCoreWidths * width;
      found.where = kind == Dirac::mirror  ? "mirror direction"
                    : kind == Dirac::retro ? "direction back to the viewer"
                                           : "direction straight on";
    }
  }
  return found;
}

}  // namespace suite::sqt
