#include "heat_left_out.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/run_app.h"
#include "heat/heat_fluxes.h"
#include "heat/seen_warmth.h"
#include "sensor/view_cones.h"

namespace suite {

namespace {

struct Ball {
  Vec3 centre;
  double radius;
};

// Balls around an element, one around its part on each instance that it is of: these may stand far from each other.
std::vector<Ball> balls_of(const Elements& elements, size_t e) {
  constexpr uint32_t kPoints = 32;
  constexpr double kMore = 1.5;  // points do not lie on the rim
  const std::vector<Vec3> places = elements.places_by_instance(e, SampleStream(0x72696d, 0, e), kPoints);
  const double least = std::sqrt(elements[e].area * kPoints / static_cast<double>(places.size()));
  std::vector<Ball> balls;
  for (size_t from = 0; from < places.size(); from += kPoints) {
    Vec3 sum{};
    for (size_t k = from; k < from + kPoints; ++k) sum += places[k];
    Ball ball{sum / static_cast<double>(kPoints), least};
    for (size_t k = from; k < from + kPoints; ++k)
      ball.radius = std::max(ball.radius, kMore * length(places[k] - ball.centre));
    balls.push_back(ball);
  }
  return balls;
}

// A material of the elements whose infrared is not scattered evenly; empty = none.
std::string mirroring(const PreparedHeat& p) {
  const std::vector<bool> used = used_materials(*p.tracer);
  for (uint32_t m = 0; m < used.size(); ++m)
    if (const ScatterModel* model = used[m] ? p.optics.glow->material(m).model : nullptr; model && !model->diffuse())
      return p.tracer->scene().materials[m].id;
  return {};
}

size_t count_of(const std::vector<bool>& which) {
  return static_cast<size_t>(std::count(which.begin(), which.end(), true));
}

}  // namespace

std::vector<bool> elements_in_view(const Elements& elements, const Simulation& sim) {
  std::vector<ViewCone> cones;
  for (const auto& sensor : sim.sensors)
    for (const ViewCone& cone : view_cones(*sensor)) cones.push_back(cone);
  std::vector<uint8_t> seen(elements.size(), 0);
  parallel_for(0, elements.size(), 64, [&](size_t begin, size_t end) {
    for (size_t e = begin; e < end; ++e) {
      seen[e] = std::ranges::any_of(balls_of(elements, e), [&](const Ball& ball) {
        return std::ranges::any_of(cones, [&](const ViewCone& c) { return c.touches(ball.centre, ball.radius); });
      });
    }
  });
  return {seen.begin(), seen.end()};
}

void check_kept(const Elements& all, const Simulation& sim, const std::vector<uint32_t>& kept) {
  const std::vector<bool> seen = elements_in_view(all, sim);
  std::vector<bool> there(seen.size(), false);
  for (const uint32_t e : kept)
    if (e < there.size()) there[e] = true;
  size_t lacking = 0;
  for (size_t e = 0; e < seen.size(); ++e) lacking += seen[e] && !there[e];
  if (lacking > 0)
    throw Error(strf("%zu elements that the sensors may see were left out when the temperatures were found", lacking),
                "find them with these sensors too, or all ('influence_cutoff_k: 0')");
}

void keep_elements(PreparedHeat& p, const std::vector<uint32_t>& numbers) {
  std::vector<bool> kept(p.elements->size(), false);
  for (const uint32_t e : numbers) {
    if (e >= kept.size()) throw Error("temperatures of another scene: they are of elements that it does not have");
    kept[e] = true;
  }
  p.cut.kept = numbers;
  p.elements->keep(kept);
  p.faces = std::make_unique<HeatFaces>(*p.elements, p.optics);
}

LeftOut::LeftOut(PreparedHeat& p, const Simulation& sim, std::array<double, 2> air, const HeatProgress& progress)
    : faces_(std::move(p.faces)), seen_(elements_in_view(*p.elements, sim)), air_(air) {
  for (const auto& [name, place] : sim.heat->probes)
    seen_[element_of(*p.tracer, *p.elements, place, p.spec.span.begin)] = true;
  progress.begin("exchange of infrared", static_cast<double>(faces_->size()), "face");
  exchange_ = find_exchange({*p.tracer, *p.elements, *faces_, p.optics}, path_options(p.spec), nullptr,
                            [&](size_t more) { progress.done(static_cast<double>(more)); });
  influence_ = std::make_unique<const Influence>(exchange_, *faces_,
                                                 std::max({kWeatherBelow, hottest_given(p.tracer->scene()), air[1]}));
  const std::string mirror = mirroring(p);
  if (mirror.empty()) {
    // Some room: temperatures that differ raise the bound that holds in the end.
    kept_ = influence_->kept_for(seen_, sim.heat->leave_out / 3, (air[0] + air[1]) / 2);
  } else {
    kept_.assign(p.elements->size(), true);
    note("heat: no elements are left out: material '" + mirror +
         "' does not scatter infrared evenly, and what it shows may be anywhere");
  }
  std::vector<uint32_t> numbers;
  for (uint32_t e = 0; e < kept_.size(); ++e)
    if (kept_[e]) numbers.push_back(e);
  keep_elements(p, numbers);
  left_ = left_of(exchange_, *faces_, *p.faces, kept_);
}

double LeftOut::bound(const HeatResult& h) const {
  Influence::Range range{std::vector<double>(faces_->size(), air_[0]), std::vector<double>(faces_->size(), air_[1])};
  size_t row = 0;
  for (size_t f = 0; f < faces_->size(); ++f) {
    if (!kept_[faces_->element(f)]) continue;
    const auto first = h.kelvin.begin() + static_cast<std::ptrdiff_t>(row++ * h.moments);
    const auto [low, high] = std::minmax_element(first, first + static_cast<std::ptrdiff_t>(h.moments));
    range.low[f] = double{*low}, range.high[f] = double{*high};
  }
  return influence_->off_at_most(seen_, kept_, range, air_);
}

std::string LeftOut::sentence(const HeatResult& h) const {
  const size_t all = kept_.size(), kept = count_of(kept_);
  if (kept == all)
    return strf("none of the %zu elements are left out: all matter to the %zu in view", all, count_of(seen_));
  const double off = bound(h);
  const std::string left = strf("%zu of %zu elements are left out, %zu are in view", all - kept, all, count_of(seen_));
  if (off >= influence_->hottest())
    return left + strf(
                      ": how far they are from what they were with all of them has no bound here, if some of these "
                      "are as warm as %.4g K",
                      influence_->hottest());
  return left + strf(
                    " and within %.2g K of what they were with all of them, along the same paths, if nothing is "
                    "warmer than %.4g K",
                    off, influence_->hottest());
}

}  // namespace suite
