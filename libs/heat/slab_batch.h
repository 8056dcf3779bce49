// Heat conduction through one construction for many elements at once, which differ by what acts on their faces. All
// elements take the same steps, so that they share one elimination, and lie beside each other in memory, so that every
// loop runs over elements in the machine's vectors.
//
// Assumes: as Slab; faces that exchange by lines of temperature and T^4, which is solved implicitly.
// Method: the volumes and the time scheme of Slab (finite volumes, TR-BDF2, L-stable, second order). With properties
// that do not depend on temperature the nodes between the faces are eliminated once a step length; what is left are two
// equations an element in the temperatures of its faces, solved by Newton's method, which converges from any start
// because both are increasing and convex. With other properties Newton's method takes all nodes and an elimination an
// element and turn. Elements that conduct to each other along the surface are solved together (slab_batch_lateral.h).
#pragma once
#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "heat/averaged_table.h"
#include "heat/slab_neighbours.h"
#include "thermal/slab_grid.h"
#include "thermal/step_control.h"

namespace suite {

// What acts on one face of every element through a step: flux into the slab = constant - linear T - quartic T^4. One
// entry an element. All zero: a face without exchange.
struct FaceLines {
  std::vector<StepLine> constant;  // W/m2
  std::vector<StepLine> linear;    // W/(m2 K), >= 0
  std::vector<double> quartic;     // W/(m2 K4), >= 0: emissivity times Stefan and Boltzmann's constant
  explicit FaceLines(size_t elements = 0) : constant(elements), linear(elements), quartic(elements) {}
};
// A temperature that is held is a film so conductive that it makes no difference: W/(m2 K).
inline constexpr double kHeldFilm = 1e8;

class SlabBatch;
// Fills both faces for the step from begin to end (s); the batch still is in the state at `begin`. Lines are to be
// averages over the step (AveragedTable).
using BatchLoads =
    std::function<void(double begin, double end, const SlabBatch& batch, FaceLines& top, FaceLines& bottom)>;

struct SlabBatchOptions {
  double resolution = 60;                                 // s: automatic grids resolve what diffuses within this time
  bool fast_below = false;                                // the bottom face changes as fast as the top one
  std::shared_ptr<const SlabNeighbours> neighbours = {};  // of its elements; none: each conducts for itself
  double left = 1e-11;  // of what neighbours give each other, where a step ends its search; energy is kept that well
};

class SlabBatch {
 public:
  // Error: layers as in Slab, no element, neighbours of other ones.
  SlabBatch(std::vector<SlabLayer> layers, size_t elements, SlabBatchOptions options = {});

  // Sets time (s) and temperature (K) of all nodes. Error: not within 1..10000 K.
  void start(double t, double kelvin);
  // Sets the time alone: the same temperatures begin another period.
  void restart(double t) { t_ = t; }
  // Gives memory back that the next step takes again.
  void rest() { std::vector<Lanes>().swap(end_); }
  void set_kelvin(size_t element, size_t node, double kelvin);

  // One step (s, > 0) of all elements; one after which an element would hold less than no heat is taken in parts, or,
  // where these find none either (loads below 0), as it is.
  // Error: loads that are not finite, or negative where they must not be; no temperature above 0 K.
  void step(double dt, const BatchLoads& loads);
  // Goes on to time t with steps whose largest estimate of all elements keeps to `control`; appends them to `steps`
  // when given. Error: as advance_by_error.
  void advance(double t, const BatchLoads& loads, const StepControl& control, std::vector<double>* steps = nullptr);

  double time() const { return t_; }
  size_t elements() const { return elements_; }
  size_t nodes() const { return grid_.depth.size(); }
  const SlabGrid& grid() const { return grid_; }  // of a square metre
  // The grid with conductances and capacities as they are at the element's present temperatures in place of the
  // constant coefficients; uses the buffer when it has to.
  const SlabGrid& linearised(size_t element, SlabGrid& buffer) const;
  double kelvin(size_t element, size_t node) const { return now_[index(element, node)].get(element % kLanes); }
  double top(size_t element) const { return kelvin(element, 0); }
  double bottom(size_t element) const { return kelvin(element, nodes() - 1); }
  // Of the last step: means of the face temperatures as the scheme weighs time, the lines that acted, and the estimated
  // error an element (K, largest of its nodes).
  double top_mean(size_t element) const { return top_mean_[element]; }
  double bottom_mean(size_t element) const { return bottom_mean_[element]; }
  const FaceLines& top_lines() const { return top_lines_; }
  const FaceLines& bottom_lines() const { return bottom_lines_; }
  double estimate(size_t element) const { return estimate_[element]; }

  // Of batches whose elements have neighbours, [element][node]: solves (capacity C + weight (K + L + faces)) x = right
  // in place, C the heat capacities, K and L conduction in depth and to neighbours at the present temperatures, slopes
  // of the faces in W/(m2 K) by element; adds to a gain (W/m2) what neighbours bring at temperatures x.
  bool has_neighbours() const { return neighbours_ != nullptr; }
  void solve_lateral(double capacity, double weight, std::span<const double> top, std::span<const double> bottom,
                     std::vector<double>& x) const;
  void add_from_neighbours(const std::vector<double>& x, std::vector<double>& gain) const;

  struct Counters {
    long long steps = 0, rejected = 0, eliminations = 0;
  };
  const Counters& counters() const { return counters_; }

 private:
  static constexpr size_t kLanes = 16;  // elements that go together: four vectors of four
  // A vector of the machine where it has them (GCC and Clang: vector extensions; loops over doubles were vectorised the
  // wrong way round, along nodes).
  typedef double Four __attribute__((vector_size(32)));
  static constexpr size_t kVectors = kLanes / 4;
  struct Lanes {
    Four v[kVectors] = {};
    Lanes() = default;
    explicit Lanes(double all) {
      for (Four& four : v) four = Four{} + all;
    }
    double get(size_t l) const { return v[l / 4][l % 4]; }
    void set(size_t l, double x) { v[l / 4][l % 4] = x; }
    double largest() const;
  };
  // Both faces of the elements of a block at one moment of the step.
  struct Faces {
    struct One {
      Lanes constant, linear, quartic;
    };
    One top, bottom;
  };
  struct FaceEnds {  // at both ends of the step
    Faces begin, end;
    Faces at(double fraction) const;
  };
  // Of one product of stage weight and step. Eliminating nodes upwards: right'[i] = right[i] - up[i] right'[i+1]; a
  // node between the faces is own[i] + beta[i] top + gamma[i] bottom, own[i] = pivot[i] right'[i] - down[i] own[i-1].
  struct Elimination {
    double scale = -1, top_diagonal = 0, bottom_diagonal = 0, coupling = 0, bottom_conductance = 0;
    std::vector<double> up, down, pivot, beta, gamma;
  };
  struct Row {
    Lanes lower, diagonal, upper;
  };
  size_t index(size_t element, size_t node) const { return element / kLanes * nodes() + node; }
  void eliminate(double scale);
  void check_lines(const FaceLines& lines, const char* which) const;
  FaceEnds gather(size_t block) const;
  Lanes rise(Lanes* right) const;
  void fall(const Lanes* right, const Lanes& top, const Lanes& bottom, Lanes* kelvin) const;
  void solve_faces(const Lanes* right, const Lanes& own, const Faces& faces, Lanes& top, Lanes& bottom) const;
  void middle_stage(size_t block, double dt, const FaceEnds& faces);
  void end_stage(size_t block, const FaceEnds& faces);
  void estimate_error(size_t block, double dt, const FaceEnds& faces);
  void keep_means(size_t block);
  void keep_estimates(size_t block, const Lanes* errors);
  class Lateral;
  void step_lateral(double dt);
  void step_backward(double dt, const std::vector<FaceEnds>& faces, const std::vector<Lanes>& stored);
  // Properties that depend on temperature.
  void evaluate(const Lanes* kelvin, const Faces& faces, Lanes* heat, Lanes* gain) const;
  void set_matrix(const Lanes* kelvin, const Faces& faces, double scale, Row* rows) const;
  void solve_matrix(Lanes* right);
  void solve_newton(const Lanes* history, const Faces& faces, double scale, Lanes* kelvin);
  void step_newton(size_t block, double dt, const FaceEnds& faces);
  // Into end_. The largest estimate; infinite where there are no temperatures, or one of 0 K.
  double attempt(double dt, const BatchLoads& loads);
  double largest_estimate() const { return *std::max_element(estimate_.begin(), estimate_.end()); }
  void accept(double dt);
  void step_in_parts(double dt);  // of the lines of the last attempt

  std::vector<SlabLayer> layers_;
  size_t elements_;
  SlabGrid grid_;
  std::shared_ptr<const SlabNeighbours> neighbours_;
  double left_ = 0;
  bool linear_ = true;  // properties do not depend on temperature
  double t_ = 0, next_step_ = 1;
  std::vector<Lanes> now_, end_;                     // K, by block and node
  std::vector<Lanes> middle_, gain_, right_, heat_;  // of one block, by node
  std::vector<Row> matrix_;
  FaceLines top_lines_, bottom_lines_;
  std::vector<double> top_mean_, bottom_mean_, estimate_;
  bool vanished_ = false;  // a face was at 0 K after the last attempt
  Elimination elimination_;
  Counters counters_;
};

// Steps (s) from `begin` whose last ones before each of the ascending times `asked` (s, where steps end) are cut into
// parts that shrink eightfold down to about `finest` (s): gusts act on a surface for about as long ago as they lasted,
// so what the means of long steps leave out matters only just before a temperature is asked for.
std::vector<double> refine_steps(double begin, std::span<const double> steps, std::span<const double> asked,
                                 double finest);

// The state of every element that repeats with its loads.
struct PeriodicOptions {
  double tolerance = 1e-3;  // K: largest estimated distance of a node from the periodic state
  int most_sweeps = 60;
  int enough = 0;         // after so many periods what is left is removed and told, whatever it is; 0 = until reached
  bool harmonics = true;  // start from the answer to the harmonics; otherwise from the present state
};
struct PeriodicResult {
  int sweeps = 0;       // periods simulated
  double distance = 0;  // K, as estimated
};
// Starts at t0 from the answer to the mean and the first harmonics of the loads, linearised about the mean (from the
// batch's present temperatures), then simulates periods of the given steps (s, one period together) until it repeats,
// and leaves the batch at the end of one. After every period the slow part of what is left is removed: with A the
// linearised decay of an element and P the period, the remaining distance is (exp(P A) - 1)^-1 times the change over
// the period, for which (P A + (P A)^2 / 2)^-1 stands; it is exact for slow parts, and fast ones have decayed. after:
// called after every step of every sweep, e.g. to keep the history of the last one. Error: not reached within
// most_sweeps.
PeriodicResult find_periodic(SlabBatch& batch, double t0, std::span<const double> steps, const BatchLoads& loads,
                             const PeriodicOptions& options = {}, const std::function<void(size_t step)>& after = {});

}  // namespace suite
