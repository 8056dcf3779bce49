// A spectral curve: piecewise linear in wavelength, with a declared rule for what holds outside its range.
#pragma once
#include <string>
#include <vector>

#include "base/error.h"

namespace suite {

// What a curve is worth outside its tabulated range. Only `error` is ever implied.
enum class Outside { error, hold, zero };
const char* to_text(Outside rule);

class Curve {
 public:
  Curve() = default;
  // wavelength_um: strictly monotonic (descending is reversed), positive, finite; value: same length >= 1, finite.
  // name: for messages ("asphalt.txt"). Error otherwise, located at `where`.
  Curve(std::vector<double> wavelength_um, std::vector<double> value, Outside outside, const Where& where = {});
  static Curve constant(double value);  // the same everywhere

  double at(double wavelength_um) const;                 // Error outside the range under Outside::error
  double mean(double low_um, double high_um) const;      // exact average of the piecewise linear curve; low <= high
  double integral(double low_um, double high_um) const;  // exact
  bool covers(double low_um, double high_um) const;      // inside the range, or a rule other than error is declared

  bool is_constant() const { return constant_; }
  Outside outside() const { return outside_; }
  std::string range_text() const;  // "0.4 to 0.9 um", for messages; asks when that looks like nanometres
  double low_um() const;           // of the tabulated range; 0 and infinity for a constant
  double high_um() const;
  const std::vector<double>& wavelength_um() const { return x_; }
  const std::vector<double>& value() const { return y_; }
  double min() const;
  double max() const;
  Curve scaled(double factor) const;
  Curve with_outside(Outside rule) const;

 private:
  std::vector<double> x_, y_;       // x ascending
  std::vector<double> cumulative_;  // integral from x_[0] to x_[i]
  Outside outside_ = Outside::error;
  bool constant_ = false;
  double primitive(double wavelength_um) const;  // integral from x_[0]
};

}  // namespace suite
