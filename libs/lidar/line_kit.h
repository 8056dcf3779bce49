// A scene baked for one laser line: what all threads share.
#pragma once
#include <memory>

#include "light/environment.h"
#include "surface/optics.h"
#include "surface/surface.h"
#include "trace/tracer.h"

namespace suite {

class LineKit {
 public:
  // Keeps a reference to the tracer. passive: resolved; time: s, at which an even ground under real air is looked at.
  // Temperatures that follow from loads do not glow. Error: what cannot be baked for the wavelength.
  LineKit(const Tracer& tracer, const SourceSpecs& passive, double wavelength_um, double width_um, TimeSpan window);

  const Optics optics;
  const Surface surface;
  const Environment environment;  // passive light
  double wavelength_um;
  double photons_of_joule;
  // Whether anything shines but the laser.
  bool shines() const;
  // Whether a medium (number of Optics::media()) is leaves.
  bool leaves(size_t medium) const;
  bool any_leaves() const;

 private:
  static SpectralState state_of(double wavelength_um, double width_um);
  Environment bake(const Tracer& tracer, SourceSpecs passive, double time) const;
};

}  // namespace suite
