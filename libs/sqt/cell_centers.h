// Middles of cells, eight at a time, in single precision and the same on every machine. Internal to libs/sqt.
// Based on: as cell.h (Gorski et al. 2005).
#pragma once
#include <immintrin.h>

#include "sqt/cell.h"
#include "sqt/vectors.h"

namespace suite::sqt {

struct CellLanes {
  Int8 face{}, x{}, y{};
  void set(size_t lane, CellXY at) {
    face[lane] = at.face, x[lane] = static_cast<int32_t>(at.x), y[lane] = static_cast<int32_t>(at.y);
  }
};

// Unit vectors, to about 1e-6.
inline void centers_of(const CellLanes& cells, int order, EightFloats& dx, EightFloats& dy, EightFloats& dz) {
  const float width = 1.0f / static_cast<float>(1 << order);
  const EightFloats x = (__builtin_convertvector(cells.x, EightFloats) + 0.5f) * width,
                    y = (__builtin_convertvector(cells.y, EightFloats) + 0.5f) * width;
  const Int8 row = cells.face >> 2;  // north, belt, south
  const EightFloats ring = __builtin_convertvector(row + 2, EightFloats) - x - y;
  const Int8 longitude = 2 * (cells.face & 3) + (row == 1 ? Int8{} : Int8{} + 1);
  const Int8 north = ring<1, south = ring> 3, belt = ~(north | south);
  const EightFloats one = EightFloats{} + 1;
  const EightFloats across = belt ? one : north ? ring : 4 - ring, t = across * across * (1.0f / 3);
  const EightFloats z = belt ? (2 - ring) * (2.0f / 3) : north ? 1 - t : t - 1;
  const EightFloats s = _mm256_sqrt_ps(belt ? (1 - z) * (1 + z) : t * (2 - t));
  const EightFloats eighths = __builtin_convertvector(longitude, EightFloats) + (x - y) / across;
  // Cosine and sine of the nearest multiple of pi/4, turned by the rest (at most pi/8, Taylor).
  constexpr float h = 0.70710678f;
  const EightFloats cosines{h, 1, h, 0, -h, -1, -h, 0}, sines{-h, 0, h, 1, h, 0, -h, -1};
  const Int8 n = __builtin_convertvector(eighths + 1.5f, Int8);  // azimuths from -pi/4 to 2 pi
  const EightFloats r = (eighths + 1 - __builtin_convertvector(n, EightFloats)) * 0.78539816f, r2 = r * r;
  const EightFloats sine = r * (1 - r2 * (1.0f / 6) * (1 - r2 * (1.0f / 20) * (1 - r2 * (1.0f / 42)))),
                    cosine = 1 - r2 * 0.5f * (1 - r2 * (1.0f / 12) * (1 - r2 * (1.0f / 30)));
  const Int8 turn = n & 7;
  const EightFloats cos_n = __builtin_shuffle(cosines, turn), sin_n = __builtin_shuffle(sines, turn);
  dx = s * (cos_n * cosine - sin_n * sine), dy = s * (sin_n * cosine + cos_n * sine), dz = z;
}

}  // namespace suite::sqt
