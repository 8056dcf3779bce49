// The air along a flight through media (flight.h): it dims what the media emit and what comes from behind, and
// sends light of its own that the media dim.
//
// With T and S the air's transmittance and path radiance from the start of the flight to a place (atmosphere.h), a_i
// and t_i depths of absorption and scattering of the media up to there, J_i their emission a metre, and
//   W_i = exp(-a_i - t_i) / sum P_k r_k exp(-t_k)       (exp(-a_i) where scattering does not depend on wavelength),
// a flight over d gathers, by parts in S,
//   integral W_i dS_i + integral W_i T_i J_i ds
//     = W_i(d) S_i(d) + T_i(e) integral W_i J_i ds + integral ( -S_i dW_i/ds + W_i (T_i - T_i(e)) J_i ) ds.
// The first two are known: the air in closed form, the media's emission by Flights, e being where they begin to emit.
// The last one, which is small where media are thin or little air lies along them, is asked at one place, drawn from
// the absorption of a bin drawn at random and weighed by the mean over all bins (balance heuristic). A flight that is
// only scattered, alike at all wavelengths, needs no such place.
// The air fills bodies, too: what it does within metres of glass or water is below its own accuracy.
#pragma once
#include <span>
#include <vector>

#include "light/atmosphere.h"
#include "surface/optics.h"
#include "transport/media/field.h"
#include "transport/media/live_path.h"

namespace suite {

class FlightAir {
 public:
  // Keeps references. air: may be null, then nothing else may be called. knot_probability: P_k.
  FlightAir(const Atmosphere* air, const VolumeField& field, const Optics& optics,
            std::span<const double> knot_probability);
  bool any() const { return air_ != nullptr; }

  // A flight begins at the path's place. It and beta must not change before finish().
  void begin(const LivePath& live) { live_ = &live, emits_ = false; }
  // T(e): something on the way emits, for the first time at a distance, m.
  std::span<const float> reference(double distance);
  // The flight has ended after a distance with these depths (density integrated, per medium), in `background` at a
  // time. gathered receives the sum above without its second part; beta is dimmed. u: a number in [0, 1).
  void finish(double distance, std::span<const double> depth, uint32_t background, double time, double u,
              std::span<float> beta, std::span<float> gathered);

 private:
  bool dimmed(std::span<const double> depth) const;
  double coefficient(size_t medium, size_t bin) const;
  void depths_of_bins(std::span<const double> media, std::span<double> bins) const;
  struct Mixture {
    double sum, offset;
    double fall;  // -d/ds of its logarithm, where the scattering rates of the place are given, 1/m
  };
  Mixture mixture(std::span<const double> media, std::span<const double> rates) const;
  bool draw(double length, uint32_t background, double time, double u);
  void add_place(std::span<const float> beta, std::span<float> gathered);

  const Atmosphere* air_;
  const VolumeField& field_;
  const Optics& optics_;
  std::vector<double> probability_;
  const LivePath* live_ = nullptr;
  bool emits_ = false;
  FieldWalk walk_;
  double place_ = 0;                    // the place drawn, m from the start
  std::vector<Constituent> contents_;   // there
  std::vector<double> before_, there_;  // per medium: depth up to the place; density there
  size_t weakened_ = 0;                 // bins with a depth
  std::vector<double> whole_, to_, c_;  // per bin: depths of the flight and up to the place; the latter's slope
  std::vector<float> T_, S_, reference_, behind_;  // of the air; behind_: T of the whole flight
};

}  // namespace suite
