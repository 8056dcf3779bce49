// Builds paths: traces, meets surfaces, asks sources, draws continuations (paper, section IV-A, steps 2 and 3).
//
// Directions are drawn from the shapes at one of the state's knots, chosen per path; every other knot could have drawn
// the same path, and the one-sample balance heuristic (Veach & Guibas 1995; Wilkie et al. 2014) divides by the mean of
// all their densities. With P_k the probability of knot k, r_k the density of the path so far under knot k relative to
// the knot that drew it, and A = sum P_k r_k, a contribution carries the factor 1 / A. Explicit samples of a source
// with density p_s and continuations that meet it by chance share the same heuristic:
//   explicit:   1 / (A p_s + sum P_k r_k p_k)        by chance:   1 / (A' + A p_s / p_h),  A' after the last event.
// Samples of the Sun's and the Moon's disk hardly vary by themselves, while a lobe a few times as wide as the disk
// meets it rarely: what the rare continuation may bring is made small by the power heuristic (exponent 2; Veach &
// Guibas 1995). With b = A p_s, a = sum P_k r_k p_k; B = A p_s / p_h:
//   explicit:   b / (a^2 + b^2)                      by chance:   A' / (A'^2 + B^2).
// Skies and lamps stay with the balance heuristic, which is the better one for densities that are alike.
#pragma once
#include <memory>

#include "radiometry/live_path.h"
#include "radiometry/pipeline.h"
#include "radiometry/wave.h"

namespace suite {

// With Method::paper the knots have probability 1 and 0, nothing is shared, and each node asks one source (pipeline.h).
//
// Several lamps asked at one node are strata of one choice: each stands for 1 / draws of it, so the density p_s of the
// formulas above is draws times that of one draw.
//
// Dimensions of the sample streams: block 0 is the sensor's, 1 + n is node n's continuation and its sample of the sun,
// kLobeBlock + n its choice of lobe (first number) and its sample of the sky (last two), kLampBlock + n of a lamp
// (three numbers), kMoonBlock + n of the moon.
inline constexpr uint32_t kLobeBlock = 128, kLampBlock = 512, kMoonBlock = 640;
// Roulette and the choice of the knot use hashed numbers, which take no stratification away from the others: purpose
// kRoulettePurpose + 16 n at node n.
inline constexpr uint32_t kKnotPurpose = 1, kRoulettePurpose = 2;

class LostLight;
class VolumePaths;

class PathGenerator {
 public:
  PathGenerator(const Surface& surface, const Optics& optics, const Environment& environment,
                const PipelineOptions& options);

  ~PathGenerator();
  PathGenerator(PathGenerator&&) noexcept;

  // Starts path p of the wave with a sensor ray. sample: index within the stream of its problem and scramble.
  void start(Wave& wave, size_t p, const SensorRay& ray, const SampleStream& stream, uint32_t sample);
  // Completes all started paths (those in wave.active).
  void complete(Wave& wave, RunStatistics& statistics);

 private:
  using Live = LivePath;
  void set_receivers_aside(Wave& wave);
  void receive(Wave& wave, uint32_t p);
  bool arrive(Wave& wave, uint32_t p, const Hit& hit);
  bool arrive_on_earth(Wave& wave, uint32_t p);
  Node& add_node(Wave& wave, uint32_t p, const Hit& hit);
  bool scatters(Path& path, const Node& node) const;
  // Sources (path_sources.cpp).
  void escape(Path& path, const Live& live) const;
  void ask_disks(Wave& wave, uint32_t p);
  void ask_around(Wave& wave, uint32_t p);
  void see(Wave& wave, size_t parallel, bool first, TraceStatistics& statistics) const;
  void ask(Wave& wave, uint32_t p, uint8_t slot, const ExplicitLight& light, double distance, const Vec3* end);
  void ask_lamps(Wave& wave, uint32_t p);
  void ask_one(Wave& wave, uint32_t p);
  void ask_lamp(Wave& wave, uint32_t p, int draw, const std::optional<LightSample>& lamp);
  // Lamps that node n asks.
  int lamp_draws(int n) const { return n == 0 ? lamp_draws_ : 1; }
  void meet_glow(Wave& wave, uint32_t p);
  // ray: of wave.rays, which found the source in sight.
  void add_explicit(Wave& wave, uint32_t p, uint8_t slot, size_t ray);
  // Adds what an explicit sample sends through the node to `sum`: scale times its radiance times w in the wave's
  // scratch spectrum.
  void add_shining(Wave& wave, const Node& node, const ExplicitLight& light, float scale, std::span<float> sum) const;
  // Estimates what of the light that did not arrive has only been bent on its way (lost_light.h).
  void look_for_lost(Wave& wave, TraceStatistics& statistics);
  void miss(Wave& wave, uint32_t p, uint8_t slot, size_t ray, double passes);
  // Density with which continuations are drawn from `out` to `in` (both in the shading frame) and reach the source,
  // over all knots: sum P_k r_k p_k reach_k.
  double density_by_chance(const Live& live, const ScatterModel& model, Dir out, Dir in,
                           std::span<const double> reach) const;
  bool go_on(Wave& wave, uint32_t p);

  const Surface& surface_;
  const Optics& optics_;
  const Environment& environment_;
  PipelineOptions options_;
  size_t knots_;
  bool paper_;                     // Method::paper
  bool asks_disks_, asks_around_;  // explicit sources: far disks and others
  int lamp_draws_ = 1;
  double knot_probability_[kMaxKnots];
  std::vector<size_t> knot_bins_;
  std::vector<Live> live_;
  std::unique_ptr<LostLight> lost_;      // null where no light can be lost
  std::unique_ptr<VolumePaths> volume_;  // null where the scene has no media
  TraceStatistics probing_;              // of rays that look for bodies around sensors
  std::vector<float> transmission_;
  std::vector<uint32_t> received_;  // paths that start at a receiver
  BakedMaterial receivers_[2];      // plane, sphere; made when a ray first asks for one
};

}  // namespace suite
