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
  struct Line {
    double wavelength_um, width_um;
    double filter_um;  // full width of what passive light comes through
  };
  // Keeps a reference to the tracer. passive: resolved; time: s, at which an even ground under real air is looked at.
  // Lights have their mean over the filter; those that real air is given beams of, the air and all matter are those of
  // the line. Temperatures that follow from loads do not glow. Error: what cannot be baked for the wavelength.
  LineKit(const Tracer& tracer, const SourceSpecs& passive, const Line& line, TimeSpan window);

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
  // Whether a surface turns light like a mirror or a pane.
  bool any_smooth() const;

 private:
  Environment bake(const Tracer& tracer, SourceSpecs passive, const Line& line, double time) const;
};

}  // namespace suite
