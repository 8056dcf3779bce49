#include "compare.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/sampling.h"
#include "math/warps.h"

namespace suite {

namespace {

constexpr double kLimitCosine = 0.17364817766693033;  // cos 80 deg

// Sums of one channel; `narrow` ones up to 80 deg.
struct Sums {
  double error = 0, data = 0, square = 0, data_square = 0, signed_error = 0, all_square = 0, weight = 0;
  void add(double f, double g, double cosine, double w, bool narrow) {
    const double e = g - f;
    all_square += w * e * e;
    weight += w;
    if (!narrow) return;
    error += w * std::fabs(e) * cosine;
    signed_error += w * e * cosine;
    data += w * f * cosine;
    square += w * e * e * cosine * cosine;
    data_square += w * f * f * cosine * cosine;
  }
  void add(const Sums& o) {
    error += o.error, data += o.data, square += o.square, data_square += o.data_square;
    signed_error += o.signed_error, all_square += o.all_square, weight += o.weight;
  }
  Comparison::Figures figures() const {
    Comparison::Figures r;
    r.l1 = data > 0 ? error / data : 0;
    r.bias = data > 0 ? signed_error / data : 0;
    r.cos_rmse = data_square > 0 ? std::sqrt(square / data_square) : 0;
    r.rmse = weight > 0 ? std::sqrt(all_square / weight) : 0;
    return r;
  }
};

double cosine_of(const sqt::Bundle& bundle, Dir in) { return bundle.cosine_weighted() ? std::fabs(in.z) : 1; }

// Half of the points uniform, half in a lobe (1 - cos drawn as a power law around the mirror direction); the density of
// the mixture weighs them back.
struct LobeSampler {
  static constexpr double kSharpness = 1e-3;
  static Dir mirror(Dir out, bool phase) { return phase ? -out : Dir{-out.x, -out.y, out.z}; }
  // 1 - cos = k (1/(1 - u v) - 1) with the largest value 2 at u = 1.
  static Dir draw(Dir axis, double u, double turn) {
    const double whole = 2 / (2 + kSharpness), drop = std::min(2.0, kSharpness * (1 / (1 - u * whole) - 1)),
                 s = std::sqrt(drop * (2 - drop));
    return normalized(
        Frame::around(axis).to_world({s * std::cos(2 * kPi * turn), s * std::sin(2 * kPi * turn), 1 - drop}));
  }
  static double density(Dir axis, Dir d) {
    const double half = std::sin(angle_between(axis, d) / 2), drop = 2 * half * half, whole = 2 / (2 + kSharpness),
                 k = kSharpness + drop;
    return kSharpness / (k * k) / whole / (2 * kPi);
  }
};

// Directions within the narrow lobe for which a Dirac lobe stands: there is nothing to compare.
bool replaced_by_dirac(const sqt::Bundle& bundle, Dir out, Dir in) {
  if (!bundle.info().has_delta()) return false;
  if (bundle.info().delta == sqt::Dirac::through) in.z = -in.z;
  if (in.z <= 0) return false;
  if (bundle.info().delta == sqt::Dirac::retro) out = {-out.x, -out.y, out.z};
  const Dir h = normalized(in + out);
  return h.x * h.x + h.y * h.y < bundle.info().delta_core * bundle.info().delta_core;
}

void peak_ratios(const sqt::Bundle& bundle, const sqt::Function& data, Comparison& result) {
  const size_t n = bundle.channels();
  std::vector<double> f(n), g(n);
  for (const int deg : {20, 45, 70}) {
    const Dir out = dir_from_angles(deg * kDegree, 0);
    std::vector<double> top_f(n), top_g(n);
    const int last = data.info().domain == sqt::Domain::sphere ? 18000 : 8000;  // hundredths of a degree
    for (int i = -last; i <= last; ++i) {
      const Dir in = dir_from_angles(std::abs(i) * 0.01 * kDegree, i < 0 ? kPi : 0);
      if (bundle.cosine_weighted() && std::fabs(in.z) < kLimitCosine) continue;
      if (replaced_by_dirac(bundle, out, in)) continue;
      data.value(out, in, f);
      bundle.value(out, in, g);
      for (size_t c = 0; c < n; ++c)
        if (std::isfinite(f[c])) top_f[c] = std::max(top_f[c], f[c]), top_g[c] = std::max(top_g[c], g[c]);
    }
    for (size_t c = 0; c < n; ++c) {
      const double ratio = top_f[c] > 0 ? top_g[c] / top_f[c] : 1;
      auto set = [&](Comparison::Figures& figures, bool worst) {
        double& slot = deg == 20 ? figures.peak_ratio_20 : deg == 45 ? figures.peak_ratio_45 : figures.peak_ratio_70;
        if (!worst || std::fabs(ratio - 1) > std::fabs(slot - 1)) slot = ratio;
      };
      set(result.channels[c], false);
      set(result.overall, true);
    }
  }
}

Comparison gathered(const std::vector<Sums>& sums) {
  Comparison result;
  Sums all;
  for (const Sums& s : sums) {
    result.channels.push_back(s.figures());
    all.add(s);
  }
  result.overall = all.figures();
  return result;
}

}  // namespace

void require_same_channels(const sqt::Bundle& bundle, const sqt::Function::Info& data) {
  const std::vector<double>&a = bundle.info().function.wavelength_um, &b = data.wavelength_um;
  bool same = a.size() == b.size();
  for (size_t c = 0; same && c < a.size(); ++c) same = std::fabs(a[c] - b[c]) < 1e-6;
  if (!same)
    throw Error(strf("the fit has %zu channels and the data %zu, or their wavelengths differ", a.size(), b.size()),
                "compare with what was fitted");
}

Comparison compare(const sqt::Bundle& bundle, const sqt::Function& data, size_t pairs) {
  const bool sphere = data.info().domain == sqt::Domain::sphere, phase = data.info().quantity != sqt::Quantity::bsdf;
  const size_t n = bundle.channels();
  std::vector<Sums> sums(n);
  std::vector<double> f(n), g(n);
  const SampleStream stream(20261121, 0, 0);
  size_t invalid = 0;
  for (size_t k = 0; k < pairs; ++k) {
    const auto a = stream.draw(static_cast<uint32_t>(k), 0), b = stream.draw(static_cast<uint32_t>(k), 1);
    Dir out = uniform_sphere({a[0], a[1]});
    if (!phase) out.z = std::fabs(out.z);
    const Dir axis = LobeSampler::mirror(out, phase);
    Dir in = b[0] < 0.5 ? uniform_sphere({a[2], a[3]}) : LobeSampler::draw(axis, a[2], a[3]);
    if (!sphere && b[0] < 0.5) in.z = std::fabs(in.z);
    if (out.z == 0 || in.z == 0 || (!sphere && in.z < 0)) continue;
    const double weight = 1 / (0.5 / (sphere ? 4 * kPi : 2 * kPi) + 0.5 * LobeSampler::density(axis, in));
    if (replaced_by_dirac(bundle, out, in)) continue;
    data.value(out, in, f);
    bundle.value(out, in, g);
    const bool narrow = phase || std::min(std::fabs(out.z), std::fabs(in.z)) >= kLimitCosine;
    for (size_t c = 0; c < n; ++c)
      std::isfinite(f[c]) ? sums[c].add(f[c], g[c], cosine_of(bundle, in), weight, narrow) : void(++invalid);
  }
  Comparison result = gathered(sums);
  result.pairs = pairs;
  result.invalid = invalid;
  peak_ratios(bundle, data, result);
  return result;
}

Comparison compare(const sqt::Bundle& bundle, const sqt::Samples& data) {
  const size_t n = bundle.channels();
  std::vector<Sums> sums(n);
  std::vector<double> g(n);
  size_t invalid = 0;
  for (size_t k = 0; k < data.in.size(); ++k) {
    bundle.value(data.out[k], data.in[k], g);
    const bool narrow =
        !bundle.cosine_weighted() || std::min(std::fabs(data.out[k].z), std::fabs(data.in[k].z)) >= kLimitCosine;
    for (size_t c = 0; c < n; ++c) {
      const double f = data.value[k * n + c];
      std::isfinite(f) ? sums[c].add(f, g[c], cosine_of(bundle, data.in[k]), 1, narrow) : void(++invalid);
    }
  }
  Comparison result = gathered(sums);
  result.pairs = data.in.size();
  result.invalid = invalid;
  return result;
}

std::string Comparison::text() const {
  std::string t = strf("compared at %zu pairs of directions, %zu values of them without valid data\n", pairs, invalid);
  t += "  channel       l1   cos_rmse   rmse [1/sr]     bias   peak 20   peak 45   peak 70\n";
  auto line = [&](const std::string& name, const Figures& f) {
    t += strf("  %-8s %6.2f %%   %6.2f %%   %11.4g  %+5.2f %%   %7.3f   %7.3f   %7.3f\n", name.c_str(), 100 * f.l1,
              100 * f.cos_rmse, f.rmse, 100 * f.bias, f.peak_ratio_20, f.peak_ratio_45, f.peak_ratio_70);
  };
  for (size_t c = 0; c < channels.size(); ++c) line(std::to_string(c), channels[c]);
  line("overall", overall);
  return t;
}

Json Comparison::json() const {
  auto one = [](const Figures& f) {
    Json j = Json::object();
    j.set("l1", f.l1);
    j.set("cos_rmse", f.cos_rmse);
    j.set("rmse", f.rmse);
    j.set("bias", f.bias);
    j.set("peak_ratio_20", f.peak_ratio_20);
    j.set("peak_ratio_45", f.peak_ratio_45);
    j.set("peak_ratio_70", f.peak_ratio_70);
    return j;
  };
  Json j = Json::object();
  j.set("schema", "suite.sqt-compare/1");
  j.set("pairs", pairs);
  j.set("invalid", invalid);
  j.set("overall", one(overall));
  Json list = Json::array();
  for (const Figures& f : channels) list.push(one(f));
  j.set("channels", std::move(list));
  return j;
}

Canvas draw_errors(const sqt::Bundle& bundle, const sqt::Function& data, size_t channel, const std::string& title) {
  constexpr int size = 360, header = 34, caption = 18;
  constexpr double views[6] = {0, 15, 30, 45, 60, 75};
  Canvas canvas(3 * size + 90, header + 2 * (size + caption));
  canvas.text(8, 6, title, kBlack, 2);
  std::vector<double> f(bundle.channels());
  for (int v = 0; v < 6; ++v) {
    const int x0 = v % 3 * size, y0 = header + v / 3 * (size + caption);
    const Dir out = dir_from_angles(views[v] * kDegree, 0);
    canvas.text(x0 + 8, y0 + 4, strf("view %g deg", views[v]));
    const double radius = size * 0.5 - 6;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const double px = (x + 0.5 - size * 0.5) / radius, py = (size * 0.5 - y - 0.5) / radius, r2 = px * px + py * py;
        if (r2 >= 1) continue;
        const double s = std::sqrt(2 - r2);
        const Dir in{px * s, py * s, 1 - r2};
        data.value(out, in, f);
        const double g = bundle.value(out, in, channel), sum = f[channel] + g;
        canvas.set(x0 + x, y0 + caption + y,
                   diverging(std::isnan(f[channel]) ? f[channel]
                             : sum > 0              ? (g - f[channel]) / sum * 4
                                                    : 0));
      }
  }
  // The scale saturates at a quarter: there the fit is off by a factor of 5/3.
  const int x = 3 * size + 14, y = header + 60, height = 300;
  canvas.text(x - 8, y - 30, "(g-f)/(g+f)");
  for (int j = 0; j < height; ++j) canvas.fill(x, y + j, 20, 1, diverging(1 - 2.0 * j / (height - 1)));
  canvas.frame(x, y, 20, height, kBlack);
  for (const int k : {-2, -1, 0, 1, 2})
    canvas.text(x + 25, y + height / 2 - k * (height / 2 - 4) / 2 - 3, strf("%+.3g", k * 0.125));
  return canvas;
}

}  // namespace suite
