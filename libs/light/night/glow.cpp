#include "light/night/glow.h"

#include "spectral/photopic.h"

namespace suite {

double GlowSpectrum::mean(double low_um, double high_um) const {
  double in_lines = 0;
  for (const Line& line : lines)
    if (line.wavelength_um >= low_um && line.wavelength_um < high_um) in_lines += line.power;
  return smooth.mean(low_um, high_um) + in_lines / (high_um - low_um);
}

GlowSpectrum GlowSpectrum::scaled(double factor) const {
  GlowSpectrum s{smooth.scaled(factor), lines};
  for (Line& line : s.lines) line.power *= factor;
  return s;
}

double GlowSpectrum::photopic() const {
  double sum = suite::photopic(smooth);
  for (const Line& line : lines) sum += photopic_weight(line.wavelength_um) * line.power;
  return sum;
}

double GlowSpectrum::scotopic() const {
  double sum = suite::scotopic(smooth);
  for (const Line& line : lines) sum += scotopic_weight(line.wavelength_um) * line.power;
  return sum;
}

}  // namespace suite
