// A wave of paths under way, and what everything that works on it shares: the scene, the lanes, the nodes of the stage,
// shadow rays, contributions. The kernel (kernel.h) takes the paths from node to node; techniques (techniques/) bring
// light to the nodes. Both do so through this class alone.
#pragma once
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "transport/contacts.h"
#include "transport/lost_light.h"
#include "transport/node.h"
#include "transport/path/suffix_matrices.h"
#include "transport/path_tracing.h"
#include "transport/shares.h"
#include "transport/space_nothing.h"
#include "transport/surfaces_any.h"
#include "transport/waters.h"

// Functions of the inner loop that are called from one place: compilers inline those of templates only when told to.
#define SUITE_INLINE [[gnu::always_inline]] inline

namespace suite {

// The hero wavelengths of a spectral state.
struct HeroSet {
  size_t count;
  std::vector<size_t> bins;                   // of each
  std::vector<int> of_bin;                    // the hero whose shapes a bin has
  std::array<double, kMaxKnots> probability;  // P_k
};

// What algebras that carry polarisation need: the matrices of the last event, or of the suffix under way; scratch.
struct PolarisedScratch {
  SuffixMatrices suffix;
  Interaction at;
  struct {
    std::vector<float> I, Q, U, V;  // Q, U and V over I; no V where nobody asks
    double unknown = 0;
  } air;            // light along the last way through it
  Stokes source{};  // of the light of the contribution under way
};
struct NoPolarisedScratch {
  NoMatrices suffix;
};

// Contributions of the stage, until a sink takes them.
template <class Throughputs>
struct Outbox {
  Sink<Throughputs>& sink;
  std::vector<Contribution> contributions;
  size_t pending = 0;  // of them
};

template <class SurfacesOf, class SpaceOf, class ThroughputsOf, class EstimatorOf>
class Wave {
 public:
  using Surfaces = SurfacesOf;
  using Space = SpaceOf;
  using Throughputs = ThroughputsOf;
  using Estimator = EstimatorOf;
  using Path = Lane<Surfaces::kKnots>;
  static constexpr bool kStokes = requires { typename Throughputs::Polarised; };
  // Algebras of tests that watch who asks for which light, and what chance brings
  // (tests/physics/transport/ownership_test.cpp).
  static constexpr bool kWatched = requires { typename Throughputs::Watched; };
  Wave(const KernelContext& context, size_t width, Throughputs& throughputs, Sink<Throughputs>& sink);

  const Surface& surface;
  const Environment& environment;
  const PipelineOptions& options;
  const HeroSet heroes;
  const size_t bins;
  const std::unique_ptr<LostLight> lost;  // null: no light can be lost
  Contacts contacts;
  const Waters waters;
  LightLists lights;
  Surfaces surfaces;
  Space space;
  Throughputs& throughputs;
  Outbox<Throughputs> outbox;
  // Of each path.
  std::vector<Path> paths;
  std::vector<PathRecord> records;
  std::vector<LastAsked> last;  // empty where surfaces do not shine
  // Of the stage.
  std::vector<Hit> hits;
  std::vector<PathNode> nodes;
  SightRays sight_rays;
  std::vector<float> transmission;  // scratch
  using Matrices = std::conditional_t<kStokes, SuffixMatrices, NoMatrices>;
  std::conditional_t<kStokes, PolarisedScratch, NoPolarisedScratch> polarisation;
  TraceStatistics touching;  // of short rays at touching bodies

  size_t knots() const {
    if constexpr (Surfaces::kKnots == 1) return 1;
    return heroes.count;
  }
  std::span<const double> P() const { return std::span(heroes.probability).first(knots()); }

  // Of nodes.
  std::array<double, 4> numbers(const PathNode& node, dimensions::Use use) const;
  // Whether it is the first of its path.
  bool is_first(const PathNode& node) const { return paths[node.path].order() == 1; }
  size_t number_of(const PathNode& node) const { return static_cast<size_t>(&node - nodes.data()); }
  LightReceiver receiver(const PathNode& node) const;
  double time(const PathNode& node) const { return paths[node.path].time; }
  // Whether it is a place in the air to which a path has gone back (techniques/air_residual.h): what the even field
  // there has already is not asked for.
  bool in_air(const PathNode& node) const {
    if constexpr (Space::kGoesBack) return node.event && space.in_air(node.path);
    return false;
  }
  // memory: for a spectrum.
  SUITE_INLINE Factor evaluate(const PathNode& node, Dir in, std::span<float> memory);
  // Whether a continuation goes on behind the surface of the node.
  bool passes(const PathNode& node, const Continuation& on) const {
    const Dir normal = hits[node.slot].normal;
    return dot(on.in, normal) * dot(paths[node.path].direction, normal) > 0;
  }
  // What its path has come to of water when it goes on towards `in`.
  WaterSeen water_behind(const PathNode& node, Dir in) const;

  // From where a path stands to what its ray has met, m.
  double way_to(const Hit& hit, const Path& path) const;
  bool is_behind_earth(const Ray& ray, double length) const {
    return environment.earth && environment.earth->meet(ray.origin, ray.direction, length);
  }

  // The next contribution, of path p as it stands; it counts from contribute() on. Its `water` is right for light of
  // the scene's things.
  SUITE_INLINE Contribution& contribution(uint32_t p, uint16_t light);
  void contribute() { ++outbox.pending; }
  void hand_over();
  // Where polarisation is carried: the contribution's light leaves a source of a light of the environment along k.
  // Until the next one's is told it has to be handed over.
  void leaves(Contribution& c, uint32_t source, Dir k, double time) {
    if constexpr (kStokes) {
      if (source == kUnpolarised) return;
      polarisation.source = environment.lights[c.light]->stokes(source, k, time);
      c.source = &polarisation.source;
    }
  }
  // Memory for one spectrum of path p, `count` of which are taken before anything else is handed over.
  std::span<float> dense(uint32_t p, uint32_t count = 1);

  // wave_stokes.h: the Mueller matrices of an event, where polarisation is carried. They stay until the next are made:
  // what refers to them has to be handed over first.
  // Of a node that scatters light from `in`; dirac: a continuation along a Dirac lobe, else null.
  const PolarisedEvent* polarise(const PathNode& node, Dir in, const Continuation* dirac = nullptr);
  // The same of what lies behind it on the way of a suffix: matter at an event of the space, and a lobe of a smooth
  // interface at a knot.
  void polarise_further(uint32_t event, Dir out, Dir in);
  void polarise_further(const Hit& hit, Dir out, Dir in, int lobe, int knot, double time);
  // Of what a warm surface sends out.
  const PolarisedEvent* polarise_emission(uint32_t p);
  // Of the air's own light along a way, `radiance` as the scalar field has it: returns that of the vector field, which
  // stays until the next way. sky: light is scattered on it, and one of its neighbours will do.
  enum class AirWay { exact, sky };
  const float* polarise_air(AirWay way, Vec3 from, Dir d, double distance, const float* radiance);
  // A contribution brings that light: before its scattering, where it has one.
  void lit_by_air(Contribution& c);

 private:
  void list_lights();
};

template <class Surfaces, class Space, class Throughputs, class Estimator>
Wave<Surfaces, Space, Throughputs, Estimator>::Wave(const KernelContext& c, size_t width, Throughputs& of_paths,
                                                    Sink<Throughputs>& sink)
    : surface(c.surface),
      environment(c.environment),
      options(c.options),
      heroes{c.optics.state().knots.size(), c.optics.state().knots, c.optics.state().knot_of_bin(),
             Estimator::knot_probabilities(c.optics.state().knots.size())},
      bins(c.optics.state().size()),
      lost(may_lose(c) ? std::make_unique<LostLight>(c.surface, c.optics) : nullptr),
      contacts(c.surface, c.optics),
      waters(c),
      surfaces(c.surface, c.optics, width, c.keep_first),
      space(SpaceContext{c.surface, c.optics, c.environment, c.options, width,
                         std::span<const double>(heroes.probability).first(heroes.count), lost.get(), c.parts}),
      throughputs(of_paths),
      outbox{sink, std::vector<Contribution>(std::max<size_t>(256, 4 * width))},
      paths(width),
      records(width),
      hits(width),
      transmission(bins) {
  list_lights();
  if (!lights.glowing.empty()) last.resize(width);
  nodes.reserve(width);
}

// Which lights are sampled, far disks first, and with which numbers: the first light of two numbers takes those that
// the scattering leaves over, the second those of the choice of lobe, and so on.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void Wave<Surfaces, Space, Throughputs, Estimator>::list_lights() {
  for (size_t i = 0; i < environment.lights.size(); ++i) {
    const Light& light = *environment.lights[i];
    SampledLight of{&light,       static_cast<uint16_t>(i), light.nature(), dimensions::kOfScatter, 0,
                    std::nullopt, light.beam().has_value()};
    if (!of.nature.delta) (of.nature.far ? lights.outside : lights.glowing).push_back(of);
    if (!options.explicit_sources || !light.nature().drawn) continue;
    if (of.nature.far && of.nature.delta) of.only = light.sample({}, {}, 0);
    lights.sampled.push_back(of);
  }
  if (const Light* sky = options.explicit_sources ? space.sky() : nullptr)
    lights.sampled.push_back({sky, kFromAir, sky->nature(), dimensions::kOfScatter, 0, std::nullopt, false});
  std::stable_sort(lights.sampled.begin(), lights.sampled.end(), [](const SampledLight& a, const SampledLight& b) {
    return Estimator::parallel(a.nature) > Estimator::parallel(b.nature);
  });
  uint32_t own = 0;
  bool scatter = true, second = true;
  for (SampledLight& light : lights.sampled) {
    if (light.only) continue;
    const bool two = light.nature.numbers <= 2;
    const bool with_scatter = two && std::exchange(scatter, scatter && !two);
    const bool with_second = two && !with_scatter && std::exchange(second, false);
    light.use = with_scatter  ? dimensions::kOfScatter
                : with_second ? dimensions::kOfSecond
                              : dimensions::own_light(own++);
    light.first_number = with_scatter || with_second ? 2 : 0;
  }
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
std::array<double, 4> Wave<Surfaces, Space, Throughputs, Estimator>::numbers(const PathNode& node,
                                                                             dimensions::Use use) const {
  const Path& path = paths[node.path];
  if (Space::kScatters && node.event) return dimensions::at_scattering(path.stream, path.sample, path.flights, use);
  return dimensions::at_surface(path.stream, path.sample, path.surfaces - 1, use);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
LightReceiver Wave<Surfaces, Space, Throughputs, Estimator>::receiver(const PathNode& node) const {
  if constexpr (Space::kScatters)
    if (node.event) return {space.place(node.path), {}, true};
  return surfaces.receiver(node.path, hits[node.slot], -paths[node.path].direction);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
Factor Wave<Surfaces, Space, Throughputs, Estimator>::evaluate(const PathNode& node, Dir in, std::span<float> memory) {
  const Dir direction = paths[node.path].direction;
  if constexpr (Space::kScatters)
    if (node.event) return space.evaluate(node.path, scattering_cosine(-direction, in), memory);
  return surfaces.evaluate(node.path, -direction, in, memory);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
WaterSeen Wave<Surfaces, Space, Throughputs, Estimator>::water_behind(const PathNode& node, Dir in) const {
  const Path& path = paths[node.path];
  if (node.event) return Waters::behind_scattering(path.water);
  return waters.behind_surface(path.water, surfaces.material(node.path), hits[node.slot].normal, -path.direction, in);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
double Wave<Surfaces, Space, Throughputs, Estimator>::way_to(const Hit& hit, const Path& path) const {
  constexpr double kForever = std::numeric_limits<double>::infinity();
  if (hit.hit() || !environment.earth) return hit.hit() ? hit.distance : kForever;
  const auto met = environment.earth->meet(path.origin, path.direction, kForever);
  return met ? met->distance : kForever;
}

// Far lights shine evenly in time: their arrival is that of the last event.
template <class Surfaces, class Space, class Throughputs, class Estimator>
Contribution& Wave<Surfaces, Space, Throughputs, Estimator>::contribution(uint32_t p, uint16_t light) {
  if (outbox.pending == outbox.contributions.size()) hand_over();
  const Path& path = paths[p];
  Contribution& c = outbox.contributions[outbox.pending];
  c.path = p;
  c.light = light;
  c.events = path.events;
  c.asked = c.beam = false;
  c.water = path.water == WaterSeen::mirrored ? WaterSeen::other : path.water;
  c.order = path.order();
  c.smooth = path.smooth;
  c.scale = 1;
  c.factor = {};
  c.radiance = nullptr;
  c.arrival = path.arrival;
  c.missed = std::numeric_limits<float>::infinity();
  c.polarised = nullptr, c.unknown = 0, c.source = nullptr;
  return c;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void Wave<Surfaces, Space, Throughputs, Estimator>::hand_over() {
  if (outbox.pending == 0) return;
  outbox.sink.add({outbox.contributions.data(), outbox.pending}, throughputs);
  outbox.pending = 0;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
std::span<float> Wave<Surfaces, Space, Throughputs, Estimator>::dense(uint32_t p, uint32_t count) {
  if (!throughputs.has_room(p, count)) {
    hand_over();
    throughputs.make_room(p);
  }
  return throughputs.take(p);
}

}  // namespace suite
