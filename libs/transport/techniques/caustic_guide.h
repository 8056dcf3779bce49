// Caustics by photon guiding (gloss_guide.h). A surface in such light draws a share of its continuations where photons
// came from, the others as it draws itself; both have the density of the mixture (one-sample MIS).
#pragma once
#include <algorithm>
#include <cmath>

#include "transport/gloss_guide.h"
#include "transport/wave.h"

namespace suite {

template <class Wave>
class CausticGuide {
 public:
  using Path = typename Wave::Path;
  // others: whether other guides are at work.
  void prepare(const KernelContext& context, bool others) { guide_ = others ? nullptr : context.gloss; }
  // Looks up the nodes of the stage.
  void find(const Wave& wave) {
    if (!guide_) return;
    of_node_.resize(wave.nodes.size());
    for (size_t i = 0; i < wave.nodes.size(); ++i) of_node_[i] = at(wave, wave.nodes[i]);
  }
  bool guides(const Wave& wave, const PathNode& node) const { return of(wave, node).cell != nullptr; }
  // density: as the surface draws; becomes that of both.
  void share(const Wave& wave, const PathNode& node, Dir in, std::span<float> density) const;
  // Draws node i's continuation by either.
  bool draw(Wave& wave, size_t i, Vec2 u, double lobe_u, std::span<float> memory, Continuation& on);

 private:
  GlossShare at(const Wave& wave, const PathNode& node) const;
  GlossShare of(const Wave& wave, const PathNode& node) const {
    return guide_ ? of_node_[wave.number_of(node)] : GlossShare{};
  }
  const GlossGuide* guide_ = nullptr;  // null: nothing glossy throws light
  std::vector<GlossShare> of_node_;
};

// Where all surfaces are matte.
template <class Wave>
class NoCausticGuide {
 public:
  void prepare(const KernelContext&, bool) {}
  void find(const Wave&) {}
  bool guides(const Wave&, const PathNode&) const { return false; }
  void share(const Wave&, const PathNode&, Dir, std::span<float>) const {}
  bool draw(Wave&, size_t, Vec2, double, std::span<float>, Continuation&) { return false; }
};

// Surfaces that draw hardly any directions there by themselves have little use for what they find there.
template <class Wave>
auto CausticGuide<Wave>::at(const Wave& wave, const PathNode& node) const -> GlossShare {
  if (node.event || wave.surfaces.is_sharp(node.path)) return {};
  const Hit& hit = wave.hits[node.slot];
  const GlossGuide::Cell* cell = guide_->at(hit.position);
  if (!cell) return {};
  const Vec3 way = cell->middle(hit.position);
  const double distance = length(way);
  if (!(distance > 0)) return {};
  const Dir in = way / distance, out = -wave.paths[node.path].direction;
  float density[kMaxKnots] = {};
  wave.surfaces.densities(node.path, out, in, {density, wave.knots()});
  const double matte = std::fabs(dot(in, hit.normal)) / kPi;
  const double uses = matte > 0 ? std::min(1.0, double{density[0]} / matte) : 0;
  constexpr double kLeast = 0.01;
  const double share = cell->share() * uses;
  return share > kLeast ? GlossShare{cell, share} : GlossShare{};
}

template <class Wave>
void CausticGuide<Wave>::share(const Wave& wave, const PathNode& node, Dir in, std::span<float> density) const {
  const GlossShare gloss = of(wave, node);
  if (!gloss.cell) return;
  const auto guided = static_cast<float>(gloss.share);
  const float there = guided * gloss.cell->density(wave.hits[node.slot].position, in);
  for (float& p : density) p = (1 - guided) * p + there;
}

template <class Wave>
bool CausticGuide<Wave>::draw(Wave& wave, size_t i, Vec2 u, double lobe_u, std::span<float> memory, Continuation& on) {
  const PathNode& node = wave.nodes[i];
  const Path& path = wave.paths[node.path];
  const auto [cell, guided] = of(wave, node);
  const Hit& hit = wave.hits[node.slot];
  const Dir out = -path.direction;
  if (u.x < guided) {
    on.in = cell->draw(hit.position, {u.x / guided, u.y});
    if (!wave.surfaces.takes(node.path, hit, out, on.in)) return false;
    on.dirac = false;
    wave.surfaces.densities(node.path, out, on.in, {on.density, wave.knots()});
    on.weight = wave.evaluate(node, on.in, memory);
  } else if (!wave.surfaces.sample(i, node.path, hit, out, {(u.x - guided) / (1 - guided), u.y}, lobe_u, path.knot,
                                   memory, on)) {
    return false;
  }
  const double own = double{on.density[path.knot]};
  share(wave, node, on.in, {on.density, wave.knots()});
  // Roulette looks at the light that a path may find, not at how often it is sent there.
  if (own > 0) on.bright = double{on.density[path.knot]} / own;
  return true;
}

}  // namespace suite
