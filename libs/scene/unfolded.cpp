#include "scene/unfolded.h"

#include <algorithm>

#include "scene/presence.h"
#include "scene/primitives.h"

namespace suite {

namespace {

// The hierarchy without its places: how often each group places each other one.
struct Edges {
  struct Edge {
    uint32_t target;
    double times;
  };
  std::vector<std::vector<Edge>> to;
  std::vector<double> own;        // meshes and exact surfaces that a group itself places
  std::vector<char> fit;          // may be shared
  std::vector<uint32_t> level;    // longest way from the root: equal ones do not contain each other
  std::vector<double> instances;  // of Sharing

  explicit Edges(const Scene& scene)
      : to(scene.groups.size()), own(to.size(), 0), fit(to.size(), 1), level(to.size(), 0), instances(to.size(), 0) {
    std::vector<double> times(to.size(), 0), copies(to.size(), 0);
    for (size_t g = to.size(); g-- > 0;) {
      for (const Placement& p : scene.groups[g].placements) {
        const bool still = p.track == kNone && p.schedule == kNone;
        // What changes its material is unfolded once for each; they share the numbers of their instances.
        const double made = still ? 1 : static_cast<double>(made_of(scene, p.schedule).size());
        if (!still) fit[g] = 0;
        if (p.kind != TargetKind::group) {
          own[g] += made, instances[g] += 1;
          if (p.kind == TargetKind::primitive && primitive_box(scene.primitives[p.target]).empty()) fit[g] = 0;
          continue;
        }
        if (times[p.target] == 0) to[g].push_back({p.target, 0});
        times[p.target] += made, copies[p.target] += 1;
      }
      for (Edge& e : to[g]) {
        e.times = times[e.target];
        instances[g] += copies[e.target] * instances[e.target];
        times[e.target] = copies[e.target] = 0;
        if (!fit[e.target]) fit[g] = 0;
      }
    }
    for (size_t g = 0; g < to.size(); ++g)
      for (const Edge& e : to[g]) level[e.target] = std::max(level[e.target], level[g] + 1);
  }
};

// What each group holds and how often it is unfolded when some are shared.
struct Counts {
  std::vector<double> held, uses;
  double kept = 0;

  Counts(const Edges& edges, const std::vector<char>& shared) : held(edges.own), uses(held.size(), 0) {
    for (size_t g = held.size(); g-- > 0;)
      for (const Edges::Edge& e : edges.to[g]) held[g] += e.times * (shared[e.target] ? 1 : held[e.target]);
    for (size_t g = 0; g < held.size(); ++g) {
      if (g == 0 || (shared[g] && uses[g] > 0)) uses[g] = 1, kept += held[g];
      for (const Edges::Edge& e : edges.to[g]) uses[e.target] += uses[g] * e.times;
    }
  }
  double saving(size_t g) const { return uses[g] * held[g] - (uses[g] + held[g]); }
};

}  // namespace

Sharing share_groups(const Scene& scene, double most) {
  const Edges edges(scene);
  Sharing sharing{edges.instances, std::vector<char>(scene.groups.size(), 0), 0};
  for (;;) {
    const Counts counts(edges, sharing.shared);
    sharing.kept = counts.kept;
    if (!(counts.kept > most)) break;
    std::vector<size_t> order;
    for (size_t g = 1; g < edges.to.size(); ++g)
      if (edges.fit[g] && !sharing.shared[g] && counts.saving(g) > 0) order.push_back(g);
    if (order.empty()) break;
    // Of equal savings the larger group: rays then enter fewer.
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      const double x = counts.saving(a), y = counts.saving(b);
      return x != y ? x > y : counts.held[a] != counts.held[b] ? counts.held[a] > counts.held[b] : a < b;
    });
    // Others of its level that save nearly as much go with the best; what they save adds up.
    double kept = counts.kept;
    for (const size_t g : order) {
      if (!(kept > most) || counts.saving(g) < 0.5 * counts.saving(order.front())) break;
      if (edges.level[g] != edges.level[order.front()]) continue;
      sharing.shared[g] = 1;
      kept -= counts.saving(g);
    }
  }
  return sharing;
}

}  // namespace suite
