// MERL .binary: isotropic BRDFs tabulated over half and difference angles (FORMAT.md).
//
// Assumes: R, G, B; nearest-bin lookup as the database defines it; a bin's value stands for its centre.
// Based on: W. Matusik, H. Pfister, M. Brand, L. McMillan, "A data-driven reflectance model", ACM TOG 22(3), 2003;
// half/difference angles: S. Rusinkiewicz, "A new change of variables for efficient BRDF representation", 1998.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sqt/function.h"

namespace suite {

// Data whose mirror asymmetry is below this share are declared bilaterally symmetric.
inline constexpr double kBilateralLimit = 0.02;

// Where within a bin a value is taken to stand, as a fraction of the bin in every angle. Files do not say; 0 is the
// lower edge, 0.5 the centre.
inline constexpr double kMerlBinCentre = 0.5;

class MerlTable final : public sqt::Function {
 public:
  static constexpr int kThetaH = 90, kThetaD = 90;

  // raw: three planes (R, G, B) of kThetaH x kThetaD x phi_d values as in the file; phi_d is 180 or 360.
  MerlTable(std::string name, int phi_d, std::span<const double> raw);

  const Info& info() const override { return info_; }
  // f in 1/sr for R, G, B. NaN when in.z <= 0 or out.z <= 0, or when the bin has no valid data.
  void value(Dir out, Dir in, std::span<double> f) const override;

  int phi_d_bins() const { return phi_d_; }
  // Bins whose triple was negative, NaN or infinite and is therefore invalid, among those above the horizon.
  size_t invalid_bins() const { return invalid_; }
  size_t valid_bins() const { return valid_; }
  // Mean |f(phi) - f(-phi)| over mean f, of the green channel, cosine and solid-angle weighted, up to 80 deg.
  double asymmetry() const { return asymmetry_; }

 private:
  Info info_;
  int phi_d_;
  std::vector<std::array<float, 3>> bins_;  // 1/sr, NaN = invalid
  size_t invalid_ = 0, valid_ = 0;
  double asymmetry_ = 0;
};

// The pair of directions that bin (i, j, k) stands for at `fraction` of its width, phi_h = 0. phi_d_bins: 180 or 360.
// Below the horizon (z <= 0) for many bins near grazing.
struct MerlPair {
  Dir in, out;
};
MerlPair merl_bin_directions(int i, int j, int k, int phi_d_bins, double fraction = kMerlBinCentre);
// Offset of the bin that holds a pair of directions above the horizon.
size_t merl_bin(Dir out, Dir in, int phi_d_bins);

// Error: missing, wrong dimensions (hint names the two layouts), size that does not fit them.
std::shared_ptr<const MerlTable> read_merl(const std::string& path);
std::shared_ptr<const MerlTable> parse_merl(std::span<const std::byte> bytes, const std::string& file_name);

// Tabulates `function` at `fraction` of each bin and writes it; bins below the horizon or without data become -1.
// function must have three channels and be isotropic. phi_d_bins: 180 or 360.
// A 180 table holds f(out, in) of the pairs merl_bin_directions names; it gives the same value with both exchanged.
void write_merl(const std::string& path, const sqt::Function& function, int phi_d_bins = 180,
                double fraction = kMerlBinCentre);
// The same table in memory, raw values as in the file.
std::vector<double> merl_raw(const sqt::Function& function, int phi_d_bins = 180, double fraction = kMerlBinCentre);

}  // namespace suite
