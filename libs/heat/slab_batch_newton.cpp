// The stages of a batch whose properties depend on temperature: Newton's method on all nodes, an elimination an element
// and turn, all in the machine's vectors. The stages are written in the stored heat, as those of Slab.
#include <algorithm>
#include <cmath>

#include "heat/slab_batch.h"
#include "thermal/tr_bdf2.h"

namespace suite {

using namespace tr_bdf2;

// Stored heat (J/m2) and gain (W/m2) of the nodes at temperatures.
void SlabBatch::evaluate(const Lanes* kelvin, const Faces& faces, Lanes* heat, Lanes* gain) const {
  const size_t n = nodes();
  const auto& h = grid_.heat;
  const auto& k = grid_.conductance;
  const auto flux = [](const Faces::One& face, const Lanes& at, size_t v) {
    const Four T = at.v[v];
    return face.constant.v[v] - T * (face.linear.v[v] + face.quartic.v[v] * T * T * T);
  };
  Lanes above;
  for (size_t v = 0; v < kVectors; ++v) above.v[v] = flux(faces.top, kelvin[0], v);
  for (size_t i = 0; i + 1 < n; ++i) {
    const double k0 = k[0][i], k1 = k[1][i] / 2, k2 = k[2][i] / 3, k3 = k[3][i] / 4;
    for (size_t v = 0; v < kVectors; ++v) {
      // The mean of k over both temperatures, as symmetric polynomials, so that nothing cancels when they are close.
      const Four a = kelvin[i].v[v], b = kelvin[i + 1].v[v], sum = a + b, squares = a * a + b * b;
      const Four below = (k0 + k1 * sum + k2 * (squares + a * b) + k3 * sum * squares) * (a - b);
      gain[i].v[v] = grid_.source[i] + above.v[v] - below;
      above.v[v] = below;
    }
  }
  for (size_t v = 0; v < kVectors; ++v)
    gain[n - 1].v[v] = grid_.source[n - 1] + above.v[v] + flux(faces.bottom, kelvin[n - 1], v);
  for (size_t i = 0; i < n; ++i) {
    const double h0 = h[0][i], h1 = h[1][i], h2 = h[2][i], h3 = h[3][i], h4 = h[4][i];
    for (size_t v = 0; v < kVectors; ++v) {
      const Four T = kelvin[i].v[v];
      heat[i].v[v] = T * (h0 + T * (h1 + T * (h2 + T * (h3 + T * h4))));
    }
  }
}

// The matrix of Newton's method at `kelvin`: lower, diagonal and upper of every node.
void SlabBatch::set_matrix(const Lanes* kelvin, const Faces& faces, double scale, Row* rows) const {
  const size_t n = nodes();
  const auto& h = grid_.heat;
  const auto& k = grid_.conductance;
  const auto slope = [](const Faces::One& face, const Lanes& at, size_t v) {
    const Four T = at.v[v];
    return face.linear.v[v] + 4.0 * face.quartic.v[v] * T * T * T;
  };
  Lanes up;  // what the node loses upwards a kelvin
  for (size_t v = 0; v < kVectors; ++v) up.v[v] = slope(faces.top, kelvin[0], v);
  for (size_t i = 0; i + 1 < n; ++i) {
    const double k0 = k[0][i], k1 = k[1][i], k2 = k[2][i], k3 = k[3][i];
    for (size_t v = 0; v < kVectors; ++v) {
      const Four a = kelvin[i].v[v], b = kelvin[i + 1].v[v];
      const Four own = scale * (k0 + a * (k1 + a * (k2 + a * k3))), next = k0 + b * (k1 + b * (k2 + b * k3));
      rows[i].diagonal.v[v] = scale * up.v[v] + own;
      rows[i].upper.v[v] = -scale * next;
      rows[i + 1].lower.v[v] = -own;
      up.v[v] = next;
    }
  }
  for (size_t v = 0; v < kVectors; ++v)
    rows[n - 1].diagonal.v[v] = scale * (up.v[v] + slope(faces.bottom, kelvin[n - 1], v));
  for (size_t i = 0; i < n; ++i) {
    const double h0 = h[0][i], h1 = 2 * h[1][i], h2 = 3 * h[2][i], h3 = 4 * h[3][i], h4 = 5 * h[4][i];
    for (size_t v = 0; v < kVectors; ++v) {
      const Four T = kelvin[i].v[v];
      rows[i].diagonal.v[v] += h0 + T * (h1 + T * (h2 + T * (h3 + T * h4)));
    }
  }
}

// Solves with matrix_, which it overwrites, for `right` in place.
void SlabBatch::solve_matrix(Lanes* right) {
  const size_t n = nodes();
  for (size_t i = 0; i < n; ++i) {
    Row& row = matrix_[i];
    for (size_t v = 0; v < kVectors; ++v) {
      Four diagonal = row.diagonal.v[v], r = right[i].v[v];
      if (i > 0) {
        diagonal -= row.lower.v[v] * matrix_[i - 1].upper.v[v];
        r -= row.lower.v[v] * right[i - 1].v[v];
      }
      const Four pivot = 1.0 / diagonal;
      row.upper.v[v] *= pivot;
      right[i].v[v] = r * pivot;
    }
  }
  for (size_t i = n - 1; i-- > 0;)
    for (size_t v = 0; v < kVectors; ++v) right[i].v[v] -= matrix_[i].upper.v[v] * right[i + 1].v[v];
}

// heat(x) - scale gain(x) = history, from the guess in kelvin; leaves what is stored then in heat_.
void SlabBatch::solve_newton(const Lanes* history, const Faces& faces, double scale, Lanes* kelvin) {
  const size_t n = nodes();
  constexpr double kEnough = 1e-4;  // K: the next change would be its square by some hundred kelvin
  double worst = INFINITY;
  Lanes far;
  for (int turn = 0; turn < 40 && worst > kEnough; ++turn) {
    evaluate(kelvin, faces, heat_.data(), gain_.data());
    for (size_t i = 0; i < n; ++i)
      for (size_t v = 0; v < kVectors; ++v) right_[i].v[v] = history[i].v[v] + scale * gain_[i].v[v] - heat_[i].v[v];
    set_matrix(kelvin, faces, scale, matrix_.data());
    solve_matrix(right_.data());
    far = Lanes();
    for (size_t i = 0; i < n; ++i)
      for (size_t v = 0; v < kVectors; ++v) {
        const Four change = right_[i].v[v], T = kelvin[i].v[v], size = change < 0.0 ? -change : change;
        kelvin[i].v[v] = T + change < 0.1 * T ? 0.1 * T : T + change;
        far.v[v] = far.v[v] > size ? far.v[v] : size;
      }
    worst = far.largest();
  }
  for (size_t l = 0; l < kLanes; ++l)
    if (!(far.get(l) <= kEnough)) kelvin[0].set(l, NAN);  // told by keep_estimates
  evaluate(kelvin, faces, heat_.data(), gain_.data());
}

// Both stages of a block and its estimate, as middle_stage, end_stage and estimate_error do with constant properties.
void SlabBatch::step_newton(size_t block, double dt, const FaceEnds& faces) {
  const size_t n = nodes();
  const Lanes* now = &now_[block * n];
  Lanes* end = &end_[block * n];
  const double s = kD * dt, curve = kW / kD;
  std::vector<Lanes> stored(n), rates(n), history(n), between(n);
  evaluate(now, faces.begin, stored.data(), rates.data());
  for (size_t i = 0; i < n; ++i)
    for (size_t v = 0; v < kVectors; ++v) history[i].v[v] = stored[i].v[v] + s * rates[i].v[v];
  std::copy(now, now + n, middle_.begin());
  solve_newton(history.data(), faces.at(kGamma), s, middle_.data());
  between = heat_;
  for (size_t i = 0; i < n; ++i)
    for (size_t v = 0; v < kVectors; ++v) history[i].v[v] = stored[i].v[v] + curve * (between[i].v[v] - stored[i].v[v]);
  std::copy(middle_.begin(), middle_.end(), end);
  solve_newton(history.data(), faces.end, s, end);
  keep_means(block);
  for (size_t i = 0; i < n; ++i)
    for (size_t v = 0; v < kVectors; ++v) {
      const Four to_middle = between[i].v[v] - stored[i].v[v], rest = heat_[i].v[v] - history[i].v[v];
      right_[i].v[v] = (kError2 * to_middle + kError3 * rest) / kD + dt * (kError1 - kError2) * rates[i].v[v];
    }
  set_matrix(end, faces.end, s, matrix_.data());
  solve_matrix(right_.data());
  keep_estimates(block, right_.data());
}

const SlabGrid& SlabBatch::linearised(size_t element, SlabGrid& buffer) const {
  if (linear_) return grid_;
  buffer = grid_;
  for (size_t i = 0; i < nodes(); ++i) {
    const double T = kelvin(element, i);
    double power = 1;
    for (size_t m = 1; m < grid_.heat.size(); ++m)
      buffer.heat[0][i] += static_cast<double>(m + 1) * (power *= T) * grid_.heat[m][i];
    if (i + 1 == nodes()) break;
    const double between = (T + kelvin(element, i + 1)) / 2;
    power = 1;
    for (size_t m = 1; m < grid_.conductance.size(); ++m)
      buffer.conductance[0][i] += (power *= between) * grid_.conductance[m][i];
  }
  return buffer;
}

}  // namespace suite
