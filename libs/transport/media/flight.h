// One flight of a path through media and the layers of the air: how far it gets before it is scattered, what the way
// does to every wavelength, and what shines on the way.
//
// Only scattering ends a flight; absorption weakens it. With s_k(x) the scattering coefficient at knot k, t_k(t) its
// integral over the way and a(t) that of absorption, a flight drawn at knot h has the density
//   p_h(t) = s_h exp(-t_h(t)) of being scattered at t,     P_h = exp(-t_h(T)) of reaching the end T,
// and weighs wavelength i by exp(-a_i - t_i) / p_h. The densities of all knots join the one-sample balance heuristic of
// shares.h; after each flight the r_k and the spectrum are divided by A = sum P_k r_k, so that A = 1 and neither
// overflows on walks of any length. Emission is an expectation over the flight: from a stretch of constant
// contents
//   (1 - exp(-da_i)) J_i / a_i exp(-a_i(begin)) R_i,   R_i = exp(-t_i) / sum P_k r_k exp(-t_k),
// with R taken at a place drawn from the stretch's own emission; R = 1, and nothing is left to chance, where scattering
// does not depend on wavelength. An isothermal medium so returns B(T) without noise. The air only weakens flights,
// exactly for every bin, and shines (air_light.h); it has no part in t and R.
// Based on: B. Miller, I. Georgiev, W. Jarosz, "A null-scattering path integral formulation of light transport", ACM
// TOG 38(4), 2019 (spectral weights; null collisions are not needed where optical depths are sums); Wilkie et al. 2014.
#pragma once
#include <span>

#include "surface/optics.h"
#include "transport/media/air_light.h"
#include "transport/media/field.h"
#include "transport/media/live_path.h"

namespace suite {

class Flights {
 public:
  // Keeps references. knot_probability: P_k. air: null where there is none.
  Flights(const VolumeField& field, const Optics& optics, std::span<const double> knot_probability,
          const Atmosphere* air = nullptr);

  // How far a flight gets, and what it makes of the path behind it.
  struct Result {
    bool scattered = false;
    double distance = 0;  // m from the origin of the flight
    double scale = 1;     // the path's weight is multiplied by scale and, if `dense`, by `through`
    bool dense = false;   // `through` has been filled
    bool emits = false;   // `emitted` has been filled
  };
  // Flies path `live` from its origin along its direction to at most `length` in `background`. through: receives what
  // the way does to every bin (without the scattering coefficient of the bin where it is scattered); emitted: the
  // light of the way as seen from its start. u: numbers in [0, 1) for the way and for what shines on it.
  // airless: there is none of the air on the way.
  Result fly(LivePath& live, double length, uint32_t background, bool airless, Vec2 u, std::span<float> through,
             std::span<float> emitted);
  // Where the last flight was scattered.
  const std::vector<Constituent>& contents() const { return walk_.contents(); }

  // Adds each medium's density, integrated along a way, to depth[medium].
  void add_depths(const Ray& ray, double length, uint32_t background, std::span<double> depth);
  // exp(-extinction) for such depths; false, and nothing written, when they are all 0.
  bool transmittance(std::span<const double> depth, std::span<float> transmission) const;

 private:
  double pass_lone(const LivePath& live, double left, double u, std::span<float> emitted);
  bool same_run() const;
  void begin_run(const LivePath& live);
  void end_run(const LivePath& live, double u, std::span<float> emitted);
  bool run_shines() const;
  void emit(const LivePath& live, double u, std::span<float> emitted);
  void media_emission();
  void emit_media(double u);
  void set_places(const LivePath& live, double share);
  double ratio(size_t bin, double share) const;
  double scattering_depth(size_t bin) const;
  void set_whole(const LivePath& live, double length, uint32_t background);
  double combined(const LivePath& live, size_t knot, bool scattered) const;
  void weigh(LivePath& live, std::span<float> through);
  double join_knots(LivePath& live, bool scattered, double own_rate);
  bool emits(const Constituent& c) const;

  const VolumeField& field_;
  const Optics& optics_;
  std::span<const BakedMedium> media_;
  std::vector<size_t> bins_of_knots_;
  std::vector<double> probability_;
  bool any_emission_ = false;
  std::vector<uint8_t> absorbs_;  // per medium
  FieldWalk walk_;
  std::vector<double> depth_;    // per medium: density integrated so far
  std::vector<double> whole_;    // the same over the whole way
  double scattered_[kMaxKnots];  // probability of being scattered on it, where the path is one of two branches
  AirLight air_;
  bool airy_ = false;  // on the flight under way there may be air
  // Stretches alike in a row.
  std::vector<Constituent> run_;      // density holds the integral
  std::vector<Constituent> stretch_;  // the first of them, where there is air
  uint32_t run_layer_ = kNone;
  double run_length_ = 0;  // m
  // Scratch, per bin: depth and emission of the media in the run; what shines in it, and where from, 0..1.
  std::vector<float> tau_, emission_;
  std::vector<double> sent_, place_;
  struct Knot {
    double share;           // P_k r_k
    double before, within;  // depth of scattering up to the run and in it
  };
  std::vector<Knot> knots_;
  // exp(-offset) times: sum P_k r_k exp(-t_k) at a place in the run, minus its derivative, and its second derivative.
  struct Mean {
    double place = 0, offset = 0, sum = 0, slope = 0, bend = 0;
    double most = 0;  // depth of scattering in the run at a knot
  } mean_;
  Result result_;  // of the flight under way
};

}  // namespace suite
