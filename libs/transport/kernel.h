// The path kernel (paper, section IV-A, steps 2 and 3): the one place where paths are taken from node to node.
//
// A stage takes every path that is on its way to its next event and makes the contributions that it finds there:
//   fly      along the ray that the tracer has answered, through what fills space (Space)
//   meet     a surface, the Earth under the scene, or the outside; lights met by chance and warm matter shine
//   ask      the lights: one sample each, a ray towards each
//   answer   what was visible shines, shared with continuations (shares.h)
//   go on    draws the continuation, plays roulette, ends paths
// A template over what surfaces can be (Surfaces: surfaces_any.h, surfaces_matte.h), what fills space (Space:
// space_nothing.h, media/space_field.h), the algebra of throughputs (throughput.h) and the estimator (estimators/), made
// for each combination that occurs in kernels.cpp. Definitions: kernel_*.h.
// Based on: Goodenough & Brown, section IV; Veach, "Robust Monte Carlo methods for light transport simulation", 1997.
#pragma once
#include <optional>
#include <vector>

#include "transport/dimensions.h"
#include "transport/path_tracing.h"
#include "transport/shares.h"
#include "transport/space_nothing.h"
#include "transport/surfaces_any.h"

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
class PathKernel final : public PathTracing {
 public:
  using Path = Lane<Surfaces::kKnots>;
  PathKernel(const KernelContext& context, size_t width, Throughputs& throughputs, Sink<Throughputs>& sink);

  void start(uint32_t p, const SensorRay& ray, const SampleStream& stream, uint32_t sample) override;
  bool next(TraceRequest& request) override;
  const PathRecord& record(uint32_t p) const override { return records_[p]; }
  const FirstMeeting& first(uint32_t p) const override { return firsts_[p]; }
  uint64_t take_nodes() override { return std::exchange(nodes_met_, 0); }
  TraceStatistics take_statistics() override { return space_.take_statistics(); }

  // For estimators: the nodes of the stage, what they may ask, and how.
  struct NodeAt {
    uint32_t path, slot;  // slot: of its hit
    bool event;           // scattered in a medium; else at a surface
  };
  struct Asked {  // a light
    const Light* light;
    uint16_t index;
    LightNature nature;
    dimensions::Use use;
    int first_number;  // of those of `use` that it takes
    std::optional<LightSample> only;  // the only sample there is of a collimated light
  };
  std::span<const NodeAt> nodes() const { return nodes_; }
  std::span<const Asked> lights() const { return asked_; }
  std::array<double, 4> numbers(const NodeAt& node, dimensions::Use use) const;
  // Whether the node is the first of its path.
  bool is_first(const NodeAt& node) const { return paths_[node.path].order() == 1; }
  LightReceiver receiver(const NodeAt& node) const;
  double time(const NodeAt& node) const { return paths_[node.path].time; }
  // Puts a question: is this sample visible? draws: samples of the light that share its density.
  void propose(const NodeAt& node, const Asked& light, const LightSample& sample, int draws);
  void set_parallel() { sight_rays_.parallel = sight_rays_.size(); }

 private:
  enum class Stage : uint8_t { leave, arrive, look } stage_ = Stage::leave;
  struct Question {
    uint32_t node;  // in nodes_
    uint16_t light;
    bool disk, wide;
    Dir direction;
    double density;
    float scale;
    const float* spectrum;
  };

  // kernel_fly.h: from one node to the next.
  void list_lights();
  void request_hits(TraceRequest& request);
  void fly();
  void fly_one(size_t slot);
  void arrive();
  bool meet(uint32_t p, uint32_t slot);
  bool meet_earth(uint32_t p, uint32_t slot);
  void receive(uint32_t p);
  bool is_first_surface(uint32_t p) const { return records_[p].size == (records_[p].received ? 1u : 0u); }
  void enter_node(uint32_t p, const Hit& hit, bool first);
  void escape(uint32_t p);
  void meet_glow(uint32_t p, const Hit& hit);
  void emit(uint32_t p);
  // kernel_light.h: questions and their answers.
  void ask();
  void answer();
  void shine(const Question& q, size_t ray, double passes);
  double chance(const NodeAt& node, Dir in, std::span<const double> reach) const;
  Factor evaluate(const NodeAt& node, Dir in, std::span<float> dense);
  void contribute(const Contribution& c) { contributions_.push_back(c); }
  void hand_over();
  std::span<float> dense(uint32_t p, uint32_t count = 1);
  Contribution contribution(uint32_t p, uint16_t light) const;
  // kernel_go_on.h: continuations.
  void go_on();
  bool go_on(size_t i);
  bool draw(size_t i, Continuation& on);
  double survives(uint32_t p, double brightest, bool dirac);
  bool cut(uint32_t p, bool event);
  void leave(size_t i, const Continuation& on);

  const Surface& surface_;
  const Environment& environment_;
  const PipelineOptions& options_;
  size_t knots_;
  std::vector<size_t> knot_bins_;
  size_t bins_;
  double probability_[kMaxKnots];
  const bool keep_first_;
  bool glows_ = false;  // some surface shines
  std::unique_ptr<LostLight> lost_;
  std::vector<Asked> asked_;
  Surfaces surfaces_;
  Space space_;
  Throughputs& throughputs_;
  Sink<Throughputs>& sink_;

  std::vector<Path> paths_;
  std::vector<PathRecord> records_;
  std::vector<FirstMeeting> firsts_;
  std::vector<SensorRay::Receiver> receivers_;
  // Of the stage.
  bool first_stage_ = true;
  std::vector<uint32_t> active_, received_;  // paths; those that start at receivers
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<Flight> flights_;
  std::vector<NodeAt> nodes_;
  std::vector<uint32_t> onward_;
  SightRays sight_rays_;
  std::vector<Question> questions_;
  std::vector<Contribution> contributions_;
  std::vector<float> transmission_;
  uint64_t nodes_met_ = 0;
};

}  // namespace suite
