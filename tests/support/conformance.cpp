#include "support/conformance.h"

#include <algorithm>
#include <cmath>

#include "math/direction_test.h"
#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"

namespace suite::test {

namespace {

// How far an estimate lies beyond a tolerance, in standard errors.
double excess(double mean, double expected, double tolerance, double standard_error) {
  const double beyond = std::fabs(mean - expected) - tolerance;
  return beyond <= 0 ? 0 : standard_error > 0 ? beyond / standard_error : 1e9;
}

// Bookkeeping of one run.
class Run {
 public:
  Run(const ScatterModel& model, const SpectralState& state, Dir out, int knot, const ConformanceOptions& options)
      : model_(model),
        state_(state),
        out_(out),
        knot_(knot),
        o_(options),
        w_(state.size()),
        p_(state.knots.size()),
        total_(state.size()),
        weights_(state.size()) {}

  ConformanceResult operator()() {
    model_.total(out_, total_);
    for (const float t : total_)
      if (!(t >= 0) || !std::isfinite(t)) result_.fault = strf("total = %g", static_cast<double>(t));
    DirectionHistogram histogram(pilot_directions(), o_.cells);
    Pcg32 random(o_.seed, 2);
    for (const uint64_t until : {std::min(o_.first_samples, o_.samples), o_.samples}) {
      while (done_ < until) add_sample(random, histogram);
      judge_directions(histogram);
      judge_totals();
      if (!result_.fault.empty() || result_.least_p() > o_.doubt) break;
    }
    return result_;
  }

 private:
  void add_sample(Pcg32& random, DirectionHistogram& histogram) {
    ++done_;
    const auto [knot, drawn] = draw(random);
    if (!drawn) {
      for (RunningStats& s : weights_) s.add(0);
      return;
    }
    if (drawn->delta)
      deltas_ += 1, weigh_delta(*drawn, knot);
    else
      histogram.add(drawn->in), weigh(*drawn, knot);
  }
  std::pair<size_t, std::optional<ScatterModel::Sample>> draw(Pcg32& random) {
    const size_t knots = state_.knots.size();
    const size_t knot = knot_ >= 0
                            ? static_cast<size_t>(knot_)
                            : std::min(knots - 1, static_cast<size_t>(random.uniform() * static_cast<double>(knots)));
    const Vec2 u{random.uniform(), random.uniform()};
    return {knot, model_.sample(out_, u, random.uniform(), static_cast<int>(knot))};
  }
  std::vector<Dir> pilot_directions() {
    std::vector<Dir> pilot;
    Pcg32 random(o_.seed, 1);
    for (uint64_t n = 0; n < o_.pilot; ++n)
      if (const auto s = draw(random).second; s && !s->delta) pilot.push_back(s->in);
    return pilot;
  }
  // Density of what was drawn: of the knot, or the mean over the knots when the knot is drawn too.
  double density(std::span<const float> p) const {
    if (knot_ >= 0) return p[static_cast<size_t>(knot_)];
    double sum = 0;
    for (const float x : p) sum += x;
    return sum / static_cast<double>(p.size());
  }
  void weigh(const ScatterModel::Sample& s, size_t knot) {
    model_.eval(out_, s.in, w_);
    model_.pdf(out_, s.in, p_);
    const double p = density(p_);
    if (!(p > 0) || !std::isfinite(p)) result_.fault = strf("a sampled direction has pdf %g", p);
    if (std::fabs(length(s.in) - 1) > 1e-9) result_.fault = strf("a sampled direction has length %.12g", length(s.in));
    add_weights(p, knot);
  }
  void weigh_delta(const ScatterModel::Sample& s, size_t knot) {
    model_.delta_weight(out_, s.lobe, static_cast<int>(knot), w_);
    model_.delta_probability(out_, s.lobe, static_cast<int>(knot), p_);
    const double p = density(p_);
    if (!(p > 0) || p > 1 + 1e-6) result_.fault = strf("a sampled Dirac lobe has probability %g", p);
    add_weights(p, knot);
  }
  void add_weights(double p, size_t knot) {
    for (size_t i = 0; i < w_.size(); ++i) {
      if (!(w_[i] >= 0) || !std::isfinite(w_[i])) result_.fault = strf("w = %g", static_cast<double>(w_[i]));
      weights_[i].add(p > 0 ? w_[i] / p : 0);
    }
    result_.worst_weight = std::max(result_.worst_weight, p > 0 ? w_[state_.knots[knot]] / p : 0.0);
  }
  void judge_directions(const DirectionHistogram& histogram) {
    const double n = static_cast<double>(done_);
    const DirectionHistogram::Verdict v = histogram.judge(
        [&](Dir in) {
          model_.pdf(out_, in, p_);
          for (const float p : p_)
            if (!(p >= 0) || !std::isfinite(p)) result_.fault = strf("pdf = %g", static_cast<double>(p));
          return density(p_);
        },
        n);
    // The share that is captured is one question, how it is spread another.
    const double share = v.mass + deltas_ / n;
    // How many draws are Dirac lobes is chance too.
    const double variance = std::max({share * (1 - share), v.mass * (1 - v.mass), 1e-6});
    result_.lost_z = excess((v.added + deltas_) / n, share, o_.total_tolerance, std::sqrt(variance / n));
    result_.chi_square_p = v.p_value;
    result_.degrees = v.degrees;
  }
  void judge_totals() {
    result_.total_z = 0;
    for (size_t i = 0; i < weights_.size(); ++i) {
      // One knot's samples answer for that knot's wavelength only: elsewhere the weights may be unbounded.
      if (knot_ >= 0 && i != state_.knots[static_cast<size_t>(knot_)]) continue;
      result_.total_z = std::max(result_.total_z,
                                 excess(weights_[i].mean(), total_[i], o_.total_tolerance * std::max(total_[i], 1e-3f),
                                        weights_[i].stderr_of_mean()));
    }
  }

  const ScatterModel& model_;
  const SpectralState& state_;
  Dir out_;
  int knot_;
  ConformanceOptions o_;
  std::vector<float> w_, p_, total_;
  std::vector<RunningStats> weights_;
  uint64_t done_ = 0;  // samples drawn
  double deltas_ = 0;  // of them Dirac lobes
  ConformanceResult result_;
};

}  // namespace

double ConformanceResult::least_p() const {
  return std::min({chi_square_p, normal_two_sided(lost_z), normal_two_sided(total_z)});
}
bool ConformanceResult::passes(const ConformanceOptions& o) const {
  return fault.empty() && least_p() >= o.significance;
}

std::string ConformanceResult::text() const {
  return strf("chi-square p = %.3g (%d degrees), lost z = %.2f, total z = %.2f, largest weight %.3g%s%s", chi_square_p,
              degrees, lost_z, total_z, worst_weight, fault.empty() ? "" : ", fault: ", fault.c_str());
}

ConformanceResult conform(const ScatterModel& model, const SpectralState& state, Dir out, int knot,
                          const ConformanceOptions& options) {
  return Run(model, state, out, knot, options)();
}

double worst_reciprocity_error(const ScatterModel& model, const SpectralState& state, int pairs, uint64_t seed) {
  std::vector<float> there(state.size()), back(state.size());
  Pcg32 random(seed);
  double worst = 0;
  for (int n = 0; n < pairs; ++n) {
    Dir a = cosine_hemisphere({random.uniform(), random.uniform()}),
        b = cosine_hemisphere({random.uniform(), random.uniform()});
    if (n % 2) {  // narrow lobes: stay near the mirror direction
      const Dir around{-a.x, -a.y, a.z};
      b = normalized(around + (b - Dir{0, 0, 1}) * 1e-2);
    }
    if (!(a.z > 1e-3 && b.z > 1e-3)) continue;
    model.eval(a, b, there);
    model.eval(b, a, back);
    for (size_t i = 0; i < there.size(); ++i) {
      const double f = there[i] / b.z, g = back[i] / a.z;
      if (f + g > 1e-20) worst = std::max(worst, std::fabs(f - g) / (f + g));
    }
  }
  return worst;
}

SpectralState test_state(size_t knots) {
  const std::vector<Band> bands{Band::rectangular("b", 0.45, 0.02), Band::rectangular("r", 0.65, 0.02),
                                Band::rectangular("n", 0.85, 0.02), Band::rectangular("s", 1.65, 0.02)};
  return make_state(bands, 0.02, 0.65, knots);
}

std::vector<Dir> test_directions(const ScatterModel& model) {
  std::vector<Dir> d;
  for (const double deg : {0.0, 20.0, 60.0, 80.0, 89.9}) d.push_back(dir_from_angles(deg * kDegree, 0.4));
  if (model.opaque()) d.push_back(dir_from_angles((180 - 35) * kDegree, 0.4));
  for (size_t i = 0; i < 5 && !model.opaque(); ++i) d.push_back({d[i].x, d[i].y, -d[i].z});
  return d;
}

}  // namespace suite::test
