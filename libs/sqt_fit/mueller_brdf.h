// A measured polarised BRDF of an isotropic surface: Mueller matrices on a grid of half-vector angles, as goniometers
// give them. As a function it is its m11.
#pragma once
#include <string>
#include <vector>

#include "sqt/function.h"
#include "sqt/half_grid.h"

namespace suite::sqt {

class MuellerBrdf final : public Function {
 public:
  static constexpr size_t kMatrix = 16;
  struct Data {
    HalfGrid grid;
    std::vector<double> wavelength_um;  // ascending
    // [node][wavelength][row][column], 1/sr, in the plane of scattering, basis (p, s, k), conventions of
    // libs/math/CONVENTIONS.md. NaN in the first: no data there.
    std::vector<float> values;
  };
  // Nodes without data, and with an m11 that is not above 0, take the nearest along theta_h, theta_d or phi_d; m11 may
  // be 0 where nothing is near. Error: axes, the number of values, no data at all, an element that is not finite.
  MuellerBrdf(std::string name, std::string source, Data data);

  const Info& info() const override { return info_; }
  // m11, 1/sr; NaN below the horizon.
  void value(Dir out, Dir in, std::span<double> f) const override;
  const Data& data() const { return data_; }
  // Share of nodes above the horizon without data, before they were filled.
  double missing_share() const { return missing_share_; }
  // Mean |f(phi) - f(-phi)| over mean f of m11.
  double asymmetry() const { return asymmetry_; }

 private:
  void check() const;
  void fill();
  double measure_asymmetry() const;
  Info info_;
  Data data_;
  double missing_share_ = 0, asymmetry_ = 0;
};

}  // namespace suite::sqt
