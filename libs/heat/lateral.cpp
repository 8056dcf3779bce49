#include "heat/lateral.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

constexpr double kFilm = 12;  // W/(m2 K), of a light wind with radiation

// W/K of a sheet a metre wide and long, no deeper than a day's warmth goes.
double sheet_of(const std::vector<SlabLayer>& layers) {
  constexpr double kDay = 86400;  // s
  double sheet = 0;
  for (const SlabLayer& layer : layers) {
    const double k = layer.conductivity[0], deep = std::sqrt(k * kDay / (kPi * layer.density * layer.specific_heat[0]));
    sheet += k * std::min(layer.thickness, deep);
    if (layer.thickness > deep) break;
  }
  return sheet;
}

bool conduct(const HeatedMaterial& a, const HeatedMaterial& b) {
  return !a.layers.empty() && alike(a.layers, b.layers) && a.back_open == b.back_open;
}

// What an element lacks of its neighbours, through the span.
class Change {
 public:
  Change(const Elements& elements, const HeatOptics& optics, const SurfaceHistory& history)
      : moments_((history.moments + kEvery - 1) / kEvery),
        from_(elements.size() * moments_, 0.0f),
        held_(elements.size(), kFilm) {
    for (const ElementContact& c : elements.contacts()) {
      const HeatedMaterial &a = optics.heated[elements[c.a].material], &b = optics.heated[elements[c.b].material];
      if (!conduct(a, b)) continue;
      const double watts = c.ratio * sheet_of(a.layers);
      for (const auto& [to, other] : {std::pair{c.a, c.b}, {c.b, c.a}}) {
        const double g = watts / elements[to].area;
        held_[to] += g;
        for (size_t m = 0; m < moments_; ++m)
          from_[to * moments_ + m] +=
              static_cast<float>(g * (history.kelvin_at(other, m * kEvery) - history.kelvin_at(to, m * kEvery)));
      }
    }
  }
  size_t moments() const { return moments_; }
  double kelvin(size_t element, size_t moment) const {
    return double{from_[element * moments_ + moment]} / held_[element];
  }

 private:
  static constexpr size_t kEvery = 8;  // moments
  size_t moments_;
  std::vector<float> from_;   // W/m2
  std::vector<double> held_;  // W/(m2 K)
};

}  // namespace

// The length of a fin is sqrt(k d / h), h as kFilm; places nearer than three of it differ little.
double evened_over(const std::vector<SlabLayer>& layers) { return 3 * std::sqrt(sheet_of(layers) / kFilm); }

LateralConduction lateral_conduction(const Elements& elements, const HeatOptics& optics) {
  LateralConduction out;
  for (size_t e = 0; e < elements.size(); ++e) out.neighbours.areas.push_back(elements[e].area);
  for (const ElementContact& c : elements.contacts()) {
    const HeatedMaterial &a = optics.heated[elements[c.a].material], &b = optics.heated[elements[c.b].material];
    if (conduct(a, b))
      out.neighbours.contacts.push_back({c.a, c.b, c.ratio});
    else
      out.apart += !a.layers.empty() && !b.layers.empty();
  }
  return out;
}

std::vector<std::string> lateral_notes(const Scene& scene, const Elements& elements, const HeatOptics& optics,
                                       const SurfaceHistory& history) {
  const size_t materials = scene.materials.size();
  std::vector<size_t> small(materials, 0), all(materials, 0);
  std::vector<double> reach(materials, 0);
  for (size_t m = 0; m < materials; ++m) reach[m] = evened_over(optics.heated[m].layers);
  for (size_t e = 0; e < elements.size(); ++e) {
    const uint32_t m = elements[e].material;
    ++all[m], small[m] += std::sqrt(elements[e].area) < reach[m];
  }
  if (std::ranges::all_of(small, [](size_t n) { return n == 0; })) return {};
  const Change change(elements, optics, history);
  std::vector<double> squares(materials, 0), areas(materials, 0), most(materials, 0);
  for (size_t e = 0; e < elements.size(); ++e) {
    const uint32_t m = elements[e].material;
    areas[m] += elements[e].area;
    for (size_t k = 0; k < change.moments(); ++k) {
      const double by = std::fabs(change.kelvin(e, k));
      squares[m] += elements[e].area * by * by / static_cast<double>(change.moments());
      most[m] = std::fmax(most[m], by);
    }
  }
  std::vector<std::string> notes;
  for (size_t m = 0; m < materials; ++m)
    if (small[m] > 0)
      notes.push_back(
          strf("material '%s': %zu of %zu elements are smaller than the %.2g m over which conduction along the surface "
               "evens temperatures out, which is left out: about %.2g K (root mean square, %.2g K at most); "
               "'lateral_conduction: true' follows it",
               scene.materials[m].id.c_str(), small[m], all[m], reach[m], std::sqrt(squares[m] / areas[m]), most[m]));
  return notes;
}

std::string apart_note(const LateralConduction& lateral) {
  if (lateral.apart == 0) return {};
  return strf(
      "%zu pairs of elements that touch have other layers, or one an open and one a closed back: nothing conducts "
      "between them along the surface, beside %zu pairs that do",
      lateral.apart, lateral.neighbours.contacts.size());
}

}  // namespace suite
