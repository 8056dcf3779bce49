// The path kernel (paper, section IV-A, steps 2 and 3): the one place where paths are taken from node to node.
//
// A stage takes every path that is on its way to its next event and makes the contributions that it finds there:
//   fly      along the ray that the tracer has answered, through what fills space (Space)
//   meet     a surface, the Earth under the scene, or the outside; lights met by chance and warm matter contribute
//   sample   the lights: next-event estimation, a shadow ray towards each sample
//   look     for what their rays meet, and for ways to the light through what bends it
//   resolve  visible samples contribute, weighted by MIS with continuations (shares.h)
//   go on    draws the continuation, plays Russian roulette, ends paths
// What the kernel and the techniques share is the wave (wave.h); the techniques that it holds are those of
// techniques/set.h, and path/claims.h says which of them brings which light. A template over the wave: what surfaces
// can be (Surfaces: surfaces_any.h, surfaces_matte.h), what fills space (Space: space_nothing.h, media/space_field.h),
// the algebra of throughputs (throughput.h) and the estimator (estimators/), made for each combination that occurs in
// kernels.cpp. Definitions: kernel_*.h. Based on: Goodenough & Brown, section IV; Veach, "Robust Monte Carlo methods
// for light transport simulation", 1997.
#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "transport/flat_mirrors.h"
#include "transport/techniques/set.h"
#include "transport/wave.h"

namespace suite {

template <class Wave>
class PathKernel final : public PathTracing {
 public:
  using Path = typename Wave::Path;
  using Surfaces = typename Wave::Surfaces;
  using Space = typename Wave::Space;
  using Throughputs = typename Wave::Throughputs;
  using Estimator = typename Wave::Estimator;
  PathKernel(const KernelContext& context, size_t width, Throughputs& throughputs, Sink<Throughputs>& sink);

  void start(uint32_t p, const SensorRay& ray, const SampleStream& stream, uint32_t sample) override;
  bool next(TraceRequest& request) override;
  const PathRecord& record(uint32_t p) override;
  const FirstMeeting& first(uint32_t p) const override { return firsts_[p]; }
  uint64_t take_nodes() override { return std::exchange(nodes_met_, 0); }
  TraceStatistics take_statistics() override;

  // For estimators: the nodes of the stage, the lights that they sample, and how.
  std::span<const PathNode> nodes() const { return wave_.nodes; }
  std::span<const SampledLight> lights() const { return wave_.lights.sampled; }
  std::array<double, 4> numbers(const PathNode& node, dimensions::Use use) const { return wave_.numbers(node, use); }
  bool is_first(const PathNode& node) const { return wave_.is_first(node); }
  LightReceiver receiver(const PathNode& node) const { return wave_.receiver(node); }
  double time(const PathNode& node) const { return wave_.time(node); }
  // The probability with which the node samples the light; 0: not this time.
  double asks(const PathNode& node, const SampledLight& light) const {
    return techniques_.side.asks(wave_, node, light);
  }
  // How many samples of the light share its density there, whatever becomes of them: 1 unless said before connect().
  void set_draws(const PathNode& node, const SampledLight& light, int draws);
  // Sends a shadow ray towards a sample. draws: samples of the light that share its density. asks: as above.
  void connect(const PathNode& node, const SampledLight& light, const LightSample& sample, int draws, double asks = 1);
  void set_parallel() { wave_.sight_rays.parallel = wave_.sight_rays.size(); }
  // At most n more shadow rays follow.
  void expect(size_t n);

 private:
  enum class Stage : uint8_t {
    leave,
    beside,
    look_beside,
    arrive,
    look,
    look_through,
    fly_aside,
    look_aside,
    go_on,
    settle
  } stage_ = Stage::leave;
  using Question = SightQuestion;

  // kernel_fly.h, kernel_start.h: from one node to the next.
  void request_hits(TraceRequest& request);
  // kernel_fill.h: through what fills space.
  void fly();
  void fly_one(size_t slot);
  bool meets_outside(const Path& path) const;
  // kernel_meet.h: what paths come to.
  void arrive();
  SUITE_INLINE bool meet(uint32_t p, uint32_t slot);
  bool meet_earth(uint32_t p, uint32_t slot);
  SUITE_INLINE void enter_node(uint32_t p, const Hit& hit, bool first);
  bool is_first_surface(uint32_t p) const {
    return !techniques_.residual.has_been_back(p) && wave_.paths[p].surfaces == wave_.paths[p].received;
  }
  // kernel_light.h: next-event estimation.
  void sample_lights();
  void look_through();
  // Its next request; false: all that was looked for is known.
  bool next_through(TraceRequest& request) {
    return techniques_.manifold.next(wave_, techniques_.chains, techniques_.guide, techniques_.ends, request);
  }
  void resolve();  // hands contributions over
  SUITE_INLINE void shine(const Question& q, size_t ray, double passes);
  void lack(const Question& q, size_t ray, bool blocked);
  const float* spectrum_of(const Question& q, size_t ray);
  SUITE_INLINE double chance(const PathNode& node, Dir in, std::span<const double> reach) const;
  // kernel_go_on.h: continuations.
  void go_on();
  void end_stage();
  SUITE_INLINE bool go_on(size_t i);
  bool go_on(size_t i, const Continuation& on);
  SUITE_INLINE bool draw(size_t i, Continuation& on);
  SUITE_INLINE bool draw(size_t i, std::span<float> memory, Continuation& on);
  SUITE_INLINE double weigh(uint32_t p, const Continuation& on, double own, double& brightest);
  // Whether it has passed a surface.
  SUITE_INLINE bool leave(size_t i, const Continuation& on);
  // kernel_end.h: how paths end.
  SUITE_INLINE void escape(uint32_t p, bool in_field);
  SUITE_INLINE double survives(uint32_t p, double brightest);
  SUITE_INLINE bool cut(size_t i, const Continuation& on);
  bool fail(uint32_t p);
  // kernel_beside.h: what only some paths come to.
  void see_from_above();
  void receive(uint32_t p);
  void meet_glow(uint32_t p, const Hit& hit);
  void emit(uint32_t p);
  // Of a light that path p has met: no technique claims it.
  SUITE_INLINE bool is_left_to_chance(uint32_t p, ClaimedLight light);
  void branch(size_t i);
  // Whether a branch of the node goes towards the end of a laser radar; what guides to the sun under water stays alone.
  bool goes_to_end(const PathNode& node) const {
    return techniques_.ends.guides(wave_, node) && !techniques_.guide.guides(wave_, node);
  }
  std::optional<bool> draw_at_interface(const PathNode& node, double lobe_u, std::span<float> memory, Continuation& on);
  SUITE_INLINE double ahead(size_t i, const Continuation& on) const;
  void leave_claims(const PathNode& node, const Continuation& on);

  Wave wave_;
  Techniques<Wave> techniques_;
  const bool keep_first_;
  const bool draws_;                  // something decides by Ray::draw
  const FlatMirrors* const mirrors_;  // null: far points come to sensors straight ahead alone
  const bool above_;                  // some light may be seen by sensors above the air
  // Of each path.
  std::vector<FirstMeeting> firsts_;
  std::vector<SensorRay::Receiver> receivers_;
  // Of the stage.
  bool first_stage_ = true;
  std::vector<uint32_t> active_, received_;  // paths; those that start at receivers
  std::vector<uint32_t> in_stage_;           // active ones when it began, where techniques want to know
  std::vector<uint32_t> onward_;             // paths that have passed a boundary which bends nothing
  std::vector<Ray> rays_;
  std::vector<Flight> flights_;
  std::vector<SampleStream::Point> points_;  // of their continuations
  std::vector<Question> questions_;          // of shadow rays
  uint64_t nodes_met_ = 0;
};

}  // namespace suite
