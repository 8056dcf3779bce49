#include "spectral/curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spectral/wavelength.h"

namespace suite {

const char* to_text(Outside rule) {
  switch (rule) {
    case Outside::error:
      return "error";
    case Outside::hold:
      return "hold";
    case Outside::zero:
      return "zero";
  }
  return "?";
}

Curve::Curve(std::vector<double> x, std::vector<double> y, Outside outside, const Where& where)
    : x_(std::move(x)), y_(std::move(y)), outside_(outside) {
  if (x_.empty() || x_.size() != y_.size())
    throw Error(where, strf("a curve needs as many values as wavelengths and at least one, found %zu and %zu",
                            y_.size(), x_.size()));
  if (x_.size() > 1 && x_.front() > x_.back()) {
    std::reverse(x_.begin(), x_.end());
    std::reverse(y_.begin(), y_.end());
  }
  for (size_t i = 0; i < x_.size(); ++i) {
    if (!std::isfinite(x_[i]) || !(x_[i] > 0))
      throw Error(where, strf("wavelength %g um is not positive and finite", x_[i]));
    if (!std::isfinite(y_[i])) throw Error(where, strf("the value at %g um is not finite", x_[i]));
    if (i && !(x_[i] > x_[i - 1]))
      throw Error(where, strf("wavelengths are not monotonic: %g um follows %g um", x_[i], x_[i - 1]),
                  "sort them and give each once");
  }
  cumulative_.assign(x_.size(), 0);
  for (size_t i = 1; i < x_.size(); ++i)
    cumulative_[i] = cumulative_[i - 1] + 0.5 * (y_[i] + y_[i - 1]) * (x_[i] - x_[i - 1]);
}

Curve Curve::constant(double value) {
  Curve c({1.0}, {value}, Outside::hold);
  c.constant_ = true;
  return c;
}

double Curve::low_um() const { return constant_ ? 0 : x_.front(); }
double Curve::high_um() const { return constant_ ? std::numeric_limits<double>::infinity() : x_.back(); }
double Curve::min() const { return *std::min_element(y_.begin(), y_.end()); }
double Curve::max() const { return *std::max_element(y_.begin(), y_.end()); }

std::string Curve::range_text() const { return wavelengths_text(x_.front(), x_.back()); }

bool Curve::covers(double low, double high) const {
  // An ulp of slack: window edges are often computed from band centres and widths.
  return outside_ != Outside::error || (low >= low_um() * (1 - 1e-9) && high <= high_um() * (1 + 1e-9));
}

double Curve::at(double w) const {
  if (w < x_.front() || w > x_.back()) {
    if (!covers(w, w))
      throw Error("a curve from " + range_text() + strf(" was asked at %g um", w),
                  "declare 'outside: hold' or 'zero', or give a longer curve");
    if (outside_ == Outside::zero) return 0;
    return w < x_.front() ? y_.front() : y_.back();
  }
  const size_t i = static_cast<size_t>(std::upper_bound(x_.begin(), x_.end(), w) - x_.begin());
  if (i == x_.size()) return y_.back();
  const double t = (w - x_[i - 1]) / (x_[i] - x_[i - 1]);
  return y_[i - 1] + t * (y_[i] - y_[i - 1]);
}

double Curve::primitive(double w) const {
  if (w <= x_.front()) return outside_ == Outside::zero ? 0 : (w - x_.front()) * y_.front();
  if (w >= x_.back()) return cumulative_.back() + (outside_ == Outside::zero ? 0 : (w - x_.back()) * y_.back());
  const size_t i = static_cast<size_t>(std::upper_bound(x_.begin(), x_.end(), w) - x_.begin());
  const double dx = w - x_[i - 1], slope = (y_[i] - y_[i - 1]) / (x_[i] - x_[i - 1]);
  return cumulative_[i - 1] + dx * (y_[i - 1] + 0.5 * slope * dx);
}

double Curve::integral(double low, double high) const {
  if (!covers(low, high))
    throw Error("a curve from " + range_text() + strf(" was asked from %g to %g um", low, high),
                "declare 'outside: hold' or 'zero', or give a longer curve");
  return primitive(high) - primitive(low);
}

double Curve::mean(double low, double high) const {
  // Differences of primitives lose digits for slivers; there the midpoint value is the better average.
  if (high - low <= 1e-7 * high) {
    const double middle = 0.5 * (low + high);
    return at(outside_ == Outside::error ? std::clamp(middle, x_.front(), x_.back()) : middle);
  }
  return integral(low, high) / (high - low);
}

Curve Curve::scaled(double factor) const {
  Curve c = *this;
  for (double& v : c.y_) v *= factor;
  for (double& v : c.cumulative_) v *= factor;
  return c;
}
Curve Curve::with_outside(Outside rule) const {
  Curve c = *this;
  c.outside_ = rule;
  return c;
}

}  // namespace suite
