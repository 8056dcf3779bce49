#include "math/coherency.h"

#include <algorithm>
#include <complex>

namespace suite {

Mueller to_world(const Mueller& local, const Frame& frame, Dir out, Dir in) {
  // The local meridian frames, as vectors of the world.
  const auto world_e1 = [&](Dir k) { return frame.to_world(meridian_frame(frame.to_local(k)).e1); };
  const bool mirrored = dot(cross(frame.x, frame.y), frame.z) < 0;
  // A left-handed frame sees the world in a mirror: U and V change sign.
  const Mueller m = mirrored ? converted(local, {"", "", {1, 1, -1, -1}}) : local;
  const Vec3 a = world_e1(-in);
  const Mueller before = frame_rotation(meridian_frame(-in), a);
  const Vec3 b = world_e1(out);
  const PolarFrame to = meridian_frame(out);
  // From (b, out x b) to `to`.
  const Mueller after = frame_rotation({b, cross(out, b)}, to.e1);
  return after * m * before;
}

namespace {

using C = std::complex<double>;

// Pauli's matrices in the order of I, Q, U, V; element (r, c) of sigma_i x sigma_j*.
C kronecker(int i, int j, int r, int c) {
  static const C kSigma[4][2][2] = {
      {{1, 0}, {0, 1}}, {{1, 0}, {0, -1}}, {{0, 1}, {1, 0}}, {{0, C(0, -1)}, {C(0, 1), 0}}};
  return kSigma[i][r / 2][c / 2] * std::conj(kSigma[j][r % 2][c % 2]);
}

// The coherency matrix 1/4 sum m_ij sigma_i x sigma_j*, written out.
void coherency(const Mueller& m, C (&H)[4][4]) {
  const auto put = [&](int r, int c, double re, double im) {
    H[r][c] = C(0.25 * re, 0.25 * im), H[c][r] = std::conj(H[r][c]);
  };
  put(0, 0, m(0, 0) + m(1, 1) + m(0, 1) + m(1, 0), 0);
  put(1, 1, m(0, 0) - m(1, 1) - m(0, 1) + m(1, 0), 0);
  put(2, 2, m(0, 0) - m(1, 1) + m(0, 1) - m(1, 0), 0);
  put(3, 3, m(0, 0) + m(1, 1) - m(0, 1) - m(1, 0), 0);
  put(0, 1, m(0, 2) + m(1, 2), m(0, 3) + m(1, 3));
  put(2, 3, m(0, 2) - m(1, 2), m(0, 3) - m(1, 3));
  put(0, 2, m(2, 0) + m(2, 1), -m(3, 0) - m(3, 1));
  put(1, 3, m(2, 0) - m(2, 1), -m(3, 0) + m(3, 1));
  put(0, 3, m(2, 2) + m(3, 3), m(2, 3) - m(3, 2));
  put(1, 2, m(2, 2) - m(3, 3), -m(2, 3) - m(3, 2));
}

// The coherency matrix H as the symmetric matrix (Re -Im; Im Re), whose eigenvalues are those of H twice.
struct Coherency {
  double a[8][8], vector[8][8] = {};  // columns of `vector`, once diagonal
  explicit Coherency(const Mueller& m) {
    C H[4][4];
    coherency(m, H);
    for (int r = 0; r < 8; ++r)
      for (int c = 0; c < 8; ++c) {
        const C h = H[r % 4][c % 4];
        a[r][c] = r / 4 == c / 4 ? h.real() : r < c ? -h.imag() : h.imag();
        vector[r][c] = r == c;
      }
  }
  // Jacobi's method.
  void diagonalise() {
    for (int sweep = 0; sweep < 30; ++sweep) {
      double off = 0;
      for (int p = 0; p < 8; ++p)
        for (int q = p + 1; q < 8; ++q) {
          off += a[p][q] * a[p][q];
          if (a[p][q] != 0) turn(p, q);
        }
      if (off < 1e-30) break;
    }
  }
  double least() const {
    double least = a[0][0];
    for (int i = 1; i < 8; ++i) least = std::min(least, a[i][i]);
    return least;
  }

 private:
  void turn(int p, int q) {
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = std::copysign(1.0, theta) / (std::fabs(theta) + std::hypot(theta, 1.0));
    const double c = 1 / std::hypot(t, 1.0), s = t * c;
    for (int k = 0; k < 8; ++k) {
      const double x = a[k][p], y = a[k][q], u = vector[k][p], v = vector[k][q];
      a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
      vector[k][p] = c * u - s * v, vector[k][q] = s * u + c * v;
    }
    for (int k = 0; k < 8; ++k) {
      const double x = a[p][k], y = a[q][k];
      a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
    }
  }
};

}  // namespace

double least_coherency(const Mueller& m) {
  Coherency h(m);
  h.diagonalise();
  return h.least();
}

bool coherency_exceeds(const Mueller& m, double least) {
  C H[4][4];
  coherency(m, H);
  // Cholesky's factors of H - least.
  for (int k = 0; k < 4; ++k) {
    const double pivot = H[k][k].real() - least;
    if (!(pivot > 0)) return false;
    for (int r = k + 1; r < 4; ++r)
      for (int c = k + 1; c <= r; ++c) H[r][c] -= H[r][k] * std::conj(H[c][k]) / pivot;
  }
  return true;
}

Mueller physical(const Mueller& m) {
  if (coherency_exceeds(m, 0)) return m;
  Coherency h(m);
  h.diagonalise();
  if (h.least() >= 0) return m;
  C H[4][4] = {};
  for (int k = 0; k < 8; ++k)
    for (int r = 0; r < 4 && h.a[k][k] > 0; ++r)
      for (int c = 0; c < 4; ++c) H[r][c] += h.a[k][k] * h.vector[c][k] * C(h.vector[r][k], h.vector[r + 4][k]);
  Mueller p;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) p(i, j) += (H[r][c] * kronecker(i, j, c, r)).real();
  return p(0, 0) > 0 ? p * (m(0, 0) / p(0, 0)) : Mueller::depolariser() * m(0, 0);
}

}  // namespace suite
