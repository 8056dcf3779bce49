// A measured surface by formula: small elements over a lobe, so that every matrix can exist.
#pragma once
#include <cmath>

#include "math/mueller.h"
#include "support/tensor_file.h"

namespace suite::test {

struct MuellerFormula {
  std::vector<double> theta_h_deg{0, 5, 12, 25, 45, 70, 90}, theta_d_deg{0, 10, 25, 45, 65, 90}, phi_d_deg;
  std::vector<uint16_t> wavelength_nm{450, 500, 550, 600, 650};
  MuellerFormula() {
    for (int p = -180; p <= 180; p += 30) phi_d_deg.push_back(p);
  }
  // f M, in the frames and signs of .pbsdf.
  static Mueller at(double theta_h, double theta_d, double phi_d, double nm) {
    const double f = (0.1 + 0.8 * std::exp(-6 * theta_h * theta_h)) * (1 + 0.3 * std::cos(theta_d)) *
                     (1 + 0.2 * std::cos(phi_d)) * (nm / 550);
    Mueller m;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        m(i, j) =
            f * 0.06 *
            std::cos(1 + i + 2 * j + theta_h * i - theta_d * j + 0.5 * (i - j) * std::sin(phi_d) + 0.001 * (nm - 550));
    m(0, 0) = f;
    return m;
  }
  // Values in the order of the file: phi_d, theta_d, theta_h, wavelength.
  void every(const auto& f) const {
    for (const double p : phi_d_deg)
      for (const double d : theta_d_deg)
        for (const double h : theta_h_deg)
          for (const uint16_t nm : wavelength_nm) f(h, d, p, nm);
  }
  TensorFileBuilder pbsdf() const {
    const auto radians = [](const std::vector<double>& deg) {
      std::vector<float> v;
      for (const double x : deg) v.push_back(static_cast<float>(x * kDegree));
      return v;
    };
    TensorFileBuilder b;
    b.floats("theta_h", {1, theta_h_deg.size()}, radians(theta_h_deg));
    b.floats("theta_d", {1, theta_d_deg.size()}, radians(theta_d_deg));
    b.floats("phi_d", {1, phi_d_deg.size()}, radians(phi_d_deg));
    b.words("wvls", wavelength_nm);
    std::vector<float> values;
    every([&](double h, double d, double p, double nm) {
      for (const double x : at(h * kDegree, d * kDegree, p * kDegree, nm).m) values.push_back(static_cast<float>(x));
    });
    b.floats("M", {phi_d_deg.size(), theta_d_deg.size(), theta_h_deg.size(), wavelength_nm.size(), 4, 4}, values);
    return b;
  }
};

}  // namespace suite::test
