// Throughputs of paths that carry polarisation: the spectra of throughput.h by intensities alone (m11 of every event),
// and beside them, for every path, the product of the events' Mueller matrices over their m11, from the sensor to where
// the path has come. With R that product and s the light that arrives over its intensity, the Stokes vector that the
// sensor gets is
//   T (R s),   T the spectrum.
// Matrices stand between meridian frames of the world (math/mueller.h). Where no event of a path tells wavelengths
// apart there is one product for all of them.
#pragma once
#include <vector>

#include "math/mueller.h"
#include "transport/throughput.h"

namespace suite {

class StokesThroughputs : public SpectralThroughputs {
 public:
  using Polarised = void;  // the kernel is to tell matrices
  StokesThroughputs(size_t width, size_t bins, size_t targets);

  // Beside begin(): the sensor's own matrix, from the meridian frame of the light that arrives to what it measures.
  void begin_rows(uint32_t p, const Mueller& sensor);
  void scatter(uint32_t p, const Factor& w, const Event& event) {
    SpectralThroughputs::scatter(p, w, event);
    if (event.polarised) multiply(p, *event.polarised);
  }
  struct Kept : SpectralThroughputs::Kept {
    std::vector<Mueller> rows;  // one for all bins, or one a bin
    float unknown = 0;
  };
  void keep(uint32_t p, float share, Kept& to);
  void resume(uint32_t p, const Kept& from);
  // The path's light goes to the targets: component k of the Stokes vector to targets[k], kNone = to none.
  struct Targets {
    uint16_t of[4];
  };
  void shine_stokes(const Contribution& c, float scale, const Targets& targets);
  // The Stokes vector, over the intensity of the path and the factor alone, that light makes at the sensor in a bin.
  // light: over its intensity, in the meridian frame of the way on which it comes to the last event.
  Stokes seen(const Contribution& c, size_t bin, const Stokes& light) const;
  // Share of a contribution's light that has passed something of which no matrix is known.
  float unknown(const Contribution& c) const {
    const float beside = c.polarised ? c.polarised->unknown : 0;
    return 1 - (1 - unknown_[c.path]) * (1 - beside) * (1 - c.unknown);
  }

 private:
  void multiply(uint32_t p, const PolarisedEvent& event);

  std::vector<Mueller> rows_;   // [path][bin]
  std::vector<uint8_t> grey_;   // [path] the first holds for all bins
  std::vector<float> unknown_;  // [path]
  std::vector<float> spectrum_;
};

}  // namespace suite
