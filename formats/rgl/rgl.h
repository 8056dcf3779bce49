// RGL (EPFL) measured BRDFs, .bsdf "tensor files" (FORMAT.md): rgb or spectral, isotropic or anisotropic.
//
// Assumes: theta_i, phi_i of the file is the direction of the light, our `in`; its other direction is our `out`. The
// stored quantity contains the cosine of `out`, which value() divides out. The data are not exactly reciprocal.
// Based on: J. Dupuy & W. Jakob, "An adaptive parameterization for efficient material acquisition and rendering",
// ACM TOG 37(6), 2018, equations 19-23; the public reader rgl-epfl/brdf-loader for the layout.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/rgl/warp.h"
#include "sqt/function.h"

namespace suite {

class RglBrdf final : public sqt::Function {
 public:
  // Fields of the file; shapes are checked by the reader. phi, theta: radians, strictly ascending. ndf and sigma have
  // ndf_rows (2 when isotropic) x ndf_columns; vndf has phi x theta x vndf_side^2; values phi x theta x channels x
  // side^2.
  struct Tables {
    std::vector<double> phi, theta;
    std::vector<double> wavelength_um;  // one per channel
    bool spectral = false, jacobian = true;
    size_t ndf_rows = 0, ndf_columns = 0, sigma_rows = 0, sigma_columns = 0, vndf_rows = 0, vndf_columns = 0, rows = 0,
           columns = 0;
    std::vector<float> ndf, sigma, vndf, values;
  };
  RglBrdf(std::string name, std::string description, Tables tables);

  const Info& info() const override { return info_; }
  // f in 1/sr per channel; NaN when in.z <= 0 or out.z <= 0. The division by the cosine uses max(cos out, cos 88 deg):
  // beyond 88 deg the stored product is finite but f is not measured. Negative stored values (colours out of gamut)
  // count as 0.
  void value(Dir out, Dir in, std::span<double> f) const override;

  const std::string& description() const { return description_; }
  // Mean |f(phi) - f(-phi)| over mean f of the middle channel, weighted by both cosines and solid angles, up to 80 deg;
  // 0 when anisotropic.
  double asymmetry() const { return asymmetry_; }
  // Share of stored values that are negative.
  double negative_share() const { return negative_share_; }

 private:
  void stored(Dir out, Dir in, std::span<double> w) const;  // f cos(out)
  rgl::SliceMix slices(double phi, double theta) const;
  double measure_asymmetry() const;
  Info info_;
  std::string description_;
  std::vector<double> phi_, theta_;
  int reduction_ =
      1;  // the stored phi range is 2 pi / reduction: 1 whole, 2 half (rotation by pi), 4 quarter (mirrors)
  bool jacobian_;
  size_t channels_;
  rgl::Bilinear ndf_, sigma_, values_;
  rgl::Warp vndf_;
  double asymmetry_ = 0, negative_share_ = 0;
};

// Error: missing, not a tensor file, fields missing or of the wrong type or shape, data beyond the end, non-finite
// data.
std::shared_ptr<const RglBrdf> read_rgl(const std::string& path);
std::shared_ptr<const RglBrdf> parse_rgl(std::span<const std::byte> bytes, const std::string& file_name);

// How finely a function is tabulated for a .bsdf: slices over the polar angle (and azimuth, when it is not isotropic)
// of the viewer, each with side x side half vectors, the polar angle's root along one and the azimuth along the other.
struct RglSize {
  size_t theta = 32, phi = 25, side = 64;
};
// The bytes of a .bsdf as Mitsuba's `measured` and pbrt take it: theta_i, phi_i are the viewer's direction, values hold
// the cosine of the light's. The warp is the identity and `jacobian` 0: values are tabulated over half vectors as they
// are. read_rgl takes theta_i for the light's, so `sqt::swapped` of what it reads is the function. Error: no BRDF;
// wavelengths that neither ascend nor are those that stand for R, G, B.
std::vector<std::byte> rgl_of(const sqt::Function& function, const std::string& description, const RglSize& size = {});

}  // namespace suite
