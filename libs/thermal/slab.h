// Temperatures in a slab of plane layers: heat conduction in depth, radiation, convection and absorbed light at its
// faces. Stiff by nature (a film reacts in milliseconds, the ground in weeks), so the time steps are implicit.
//
// Assumes: one dimension; materials without phase change; faces grey in the thermal infrared.
// Method: finite volumes around nodes, conserving heat to rounding: nodes lie on the faces and on every layer contact;
// between two nodes the flux is the integral of k(T) over their temperatures by their distance, exact when steady. In
// time TR-BDF2, second order, L-stable, with an embedded third-order estimate; its stages are written in the stored
// heat, so that heat is conserved with c(T) too. Based on: M. E. Hosea, L. F. Shampine, "Analysis and implementation of
// TR-BDF2", Appl. Num. Math. 20, 1996; finite volumes after S. V. Patankar, "Numerical heat transfer and fluid flow",
// 1980, chapter 4; k(T) integral: Kirchhoff 1894.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "thermal/loads.h"
#include "thermal/slab_grid.h"

namespace suite {

// One face of the slab.
struct SlabFace {
  enum class Kind {
    surface,      // radiation, convection and absorbed light by `loads`
    flux,         // `value` W/m2 into the slab
    temperature,  // `value` K
  } kind = Kind::flux;
  double emissivity = 0.95;     // surface: 0..1
  double convection_still = 0;  // surface: W/(m2 K) in still air, >= 0
  double convection_wind = 0;   // surface: W/(m2 K) per m/s of wind, >= 0
  Loads loads;                  // surface
  TimeFunction value;           // flux, temperature
};

struct SlabSpec {
  std::vector<SlabLayer> layers;  // from the top down
  SlabFace top, bottom;           // bottom flux: positive upwards into the slab
};

struct SlabOptions {
  double tolerance = 0.01;  // K, bound of the estimated error of one step
  double max_step = 3600;   // s
  double min_step = 1e-9;   // s; below it the solver gives up with an Error
  double most_steps = 2e6;  // of one advance(); beyond, the solver gives up with an Error
  double resolution = 60;   // s: automatic grids resolve what diffuses within this time
};

class Slab {
 public:
  // Error: no layer; thickness, density, conductivity or specific heat not positive; emissivity outside 0..1; negative
  // convection, resistance or tolerance; a face without its function; more than 100 000 nodes.
  Slab(SlabSpec spec, SlabOptions options);

  // Sets time (s) and temperature (K): one for all nodes, or one a node. Error: not within 1..10000 K.
  void start(double t, double kelvin);
  void start(double t, std::span<const double> kelvin);

  // Goes on to time t (s, not before the present) with steps chosen by the estimated error. Error: the loads give what
  // is no load, no step down to min_step succeeds, or there would be more than most_steps.
  void advance(double t);
  // One step of the given length (s, > 0) whatever its error; false (and no change) when Newton's method does not
  // converge or a temperature leaves 0..1e4 K, as it can far from balance with steps far beyond the time constants.
  // estimate: of the step's error, K.
  bool step(double dt, double* estimate = nullptr);

  double time() const { return t_; }
  double surface() const { return T_.front(); }  // K, top face
  double bottom() const { return T_.back(); }
  double at_depth(double z) const;  // K, z in m within the slab (clamped), linear between nodes
  std::span<const double> kelvin() const { return T_; }
  std::span<const double> depths() const {
    return grid_.depth;
  }                                                 // m, of the nodes; a resistive contact has two at one depth
  std::span<const double> heat_capacities() const;  // J/(m2 K) of the nodes at present

  // Flux downwards through every interval between nodes, W/m2, as a mean over the time since reset_means(), weighted as
  // the time scheme weighs it: over a period of a periodic state it is the same at every depth to rounding.
  void reset_means();
  std::vector<double> mean_fluxes() const;

  struct Counters {
    long long steps = 0, rejected = 0, eliminations = 0;
  };
  const Counters& counters() const { return counters_; }
  // Lengths of accepted steps, recorded while on.
  void record_steps(bool on) { recording_ = on, recorded_.clear(); }
  const std::vector<double>& recorded_steps() const { return recorded_; }

 private:
  struct FaceNow {  // flux into the slab = constant - linear T - quartic T^4, or a fixed temperature
    bool fixed = false;
    double kelvin = 0, constant = 0, linear = 0, quartic = 0;
    double flux(double T) const { return constant - T * (linear + quartic * T * T * T); }
    double slope(double T) const { return -(linear + 4 * quartic * T * T * T); }
  };
  struct Stage {                              // of one time within a step
    std::vector<double> T, heat, flux, gain;  // K, J/m2 a node; W/m2 an interval; W/m2 a node
  };
  void check() const;
  FaceNow face_at(const SlabFace& face, double t) const;
  double capacity_of(size_t node, double T) const;
  void evaluate(Stage& s, const FaceNow& top, const FaceNow& bottom) const;
  void set_newton_matrix(const Stage& s, double scale, const FaceNow& top, const FaceNow& bottom);
  void factor_linear(double scale);
  bool solve_linear(std::span<const double> history, double scale, const FaceNow& top, const FaceNow& bottom, Stage& s);
  bool solve_newton(std::span<const double> history, double scale, const FaceNow& top, const FaceNow& bottom, Stage& s);
  bool solve(std::span<const double> history, double scale, double t, Stage& s);
  double filtered_error(double dt, double t_end);
  void guess_middle(double dt);
  void guess_end(double dt);
  bool attempt(double dt, double& error);  // into end_
  void accept(double dt);                  // end_ becomes the present

  SlabSpec spec_;
  SlabOptions options_;
  bool linear_ = false;  // constant properties and a bottom without radiation: one elimination a stage
  double t_ = 0, next_step_ = 0;
  SlabGrid grid_;
  std::vector<double> T_, heat_;  // K, conserved heat in J/m2
  Stage now_, middle_, end_;
  // Elimination from the bottom up, for one product of stage weight and step.
  double factored_for_ = -1;
  std::vector<double> pivot_, up_, down_, right_, diagonal_, lower_, upper_, history_;
  double top_diagonal_ = 0;
  std::vector<double> rate_, bend_;  // K/s, K/s2 at the end of the last step, for guesses; used while last_step_ > 0
  double last_step_ = 0;
  std::vector<double> flux_sum_;
  double sum_time_ = 0;
  Counters counters_;
  bool recording_ = false;
  std::vector<double> recorded_;
  mutable std::vector<double> capacities_;
};

// Finding the state that repeats after a period of the loads.
struct SpinUpOptions {
  double tolerance = 1e-4;  // K: largest change of any node over a period
  int max_periods = 500;
};
struct SpinUpResult {
  int periods = 0;            // simulated
  double change = 0;          // K over the last period
  std::vector<double> steps;  // of that period
};
// Starts at (t0, the slab's present temperatures) and leaves the slab at t0 + period in the periodic state, with the
// means of the last period. The period is first run with adaptive steps, then its steps are kept and the fixed point of
// the period map is found by Anderson's acceleration; then the steps are chosen anew from there and it is found again.
// Error: no convergence within max_periods.
// Based on: D. G. Anderson, "Iterative procedures for nonlinear integral equations", J. ACM 12(4), 1965.
SpinUpResult spin_up(Slab& slab, double t0, double period, const SpinUpOptions& options);

}  // namespace suite
