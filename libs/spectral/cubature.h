// Which few of many fine cells of wavelength stand for all of them, and how much each counts in each band, so that the
// bands of given products of spectra come out right: light is followed at the chosen cells only.
//
// Method: for each band a non-negative least-squares fit (active set) of what the cells count to the integrals over all
// cells, stopped as soon as every product is within the tolerance; only products that are not within it enter the fit.
// Cells that other bands chose already are preferred, and at the end every cell without which its bands can do is
// dropped. Weights are never negative and add up to 1, so sums of the products are as right as the products.
// Based on: J.-L. Moncet et al., "Infrared radiance modeling by optimal spectral sampling", J. Atmos. Sci. 65, 2008
// (monochromatic nodes with weights fitted to training spectra); C. Lawson & R. Hanson, "Solving least squares
// problems", 1974, chapter 23. That such weights exist: V. Tchakaloff, Bull. Sci. Math. 81, 1957.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace suite {

// Spectra over cells and the products of them that count.
struct SpectralProducts {
  std::vector<std::vector<float>> spectra;  // [spectrum][cell], >= 0
  static constexpr uint32_t kOne = 0xffffffffu;
  struct Product {
    uint32_t light = kOne;                                 // index into spectra
    std::array<uint32_t, 3> factors = {kOne, kOne, kOne};  // indices; kOne = 1
    // The product whose mean its error is relative to, kOne = its own: light that is never seen alone.
    uint32_t judged_by = kOne;
  };
  std::vector<Product> products;
  size_t cells = 0;
  // Of lights that gases have absorbed on their way: the same without gases; empty for others. Errors are never
  // relative to less than a hundredth of that, nor to less than a thousandth of the brightest of them.
  std::vector<std::vector<float>> unabsorbed = {};  // [spectrum][cell]; shorter: empty
  bool absorbed(const Product& p) const { return p.light < unabsorbed.size() && !unabsorbed[p.light].empty(); }
  double at(const Product& p, size_t cell) const {
    return p.light == kOne ? with_factors(p, cell, 1)
                           : with_factors(p, cell, static_cast<double>(spectra[p.light][cell]));
  }
  double unabsorbed_at(const Product& p, size_t cell) const {
    return with_factors(p, cell, static_cast<double>(unabsorbed[p.light][cell]));
  }
  double with_factors(const Product& p, size_t cell, double v) const {
    for (const uint32_t f : p.factors)
      if (f != kOne) v *= static_cast<double>(spectra[f][cell]);
    return v;
  }
};

// What each cell counts in a band when all are taken: cells first, first + 1, ...; adds up to 1.
struct BandCells {
  size_t first = 0;
  std::vector<double> share;
  // Stretches of cells (first, end) whose share of the band is kept as well.
  std::vector<std::array<size_t, 2>> stretches = {};
  double tolerance = 0;  // of this band; 0 = that of all
};

// Means of the products over a band. What is too dark to matter is 0: a light below 1e-6 of the brightest, a product
// of several factors below 1e-4 of its light, one factor below 1e-6.
struct BandMean {
  double mean = 0, scale = 1;  // errors are relative to the scale
  double dark = 0;             // the mean of a light that is too dark to matter
  double error(double value) const { return std::fabs(value - mean) / scale; }
};
std::vector<BandMean> band_means(const SpectralProducts& all, const BandCells& band);

struct ChosenCells {
  std::vector<size_t> cells;     // ascending
  std::vector<double> shares;    // [band][chosen cell], adding up to 1 for each band
  double error = 0;              // the largest of all bands and products, relative
  size_t band = 0, product = 0;  // whose it is
};
// tolerance > 0: largest relative error of each product in each band. most: cells that one band may take; what is not
// reached with them is told in `error`.
ChosenCells choose_cells(const SpectralProducts& all, std::span<const BandCells> bands, double tolerance, size_t most);

}  // namespace suite
