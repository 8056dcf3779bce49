// Parts of a spectral interval on their way to a few points: each a weight and its absorption at every level.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "air/gases.h"

namespace suite {

inline constexpr double kSlight = 0.001;        // share of the light that an absorber may take and still count as grey
inline constexpr size_t kPartsOfBand = 50;      // of one band, between its gases
inline constexpr size_t kPartsOfInterval = 80;  // from which the points are chosen

// Mean of a quantity that runs exponentially between two values, linearly when one is 0.
double mean_between(double a, double b);

// The levels as a quadrature of the vertical path.
class Column {
 public:
  explicit Column(std::span<const AirLevel> levels);
  size_t levels() const { return thickness_.size() + 1; }
  double depth(std::span<const float> absorption) const;  // of one part

 private:
  std::vector<double> thickness_;
};

class Parts {
 public:
  explicit Parts(size_t levels) : levels_(levels) {}
  Parts(const GasPoints& points, size_t levels);

  size_t count() const { return weight_.size(); }
  double weight(size_t i) const { return weight_[i]; }
  std::span<const float> absorption(size_t i) const { return {absorption_.data() + i * levels_, levels_}; }

  void add(double weight, std::span<const float> absorption);
  void append(const Parts& other);
  void add_to_all(std::span<const float> absorption);
  Parts times(const GasPoints& points) const;  // random overlap
  std::vector<double> depths(const Column& column) const;

  // Parts of neighbouring vertical depth joined, about `most` of them.
  Parts gathered(const Column& column, size_t most) const;
  // The best grouping into few points; see gas_points.
  GasPoints reduced(const Column& column, const GasReduction& reduction) const;
  // Absorption that stands for the parts first to last - 1 together.
  std::vector<float> joined(size_t first, size_t last, std::span<const double> depth) const;

 private:
  Parts sorted(const Column& column, std::vector<double>& depth) const;

  size_t levels_;
  std::vector<double> weight_;
  std::vector<float> absorption_;  // [part][level]
};

}  // namespace suite
