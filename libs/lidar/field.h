// What a receiver sees: its pixels, and what each makes of light from a direction.
//
// Photons = importance x radiance x solid angle, summed over a pixel (photons of the same radiance's energy).
//   one detector behind a field stop   importance = area of the aperture x (1 - obscuration) x throughput, evenly over
//                                      the cone
//   an array of pitch p behind f       p^2 / G# over the pixel's p^2 / f^2 of the tangent plane, G# = (1 + 4 F^2) /
//                                      (pi throughput (1 - obscuration)), F = f / aperture
// The array's is that of the suite's cameras and of DIRSIG. Against the aperture's area seen from the target, which is
// the detector's, it is less by 4 F^2 / (1 + 4 F^2): 6 % at f/2, 0.4 % at f/8.
#pragma once
#include <optional>

#include "lidar/instrument.h"

namespace suite {

class ReceiverField {
 public:
  // receiver: without a fault.
  explicit ReceiverField(const LidarReceiver& receiver);

  size_t pixels() const { return size_t{columns_} * rows_; }
  uint32_t columns() const { return columns_; }
  uint32_t rows() const { return rows_; }
  Dir middle(size_t pixel) const;  // receiver's frame
  double solid_angle() const;      // sr, of a pixel in the middle

  // In a direction of the receiver's frame (unit).
  struct Seen {
    uint32_t pixel;
    double importance;  // m2
  };
  std::optional<Seen> at(Dir local) const;
  // A direction within a pixel, and its density, 1/sr.
  Dir sample(size_t pixel, Vec2 u) const;
  double density(Dir local) const;

 private:
  bool stop() const { return pitch_ == 0; }
  uint32_t columns_ = 1, rows_ = 1;
  double pitch_ = 0;   // of the tangent plane; 0: one detector behind a field stop
  double half_ = 0;    // rad, of the stop
  double height_ = 0;  // 1 - cosine of it
  double importance_ = 0;
};

}  // namespace suite
