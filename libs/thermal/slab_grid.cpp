// The grid of a slab and what does not change with time: checks, nodes, coefficients of heat and conductance, faces.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "spectral/planck.h"
#include "thermal/slab.h"

namespace suite {

namespace {

constexpr size_t kMostNodes = 100000;
constexpr double kColdest = 20, kHottest = 1500;  // K, where the property polynomials must stay positive

template <size_t N>
double polynomial(const std::array<double, N>& c, double x) {
  double v = 0;
  for (size_t i = N; i-- > 0;) v = v * x + c[i];
  return v;
}

template <size_t N>
void check_positive(const std::array<double, N>& c, const char* what, const std::string& layer) {
  for (int i = 0; i <= 64; ++i) {
    const double T = kColdest * std::pow(kHottest / kColdest, i / 64.0), v = polynomial(c, T);
    if (!(v > 0 && std::isfinite(v)))
      throw Error(layer + strf(": the %s is %g at %g K", what, v, T),
                  strf("it must be positive from %g to %g K", kColdest, kHottest));
  }
}

void check_layer(const SlabLayer& l, size_t number) {
  const std::string name = strf("layer %zu of a slab", number);
  if (!(l.thickness > 0 && l.thickness <= 1e6))
    throw Error(name + strf(": thickness %g m", l.thickness), "more than 0, at most 1e6 m");
  if (!(l.density > 0 && l.density <= 1e5))
    throw Error(name + strf(": density %g kg/m3", l.density), "more than 0, at most 1e5 kg/m3");
  check_positive(l.specific_heat, "specific heat", name);
  check_positive(l.conductivity, "conductivity", name);
  if (!std::isfinite(l.heat_generation)) throw Error(name + ": heat generation is not finite");
  if (!(l.contact_resistance >= 0 && std::isfinite(l.contact_resistance)))
    throw Error(name + strf(": contact resistance %g m2 K/W", l.contact_resistance), "0 or more");
  if (l.intervals < 0 || l.intervals > 50000)
    throw Error(name + strf(": %d intervals", l.intervals), "0 (automatic) to 50000");
}

void check_face(const SlabFace& f, const char* which) {
  const std::string name = std::string("the ") + which + " of a slab";
  if (f.kind != SlabFace::Kind::surface) {
    if (!f.value)
      throw Error(name + " has no function for its " + (f.kind == SlabFace::Kind::flux ? "flux" : "temperature"));
    return;
  }
  if (!f.loads) throw Error(name + " has no loads");
  if (!(f.emissivity >= 0 && f.emissivity <= 1)) throw Error(name + strf(": emissivity %g", f.emissivity), "0 to 1");
  for (const double h : {f.convection_still, f.convection_wind})
    if (!(h >= 0 && h <= 1e6)) throw Error(name + strf(": convection %g W/(m2 K)", h), "0 or more");
}

// Interval lengths of a layer, from the top down. `above` and `below`: distances of its top and bottom from the faces
// that change fast (infinite when there is none).
std::vector<double> intervals_of(const SlabLayer& l, double above, double below, double resolution) {
  if (l.intervals > 0) return std::vector<double>(static_cast<size_t>(l.intervals), l.thickness / l.intervals);
  const double diffusivity = polynomial(l.conductivity, 300.0) / (l.density * polynomial(l.specific_heat, 300.0));
  const double finest = 0.3 * std::sqrt(diffusivity * resolution);
  constexpr double kGrowth = 0.12;  // per length of distance from the face
  std::vector<double> lengths;
  double z = 0;
  while (z < l.thickness && lengths.size() <= kMostNodes) {
    const double distance = std::fmin(above + z, below + l.thickness - z);
    lengths.push_back(std::fmin(finest + kGrowth * distance, l.thickness / 3));
    z += lengths.back();
  }
  for (double& h : lengths) h *= l.thickness / z;
  return lengths;
}

}  // namespace

Slab::Slab(SlabSpec spec, SlabOptions options) : spec_(std::move(spec)), options_(options) {
  check();
  build_grid();
  linear_ = spec_.bottom.kind != SlabFace::Kind::surface;
  for (const SlabLayer& l : spec_.layers) {
    for (size_t i = 1; i < l.specific_heat.size(); ++i) linear_ = linear_ && l.specific_heat[i] == 0;
    for (size_t i = 1; i < l.conductivity.size(); ++i) linear_ = linear_ && l.conductivity[i] == 0;
  }
  const size_t n = depth_.size();
  for (Stage* s : {&now_, &middle_, &end_}) {
    s->T.resize(n);
    s->heat.resize(n);
    s->gain.resize(n);
    s->flux.resize(n - 1);
  }
  for (auto* v : {&pivot_, &up_, &down_, &right_, &diagonal_, &lower_, &upper_, &history_, &rate_, &bend_})
    v->resize(n);
  flux_sum_.resize(n - 1);
  T_.assign(n, 0);
}

void Slab::check() const {
  if (spec_.layers.empty()) throw Error("a slab without a layer", "give at least one");
  for (size_t i = 0; i < spec_.layers.size(); ++i) check_layer(spec_.layers[i], i + 1);
  check_face(spec_.top, "top");
  check_face(spec_.bottom, "bottom");
  const SlabOptions& o = options_;
  if (!(o.tolerance > 0 && o.tolerance <= 100))
    throw Error(strf("a tolerance of %g K", o.tolerance), "more than 0, at most 100 K");
  if (!(o.max_step > 0 && std::isfinite(o.max_step)))
    throw Error(strf("a largest step of %g s", o.max_step), "more than 0");
  if (!(o.min_step > 0 && o.min_step <= o.max_step))
    throw Error(strf("a smallest step of %g s", o.min_step), "more than 0, at most the largest");
  if (!(o.resolution > 0 && std::isfinite(o.resolution)))
    throw Error(strf("a resolution of %g s", o.resolution), "more than 0");
}

void Slab::build_grid() {
  double total = 0;
  for (const SlabLayer& l : spec_.layers) total += l.thickness;
  const bool radiates_below = spec_.bottom.kind == SlabFace::Kind::surface;
  auto add_node = [this](double z) {
    depth_.push_back(z);
    for (auto& c : heat_coefficients_) c.push_back(0);
    source_.push_back(0);
  };
  add_node(0);
  double z = 0;
  for (size_t k = 0; k < spec_.layers.size(); ++k) {
    const SlabLayer& l = spec_.layers[k];
    const double below = radiates_below ? total - z - l.thickness : INFINITY;
    for (const double h : intervals_of(l, z, below, options_.resolution)) {
      // Half of the interval's heat and source go to the node at each end.
      add_node(depth_.back() + h);
      for (const size_t node : {depth_.size() - 2, depth_.size() - 1}) {
        for (size_t m = 0; m < 5; ++m)
          heat_coefficients_[m][node] += l.density * h / 2 * l.specific_heat[m] / static_cast<double>(m + 1);
        source_[node] += l.heat_generation * h / 2;
      }
      for (size_t m = 0; m < 4; ++m) flux_coefficients_[m].push_back(l.conductivity[m] / h);
      if (depth_.size() > kMostNodes)
        throw Error(strf("a slab needs more than %zu nodes", kMostNodes),
                    "give a coarser resolution or the number of intervals");
    }
    z += l.thickness;
    depth_.back() = z;
    if (l.contact_resistance > 0 && k + 1 < spec_.layers.size()) {
      add_node(z);  // the other side of the contact
      for (size_t m = 0; m < 4; ++m) flux_coefficients_[m].push_back(m == 0 ? 1 / l.contact_resistance : 0);
    }
  }
}

double Slab::capacity_of(size_t node, double T) const {
  const auto& c = heat_coefficients_;
  return c[0][node] + T * (2 * c[1][node] + T * (3 * c[2][node] + T * (4 * c[3][node] + T * 5 * c[4][node])));
}

Slab::FaceNow Slab::face_at(const SlabFace& face, double t) const {
  FaceNow now;
  switch (face.kind) {
    case SlabFace::Kind::flux:
      now.constant = face.value(t);
      break;
    case SlabFace::Kind::temperature:
      now.fixed = true;
      now.kelvin = face.value(t);
      if (!(now.kelvin > 0)) throw Error(strf("a slab's face is given %g K at %.9g s", now.kelvin, t), "more than 0");
      break;
    case SlabFace::Kind::surface: {
      const SurfaceLoad load = face.loads(t);
      now.linear = face.convection_still + face.convection_wind * load.wind;
      now.constant = load.sun_absorbed + face.emissivity * load.sky_irradiance + now.linear * load.air_temperature;
      now.quartic = face.emissivity * kStefanBoltzmann;
      if (!(now.linear >= 0))
        throw Error(strf("a slab's loads are no loads at %.9g s", t), "finite numbers, wind 0 or more");
    }
  }
  if (!std::isfinite(now.constant) || !std::isfinite(now.kelvin))
    throw Error(strf("a slab's loads are not finite at %.9g s", t), "finite numbers");
  return now;
}

double Slab::at_depth(double z) const {
  const auto after = std::upper_bound(depth_.begin(), depth_.end(), z);
  if (after == depth_.begin()) return T_.front();
  if (after == depth_.end()) return T_.back();
  const size_t i = static_cast<size_t>(after - depth_.begin());
  return T_[i - 1] + (T_[i] - T_[i - 1]) * (z - depth_[i - 1]) / (depth_[i] - depth_[i - 1]);
}

std::span<const double> Slab::heat_capacities() const {
  capacities_.resize(T_.size());
  for (size_t i = 0; i < T_.size(); ++i) capacities_[i] = capacity_of(i, T_[i]);
  return capacities_;
}

}  // namespace suite
