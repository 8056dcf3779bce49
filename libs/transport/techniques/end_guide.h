// Splitting towards an end of a laser radar, where media scatter forwards.
//
// Half of the multiple scattering of fog is scattered back first and forwards into the receiver last. Next-event
// estimation at the last vertex then finds the peak of the phase function, hundreds of times its value backwards, but
// only of the few paths that happen to come from below. So every node, in media and at surfaces, is left twice: as it
// draws itself (density p_k of directions at knot k), and by chance s as matter scatters what comes from the end
// (density g_k about the direction towards it; at surfaces that of the medium of the scene that scatters most). Both
// go on as any path does, so all further orders are found, and both count
//   w / (p_k + s g_k)      (multi-sample balance heuristic with 1 and s samples):
// no more than the smaller one of two phase functions over s. s is what the node itself makes of light from the end,
// over kCarries. Where p is the path's own peak, s g hardly matters: paths that go deep into a cloud lose nothing.
// Angles to the end grow along any way from the node, so that the next vertex sees no more than g there: a path never
// finds a peak that it has not been sent to. Nothing meets an end by chance: no light changes hands, and no claims are
// made. Lights met by chance see the density of both.
// Behind smooth interfaces the direction towards the end is that of a way which the manifold has found, if any.
// Based on: E. Veach & L. Guibas, "Optimally combining sampling techniques for Monte Carlo rendering", 1995; directions
// drawn about those of light sources: J. Krivanek & E. d'Eon, "A zero-variance-based sampling scheme for Monte Carlo
// subsurface scattering", SIGGRAPH 2014 talks.
#pragma once
#include <algorithm>
#include <vector>

#include "optics/phase_function.h"
#include "transport/wave.h"

namespace suite {

template <class Wave>
class EndGuide {
 public:
  using Path = typename Wave::Path;
  void prepare(const KernelContext& context, const Wave& wave);
  bool on() const { return light_ != nullptr; }
  // Looks at the nodes of the stage, straight towards the end.
  void find(const Wave& wave);
  // A way to a light that interfaces bend leaves the node towards `toward`.
  void find(const Wave& wave, size_t node, uint16_t light, Dir toward) {
    if (light_ && light == light_->index && guided_[node].chance > 0) look(wave, node, toward);
  }
  bool guides(const Wave& wave, const PathNode& node) const {
    return light_ && guided_[wave.number_of(node)].chance > 0;
  }
  // density: as the node draws; becomes that of both ways.
  void share(const Wave& wave, const PathNode& node, Dir in, std::span<float> density) const;
  void share(const Wave& wave, const PathNode& node, Continuation& on) const;
  // Draws a direction about that of the end; false: not this time, or nothing scatters so.
  bool draw(Wave& wave, const PathNode& node, std::span<float> memory, Continuation& on) const;

 private:
  // A quarter of even scattering of all of a path's light is worth a branch; less is by chance, kLeast at least.
  static constexpr double kCarries = 0.25, kLeast = 0.05;
  struct Guided {
    double chance = 0;  // s; 0: the node is left once
    Dir toward;
  };
  void look(const Wave& wave, size_t node, Dir toward);
  void densities(const Wave& wave, const PathNode& node, Dir in, std::span<float> density) const;

  const SampledLight* light_ = nullptr;    // the end; null: no branches
  const PhaseFunction* medium_ = nullptr;  // of surfaces' directions
  std::vector<Guided> guided_;             // [node]
};

// Where media do not scatter paths.
template <class Wave>
class NoEndGuide {
 public:
  void prepare(const KernelContext&, const Wave&) {}
  static constexpr bool on() { return false; }
  void find(const Wave&) {}
  void find(const Wave&, size_t, uint16_t, Dir) {}
  static constexpr bool guides(const Wave&, const PathNode&) { return false; }
  void share(const Wave&, const PathNode&, Dir, std::span<float>) const {}
  void share(const Wave&, const PathNode&, Continuation&) const {}
};

template <class Wave>
void EndGuide<Wave>::prepare(const KernelContext& context, const Wave& wave) {
  if (context.end == kNoLight || !wave.options.side_flights) return;
  const auto end = std::find_if(wave.lights.sampled.begin(), wave.lights.sampled.end(),
                                [&](const SampledLight& light) { return light.index == context.end; });
  if (end == wave.lights.sampled.end()) return;
  const size_t reference = wave.heroes.bins[0];
  double most = 0;
  std::vector<float> mean(wave.bins);
  for (const BakedMedium& medium : context.optics.media()) {
    if (!medium.scatters() || !(double{medium.scattering[reference]} > most)) continue;
    medium.phase->asymmetry(mean);
    if (!(double{mean[reference]} > kForwardScattering)) continue;
    most = double{medium.scattering[reference]}, medium_ = medium.phase.get();
  }
  if (medium_) light_ = &*end;
}

template <class Wave>
void EndGuide<Wave>::find(const Wave& wave) {
  if (!light_) return;
  guided_.assign(wave.nodes.size(), {});
  for (size_t i = 0; i < wave.nodes.size(); ++i) {
    const PathNode& node = wave.nodes[i];
    if (node.event ? wave.in_air(node) || !(wave.space.asymmetry(node.path) > kForwardScattering)
                   : wave.surfaces.is_sharp(node.path))
      continue;
    const Vec3 from = node.event ? wave.space.place(node.path) : wave.hits[node.slot].position;
    const auto end = light_->light->draw_place({}, {}, wave.time(node));
    const Vec3 way = end ? end->place - from : Vec3{};
    if (const double distance = length(way); distance > 0) look(wave, i, way / distance);
  }
}

// What the path's light comes to towards the end, over even scattering of all of it.
template <class Wave>
void EndGuide<Wave>::look(const Wave& wave, size_t i, Dir toward) {
  const PathNode& node = wave.nodes[i];
  const Path& path = wave.paths[node.path];
  float p[kMaxKnots];
  if (node.event)
    wave.space.densities(node.path, -path.direction, toward, {p, wave.knots()});
  else
    wave.surfaces.densities(node.path, -path.direction, toward, {p, wave.knots()});
  const double brings =
      4 * kPi * *std::max_element(path.throughput, path.throughput + wave.knots()) * path.relative.mean(wave.P(), p);
  guided_[i] = {brings > 0 ? std::clamp(brings / kCarries, kLeast, 1.0) : 0, toward};
}

template <class Wave>
void EndGuide<Wave>::densities(const Wave& wave, const PathNode& node, Dir in, std::span<float> density) const {
  const Dir toward = guided_[wave.number_of(node)].toward;
  if (node.event)
    wave.space.densities(node.path, -toward, in, density);
  else
    medium_->pdf(scattering_cosine(-toward, in), density);
}

template <class Wave>
void EndGuide<Wave>::share(const Wave& wave, const PathNode& node, Dir in, std::span<float> density) const {
  if (!guides(wave, node)) return;
  float g[kMaxKnots];
  densities(wave, node, in, {g, wave.knots()});
  for (size_t k = 0; k < wave.knots(); ++k)
    density[k] += static_cast<float>(guided_[wave.number_of(node)].chance) * g[k];
}

template <class Wave>
void EndGuide<Wave>::share(const Wave& wave, const PathNode& node, Continuation& on) const {
  if (on.dirac || !guides(wave, node)) return;
  float g[kMaxKnots];
  densities(wave, node, on.in, {g, wave.knots()});
  for (size_t k = 0; k < wave.knots(); ++k)
    on.density[k] += static_cast<float>(guided_[wave.number_of(node)].chance) * g[k];
  on.bright *= 1 + 4 * kPi * double{g[0]};  // the next vertex sees as much
}

template <class Wave>
bool EndGuide<Wave>::draw(Wave& wave, const PathNode& node, std::span<float> memory, Continuation& on) const {
  const Path& path = wave.paths[node.path];
  const Guided& guided = guided_[wave.number_of(node)];
  const Dir out = -path.direction;
  const std::array<double, 4> u = node.event ? dimensions::of_side(path.stream, path.sample, path.flights, 0)
                                             : dimensions::of_guided(path.stream, path.sample, path.surfaces - 1);
  if (u[3] >= guided.chance) return false;
  if (node.event) {
    if (!wave.space.scatter(node.path, -guided.toward, path.knot, {u[0], u[1]}, u[2], on.in)) return false;
    wave.space.densities(node.path, out, on.in, {on.density, wave.knots()});
  } else {
    on.in = scattered_direction(-guided.toward, medium_->sample(u[0], path.knot), u[1]);
    if (!wave.surfaces.takes(node.path, wave.hits[node.slot], out, on.in)) return false;
    wave.surfaces.densities(node.path, out, on.in, {on.density, wave.knots()});
  }
  on.dirac = false;
  on.weight = wave.evaluate(node, on.in, memory);
  share(wave, node, on);
  return true;
}

}  // namespace suite
