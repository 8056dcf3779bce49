// Particles as a user knows them: numbers over wavelengths, measured or computed elsewhere, in place of a named kind.
//
// Between wavelengths as between those of the named kinds: logarithms of extinction and of what is absorbed over the
// logarithm of the wavelength; phase functions mixed by what they scatter, the nearest one outside of theirs.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "air/particles.h"

namespace suite {

struct ParticleData {
  std::string name;                        // for messages
  bool relative = true;                    // extinction is over that at 0.55 um; else m2/kg
  std::vector<double> wavelengths_um;      // ascending, two at least
  std::vector<double> extinction, albedo;  // at these
  std::vector<double> phase_um;            // ascending, one at least
  std::vector<std::vector<double>> phase;  // at these, over phase_cosines(), 1/sr
  // Scattering matrices over P11, likewise; empty: not known.
  std::vector<std::vector<PlaneBlocks>> matrices;

  double extinction_at(double wavelength_um) const;
  double albedo_at(double wavelength_um) const;
  // 0.55 um lies within its wavelengths.
  bool reaches_green() const;
  // What one unit of it has at 0.55 um: 1, or m2/kg; nothing when it does not say.
  std::optional<double> green() const;
  // The wavelengths lie within its own. Error: as ParticleOptics::add.
  ParticleOptics optics(std::span<const double> at_um) const;

 private:
  // What each entry of `phase` counts at a wavelength: use(entry, weight).
  template <class Use>
  void each_phase(double wavelength_um, const Use& use) const;
  std::vector<PlaneBlocks> matrices_at(double wavelength_um) const;
};

// The same with its extinction over that at 0.55 um. Error: that is 0 or unknown.
ParticleData relative(ParticleData data);

}  // namespace suite
