// The air's part in the light of a flight through media (flight.h), run by run: how it dims the flight, and what shines
// in it.
//
// Along a run of constant contents everything that shines falls off exponentially as seen from the start of the flight,
// by absorption in the media, by extinction in the air and, for light that the air scatters once out of a beam, by the
// growth of the beam's own depth. So each *part*, which is what is warm or one of the beams, sends the closed form
//   T l e exp(-t) (1 - exp(-x)) / x,
// with T what is left of light from the begin of the run, l its length, e emission a metre, t depth of the beam there
// (0 for what is warm) and x the growth of all depths along the run. The air neither ends flights nor turns them.
// The air fills bodies, too: what it does within metres of glass or water is below its own accuracy.
#pragma once
#include <span>
#include <vector>

#include "light/atmosphere.h"
#include "scene/scene.h"

namespace suite {

class AirLight {
 public:
  // air: may be null, then nothing but any(), bounds() and parts() may be asked. Keeps a reference.
  AirLight(const Atmosphere* air, size_t bins);
  bool any() const { return air_ != nullptr; }
  std::span<const double> bounds() const { return air_ ? air_->bounds() : std::span<const double>{}; }
  size_t parts() const { return 1 + beams_.size(); }

  void begin();
  // The next run goes on from `from` in a direction, in a layer or, kNone, outside the air.
  void enter(uint32_t layer, Vec3 from, Dir direction);
  // What a part sends from the run, whose media have these depths of absorption, and emission times length (0 for
  // beams: what is warm is part 0). fall: x; sent: the closed form. Per bin.
  void shine(size_t part, double length, std::span<const float> depth, std::span<const float> emission,
             std::span<float> fall, std::span<double> sent) const;
  // Leaves the run.
  void pass(double length, std::span<const float> depth);
  // exp(-extinction) of the air so far.
  void transmittance(std::span<float> T) const;

 private:
  struct Part {
    std::vector<float> scattered, depth, slope;  // Atmosphere::BeamAlong
  };
  const Atmosphere* air_;
  uint32_t layer_ = kNone;
  Vec3 from_;                  // where the run begins
  std::vector<Part> beams_;    // at the begin of the run
  std::vector<float> left_;    // T
  std::vector<float> passed_;  // extinction of the air so far
};

}  // namespace suite
