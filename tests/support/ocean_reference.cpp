#include "support/ocean_reference.h"

#include "optics/fresnel.h"

namespace suite::test {

namespace {
constexpr double kBeamWeight = 1e-7;

// Points and weights of Gauss and Legendre on [-1, 1] by Newton's steps.
std::vector<std::pair<double, double>> legendre(int n) {
  std::vector<std::pair<double, double>> rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 50; ++step) {
      double before = 1, p = x;
      for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p, p = next;
      }
      slope = n * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    rule.push_back({x, 2 / ((1 - x * x) * slope * slope)});
  }
  return rule;
}

// Mean over azimuth of the phase function between two cosines of travel: panels that double in width from the plane of
// both, where a peak may be.
double mean_over_azimuth(const std::function<double(double)>& phase, double a, double b) {
  static const auto rule = legendre(8);
  const double s = std::sqrt(std::max(0.0, (1 - a * a) * (1 - b * b)));
  if (s < 1e-12) return phase(std::clamp(a * b, -1.0, 1.0));
  double sum = 0, low = 0;
  for (double high = kPi / 4096; low < kPi - 1e-9; low = high, high = std::min(kPi, 2 * high))
    for (const auto& [x, w] : rule) {
      const double phi = 0.5 * (low + high) + 0.5 * (high - low) * x, half = std::sin(0.5 * phi);
      sum += 0.5 * (high - low) * w * phase(std::clamp(a * b + s - 2 * s * half * half, -1.0, 1.0));
    }
  return sum / kPi;
}
}  // namespace

OceanReference::OceanReference(const std::function<double(double)>& phase, double albedo, double index, double mu_sun,
                               int nodes)
    : index_(index) {
  const double critical = std::sqrt(1 - 1 / (index * index));
  gauss(0, critical, nodes);
  gauss(critical, 1, 2 * nodes);
  const Fresnel entry = fresnel_dielectric(mu_sun, index);
  transmitted_ = entry.transmittance, mu_beam_ = entry.cos_transmitted;
  mu_.push_back(mu_beam_), weight_.push_back(kBeamWeight);
  mu_.push_back(1), weight_.push_back(0);
  n_ = mu_.size();
  for (const double mu : mu_) surface_.push_back(fresnel_dielectric(mu, 1 / index).reflectance);
  scatter(phase, albedo);
  half_space_ = doubled(thin(std::ldexp(1.0, -22)), 22 + 7);  // 128 depths
}

void OceanReference::gauss(double low, double high, int count) {
  for (const auto& [x, w] : legendre(count))
    mu_.push_back(0.5 * (low + high) + 0.5 * (high - low) * x), weight_.push_back(0.5 * (high - low) * w);
}

void OceanReference::scatter(const std::function<double(double)>& phase, double albedo) {
  same_.assign(n_ * n_, 0), turned_ = same_;
  for (size_t i = 0; i < n_; ++i) {
    double sum = 0;
    for (size_t j = 0; j < n_; ++j) {
      // The diagonal of a peaked function is what the row misses.
      if (i != j) same_[i * n_ + j] = 2 * kPi * mean_over_azimuth(phase, mu_[i], mu_[j]) * weight_[j];
      turned_[i * n_ + j] = 2 * kPi * mean_over_azimuth(phase, mu_[i], -mu_[j]) * weight_[j];
      sum += same_[i * n_ + j] + turned_[i * n_ + j];
    }
    same_[i * n_ + i] = 1 - sum;
  }
  for (double& x : same_) x *= albedo;
  for (double& x : turned_) x *= albedo;
}

OceanReference::Slab OceanReference::thin(double depth) const {
  Slab s{turned_, same_};
  for (size_t i = 0; i < n_; ++i)
    for (size_t j = 0; j < n_; ++j) {
      s.r[i * n_ + j] *= depth / mu_[i];
      s.t[i * n_ + j] = (i == j ? 1 : 0) + depth / mu_[i] * (same_[i * n_ + j] - (i == j ? 1 : 0));
    }
  return s;
}

// a above b. Light between them: (1 - r_a r_b)^-1.
OceanReference::Pile OceanReference::joined(const Pile& a, const Pile& b) const {
  const Matrix between = solved(unit_less(product(a.from_below, b.from_above)), a.down);
  const Matrix between_up = solved(unit_less(product(b.from_above, a.from_below)), b.up);
  Pile p{a.from_above, product(b.down, between), b.from_below, product(a.up, between_up)};
  const Matrix back = product(a.up, product(b.from_above, between)),
               back_up = product(b.down, product(a.from_below, between_up));
  for (size_t k = 0; k < back.size(); ++k) p.from_above[k] += back[k], p.from_below[k] += back_up[k];
  return p;
}

OceanReference::Pile OceanReference::pile(const std::vector<Layer>& layers) const {
  Pile all;
  for (const Layer& l : layers) {
    const Slab s = std::isinf(l.depth) ? l.water->half_space_ : l.water->layer(l.depth);
    const Pile one{s.r, s.t, s.r, s.t};
    all = all.down.empty() ? one : joined(all, one);
  }
  return all;
}

OceanReference::Slab OceanReference::doubled(const Slab& s, int times) const {
  Slab d = s;
  for (int k = 0; k < times; ++k) {
    const Matrix between = solved(unit_less(product(d.r, d.r)), d.t);
    const Matrix back = product(d.t, product(d.r, between));
    d.t = product(d.t, between);
    for (size_t i = 0; i < back.size(); ++i) d.r[i] += back[i];
  }
  return d;
}

OceanReference::Slab OceanReference::layer(double depth) const {
  if (depth == 0) return {Matrix(n_ * n_, 0), unit_less(Matrix(n_ * n_, 0))};
  int times = 0;
  while (depth > std::ldexp(1.0, times - 22)) ++times;
  return doubled(thin(std::ldexp(depth, -times)), times);
}

OceanReference::Matrix OceanReference::product(const Matrix& a, const Matrix& b) const {
  Matrix c(n_ * n_, 0);
  for (size_t i = 0; i < n_; ++i)
    for (size_t k = 0; k < n_; ++k)
      for (size_t j = 0; j < n_; ++j) c[i * n_ + j] += a[i * n_ + k] * b[k * n_ + j];
  return c;
}

OceanReference::Matrix OceanReference::unit_less(Matrix a) const {
  for (double& x : a) x = -x;
  for (size_t i = 0; i < n_; ++i) a[i * n_ + i] += 1;
  return a;
}

OceanReference::Matrix OceanReference::solved(Matrix a, Matrix b) const {
  for (size_t k = 0; k < n_; ++k) {
    size_t best = k;
    for (size_t i = k + 1; i < n_; ++i)
      if (std::fabs(a[i * n_ + k]) > std::fabs(a[best * n_ + k])) best = i;
    for (size_t j = 0; j < n_; ++j)
      std::swap(a[k * n_ + j], a[best * n_ + j]), std::swap(b[k * n_ + j], b[best * n_ + j]);
    for (size_t i = 0; i < n_; ++i) {
      if (i == k) continue;
      const double factor = a[i * n_ + k] / a[k * n_ + k];
      if (factor == 0) continue;
      for (size_t j = k; j < n_; ++j) a[i * n_ + j] -= factor * a[k * n_ + j];
      for (size_t j = 0; j < n_; ++j) b[i * n_ + j] -= factor * b[k * n_ + j];
    }
  }
  for (size_t i = 0; i < n_; ++i)
    for (size_t j = 0; j < n_; ++j) b[i * n_ + j] /= a[i * n_ + i];
  return b;
}

OceanLight OceanReference::layered(bool sun, const std::vector<Layer>& above, const std::vector<Layer>& below) {
  const OceanReference& top = *above[0].water;
  const size_t n = top.n_;
  Matrix source(n * n, 0);
  if (sun) source[(n - 2) * n] = top.transmitted_ / (2 * kPi * top.mu_beam_ * kBeamWeight);
  for (size_t i = 0; i < n && !sun; ++i) source[i * n] = top.index_ * top.index_ * (1 - top.surface_[i]);
  return top.light(std::move(source), top.pile(above), top.pile(below));
}

// source: what enters from above, in the first column.
OceanLight OceanReference::light(Matrix source, const Pile& above, const Pile& below) const {
  const Matrix& deep = below.from_above;
  // Just under the surface: that, and what the surface sends back of what all of the water does.
  Matrix returned = joined(above, below).from_above;
  for (size_t i = 0; i < n_; ++i)
    for (size_t j = 0; j < n_; ++j) returned[i * n_ + j] *= surface_[i];
  const Matrix entered = solved(unit_less(returned), std::move(source));
  const Matrix down = solved(unit_less(product(above.from_below, deep)), product(above.down, entered)),
               up = product(deep, down);
  OceanLight sum;
  for (size_t i = 0; i < n_; ++i) {
    sum.down += 2 * kPi * weight_[i] * mu_[i] * down[i * n_];
    sum.up += 2 * kPi * weight_[i] * mu_[i] * up[i * n_];
    sum.up_scalar += 2 * kPi * weight_[i] * up[i * n_];
  }
  sum.nadir = up[(n_ - 1) * n_];
  return sum;
}

}  // namespace suite::test
