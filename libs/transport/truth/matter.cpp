// What the first things met are made of and belong to.
#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "scene/leaves.h"
#include "transport/truth/truth.h"

namespace suite {

namespace {

// The most frequent of a few identifiers, seen in turn, in little memory: any id seen in more than a fifth of the
// samples survives, which includes every majority. Based on: Misra & Gries, "Finding repeated elements", 1982; joined
// as in Agarwal et al., "Mergeable summaries", PODS 2012, section 2, which keeps that promise.
constexpr size_t kVotes = 4;
struct Votes {  // (id + 1, count) pairs in the slots; (0, 0) = free
  static void add(double* slots, uint32_t id) {
    for (size_t i = 0; i < kVotes; ++i)
      if (slots[2 * i + 1] > 0 && slots[2 * i] == id + 1.0) {
        ++slots[2 * i + 1];
        return;
      }
    for (size_t i = 0; i < kVotes; ++i)
      if (!(slots[2 * i + 1] > 0)) {
        slots[2 * i] = id + 1.0;
        slots[2 * i + 1] = 1;
        return;
      }
    for (size_t i = 0; i < kVotes; ++i) --slots[2 * i + 1];
  }
  static void join(const double* others, double* slots) {
    std::array<std::array<double, 2>, 2 * kVotes> all{};  // ours, then those that only others have
    for (size_t i = 0; i < kVotes; ++i) all[i] = {slots[2 * i], slots[2 * i + 1]};
    size_t end = kVotes;
    for (size_t i = 0; i < kVotes; ++i) {
      const double id = others[2 * i], count = others[2 * i + 1];
      if (!(count > 0)) continue;
      size_t at = 0;
      while (at < end && !(all[at][1] > 0 && all[at][0] == id)) ++at;
      if (at == end) end += 1, all[at] = {id, 0};
      all[at][1] += count;
    }
    std::array<double, 2 * kVotes> counts{};
    for (size_t i = 0; i < end; ++i) counts[i] = all[i][1];
    std::nth_element(counts.begin(), counts.begin() + kVotes, counts.end(), std::greater<>());
    std::fill_n(slots, 2 * kVotes, 0.0);
    size_t kept = 0;
    for (size_t i = 0; i < end; ++i) {
      const double count = all[i][1] - counts[kVotes];  // what the fifth has, all give up
      if (!(count > 0)) continue;
      slots[2 * kept] = all[i][0], slots[2 * kept + 1] = count;
      ++kept;
    }
  }
  static size_t most(const double* slots) {
    size_t best = 0;
    for (size_t i = 1; i < kVotes; ++i)
      if (slots[2 * i + 1] > slots[2 * best + 1]) best = i;
    return best;
  }
};

enum class What { material, instance, tag, object };
uint32_t id_of(What what, const TruthContext& c, const FirstMeeting& node) {
  if (node.object == kNone && what != What::material) return kNone;  // the Earth is no instance and has no tag
  switch (what) {
    case What::material:
      return node.at->material;
    case What::instance:
      if (node.object == kNone) return kNone;  // the Earth under the scene
      return c.tracer.object(node.object).instance;
    case What::tag:
    case What::object:
      break;
  }
  return node.object != kNone ? c.tracer.object(node.object).tag : kNone;
}

struct Majority final : TruthCollector {
  Majority(const TruthContext& c, What w, std::string name, bool f)
      : context(c), what(w), column(std::move(name)), fraction(f) {
    if (what == What::object) leaves.emplace(c.tracer.scene());
  }
  size_t slots() const override { return 2 * kVotes; }
  std::vector<std::string> columns() const override { return {column}; }
  void add(const TruthSample& s, double* slots) const override {
    if (!s.first) return;
    const uint32_t id = id_of(leaves ? What::instance : what, context, *s.first);
    Votes::add(slots, leaves && id != kNone ? static_cast<uint32_t>(leaves->object_of(id)) : id);
  }
  void join(const double* others, double* slots) const override { Votes::join(others, slots); }
  void finish(const double* slots, const TruthCounts& n, double* v) const override {
    const size_t best = Votes::most(slots);
    const double id = slots[2 * best] - 1, count = slots[2 * best + 1];
    if (!(count > 0) || id == static_cast<double>(kNone)) return;
    v[0] = fraction ? count / n.paths : id;
  }
  TruthContext context;
  What what;
  std::string column;
  bool fraction;
  std::optional<Leaves> leaves;  // of objects
};

// The share of all samples that met each material or tag first.
struct Abundance final : TruthCollector {
  Abundance(const TruthContext& c, What w) : context(c), what(w) {
    const Scene& scene = c.tracer.scene();
    if (what == What::tag)
      for (const std::string& t : scene.tags) names.push_back("share of tag " + t);
    else
      for (const Material& m : scene.materials) names.push_back("share of material " + m.id);
    if (names.empty()) throw Error("the truth 'abundance' needs a scene with tags", "tag placements in the scene text");
  }
  size_t slots() const override { return names.size(); }
  std::vector<std::string> columns() const override { return names; }
  void add(const TruthSample& s, double* slots) const override {
    if (!s.first) return;
    if (const uint32_t id = id_of(what, context, *s.first); id < names.size()) ++slots[id];
  }
  void finish(const double* slots, const TruthCounts& n, double* v) const override {
    for (size_t i = 0; i < names.size(); ++i) v[i] = slots[i] / n.paths;
  }
  TruthContext context;
  What what;
  std::vector<std::string> names;
};

// Directional-hemispherical reflectance (and transmittance) towards the sensor, averaged over each band's response.
struct Reflectance final : TruthCollector {
  explicit Reflectance(const TruthContext& c) : context(c) {}
  size_t slots() const override { return context.projection.bands() + 1; }
  std::vector<std::string> columns() const override {
    std::vector<std::string> names;
    for (size_t b = 0; b < context.projection.bands(); ++b) names.push_back("reflectance " + context.bands[b].name);
    return names;
  }
  void add(const TruthSample& s, double* slots) const override {
    if (!s.first || !s.first->at->baked || !s.first->at->baked->model) return;
    thread_local std::vector<float> w;
    w.resize(context.state.size());
    s.first->at->baked->model->total(s.first->at->frame.to_local(s.first->out), w);
    ++slots[0];
    context.projection.add(w, {slots + 1, context.projection.bands()});
  }
  void finish(const double* slots, const TruthCounts&, double* v) const override {
    for (size_t b = 0; b < context.projection.bands(); ++b)
      if (slots[0] > 0) v[b] = slots[b + 1] / slots[0];
  }
  TruthContext context;
};

template <What what, bool fraction>
std::unique_ptr<const TruthCollector> majority(const TruthContext& c) {
  static const std::array<std::string, 4> names{"material", "instance", "tag", "object"};
  const std::string& name = names[static_cast<size_t>(what)];
  return std::make_unique<Majority>(c, what, fraction ? name + " fraction" : name, fraction);
}

}  // namespace

void add_matter_rows(std::vector<TruthRow>& table) {
  table.push_back({"material", "number of the most frequent material", "", majority<What::material, false>});
  table.push_back({"material_fraction", "its share of all samples (exact up to 4 different ones)", "",
                   majority<What::material, true>});
  table.push_back({"instance", "number of the most frequent instance", "", majority<What::instance, false>});
  table.push_back({"instance_fraction", "its share of all samples (exact up to 4 different ones)", "",
                   majority<What::instance, true>});
  table.push_back({"tag", "number of the most frequent tag", "", majority<What::tag, false>});
  table.push_back(
      {"tag_fraction", "its share of all samples (exact up to 4 different ones)", "", majority<What::tag, true>});
  table.push_back({"object",
                   "number of the most frequent tagged thing: a tagged group is one, by its first instance; comes by "
                   "itself with tag and instance where groups have tags",
                   "", majority<What::object, false>});
  table.push_back({"abundance", "share of all samples that met each tag, one column a tag", "",
                   [](const TruthContext& c) -> std::unique_ptr<const TruthCollector> {
                     return std::make_unique<Abundance>(c, What::tag);
                   }});
  table.push_back({"material_abundance", "the same for each material of the scene", "",
                   [](const TruthContext& c) -> std::unique_ptr<const TruthCollector> {
                     return std::make_unique<Abundance>(c, What::material);
                   }});
  table.push_back({"reflectance", "directional-hemispherical reflectance of the first surfaces, one column a band", "",
                   [](const TruthContext& c) -> std::unique_ptr<const TruthCollector> {
                     return std::make_unique<Reflectance>(c);
                   }});
}

}  // namespace suite
