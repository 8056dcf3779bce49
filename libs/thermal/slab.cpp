// The time scheme of a slab. Every stage solves
//   heat(T) - scale * gain(T) = history,
// heat being what each node stores (J/m2), gain what flows into it (W/m2); both stages share scale = d dt, so a slab of
// constant properties needs one elimination for both and keeps it while the step stays.
#include "thermal/slab.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "thermal/step_control.h"
#include "thermal/tr_bdf2.h"

namespace suite {

using namespace tr_bdf2;

namespace {

constexpr double kHottest = 1e4;  // K

}  // namespace

void Slab::start(double t, double kelvin) { start(t, std::vector<double>(grid_.depth.size(), kelvin)); }

void Slab::start(double t, std::span<const double> kelvin) {
  SUITE_CHECK_EQ(kelvin.size(), grid_.depth.size());
  for (const double T : kelvin)
    if (!(T >= 1 && T <= kHottest)) throw Error(strf("a slab starts at %g K", T), "1 to 10000 K");
  t_ = t;
  T_.assign(kelvin.begin(), kelvin.end());
  now_.T = T_;
  evaluate(now_, {}, {});
  heat_ = now_.heat;
  next_step_ = std::fmin(1.0, options_.max_step);
  last_step_ = 0;
  reset_means();
}

void Slab::reset_means() {
  std::fill(flux_sum_.begin(), flux_sum_.end(), 0.0);
  sum_time_ = 0;
}

std::vector<double> Slab::mean_fluxes() const {
  std::vector<double> means(flux_sum_);
  for (double& m : means) m = sum_time_ > 0 ? m / sum_time_ : 0;
  return means;
}

// Stored heat, fluxes and gains of a stage from its temperatures.
void Slab::evaluate(Stage& s, const FaceNow& top, const FaceNow& bottom) const {
  const size_t n = s.T.size();
  const double* T = s.T.data();
  double *heat = s.heat.data(), *flux = s.flux.data(), *gain = s.gain.data();
  const std::vector<double>*h = grid_.heat.data(), *k = grid_.conductance.data();
  const double *h0 = h[0].data(), *h1 = h[1].data(), *h2 = h[2].data(), *h3 = h[3].data(), *h4 = h[4].data();
  const double *k0 = k[0].data(), *k1 = k[1].data(), *k2 = k[2].data(), *k3 = k[3].data();
  if (linear_) {
#pragma GCC ivdep
    for (size_t i = 0; i < n; ++i) heat[i] = h0[i] * T[i];
#pragma GCC ivdep
    for (size_t j = 0; j < n - 1; ++j) flux[j] = k0[j] * (T[j] - T[j + 1]);
  } else {
#pragma GCC ivdep
    for (size_t i = 0; i < n; ++i)
      heat[i] = T[i] * (h0[i] + T[i] * (h1[i] + T[i] * (h2[i] + T[i] * (h3[i] + T[i] * h4[i]))));
#pragma GCC ivdep
    for (size_t j = 0; j < n - 1; ++j) {
      // The mean of k over both temperatures, as symmetric polynomials, so that nothing cancels when they are close.
      const double a = T[j], b = T[j + 1], sum = a + b, squares = a * a + b * b;
      flux[j] = (k0[j] + k1[j] * sum / 2 + k2[j] * (squares + a * b) * (1.0 / 3) + k3[j] * sum * squares / 4) * (a - b);
    }
  }
  const double* source = grid_.source.data();
  gain[0] = source[0] - flux[0] + (top.fixed ? 0 : top.flux(T[0]));
#pragma GCC ivdep
  for (size_t i = 1; i < n - 1; ++i) gain[i] = source[i] + (flux[i - 1] - flux[i]);
  gain[n - 1] = source[n - 1] + flux[n - 2] + (bottom.fixed ? 0 : bottom.flux(T[n - 1]));
}

namespace {

// Eliminates a tridiagonal system from the bottom up, leaving one equation for the top unknown: returns its
// coefficient. Afterwards right'[i] = right[i] - up[i] right'[i+1] and x[i] = pivot[i] right'[i] - down[i] x[i-1].
double eliminate(std::span<const double> lower, std::span<const double> diagonal, std::span<const double> upper,
                 std::span<double> pivot, std::span<double> up, std::span<double> down) {
  const size_t n = diagonal.size();
  pivot[n - 1] = 1 / diagonal[n - 1];
  for (size_t i = n - 1; i-- > 0;) {
    down[i + 1] = pivot[i + 1] * lower[i + 1];
    up[i] = upper[i] * pivot[i + 1];
    const double d = diagonal[i] - upper[i] * down[i + 1];
    if (i == 0) return d;
    pivot[i] = 1 / d;
  }
  throw_bug(__FILE__, __LINE__, "a slab of fewer than two nodes", "");
}

}  // namespace

void Slab::factor_linear(double scale) {
  const size_t n = T_.size();
  for (size_t i = 0; i < n; ++i) {
    lower_[i] = i > 0 ? -scale * grid_.conductance[0][i - 1] : 0;
    upper_[i] = i + 1 < n ? -scale * grid_.conductance[0][i] : 0;
    diagonal_[i] = grid_.heat[0][i] - lower_[i] - upper_[i];
  }
  if (spec_.bottom.kind == SlabFace::Kind::temperature) diagonal_[n - 1] = 1, lower_[n - 1] = 0;
  top_diagonal_ = eliminate(lower_, diagonal_, upper_, pivot_, up_, down_);
  factored_for_ = scale;
  ++counters_.eliminations;
}

// Constant properties: the interior is eliminated exactly, the top face's balance is one equation in its temperature.
bool Slab::solve_linear(std::span<const double> history, double scale, const FaceNow& top, const FaceNow& bottom,
                        Stage& s) {
  const size_t n = T_.size();
  if (factored_for_ != scale) factor_linear(scale);
  double below = bottom.fixed ? bottom.kelvin : history[n - 1] + scale * (grid_.source[n - 1] + bottom.constant);
  right_[n - 1] = below;
  for (size_t i = n - 1; i-- > 0;) right_[i] = below = history[i] + scale * grid_.source[i] - up_[i] * below;
  double T = s.T[0];
  if (top.fixed) {
    T = top.kelvin;
  } else {
    // Increasing and convex for T > 0: Newton's method converges from any positive start.
    double change = INFINITY;
    for (int k = 0; k < 60 && std::fabs(change) > 1e-13 * T; ++k) {
      change = (right_[0] + scale * top.flux(T) - top_diagonal_ * T) / (top_diagonal_ - scale * top.slope(T));
      T = std::fmax(T + change, 0.1 * T);
    }
  }
  s.T[0] = T;
  for (size_t i = 1; i < n; ++i) s.T[i] = T = pivot_[i] * right_[i] - down_[i] * T;
  evaluate(s, top, bottom);
  return true;
}

// Derivatives of heat(T) - scale * gain(T); of the flux through an interval by its upper temperature k(T)/h there.
void Slab::set_newton_matrix(const Stage& s, double scale, const FaceNow& top, const FaceNow& bottom) {
  const size_t n = s.T.size();
  const double* T = s.T.data();
  const std::vector<double>*h = grid_.heat.data(), *k = grid_.conductance.data();
  const double *h0 = h[0].data(), *h1 = h[1].data(), *h2 = h[2].data(), *h3 = h[3].data(), *h4 = h[4].data();
  const double *k0 = k[0].data(), *k1 = k[1].data(), *k2 = k[2].data(), *k3 = k[3].data();
  double *lower = lower_.data(), *diagonal = diagonal_.data(), *upper = upper_.data();
#pragma GCC ivdep
  for (size_t i = 0; i < n; ++i)
    diagonal[i] = h0[i] + T[i] * (2 * h1[i] + T[i] * (3 * h2[i] + T[i] * (4 * h3[i] + T[i] * 5 * h4[i])));
#pragma GCC ivdep
  for (size_t j = 0; j < n - 1; ++j) {
    const double a = T[j], b = T[j + 1];
    upper[j] = -scale * (k0[j] + b * (k1[j] + b * (k2[j] + b * k3[j])));
    lower[j + 1] = -scale * (k0[j] + a * (k1[j] + a * (k2[j] + a * k3[j])));
  }
  lower[0] = upper[n - 1] = 0;
  for (size_t j = 0; j < n - 1; ++j) {
    diagonal[j] -= lower[j + 1];
    diagonal[j + 1] -= upper[j];
  }
  if (top.fixed)
    diagonal[0] = 1, upper[0] = 0;
  else
    diagonal[0] -= scale * top.slope(T[0]);
  if (bottom.fixed)
    diagonal[n - 1] = 1, lower[n - 1] = 0;
  else
    diagonal[n - 1] -= scale * bottom.slope(T[n - 1]);
}

// Properties that depend on temperature, or two radiating faces: Newton's method on all nodes from the guess in s.T. An
// elimination is kept, over stages and steps, as long as it makes the change shrink fiftyfold at each turn.
bool Slab::solve_newton(std::span<const double> history, double scale, const FaceNow& top, const FaceNow& bottom,
                        Stage& s) {
  const size_t n = T_.size();
  constexpr double kShrinks = 0.02, kEnough = 1e-10;  // K
  bool renew = factored_for_ != scale, done = false;
  double last = INFINITY;
  for (int k = 0; k < 40; ++k) {
    evaluate(s, top, bottom);
    if (done) return true;
    for (size_t i = 0; i < n; ++i) right_[i] = history[i] + scale * s.gain[i] - s.heat[i];
    if (top.fixed) right_[0] = top.kelvin - s.T[0];
    if (bottom.fixed) right_[n - 1] = bottom.kelvin - s.T[n - 1];
    if (renew) {
      set_newton_matrix(s, scale, top, bottom);
      top_diagonal_ = eliminate(lower_, diagonal_, upper_, pivot_, up_, down_);
      factored_for_ = scale;
      ++counters_.eliminations;
    }
    for (size_t i = n - 1; i-- > 0;) right_[i] -= up_[i] * right_[i + 1];
    double change = right_[0] / top_diagonal_, largest = 0, coldest = kHottest, hottest = 0;
    for (size_t i = 0; i < n; ++i) {
      if (i > 0) change = pivot_[i] * right_[i] - down_[i] * change;
      largest = std::fabs(change) > largest ? std::fabs(change) : largest;  // fmax would be a call a node
      const double T = s.T[i] += change;
      coldest = T < coldest ? T : coldest;
      hottest = T > hottest ? T : hottest;
    }
    if (!(coldest > 0 && hottest < kHottest && std::isfinite(change))) break;
    // The next change would be smaller by the same ratio: stop when that is too little to matter. The heat it leaves
    // out of place is carried over by accept().
    const double ratio = largest / last;
    done = largest < kEnough || (k > 0 && largest * ratio < kEnough);
    if (k > 10 && renew && ratio >= 1) break;
    renew = k == 0 ? false : ratio > kShrinks;
    if (k == 0 && largest > 1) renew = true;
    last = largest;
  }
  factored_for_ = -1;
  return false;
}

bool Slab::solve(std::span<const double> history, double scale, double t, Stage& s) {
  const FaceNow top = face_at(spec_.top, t), bottom = face_at(spec_.bottom, t);
  if (!linear_) return solve_newton(history, scale, top, bottom, s);
  return solve_linear(history, scale, top, bottom, s) && s.T[0] > 0 && s.T[0] < kHottest && s.T.back() > 0;
}

// The difference to the embedded result, through the stage's own matrix so that stiff nodes do not exaggerate it.
double Slab::filtered_error(double dt, double t_end) {
  const size_t n = T_.size();
  const FaceNow top = face_at(spec_.top, t_end), bottom = face_at(spec_.bottom, t_end);
  for (size_t i = 0; i < n; ++i)
    right_[i] = dt * (kError1 * now_.gain[i] + kError2 * middle_.gain[i] + kError3 * end_.gain[i]);
  if (bottom.fixed) right_[n - 1] = 0;
  for (size_t i = n - 1; i-- > 0;) right_[i] -= up_[i] * right_[i + 1];
  const double slope = linear_ ? kD * dt * top.slope(end_.T[0]) : 0;  // Newton's matrix has it already
  double e = top.fixed ? 0 : right_[0] / (top_diagonal_ - slope), largest = std::fabs(e);
  for (size_t i = 1; i < n; ++i) {
    e = pivot_[i] * right_[i] - down_[i] * e;
    largest = std::fabs(e) > largest ? std::fabs(e) : largest;
  }
  return std::isfinite(e) ? largest : e;  // what is not finite stays so to the last node
}

// Newton's starts: the parabola through the last step goes on to the middle; the end continues from there.
void Slab::guess_middle(double dt) {
  middle_.T = now_.T;
  if (linear_ || !(last_step_ > 0) || dt > 2 * last_step_) return;
  const double ahead = kGamma * dt;
  for (size_t i = 0; i < now_.T.size(); ++i) {
    const double change = ahead * (rate_[i] + ahead * bend_[i]);
    middle_.T[i] += std::fabs(change) < 0.1 * now_.T[i] ? change : 0;
  }
}

void Slab::guess_end(double dt) {
  // On the parabola's bend when there is one, else straight on through now and the middle; never far.
  const bool curved = !linear_ && last_step_ > 0 && dt <= 2 * last_step_;
  for (size_t i = 0; i < now_.T.size(); ++i) {
    const double slope = (middle_.T[i] - now_.T[i]) / (kGamma * dt), rest = (1 - kGamma) * dt;
    const double change = rest * (slope + (curved ? dt * bend_[i] : 0));
    end_.T[i] = middle_.T[i] + (std::fabs(change) < 0.1 * middle_.T[i] ? change : 0);
  }
}

bool Slab::attempt(double dt, double& error) {
  const size_t n = T_.size();
  const double scale = kD * dt;
  now_.T = T_;
  const FaceNow top = face_at(spec_.top, t_), bottom = face_at(spec_.bottom, t_);
  if (top.fixed) now_.T[0] = top.kelvin;
  if (bottom.fixed) now_.T[n - 1] = bottom.kelvin;
  evaluate(now_, top, bottom);
  now_.heat = heat_;
  // The middle stage: trapezoidal rule over gamma dt.
  for (size_t i = 0; i < n; ++i) history_[i] = now_.heat[i] + scale * now_.gain[i];
  guess_middle(dt);
  if (!solve(history_, scale, t_ + kGamma * dt, middle_)) return false;
  // The end: backward differences over both.
  for (size_t i = 0; i < n; ++i) history_[i] = now_.heat[i] + kW * dt * (now_.gain[i] + middle_.gain[i]);
  guess_end(dt);
  if (!solve(history_, scale, t_ + dt, end_)) return false;
  error = filtered_error(dt, t_ + dt);
  return std::isfinite(error);
}

void Slab::accept(double dt) {
  for (size_t j = 0; j < flux_sum_.size(); ++j)
    flux_sum_[j] += dt * (kW * (now_.flux[j] + middle_.flux[j]) + kD * end_.flux[j]);
  sum_time_ += dt;
  // The heat that flowed, not the heat of the temperatures found: what the iteration left over is made up for by the
  // next step, so that nothing is ever lost or gained.
  for (size_t i = 0; i < heat_.size(); ++i)
    heat_[i] += dt * (kW * (now_.gain[i] + middle_.gain[i]) + kD * end_.gain[i]);
  if (spec_.top.kind == SlabFace::Kind::temperature) heat_.front() = end_.heat.front();
  if (spec_.bottom.kind == SlabFace::Kind::temperature) heat_.back() = end_.heat.back();
  if (!linear_)
    for (size_t i = 0; i < T_.size(); ++i) {
      const double first = (middle_.T[i] - now_.T[i]) / (kGamma * dt);
      const double second = (end_.T[i] - middle_.T[i]) / ((1 - kGamma) * dt);
      bend_[i] = (second - first) / dt;
      rate_[i] = second + bend_[i] * (1 - kGamma) * dt;
    }
  last_step_ = dt;
  T_ = end_.T;
  t_ += dt;
  ++counters_.steps;
  if (recording_) recorded_.push_back(dt);
}

bool Slab::step(double dt, double* estimate) {
  SUITE_CHECK(dt > 0 && T_.front() > 0);
  double error = 0;
  if (!attempt(dt, error)) return false;
  accept(dt);
  if (estimate) *estimate = error;
  return true;
}

void Slab::advance(double t) {
  SUITE_CHECK(T_.front() > 0);  // started
  if (!(t >= t_)) throw Error(strf("a slab at %.9g s is asked to go to %.9g s", t_, t), "times ascend");
  next_step_ = advance_by_error(
      t_, t, next_step_, {options_.tolerance, options_.max_step, options_.min_step, options_.most_steps},
      [this](double dt) {
        double error = 0;
        return attempt(dt, error) ? error : INFINITY;
      },
      [this](double dt) { accept(dt); }, [this] { ++counters_.rejected; });
}

}  // namespace suite
