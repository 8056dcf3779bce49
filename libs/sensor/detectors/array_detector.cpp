#include "sensor/detectors/array_detector.h"

#include <algorithm>
#include <cmath>

#include "math/variates.h"

namespace suite {

Character character_of(const DetectorSpec& spec, const DetectorSite& site) {
  Pcg32 random(hash_of(spec.seed, 0x706978656cull), site.number);
  Character c;
  const double kind = random.uniform();
  c.dead = kind < spec.dead;
  c.hot = !c.dead && kind < spec.dead + spec.hot;
  c.response = std::max(0.0, 1 + spec.nonuniformity * normal(random));
  c.dark = std::max(0.0, 1 + spec.dark_nonuniformity * normal(random));
  c.dead = c.dead || site.dead;
  c.hot = c.hot && !c.dead;
  return c;
}

double collected(const DetectorSpec& spec, const Character& of, double signal, double exposure) {
  return std::max(0.0, signal) * of.response + spec.dark_current * of.dark * exposure;
}

double most_counts(const DetectorSpec& spec) { return std::ldexp(1.0, spec.bits) - 1; }

Converted convert(const DetectorSpec& spec, double charge) {
  const double counts = std::round(charge / spec.gain + spec.bias), most = most_counts(spec);
  return {std::clamp(counts, 0.0, most), counts < 0 || counts > most};
}

ArrayReading empty_reading(size_t detectors, bool dn, bool counts) {
  ArrayReading r;
  if (dn) r.dn.assign(detectors, 0);
  if (counts) r.counts.assign(detectors, 0);
  r.clipped.assign(detectors, 0);
  return r;
}

}  // namespace suite
