#include "sqt_fit/mueller_fit.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "math/coherency.h"

namespace suite::sqt {

namespace {

constexpr size_t kElements = MuellerTable::kElements;
constexpr double kImpossible = -1e-3;  // eigenvalues below are no rounding
// Whole numbers move an eigenvalue by at most 15 half units over 4; matrices of pure states leave that much room.
constexpr double kRoom = 15 * 0.5 / MuellerTable::kUnit / 4;

enum Axis { kThetaH, kThetaD, kPhiD };

// The data over m11, made possible: [node][wavelength][element].
struct Shapes {
  std::vector<float> of;
  size_t row = 0;  // of a node
  double changed = 0, most_changed = 0;
};

Mueller over_m11(const float* m) {
  Mueller r = Mueller::depolariser();
  if (!(m[0] > 0)) return r;
  for (size_t e = 1; e <= kElements; ++e) r.m[e] = static_cast<double>(m[e]) / static_cast<double>(m[0]);
  return r;
}

// Towards the ideal depolariser, whose eigenvalues are all 1/4, until none is below the room.
Mueller with_room(const Mueller& m) {
  if (coherency_exceeds(m, kRoom)) return m;
  const double least = least_coherency(m);
  const double share = (kRoom - least) / (0.25 - least);
  return m * (1 - share) + Mueller::depolariser() * share;
}

double rms_between(const Mueller& a, const Mueller& b) {
  double sum = 0;
  for (size_t e = 1; e <= kElements; ++e) sum += (a.m[e] - b.m[e]) * (a.m[e] - b.m[e]);
  return std::sqrt(sum / kElements);
}

Shapes shapes_of(const MuellerBrdf::Data& data) {
  const size_t matrices = data.values.size() / MuellerBrdf::kMatrix;
  Shapes s;
  s.row = data.wavelength_um.size() * kElements;
  s.of.resize(matrices * kElements);
  constexpr size_t kBlock = 4096;
  const size_t blocks = (matrices + kBlock - 1) / kBlock;
  std::vector<size_t> changed(blocks);
  std::vector<double> most(blocks);
  parallel_for(0, blocks, 1, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b)
      for (size_t i = b * kBlock; i < std::min(matrices, (b + 1) * kBlock); ++i) {
        const Mueller raw = over_m11(&data.values[i * MuellerBrdf::kMatrix]), m = physical(raw);
        if (!coherency_exceeds(raw, kImpossible)) {
          ++changed[b];
          most[b] = std::max(most[b], rms_between(raw, m));
        }
        for (size_t e = 1; e <= kElements; ++e) s.of[i * kElements + e - 1] = static_cast<float>(m.m[e]);
      }
  });
  for (size_t b = 0; b < blocks; ++b)
    s.changed += static_cast<double>(changed[b]), s.most_changed = std::max(s.most_changed, most[b]);
  s.changed /= static_cast<double>(matrices);
  return s;
}

// What a node of the data counts for: solid angles of both directions times their cosines; 0 at and below the horizon.
// A single angle stands for all: of phi_d, whose others may have both directions above the horizon, and of theta_h.
std::vector<double> node_weights(const HalfGrid& grid) {
  const auto steps = [](const std::vector<double>& a) {
    std::vector<double> d(a.size(), 1);
    for (size_t i = 0; i < a.size() && a.size() > 1; ++i)
      d[i] = (a[std::min(i + 1, a.size() - 1)] - a[i ? i - 1 : 0]) / 2;
    return d;
  };
  const std::vector<double> dh = steps(grid.theta_h), dd = steps(grid.theta_d);
  std::vector<double> weight(grid.nodes());
  const int azimuths = grid.phi_d.size() == 1 ? 16 : 1;
  for (size_t n = 0; n < weight.size(); ++n) {
    HalfAngles a = grid.angles(n);
    double cosines = 0;
    for (int i = 0; i < azimuths; ++i, a.phi_d += 2 * kPi / azimuths) {
      Dir out, in;
      a.directions(out, in);
      if (out.z > 1e-12 && in.z > 1e-12) cosines += out.z * in.z / azimuths;  // above by more than rounding
    }
    const double around = grid.theta_h.size() > 1 ? std::sin(a.theta_h) : 1;
    // The half vector's map to `in` has the Jacobian 4 cos theta_d.
    weight[n] = cosines * around * dh[n % dh.size()] * 4 * std::cos(a.theta_d) * std::sin(a.theta_d) *
                dd[n / dh.size() % dd.size()];
  }
  return weight;
}

// Chooses nodes along one axis: the ends, then always the one in the interval with the largest error of linear
// interpolation along that axis, over lines of the data.
class Thinning {
 public:
  Thinning(const HalfGrid& grid, const Shapes& shapes, const std::vector<double>& weights, Axis axis)
      : grid_(grid), shapes_(shapes), weights_(weights), axis_(axis), angle_(axis_of(grid)) {
    constexpr size_t kLines = 3000;
    const size_t lines = grid.nodes() / angle_.size(), step = std::max<size_t>(1, lines / kLines);
    for (size_t line = step / 2; line < lines; line += step) lines_.push_back(first_of(line));
    for (const size_t first : lines_)
      for (size_t i = 0; i < angle_.size(); ++i) total_ += weights_[first + i * stride()];
    chosen_ = angle_.size() == 1 ? std::vector<size_t>{0} : std::vector<size_t>{0, angle_.size() - 1};
    errors_.clear();
    for (size_t k = 0; k + 1 < chosen_.size(); ++k) errors_.push_back(error_between(chosen_[k], chosen_[k + 1]));
  }
  // Mean square of the elements' errors.
  double error() const {
    double sum = 0;
    for (const double e : errors_) sum += e;
    return total_ > 0 ? sum / total_ : 0;
  }
  bool whole() const { return chosen_.size() == angle_.size(); }
  void refine() {
    size_t worst = errors_.size();
    for (size_t k = 0; k < errors_.size(); ++k)
      if (chosen_[k + 1] - chosen_[k] > 1 && (worst == errors_.size() || errors_[k] > errors_[worst])) worst = k;
    if (worst == errors_.size()) return;
    const size_t low = chosen_[worst], high = chosen_[worst + 1];
    // The node that leaves least, among a few.
    size_t best = (low + high) / 2;
    double least = -1, below = 0, beyond = 0;
    for (size_t tries = 1; tries <= 7; ++tries) {
      const size_t middle = low + (high - low) * tries / 8;
      if (middle == low || middle == high) continue;
      const double a = error_between(low, middle), b = error_between(middle, high);
      if (least < 0 || a + b < least) best = middle, least = a + b, below = a, beyond = b;
    }
    if (least < 0) below = error_between(low, best), beyond = error_between(best, high);
    errors_[worst] = below;
    errors_.insert(errors_.begin() + static_cast<ptrdiff_t>(worst) + 1, beyond);
    chosen_.insert(chosen_.begin() + static_cast<ptrdiff_t>(worst) + 1, best);
  }
  const std::vector<size_t>& chosen() const { return chosen_; }

 private:
  const std::vector<double>& axis_of(const HalfGrid& g) const {
    return axis_ == kThetaH ? g.theta_h : axis_ == kThetaD ? g.theta_d : g.phi_d;
  }
  size_t stride() const {
    return axis_ == kThetaH ? 1 : axis_ == kThetaD ? grid_.theta_h.size() : grid_.theta_h.size() * grid_.theta_d.size();
  }
  // The node of a line at the axis' first angle.
  size_t first_of(size_t line) const { return line / stride() * stride() * angle_.size() + line % stride(); }
  double error_between(size_t low, size_t high) const {
    double sum = 0;
    for (const size_t first : lines_) {
      const float* const a = &shapes_.of[(first + low * stride()) * shapes_.row];
      const float* const b = &shapes_.of[(first + high * stride()) * shapes_.row];
      for (size_t i = low + 1; i < high; ++i) {
        const size_t node = first + i * stride();
        if (!(weights_[node] > 0)) continue;
        const float t = static_cast<float>((angle_[i] - angle_[low]) / (angle_[high] - angle_[low]));
        const float* const x = &shapes_.of[node * shapes_.row];
        float square = 0;
        for (size_t e = 0; e < shapes_.row; ++e) {
          const float d = (1 - t) * a[e] + t * b[e] - x[e];
          square += d * d;
        }
        sum += weights_[node] * static_cast<double>(square) / static_cast<double>(shapes_.row);
      }
    }
    return sum;
  }
  const HalfGrid& grid_;
  const Shapes& shapes_;
  const std::vector<double>& weights_;
  Axis axis_;
  const std::vector<double>& angle_;
  std::vector<size_t> lines_, chosen_;
  std::vector<double> errors_;  // of the intervals between chosen nodes
  double total_ = 0;
};

MuellerTable::Data tabulated(const MuellerBrdf::Data& data, const Shapes& shapes, const std::vector<size_t>& h,
                             const std::vector<size_t>& d, const std::vector<size_t>& p) {
  MuellerTable::Data t;
  for (const size_t i : h) t.grid.theta_h.push_back(data.grid.theta_h[i]);
  for (const size_t i : d) t.grid.theta_d.push_back(data.grid.theta_d[i]);
  for (const size_t i : p) t.grid.phi_d.push_back(data.grid.phi_d[i]);
  t.wavelength_um = data.wavelength_um;
  for (const size_t ip : p)
    for (const size_t id : d)
      for (const size_t ih : h) {
        const float* of = &shapes.of[data.grid.node(ip, id, ih) * shapes.row];
        for (size_t w = 0; w < data.wavelength_um.size(); ++w, of += kElements) {
          Mueller m = Mueller::depolariser();
          for (size_t e = 1; e <= kElements; ++e) m.m[e] = static_cast<double>(of[e - 1]);
          m = with_room(m);
          for (size_t e = 1; e <= kElements; ++e)
            t.elements.push_back(
                static_cast<int16_t>(std::lround(std::clamp(m.m[e], -1.0, 1.0) * MuellerTable::kUnit)));
        }
      }
  return t;
}

MuellerErrors errors_of(const MuellerBrdf::Data& data, const Shapes& shapes, const std::vector<double>& weights,
                        const MuellerTable& table) {
  MuellerErrors errors;
  double sum = 0, lit_sum = 0;
  const size_t channels = data.wavelength_um.size();
  std::vector<Mueller> m(channels);
  for (size_t n = 0; n < weights.size(); ++n) {
    if (!(weights[n] > 0)) continue;
    Dir out, in;
    data.grid.angles(n).directions(out, in);
    table.at(out, in, m);
    for (size_t w = 0; w < channels; ++w) {
      double square = 0;
      for (size_t e = 1; e <= kElements; ++e) {
        const double off = m[w].m[e] - static_cast<double>(shapes.of[n * shapes.row + w * kElements + e - 1]);
        square += off * off;
        errors.largest = std::max(errors.largest, std::fabs(off));
      }
      const double light = static_cast<double>(data.values[(n * channels + w) * MuellerBrdf::kMatrix]);
      errors.rms += weights[n] * square / kElements, sum += weights[n];
      errors.lit += weights[n] * light * square / kElements, lit_sum += weights[n] * light;
    }
  }
  errors.rms = std::sqrt(errors.rms / std::max(sum, 1e-300));
  errors.lit = std::sqrt(errors.lit / std::max(lit_sum, 1e-300));
  return errors;
}

// One more angle along the axis with the largest error, unless the errors of all add to no more than `aim` (their
// square), or all angles are there.
bool refine_worst(std::span<Thinning> axes, double aim) {
  Thinning* worst = nullptr;
  double sum = 0;
  for (Thinning& a : axes) {
    sum += a.error();
    if (!a.whole() && (!worst || a.error() > worst->error())) worst = &a;
  }
  if (!worst || sum <= aim) return false;
  worst->refine();
  return true;
}

}  // namespace

MuellerFit fit_mueller(const MuellerBrdf& brdf, double rms_error) {
  const MuellerBrdf::Data& data = brdf.data();
  const Shapes shapes = shapes_of(data);
  const std::vector<double> weights = node_weights(data.grid);
  Thinning axes[] = {{data.grid, shapes, weights, kThetaH},
                     {data.grid, shapes, weights, kThetaD},
                     {data.grid, shapes, weights, kPhiD}};
  MuellerFit fit;
  fit.changed = shapes.changed, fit.most_changed = shapes.most_changed;
  // Errors along the axes add; where they fall together the whole is measured, and more is asked for.
  for (double aim = rms_error * rms_error;; aim /= 4) {
    while (refine_worst(axes, aim)) {
    }
    fit.table = std::make_shared<const MuellerTable>(
        tabulated(data, shapes, axes[0].chosen(), axes[1].chosen(), axes[2].chosen()));
    fit.errors = errors_of(data, shapes, weights, *fit.table);
    if (fit.errors.rms <= rms_error || !refine_worst(axes, -1)) return fit;
  }
}

}  // namespace suite::sqt
