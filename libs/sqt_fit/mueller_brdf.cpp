#include "sqt_fit/mueller_brdf.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace suite::sqt {

namespace {

// Mean |f(phi) - f(-phi)| over mean f from which on both halves are kept: what other measured formats take.
constexpr double kMuellerBilateralLimit = 0.02;

bool above(const HalfAngles& a) {
  Dir out, in;
  a.directions(out, in);
  return out.z > 0 && in.z > 0;
}

}  // namespace

MuellerBrdf::MuellerBrdf(std::string name, std::string source, Data data) : data_(std::move(data)) {
  info_.name = std::move(name);
  info_.source = std::move(source);
  info_.wavelength_um = data_.wavelength_um;
  check();
  fill();
  asymmetry_ = measure_asymmetry();
  info_.bilateral = asymmetry_ < kMuellerBilateralLimit;
}

void MuellerBrdf::check() const {
  data_.grid.check();
  const std::vector<double>& um = data_.wavelength_um;
  if (um.empty()) throw Error("no wavelength");
  for (size_t i = 0; i < um.size(); ++i)
    if (!(um[i] > 0) || (i && !(um[i] > um[i - 1]))) throw Error("wavelengths must ascend from above 0");
  if (data_.values.size() != data_.grid.nodes() * um.size() * kMatrix)
    throw Error(
        strf("%zu values of matrices, %zu are wanted", data_.values.size(), data_.grid.nodes() * um.size() * kMatrix));
  for (size_t i = 0; i < data_.values.size(); ++i)
    if (!std::isfinite(data_.values[i]) && !std::isnan(data_.values[i - i % kMatrix]))
      throw Error(strf("element %zu%zu of a matrix is not finite where m11 is", i % kMatrix / 4 + 1, i % 4 + 1),
                  "nan in m11 marks missing matrices");
}

// Rounds over the grid: a node without data takes the first neighbour that has some.
void MuellerBrdf::fill() {
  const HalfGrid& g = data_.grid;
  const size_t row = data_.wavelength_um.size() * kMatrix, H = g.theta_h.size(), D = g.theta_d.size(),
               P = g.phi_d.size();
  std::vector<char> has(g.nodes());
  size_t missing = 0, wanted = 0;
  for (size_t n = 0; n < has.size(); ++n) {
    has[n] = true;
    for (size_t v = n * row; v < (n + 1) * row; v += kMatrix) has[n] = has[n] && data_.values[v] > 0;
    if (!above(g.angles(n))) continue;
    ++wanted;
    missing += !has[n];
  }
  if (missing == wanted) throw Error("no matrix above the horizon has an m11 above 0");
  missing_share_ = static_cast<double>(missing) / static_cast<double>(wanted);
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<char> now = has;
    for (size_t n = 0; n < has.size(); ++n) {
      if (has[n]) continue;
      const size_t h = n % H, d = n / H % D, p = n / H / D;
      const size_t near[] = {h ? g.node(p, d, h - 1) : n,   h + 1 < H ? g.node(p, d, h + 1) : n,
                             d ? g.node(p, d - 1, h) : n,   d + 1 < D ? g.node(p, d + 1, h) : n,
                             g.node((p + P - 1) % P, d, h), g.node((p + 1) % P, d, h)};
      const size_t* from = std::find_if(std::begin(near), std::end(near), [&](size_t k) { return has[k]; });
      if (from == std::end(near)) continue;
      std::copy_n(data_.values.begin() + static_cast<ptrdiff_t>(*from * row), row,
                  data_.values.begin() + static_cast<ptrdiff_t>(n * row));
      now[n] = changed = true;
    }
    has = std::move(now);
  }
}

void MuellerBrdf::value(Dir out, Dir in, std::span<double> f) const {
  if (!(out.z > 0 && in.z > 0)) {
    std::fill(f.begin(), f.end(), std::numeric_limits<double>::quiet_NaN());
    return;
  }
  const HalfGrid::Corners c = data_.grid.at(HalfAngles::of(out, in));
  std::fill(f.begin(), f.end(), 0.0);
  for (size_t k = 0; k < 8; ++k)
    for (size_t w = 0; w < f.size(); ++w)
      f[w] += c.weight[k] * static_cast<double>(data_.values[(c.node[k] * f.size() + w) * kMatrix]);
}

double MuellerBrdf::measure_asymmetry() const {
  const HalfGrid& g = data_.grid;
  const size_t channels = data_.wavelength_um.size();
  double difference = 0, sum = 0;
  std::vector<double> a(channels), b(channels);
  for (size_t p = 0; p < g.phi_d.size(); ++p)
    for (size_t n = g.node(p, 0, 0); n < g.node(p, 0, 0) + g.theta_d.size() * g.theta_h.size(); ++n) {
      HalfAngles at = g.angles(n);
      if (!above(at)) continue;
      Dir out, in;
      at.directions(out, in);
      value(out, in, a);
      value({out.x, -out.y, out.z}, {in.x, -in.y, in.z}, b);
      const double weight = out.z * in.z * std::sin(at.theta_h) * std::sin(2 * at.theta_d);
      for (size_t w = 0; w < channels; ++w) {
        difference += weight * std::fabs(a[w] - b[w]);
        sum += weight * a[w];
      }
    }
  return sum > 0 ? difference / sum : 0;
}

}  // namespace suite::sqt
