// The air's part in the light of a flight through media (flight.h), run by run: how it dims the flight, and what shines
// in it.
//
// Along a run of constant contents everything that shines falls off exponentially as seen from the start of the flight,
// by absorption in the media, by extinction in the air and, for light that the air scatters once out of a beam, by the
// growth of the beam's own depth. So each part, which is what is warm or one of the beams, sends the closed form
//   T l e exp(-t) (1 - exp(-x)) / x,
// with T what is left of light from the begin of the run, l its length, e emission a metre, t depth of the beam there
// (0 for what is warm) and x the growth of all depths along the run. The air neither ends flights nor turns them.
// The air fills bodies of index 1, too, clouds and leaves, but none that refract.
#pragma once
#include <span>
#include <vector>

#include "light/atmosphere.h"
#include "scene/scene.h"

namespace suite {

// Draws a place in 0..1 with a density that falls as exp(-fall place), or rises where fall < 0. u: in [0, 1).
double place_in_fall(double u, double fall);

class AirLight {
 public:
  // air: may be null, then nothing but any() and shells() may be asked. Keeps a reference.
  AirLight(const Atmosphere* air, size_t bins);
  bool any() const { return air_ != nullptr; }
  const Shells* shells() const { return air_ ? &air_->shells() : nullptr; }

  void begin();
  // The next run goes on from `from` in a direction, in a layer or, kNone, outside the air.
  void enter(uint32_t layer, Vec3 from, Dir direction);
  // Passes the run, whose media have these depths of absorption, and emission times length if nothing weakens it.
  // sent: the sum of the closed forms. place: unless empty, receives where in the run, 0..1, light is drawn to come
  // from, in proportion to what it brings. u: number in [0, 1). Per bin.
  void pass(double length, std::span<const float> depth, std::span<const float> emission, double u,
            std::span<double> sent, std::span<double> place);
  // exp(-extinction) of the air so far.
  void transmittance(std::span<float> T) const;
  // The same of a flight that has got outside, where beams are bent; else T stays.
  void bend(Vec3 from, Dir direction, std::span<float> T) const;

 private:
  struct Scattered {
    std::vector<float> light, depth, slope;  // Atmosphere::BeamAlong
    std::vector<float> near;                 // exp(-depth)
  };
  void add_warm(float way, std::span<const float> depth, std::span<const float> emission, std::span<double> sent);
  void add_beam(Scattered& beam, float way, std::span<double> sent, std::span<double> left_to_draw);

  const Atmosphere* air_;
  uint32_t layer_ = kNone;
  std::span<const float> extinction_;  // of the layer
  std::vector<float> source_;          // of the layer along the ray
  std::vector<Scattered> beams_;       // at the begin of the run
  std::vector<float> left_;            // T
  std::vector<float> passed_;          // extinction of the air so far
  std::vector<float> grow_;            // growth of depth along the run, and
  std::vector<float> keep_;            // exp(-that)
  std::vector<float> fall_;            // x of the part that a place is drawn from
};

}  // namespace suite
