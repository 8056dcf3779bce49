#include "sqt_fit/errors.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "sqt/mirror_pairs.h"
#include "sqt/reciprocity.h"

namespace suite::sqt {

namespace {

constexpr double kLimit = 80 * kDegree;
constexpr int kErrorsRings = 256, kSpokes = 64;  // of half directions, for totals
constexpr size_t kPoints = 2 * kErrorsRings * kSpokes;
const double kPeakAngles[3] = {20 * kDegree, 45 * kDegree, 70 * kDegree};

// Rings for totals: even in log(s + a), so that narrow lobes (down to 0.01 deg) and wide ones have their share of them.
constexpr double kFine = 1e-8;
constexpr double kGolden = 0.6180339887498949;  // turns a ring against the one before, of a spoke
const double kRange = std::log((1 + kFine) / kFine);
double ring_height(double u) { return kFine * std::expm1(kRange * u); }
double ring_pdf(double s) { return 1 / ((s + kFine) * kRange * 2 * kPi); }  // per steradian

}  // namespace

Reference::Reference(const Function& function, size_t pairs, uint64_t seed, const std::function<void(double)>& progress)
    : function_(function), channels_(function.info().wavelength_um.size()) {
  weighted_ = function.info().quantity == Quantity::bsdf;
  pairs_.resize(pairs);
  value_.resize(pairs * channels_);
  const SampleStream stream(seed, 77, 0);
  const size_t chunk = 4096;
  parallel_for(0, pairs, chunk, [&](size_t begin, size_t end) {
    std::vector<double> f(channels_);
    for (size_t n = begin; n < end; ++n)
      ask(pairs_[n], stream.draw(static_cast<uint32_t>(n), 0), stream.draw(static_cast<uint32_t>(n), 1)[0], f,
          &value_[n * channels_]);
    if (progress) progress(static_cast<double>(end - begin) / static_cast<double>(pairs));
  });
  find_totals();
  find_peaks();
  find_unphysical();
}

// Draws a pair from u and w, half of them near the mirror direction, and asks the function there.
void Reference::ask(Pair& p, const std::array<double, 4>& u, double w, std::span<double> f, float* value) const {
  const bool sphere = function_.info().domain == Domain::sphere;
  const double solid_angle = sphere ? 4 * kPi : 2 * kPi;
  p.out = weighted_ ? uniform_sphere({u[0] / 2, u[1]}) : Dir{0, 0, 1};
  if (w < 0.5) {
    p.in = uniform_sphere({sphere ? u[2] : u[2] / 2, u[3]});
  } else {
    const Dir h = near_half(u[2], u[3]);
    p.in = h * (2 * dot(h, p.out)) - p.out;
    if (sphere && w >= 0.75) p.in.z = -p.in.z;
  }
  p.weight = 0;
  if (!sphere && !(p.in.z > 0)) return;
  Dir folded = p.in;
  if (sphere) folded.z = std::fabs(folded.z);  // both sides share the near density
  const Dir h = normalized(folded + p.out);
  double near = near_pdf(1 - h.z) / (4 * std::max(1e-9, dot(h, p.out)));
  if (sphere) near = folded.z == 0 ? 0 : 0.5 * near;
  if (sphere && w >= 0.5 && w < 0.75 && !(p.in.z > 0)) return;
  if (sphere && w >= 0.75 && !(p.in.z < 0)) return;
  function_.value(p.out, p.in, f);
  bool valid = true;
  for (size_t c = 0; c < channels_; ++c) valid &= std::isfinite(f[c]);
  if (!valid) return;
  p.weight = static_cast<float>(1 / solid_angle / (0.5 / solid_angle + 0.5 * near));
  p.narrow = !weighted_ || (p.out.z > std::cos(kLimit) && std::fabs(p.in.z) > std::cos(kLimit));
  for (size_t c = 0; c < channels_; ++c) value[c] = static_cast<float>(f[c]);
}

void Reference::find_totals() {
  if (weighted_)
    for (int k = 0; k <= 8; ++k) theta_.push_back(k * 10 * kDegree);
  else
    theta_.push_back(0);
  valid_.assign(theta_.size() * kPoints, 0);
  for (size_t t = 0; t < theta_.size(); ++t) {
    const std::vector<double> W = integrate(
        [&](size_t point, Dir o, Dir i, std::span<double> f) {
          function_.value(o, i, f);
          valid_[t * kPoints + point] = std::all_of(f.begin(), f.end(), [](double v) { return std::isfinite(v); });
        },
        dir_from_angles(theta_[t], 0.3));
    total_.insert(total_.end(), W.begin(), W.end());
    for (const double w : W) findings_.largest_total = std::max(findings_.largest_total, w);
  }
}

void Reference::find_unphysical() {
  double negative = 0, invalid = 0, all = 0;
  for (size_t n = 0; n < std::min<size_t>(pairs_.size(), 50000); ++n) {
    const Pair& p = pairs_[n];
    if (p.weight == 0) {
      invalid += p.in.z > 0;
      all += p.in.z > 0;
      continue;
    }
    all += 1;
    for (size_t c = 0; c < channels_; ++c)
      negative += value_[n * channels_ + c] < 0 ? 1.0 / static_cast<double>(channels_) : 0;
  }
  if (weighted_)
    findings_.reciprocity_error = reciprocity_error(channels_, [this](Dir out, Dir in, std::span<double> f) {
                                    function_.value(out, in, f);
                                  }).back();
  findings_.negative_share = all > 0 ? negative / all : 0;
  findings_.invalid_share = all > 0 ? invalid / all : 0;
}

// Totals by the midpoint rule over half directions.
std::vector<double> Reference::integrate(const std::function<void(size_t, Dir, Dir, std::span<double>)>& value,
                                         Dir out) const {
  std::vector<double> f(channels_), W(channels_, 0.0);
  const bool sphere = function_.info().domain == Domain::sphere;
  const int n_r = kErrorsRings, n_phi = kSpokes;
  for (int side = 0; side < (sphere ? 2 : 1); ++side)
    for (int a = 0; a < n_r; ++a)
      for (int b = 0; b < n_phi; ++b) {
        const double s = ring_height((a + 0.5) / n_r), r = std::sqrt(s * (2 - s)),
                     phi = 2 * kPi * (b + std::fmod(kGolden * a, 1.0)) / n_phi;
        const Dir h{r * std::cos(phi), r * std::sin(phi), 1 - s};
        Dir in = h * (2 * dot(h, out)) - out;
        if (!(in.z > 0) || !(dot(h, out) > 0)) continue;
        if (side) in.z = -in.z;
        value(static_cast<size_t>((side * n_r + a) * n_phi + b), out, in, f);
        if (!std::all_of(f.begin(), f.end(), [](double v) { return std::isfinite(v); })) continue;
        const double weight = 4 * dot(h, out) / ring_pdf(s) / (n_r * n_phi) * (weighted_ ? std::fabs(in.z) : 1.0);
        for (size_t c = 0; c < channels_; ++c)
          if (f[c] > 0) W[c] += weight * f[c];
      }
  return W;
}

Reference::Brief Reference::brief(const Bundle& bundle) const {
  struct Part {
    double error = 0, data = 0, square = 0, data_square = 0;
  };
  const size_t chunk = 8192, chunks = (pairs_.size() + chunk - 1) / chunk;
  std::vector<Part> parts(chunks);
  parallel_for(0, chunks, 1, [&](size_t begin, size_t end) {
    std::vector<double> g(channels_);
    for (size_t k = begin; k < end; ++k)
      for (size_t n = k * chunk; n < std::min(pairs_.size(), (k + 1) * chunk); ++n) {
        const Pair& p = pairs_[n];
        if (p.weight == 0 || !p.narrow) continue;
        bundle.value(p.out, p.in, g);
        const double cosine = weighted_ ? std::fabs(p.in.z) : 1.0;
        for (size_t c = 0; c < channels_; ++c) {
          const double f = value_[n * channels_ + c] * cosine, e = g[c] * cosine - f;
          parts[k].error += p.weight * std::fabs(e);
          parts[k].data += p.weight * f;
          parts[k].square += p.weight * e * e;
          parts[k].data_square += p.weight * f * f;
        }
      }
  });
  Part all;
  for (const Part& s : parts)
    all.error += s.error, all.data += s.data, all.square += s.square, all.data_square += s.data_square;
  return {all.data > 0 ? all.error / all.data : 0, all.data_square > 0 ? std::sqrt(all.square / all.data_square) : 0};
}

void Reference::find_peaks() {
  parallel_for(0, planes_.size(), 1, [&](size_t begin, size_t end) {
    for (size_t a = begin; a < end; ++a) {
      Plane& plane = planes_[a];
      plane.out = dir_from_angles(kPeakAngles[a], 0);
      plane.peak.assign(channels_, 0.0);
      std::vector<double> f(channels_);
      const int last = function_.info().domain == Domain::sphere ? 1800 : 900;  // tenths of a degree
      for (int k = -last; k <= last; ++k) {
        const Dir in = dir_from_angles(std::abs(k) * 0.1 * kDegree, k < 0 ? kPi : 0);
        if (weighted_ && std::fabs(in.z) < std::cos(kLimit)) continue;
        function_.value(plane.out, in, f);
        if (!std::all_of(f.begin(), f.end(), [](double v) { return std::isfinite(v); })) continue;
        plane.in.push_back(in);
        for (size_t c = 0; c < channels_; ++c) plane.peak[c] = std::max(plane.peak[c], f[c]);
      }
    }
  });
}

std::array<double, 3> Reference::peaks(const Bundle& bundle, size_t channel) const {
  std::array<double, 3> ratio;
  for (size_t a = 0; a < 3; ++a) {
    const Plane& plane = planes_[a];
    double peak = 0;
    for (const Dir in : plane.in) peak = std::max(peak, bundle.value(plane.out, in, channel));
    ratio[a] = plane.peak[channel] > 0 ? peak / plane.peak[channel] : 1;
  }
  return ratio;
}

std::array<double, 3> Reference::least_peaks(const Bundle& bundle) const {
  std::vector<std::array<double, 3>> all(channels_);
  parallel_for(0, channels_, 1, [&](size_t begin, size_t end) {
    for (size_t c = begin; c < end; ++c) all[c] = peaks(bundle, c);
  });
  std::array<double, 3> least = all[0];
  for (const auto& ratio : all)
    for (size_t a = 0; a < 3; ++a) least[a] = std::min(least[a], ratio[a]);
  return least;
}

struct Reference::Sums {
  double l1 = 0, f = 0, square = 0, f_square = 0, plain = 0, weight = 0;
};

// Of a chunk of pairs, one per channel.
void Reference::add_pairs(const Bundle& bundle, size_t begin, size_t end, std::span<Sums> sums) const {
  std::vector<double> g(channels_);
  for (size_t n = begin; n < end; ++n) {
    const Pair& p = pairs_[n];
    if (p.weight == 0) continue;
    bundle.value(p.out, p.in, g);
    const double cosine = weighted_ ? std::fabs(p.in.z) : 1.0;
    for (size_t c = 0; c < channels_; ++c) {
      Sums& s = sums[c];
      const double f = value_[n * channels_ + c], e = g[c] - f;
      s.plain += p.weight * e * e;
      s.weight += p.weight;
      if (!p.narrow) continue;
      s.l1 += p.weight * cosine * std::fabs(e);
      s.f += p.weight * cosine * f;
      s.square += p.weight * e * e * cosine * cosine;
      s.f_square += p.weight * f * f * cosine * cosine;
    }
  }
}

// Totals, peaks and sampling weights of a channel.
void Reference::measure_channel(const Bundle& bundle, size_t c, ErrorFigures& out) const {
  for (size_t t = 0; t < theta_.size(); ++t) {
    const Dir view = dir_from_angles(theta_[t], 0.3);
    const double W = integrate(
        [&](size_t point, Dir o, Dir i, std::span<double> v) {
          std::fill(v.begin(), v.end(), 0.0);
          if (valid_[t * kPoints + point]) v[c] = bundle.value(o, i, c);
        },
        view)[c];
    const double expected = total_[t * channels_ + c];
    if (expected > 0) out.total_error = std::max(out.total_error, std::fabs(W - expected) / expected);
    const auto dirac = bundle.delta(view, c);
    const double whole = bundle.total(view, c) - (dirac ? dirac->total : 0);
    const SampleStream stream(5, t, c);
    for (uint32_t n = 0; n < 2000 && whole > 0; ++n) {
      const auto u = stream.draw(n, 0);
      const auto in = bundle.sample(view, {u[0], u[1]}, u[2], c);
      if (!in) continue;
      const double p = bundle.pdf(view, *in, c);
      if (p > 0) out.max_weight = std::max(out.max_weight, bundle.eval(view, *in, c) / p / whole);
    }
  }
  const std::array<double, 3> ratio = peaks(bundle, c);
  out.peak_ratio_20 = ratio[0], out.peak_ratio_45 = ratio[1], out.peak_ratio_70 = ratio[2];
}

std::vector<ErrorFigures> Reference::measure(const Bundle& bundle) const {
  const size_t count = channels_ + 1;
  std::vector<ErrorFigures> out(count);
  const size_t chunk = 8192, chunks = (pairs_.size() + chunk - 1) / chunk;
  std::vector<Sums> parts(chunks * channels_);
  parallel_for(0, chunks, 1, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k)
      add_pairs(bundle, k * chunk, std::min(pairs_.size(), (k + 1) * chunk), {&parts[k * channels_], channels_});
  });
  std::vector<Sums> sums(count);
  for (size_t i = 0; i < parts.size(); ++i)
    for (Sums* s : {&sums[i % channels_], &sums[channels_]}) {
      const Sums& p = parts[i];
      s->l1 += p.l1, s->f += p.f, s->square += p.square, s->f_square += p.f_square, s->plain += p.plain,
          s->weight += p.weight;
    }
  const std::vector<double> reciprocity = reciprocity_error(bundle);
  for (size_t c = 0; c < count; ++c) {
    const Sums& s = sums[c];
    out[c].l1 = s.f > 0 ? s.l1 / s.f : 0;
    out[c].cos_rmse = s.f_square > 0 ? std::sqrt(s.square / s.f_square) : 0;
    out[c].rmse = s.weight > 0 ? std::sqrt(s.plain / s.weight) : 0;
    out[c].reciprocity_error = reciprocity[c];
  }
  parallel_for(0, channels_, 1, [&](size_t begin, size_t end) {
    for (size_t c = begin; c < end; ++c) measure_channel(bundle, c, out[c]);
  });
  ErrorFigures& all = out[channels_];
  auto farther = [](double a, double b) {
    return std::fabs(std::log(std::max(1e-9, b))) > std::fabs(std::log(std::max(1e-9, a))) ? b : a;
  };
  all.peak_ratio_20 = all.peak_ratio_45 = all.peak_ratio_70 = 1;
  for (size_t c = 0; c < channels_; ++c) {
    all.total_error = std::max(all.total_error, out[c].total_error);
    all.max_weight = std::max(all.max_weight, out[c].max_weight);
    all.peak_ratio_20 = farther(all.peak_ratio_20, out[c].peak_ratio_20);
    all.peak_ratio_45 = farther(all.peak_ratio_45, out[c].peak_ratio_45);
    all.peak_ratio_70 = farther(all.peak_ratio_70, out[c].peak_ratio_70);
  }
  return out;
}

}  // namespace suite::sqt
