// Radiance of the air over zenith angle and azimuth, tabulated for every bin at even steps of height: the sky over a
// place, with the light that nodes ask for in it, or what lies between a place and a view from far above. Each zenith
// angle of each height is made when it is first needed: a satellite looks down one or two.
//
// Assumes: radiance that changes little over a degree of zenith angle and 2.5 degrees of azimuth; nothing is tabulated
// below the horizon. Where there is one plane of symmetry (a single sun) half of the azimuths are made.
#pragma once
#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "light/kinds/sky.h"
#include "light/sky_through_water.h"

namespace suite {

class SkyTable {
 public:
  // Radiance at a height (m, of the scene) along a direction, per bin.
  using Radiance = std::function<void(double height, Dir direction, std::span<float> radiance)>;
  // even: nothing depends on azimuth; symmetric: azimuth (rad) of the plane of symmetry, if there is one.
  // step: of heights, m.
  SkyTable(size_t bins, bool even, std::optional<double> symmetric, double step, Radiance radiance);

  // Whether a place and a direction lie in the table.
  static bool covers(double height, Dir d) { return d.z >= 0 && height >= kLowest && height < kHighest; }
  // Bilinear, and linear in height: within 2e-3 of a step of a table's height it is that table alone, which changes the
  // result by at most 2e-3 of what it changes in a step. Per bin.
  void radiance(double height, Dir d, std::span<float> to) const;
  // One of the values between which radiance() interpolates, drawn with the weight that it has there by a hash of the
  // direction: right in the mean, and as noisy as neighbouring values differ (M. Fajardo et al., "Stochastic texture
  // filtering", 2023). Per bin.
  const float* drawn(double height, Dir d) const;
  // As a light to ask (Atmosphere::sky): one density for all bins, that of height 0. Null before make_light(), and
  // where the sky is black.
  const Light* light() const { return light_.get(); }
  // 1/sr, with which light() draws a direction; 0 without it.
  double density(Dir d) const { return light_ ? density_(d) : 0; }
  void make_light();
  // To places under water, made when first asked for. knots: their bins, always the same.
  const SkyThroughWater& through_water(std::span<const size_t> knots) const;

 private:
  static constexpr double kLowest = -6000, kHighest = 12000;  // m
  static constexpr size_t kRows = 91;                         // nodes of zenith angle, 0 to 90 degrees
  struct Floor {
    std::once_flag once;       // of the memory
    std::vector<float> table;  // [row][column][bin]
    std::array<std::once_flag, kRows> row_once;
    std::array<std::atomic<bool>, kRows> made{};
  };
  // Column of an azimuth (rad), as a number with a fraction.
  double column(double azimuth) const;
  // [column][bin] of a floor.
  const float* row(size_t floor, size_t row) const {
    const Floor& of = floors_[floor];
    if (!of.made[row].load(std::memory_order_acquire)) make_row(floor, row);
    return of.table.data() + row * columns_ * bins_;
  }
  void make_row(size_t floor, size_t row) const;
  // Between which rows, columns and floors a place lies: the first ones, and how far it is to the second ones.
  struct Place {
    size_t row, column, next, floor;
    float down, turn, rise;  // 0..1
  };
  Place place(double height, double polar, double azimuth) const;
  void fill(size_t index, size_t row) const;
  SkySpec weights(std::span<const size_t> bins, const std::function<double(double)>& weight) const;

  double step_;
  size_t bins_, columns_;
  std::optional<double> symmetric_;
  double turns_ = 0;  // columns a radian
  Radiance radiance_;
  mutable std::vector<Floor> floors_;
  std::unique_ptr<const Light> light_;
  std::function<double(Dir)> density_;
  mutable std::once_flag water_once_;
  mutable std::unique_ptr<const SkyThroughWater> through_water_;
};

}  // namespace suite
