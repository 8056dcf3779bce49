// Point-spread functions in the focal plane, drawn from: where the light that should fall on a place falls instead.
//
// Based on: M. Born, E. Wolf, "Principles of Optics", section 8.5.2 and 8.6.2 (Airy pattern, annular aperture);
// G. D. Boreman, "Modulation Transfer Function in Optical and Electro-Optical Systems", 2001.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "base/params.h"
#include "sensor/sensors.h"
#include "spectral/state.h"

namespace suite {

// Immutable; all members may be called from many threads.
class PointSpread {
 public:
  virtual ~PointSpread() = default;
  // An offset in the focal plane, m, from three uniform numbers (two for the place, one for the wavelength).
  virtual Vec2 sample(double u, double v, double which) const = 0;
  // True when the pattern depends on wavelength: offsets are drawn from the mixture over the bins of the state, and
  // weights() gives, per bin, the density of an offset at that wavelength over the mixture's.
  virtual bool spectral() const { return false; }
  virtual void weights(Vec2 offset, std::span<float> per_bin) const;
  // The same pattern over the bins of another state; null when it is the same for all wavelengths.
  virtual std::unique_ptr<PointSpread> with_bins(const SpectralState&) const { return nullptr; }
  // Share of the light that is cut off far out and spread over the rest.
  virtual double cut() const { return 0; }
};

// sigma: m, > 0. Never cut.
std::unique_ptr<PointSpread> gaussian_spread(double sigma);

// Diffraction by a circular aperture with a central obscuration (share of the diameter, 0..0.95), for every bin of a
// state. tail: share of the light beyond the radius at which the pattern is cut, 1e-4..0.1. The pattern is cut at the
// same multiple of wavelength x f-number for all wavelengths.
std::unique_ptr<PointSpread> airy_spread(double f_number, double obscuration, double tail, const SpectralState& state);

// A picture whose values are relative irradiance in cells of `cell` x `cell` m, its middle at offset 0; columns to the
// right, rows downwards. Error: no light, a negative value.
std::unique_ptr<PointSpread> image_spread(const GreyImage& picture, double cell);

// The radially symmetric pattern with a modulation transfer function given at ascending frequencies (cycles/m), linear
// between, 0 beyond the last; by Hankel transform. Error: it does not start at 1 at frequency 0, leaves 0..1, or
// belongs to a pattern of which more than `most_negative` of the light is negative.
std::unique_ptr<PointSpread> mtf_spread(const std::vector<double>& frequency, const std::vector<double>& mtf,
                                        double most_negative = 0.01);

// Reads key `psf` ({kind: gaussian | airy | image | mtf, ...}; see SENSORS.md); null when absent. f_number 0 = unknown.
std::unique_ptr<PointSpread> read_psf(const Params& params, const SensorContext& context, double f_number,
                                      double obscuration, const SpectralState& state);

}  // namespace suite
