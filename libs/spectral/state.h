// Bands, spectral states and the quadrature between them. A state is what rides on one path: a window, a reference
// wavelength, and the sample bins at which radiance is carried. Quantities are bin averages, and a band's radiance is
// integral(L R) / integral(R) over those bins.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "spectral/curve.h"

namespace suite {

// A channel of an instrument: relative response, zero outside its support.
struct Band {
  std::string name;
  Curve response;        // dimensionless, >= 0, Outside::zero
  double center_um = 0;  // reported centre
  double fwhm_um = 0;
  double low_um() const { return response.low_um(); }
  double high_um() const { return response.high_um(); }

  // Gaussian by full width at half maximum, cut where the response falls below 1e-4 of its peak.
  static Band gaussian(std::string name, double center_um, double fwhm_um);
  static Band rectangular(std::string name, double center_um, double width_um);
  static Band triangular(std::string name, double center_um, double fwhm_um);
  // center = response-weighted mean wavelength, fwhm = between the outermost half-maximum crossings.
  static Band tabulated(std::string name, const Curve& response, const Where& where = {});
};

// Where radiance is carried: an interval of wavelengths, or one of its g-points, which stands for a share of it (of a
// k-distribution, in which wavelengths that a gas absorbs alike are put together).
struct Bin {
  double low_um, high_um;
  uint32_t g = 0;     // number of the g-point among those of the interval
  double weight = 1;  // the share of the interval that it stands for; those of an interval add up to 1
  double center_um() const { return 0.5 * (low_um + high_um); }
  bool operator==(const Bin&) const = default;
};

// What the bins of a state are to be chosen for when it is known what is looked at (scheduler/bins.h).
struct BinChoice {
  double error = 0;      // of each band, relative; 0: the bins stay as they are
  double widest_um = 0;  // no stretch of a band that wide goes without bins for its share; 0: no limit
  size_t knots = 4;      // wanted, 1..8
};

// One spectral state (paper, section III-C): what the radiometry core is primed for.
struct SpectralState {
  double low_um = 0, high_um = 0;  // the window
  double reference_um = 0;         // drives directions and convergence
  // Intervals ascend, do not overlap and lie inside the window, with gaps where no band looks; the g-points of one
  // stand side by side, in their order.
  std::vector<Bin> bins;
  std::vector<size_t> knots;  // <= 8 indices into bins: where the shape of scattering is drawn; knots[0] = reference
  // What each bin counts in each band, [band][bin], adding up to 1 for a band. Empty: by the part of the response that
  // lies in the bin, times the bin's weight.
  std::vector<double> shares = {};
  BinChoice choice = {};

  size_t size() const { return bins.size(); }
  size_t reference_bin() const { return knots.at(0); }
  // Index of the knot nearest in wavelength to each bin.
  std::vector<int> knot_of_bin() const;
  // Bin averages of a curve. Error when the curve does not cover them.
  std::vector<float> sample(const Curve& curve) const;
  // All that optics and lights are baked from, as numbers: equal ones bake alike. What bands make of the bins (shares)
  // is left out.
  std::vector<double> key() const;
  // A short text that identifies the state in messages and logs: "0.440-0.880 um, 45 bins".
  std::string text() const;
};

// bins: only where some band responds; each stretch of wavelengths is divided evenly into bins of at most
// `step_um`, so that bands side by side that are some steps wide share no bin. reference_um = 0: the response-weighted
// middle of all bands. knots: `knot_count` (1..8) spread over the bins, the reference first. Errors: no bands, step not
// positive, more than 100 000 bins.
SpectralState make_state(std::span<const Band> bands, double step_um, double reference_um = 0, size_t knot_count = 4);

// Chooses the knots of a state whose bins and reference wavelength are set, as make_state does.
void place_knots(SpectralState& state, size_t knot_count);

// Splits every interval of a state into g-points: weights[i] are those of bin i, adding up to 1; {1} leaves it whole.
// What stood for an interval (reference, knots) is then its first g-point. Bug: bins that are g-points already.
SpectralState with_g_points(const SpectralState& state, std::span<const std::vector<double>> weights);

// Mean of a curve weighed by the response of a band; exact. Error when the curve does not cover the band.
double band_mean(const Band& band, const Curve& curve);

// Weights that turn bin radiances into band radiances: sum over bins of weight = 1 for each band.
class BandProjection {
 public:
  // Error: a band that the bins do not cover; shares that are not [band][bin] or do not add up to 1 for each band.
  BandProjection(const SpectralState& state, std::span<const Band> bands);
  size_t bands() const { return rows_.size(); }
  bool identity() const { return identity_; }  // band b is bin b
  // out[b] = sum_k weight[b][k] in[k]; in.size() >= bins of the state
  void add(std::span<const float> in, std::span<double> sums) const;  // sums[b] += ...; the inner loop of rendering
  void apply(std::span<const double> in, std::span<double> out) const;
  double weight(size_t band, size_t bin) const;

 private:
  struct Row {
    uint32_t first = 0;   // bin
    uint32_t offset = 0;  // of its weights
    uint32_t count = 0;
  };
  std::vector<double> shares_of(const SpectralState& state, const Band& band, size_t& first) const;
  void add_row(size_t first, std::vector<double> weights);
  std::vector<Row> rows_;
  std::vector<double> weights_;
  bool identity_ = true;
};

}  // namespace suite
