#include "math/mueller.h"

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

double least_coherency(const Mueller& m) {
  using C = std::complex<double>;
  static const C kSigma[4][2][2] = {
      {{1, 0}, {0, 1}}, {{1, 0}, {0, -1}}, {{0, 1}, {1, 0}}, {{0, C(0, -1)}, {C(0, 1), 0}}};
  C H[4][4] = {};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c)
          H[r][c] += 0.25 * m(i, j) * kSigma[i][r / 2][c / 2] * std::conj(kSigma[j][r % 2][c % 2]);
  // Jacobi's method on the symmetric matrix (Re -Im; Im Re), whose eigenvalues are those of H twice.
  double A[8][8];
  for (int r = 0; r < 8; ++r)
    for (int c = 0; c < 8; ++c) {
      const C h = H[r % 4][c % 4];
      A[r][c] = r / 4 == c / 4 ? h.real() : r < c ? -h.imag() : h.imag();
    }
  for (int sweep = 0; sweep < 30; ++sweep) {
    double off = 0;
    for (int p = 0; p < 8; ++p)
      for (int q = p + 1; q < 8; ++q) {
        off += A[p][q] * A[p][q];
        if (A[p][q] == 0) continue;
        const double theta = (A[q][q] - A[p][p]) / (2 * A[p][q]);
        const double t = std::copysign(1.0, theta) / (std::fabs(theta) + std::hypot(theta, 1.0));
        const double c = 1 / std::hypot(t, 1.0), s = t * c;
        for (int k = 0; k < 8; ++k) {
          const double x = A[k][p], y = A[k][q];
          A[k][p] = c * x - s * y, A[k][q] = s * x + c * y;
        }
        for (int k = 0; k < 8; ++k) {
          const double x = A[p][k], y = A[q][k];
          A[p][k] = c * x - s * y, A[q][k] = s * x + c * y;
        }
      }
    if (off < 1e-30) break;
  }
  double least = A[0][0];
  for (int i = 1; i < 8; ++i) least = std::min(least, A[i][i]);
  return least;
}

}  // namespace suite
