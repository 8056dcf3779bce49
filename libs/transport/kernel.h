// The path kernel (paper, section IV-A, steps 2 and 3): the one place where paths are taken from node to node.
//
// A stage takes every path that is on its way to its next event and makes the contributions that it finds there:
//   fly      along the ray that the tracer has answered, through what fills space (Space)
//   meet     a surface, the Earth under the scene, or the outside; lights met by chance and warm matter shine
//   ask      the lights: one sample each, a ray towards each
//   answer   what was visible shines, shared with continuations (shares.h)
//   go on    draws the continuation, plays roulette, ends paths
// A template over what surfaces can be (Surfaces: surfaces_any.h, surfaces_matte.h), what fills space (Space:
// space_nothing.h, media/space_field.h), the algebra of throughputs (throughput.h) and the estimator (estimators/),
// made for each combination that occurs in kernels.cpp. Definitions: kernel_*.h. Based on: Goodenough & Brown, section
// IV; Veach, "Robust Monte Carlo methods for light transport simulation", 1997.
#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "transport/chain_laws.h"
#include "transport/contacts.h"
#include "transport/dimensions.h"
#include "transport/gloss_guide.h"
#include "transport/path_tracing.h"
#include "transport/refracted_sight.h"
#include "transport/shares.h"
#include "transport/space_nothing.h"
#include "transport/surfaces_any.h"
#include "transport/waters.h"

// Functions of the inner loop that are called from one place: compilers inline those of templates only when told to.
#define SUITE_INLINE [[gnu::always_inline]] inline

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
class PathKernel final : public PathTracing {
 public:
  using Path = Lane<Surfaces::kKnots>;
  PathKernel(const KernelContext& context, size_t width, Throughputs& throughputs, Sink<Throughputs>& sink);

  void start(uint32_t p, const SensorRay& ray, const SampleStream& stream, uint32_t sample) override;
  bool next(TraceRequest& request) override;
  const PathRecord& record(uint32_t p) override {
    records_[p].size = paths_[p].surfaces;
    if constexpr (kGuides)
      if (!branches_.empty()) records_[p].size = branches_[p].surfaces;
    if constexpr (Space::kGoesBack)
      if (Passed& at = passed_[p]; at.again) {
        at.record.truncated += std::exchange(records_[p].truncated, 0);
        return at.record;
      }
    return records_[p];
  }
  const FirstMeeting& first(uint32_t p) const override { return firsts_[p]; }
  uint64_t take_nodes() override { return std::exchange(nodes_met_, 0); }
  TraceStatistics take_statistics() override;

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
    int first_number;                 // of those of `use` that it takes
    std::optional<LightSample> only;  // the only sample there is of a collimated light
    bool beam = false;                // one that the air is given
  };
  std::span<const NodeAt> nodes() const { return nodes_; }
  std::span<const Asked> lights() const { return asked_; }
  std::array<double, 4> numbers(const NodeAt& node, dimensions::Use use) const;
  // Whether the node is the first of its path.
  bool is_first(const NodeAt& node) const { return paths_[node.path].order() == 1; }
  LightReceiver receiver(const NodeAt& node) const;
  double time(const NodeAt& node) const { return paths_[node.path].time; }
  // The probability with which the node is to ask the light: less than 1 where side flights leave little of it.
  double asks(const NodeAt& node, const Asked& light) const;
  // How many samples of the light share its density there, whatever becomes of them: 1 unless said before propose().
  void set_draws(const NodeAt& node, const Asked& light, int draws) {
    if (!light.nature.far && !glowing_.empty()) last_[node.path].draws = draws;
  }
  // Puts a question: is this sample visible? draws: samples of the light that share its density.
  // asks: as above.
  void propose(const NodeAt& node, const Asked& light, const LightSample& sample, int draws, double asks = 1);
  void set_parallel() { sight_rays_.parallel = sight_rays_.size(); }
  // At most n more questions follow.
  void expect(size_t n) {
    sight_rays_.expect(n);
    if (questions_.size() < sight_rays_.size() + n) questions_.resize(2 * (sight_rays_.size() + n));
  }

 private:
  enum class Stage : uint8_t { leave, arrive, look, fly_sides, look_aside, go_on } stage_ = Stage::leave;
  using Question = SightQuestion;
  struct RefractedQuestion {
    uint32_t node;
    uint16_t light;
    bool beam;
    WayEnd end;
    double scale;           // far: times spectrum, over the density; else 1 / the density or probability of the place
    const float* spectrum;  // far
    size_t member;          // a point
    bool sky = false;       // the air's
  };
  struct Sent {  // towards the last interface
    double scale;
    const float* spectrum;
  };

  // kernel_fly.h: from one node to the next.
  void list_lights();
  void request_hits(TraceRequest& request);
  void fly();
  void fly_one(size_t slot);
  bool meets_outside(const Path& path) const;
  void arrive();
  SUITE_INLINE bool meet(uint32_t p, uint32_t slot);
  bool meet_earth(uint32_t p, uint32_t slot);
  void receive(uint32_t p);
  SUITE_INLINE void enter_node(uint32_t p, const Hit& hit, bool first);
  SUITE_INLINE void escape(uint32_t p, bool in_field);
  void meet_glow(uint32_t p, const Hit& hit);
  void emit(uint32_t p);
  bool is_first_surface(uint32_t p) const;
  // kernel_back.h: places on the way.
  void pass(size_t slot);
  void go_back(std::span<const uint32_t> stage);
  bool go_back(uint32_t p);
  // kernel_light.h: questions and their answers.
  void ask();
  void answer();
  SUITE_INLINE void shine(const Question& q, size_t ray, double passes);
  void lack(const Question& q, size_t ray, bool blocked);
  bool is_behind_earth(const Ray& ray, double length) const {
    return environment_.earth && environment_.earth->meet(ray.origin, ray.direction, length);
  }
  // From where a path stands to what its ray has met, m.
  double way_to(const Hit& hit, const Path& path) const {
    constexpr double kForever = std::numeric_limits<double>::infinity();
    if (hit.hit() || !environment_.earth) return hit.hit() ? hit.distance : kForever;
    const auto met = environment_.earth->meet(path.origin, path.direction, kForever);
    return met ? met->distance : kForever;
  }
  // Mean cosine: matter that scatters more evenly has no use for side flights or chains.
  static constexpr double kForwards = 0.5;
  // kernel_side.h: flights aside of paths, from where media scatter forwards.
  struct Side {
    uint32_t node;       // in nodes_
    Path path;           // that takes the way aside
    Flight flight;       // of it
    double scale = 0;    // times spectrum: what the event makes of light from there, over its density
    LightSample sample;  // of the light
    uint32_t hit = 0;    // in side_hits_
  };
  // Of the light that may come to pass, over even scattering of all of a path's light: less than kSideCarries is left
  // to chance, with kSideLeast at least.
  static constexpr double kSideCarries = 4, kSideLeast = 0.05;
  double brings(const NodeAt& node, Dir in) const;
  void choose_side_light();
  std::span<float> side_spectrum(size_t i) { return {&side_spectra_[i * bins_], bins_}; }
  bool has_side(const NodeAt& node) const;
  bool share_with_side(const NodeAt& node, Continuation& on) const;
  // The share of what a path finds of a light at a node that side flights leave to it.
  double beside_sides(const NodeAt& node, uint16_t light) const {
    if constexpr (kGuides)
      if (node.event && paths_[node.path].sided && light == side_light_->index) return alone(paths_[node.path]);
    return 1;
  }
  double alone(const Path& path) const;
  bool begin_sides(TraceRequest& request);
  bool begin_side(const NodeAt& node, Side& side, std::span<float> spectrum);
  void fly_sides();
  bool fly_side(Side& side, std::span<float> spectrum);
  void answer_sides();
  void shine_aside(const Side& side, size_t ray, std::span<float> spectrum);
  // kernel_refract.h: lights behind smooth interfaces.
  void want_refracted(const NodeAt& node, const Asked& light, const LightSample& sample);
  void want_places();
  bool asks_through(const NodeAt& node) const;
  void shine_refracted();
  void shine_refracted(const RefractedQuestion& q, size_t knot);
  bool shine_along(const RefractedWay& way, const RefractedQuestion& q, size_t knot);
  std::optional<Sent> sent(const RefractedQuestion& q, const RefractedWay& way);
  struct Reached {             // the beginning of a way
    std::span<float> through;  // what the node and what lies before make of the light
    double arrival;            // m, optical, from the node
    double scale;
    uint32_t scatterings;  // since the node
    Dir first;             // from it
  };
  bool shine_behind(const RefractedWay& way, const RefractedQuestion& q, size_t knot, const Reached& reached);
  void keep_bins_of(size_t knot, std::span<float> through) const;
  bool weaken(const Path& path, const RefractedWay& way, size_t knot, bool sky, std::span<float> through,
              double& arrival);
  double lost(const Question& q, size_t ray, double passes);
  static constexpr bool kGuides = Space::kScatters && !Space::kGoesBack;  // places are scattered at in what fills space
  // kernel_guide.h: continuations towards where media scatter such lights forwards.
  struct Guide {
    bool branch = false;  // a continuation is drawn about `toward`, beside the others
    Dir toward;
    NodeClaims claims;  // of chains
  };
  void guide(const RefractedQuestion& q, const RefractedWay& way);
  const Guide* guide_of(const NodeAt& node) const {
    return guides_.empty() ? nullptr : &guides_[static_cast<size_t>(&node - nodes_.data())];
  }
  bool is_guided(const NodeAt& node) const { return !guides_.empty() && guide_of(node)->branch; }
  void share_with_guide(const NodeAt& node, bool forced, Continuation& on) const;
  bool draw_guided(const NodeAt& node, Vec2 u, double who, std::span<float> memory, Continuation& on);
  // kernel_gloss.h: continuations towards light that glossy surfaces throw.
  void find_gloss();
  GlossShare gloss_at(const NodeAt& node) const;
  GlossShare gloss_of(const NodeAt& node) const {
    return gloss_ ? gloss_of_node_[static_cast<size_t>(&node - nodes_.data())] : GlossShare{};
  }
  void share_with_gloss(const NodeAt& node, Dir in, std::span<float> density) const;
  bool draw_with_gloss(size_t i, Vec2 u, double lobe_u, std::span<float> memory, Continuation& on);
  // kernel_chain.h: light scattered on its way.
  static constexpr int kMostLinks = 24;
  static_assert(dimensions::of_link(kMostLinks - 1, true) < dimensions::of_link_place(1, kMostLinks, true) &&
                dimensions::of_link_place(kMostLinks, kMostLinks, true) < dimensions::kMostPerChain);
  static constexpr double kReach = 2, kDeepest = 8;
  struct Chain {
    int links;                              // scatterings
    Dir toward[kMostLinks + 1];             // from the node, and from each of them
    double density[kMostLinks];             // of each direction but the last one, at the path's knot
    uint32_t mean;                          // the event that stands for all matter up to the light's interface
    HeroDensities<Surfaces::kKnots> share;  // r_k of it all, over the density that drew it
  };
  bool ask_along_chain(const RefractedQuestion& q, Dir toward, double length, size_t knot);
  uint32_t mean_toward(const NodeAt& node, Dir toward, double length);
  bool draw_chain(const NodeAt& node, Dir toward, double length, uint32_t mean, bool sky);
  std::array<double, 4> chain_numbers(const Path& path, bool event, bool sky, uint32_t set) const;
  ClaimCone cone_of(const NodeAt& node, uint16_t light, size_t knot) const;
  RefractedSight::Node from_node(const NodeAt& node) const;
  Ray ray_from(const NodeAt& node, Dir toward) const;
  bool follow_chain(const RefractedQuestion& q, size_t knot);
  LinkPlace link_place(const RefractedQuestion& q, size_t i, double most, size_t k) const;
  void scatter_along(size_t i, Dir from, std::span<float> through, std::span<float> memory);
  bool shine_behind_chain(const RefractedQuestion& q, size_t knot, Vec3 place, double scale, double arrival);
  double free_way(const Ray& ray);
  void ask_sky(const NodeAt& node);
  void ask_sky(const NodeAt& node, size_t knot, const SkyThroughWater& sky, Dir to, double deep, uint32_t mean);
  // kernel_branch.h: paths that go on in more than one way.
  void keep(uint32_t p, double share, uint32_t times);
  bool take_up(uint32_t p);
  void take_up_ended();
  void draw_part(uint32_t p, uint32_t j);
  void part(uint32_t p);
  void keep_branch(size_t i, const Continuation& on);
  void branch_mirrored(size_t i);
  void branch_guided(size_t i);
  bool at_first_interface(const NodeAt& node) const {
    return !branches_.empty() && is_first(node) && !node.event && is_interface(node);
  }
  // Of nodes at surfaces, where light is asked for through interfaces.
  bool is_interface(const NodeAt& node) const { return refracted_->interfaces().has(surfaces_.material(node.path)); }
  bool passes(const NodeAt& node, const Continuation& on) const {
    const Dir normal = hits_[node.slot].normal;
    return dot(on.in, normal) * dot(paths_[node.path].direction, normal) > 0;
  }
  // kernel_claims.h: who brings which light.
  void leave_claims(const NodeAt& node, const Continuation& on);
  bool passes_into_claimed_sky(size_t i, const Continuation& on) const;
  void settle_sky(size_t i, const Continuation& on);
  // Whether a technique brings a light that the path has met.
  bool is_claimed(const Path& path, ClaimedLight light) const {
    return refracted_ && owner(path.claims, light, hero_of(path)) != Technique::chance;
  }
  // The hero wavelength that stands for those that smooth interfaces bend like the path's own.
  size_t hero_of(const Path& path) const { return refracted_->interfaces().set_of()[static_cast<size_t>(path.knot)]; }
  SUITE_INLINE double chance(const NodeAt& node, Dir in, std::span<const double> reach) const;
  SUITE_INLINE Factor evaluate(const NodeAt& node, Dir in, std::span<float> dense);
  // What path p has come to of water when it goes on from a node of the stage towards `in`.
  WaterSeen water_behind(const NodeAt& node, Dir in) const;
  // The next contribution, of path p as it stands; it counts from contribute() on. Its `water` is right for light of
  // the scene's things.
  SUITE_INLINE Contribution& contribution(uint32_t p, uint16_t light);
  void contribute() { ++pending_; }
  void hand_over();
  std::span<float> dense(uint32_t p, uint32_t count = 1);
  // kernel_stokes.h: polarisation.
  static constexpr bool kStokes = requires { typename Throughputs::Polarised; };
  const PolarisedEvent* polarise(const NodeAt& node, Dir in, const Continuation* dirac = nullptr);
  const PolarisedEvent* polarise_aside(const Side& side);
  const PolarisedEvent* polarise_emission(uint32_t p);
  // kernel_go_on.h: continuations.
  void go_on();
  SUITE_INLINE bool go_on(size_t i);
  bool go_on(size_t i, const Continuation& on);
  SUITE_INLINE bool draw(size_t i, Continuation& on);
  SUITE_INLINE bool draw(size_t i, std::span<float> memory, Continuation& on);
  SUITE_INLINE double weigh(uint32_t p, const Continuation& on, double own, double& brightest);
  bool fail(uint32_t p);
  SUITE_INLINE double ahead(size_t i, const Continuation& on) const;
  SUITE_INLINE double survives(uint32_t p, double brightest);
  SUITE_INLINE bool cut(size_t i, const Continuation& on);
  // Whether it has passed a surface.
  SUITE_INLINE bool leave(size_t i, const Continuation& on);

  const Surface& surface_;
  const Environment& environment_;
  const PipelineOptions& options_;
  size_t knots() const {
    if constexpr (Surfaces::kKnots == 1) return 1;
    return knots_;
  }
  size_t knots_;
  std::vector<size_t> knot_bins_;
  std::vector<int> knot_of_bin_;
  size_t bins_;
  std::array<double, kMaxKnots> probability_;  // P_k
  std::span<const double> P() const { return std::span(probability_).first(knots()); }
  const bool keep_first_;
  const bool draws_;  // something decides by Ray::draw
  std::unique_ptr<LostLight> lost_;
  std::unique_ptr<RefractedSight> refracted_;  // null where nothing refracts
  const GlossGuide* const gloss_;              // null: nothing glossy throws light, or other guides are at work
  Contacts contacts_;
  const Waters waters_;
  std::vector<Asked> asked_;
  std::vector<Asked> outside_, glowing_;  // lights that rays meet by chance: leaving the scene, at surfaces
  Surfaces surfaces_;
  Space space_;
  Throughputs& throughputs_;
  Sink<Throughputs>& sink_;

  std::vector<Path> paths_;
  std::vector<PathRecord> records_;
  std::vector<FirstMeeting> firsts_;
  std::vector<SensorRay::Receiver> receivers_;
  std::vector<LastAsked> last_;
  // Where Space::kGoesBack.
  struct Passed {
    Path before;                             // as it began the flight under way
    Path path;                               // and the one that is remembered
    double sum = 0, weight = 0, length = 0;  // of all flights; of this one; m
    bool goes_on = false, again = false;     // scratch; it has been back
    PathRecord record;                       // of the time before
  };
  std::vector<Passed> passed_;
  std::vector<float> throughput_there_;  // [path][bin]
  std::vector<uint32_t> returned_;       // to such places
  std::vector<uint32_t> in_stage_;       // paths
  // Where kGuides, and light is asked for through interfaces.
  struct Kept {
    Path path;
    typename Space::Around around;
    LastAsked last;
    std::vector<float> throughput;
    uint32_t times;  // > 0: that many parts of a path are still to come
  };
  struct Branches {
    std::vector<Kept> of;  // the first `size` of them; the others are kept for later ones
    size_t size = 0;
    bool goes_on = false;   // scratch
    uint32_t surfaces = 0;  // that the first branch to end has met
  };
  std::vector<Branches> branches_;  // [path]
  typename Space::Around around_;   // scratch
  std::vector<float> throughput_before_;
  // Of a path that enters a medium. Of the work to an error in the bay of sample_scenes four take 0.75 (coastal) to
  // 0.84 (green) of what two do, eight as much as four.
  static constexpr uint32_t kParts = 4;
  const Asked* side_light_ = nullptr;  // towards which there are side flights; null: there are none
  Dir side_toward_;                    // its middle
  // Of the stage.
  bool first_stage_ = true;
  std::vector<uint32_t> active_, received_;  // paths; those that start at receivers
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<Flight> flights_;
  std::vector<NodeAt> nodes_;
  std::vector<SampleStream::Point> points_;  // of their continuations
  std::vector<uint32_t> onward_;
  SightRays sight_rays_;
  std::vector<Question> questions_;
  std::vector<RefractedQuestion> refracted_questions_;
  std::vector<Guide> guides_;  // of nodes; where nothing refracts none
  std::vector<GlossShare> gloss_of_node_;
  Chain chain_;
  std::vector<float> chain_through_;
  std::vector<Side> sides_;  // the first side_count_ of them
  size_t side_count_ = 0;
  std::vector<Ray> side_rays_;
  std::vector<Hit> side_hits_;
  std::vector<float> side_spectra_;  // [side][bin]
  std::vector<Contribution> contributions_;
  size_t pending_ = 0;  // of them
  std::vector<Mueller> matrices_, matrices_aside_;
  PolarisedEvent polarised_;  // the last one
  std::vector<float> transmission_;
  uint64_t nodes_met_ = 0;
  TraceStatistics touching_;
};

}  // namespace suite
