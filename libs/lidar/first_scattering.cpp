#include "lidar/first_scattering.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "light/air_vertices.h"
#include "math/sampling.h"
#include "optics/phase_function.h"
#include "transport/node.h"
#include "transport/serve.h"

namespace suite {

namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr int kMostLegs = 1 << 16;

const AirVertices* places_in(const Environment& environment) {
  return environment.atmosphere ? environment.atmosphere->vertices() : nullptr;
}

}  // namespace

bool FirstScattering::any(const LineKit& kit) {
  const auto media = kit.optics.media();
  return std::any_of(media.begin(), media.end(), [](const BakedMedium& m) { return m.scatters(); }) ||
         (places_in(kit.environment) && places_in(kit.environment)->any());
}

FirstScattering::FirstScattering(const LineKit& kit, const Light& end, const LaserEnd* laser)
    : kit_(kit),
      end_(end),
      laser_(laser),
      air_(kit.environment.atmosphere.get()),
      field_(kit.surface.tracer().scene(), kit.optics.state()),
      bodies_(kit.surface),
      flights_(field_, kit.optics, knot_),
      sight_(kit.surface, bodies_, flights_, kit.optics.media().size(), nullptr) {
  const size_t media = kit.optics.media().size();
  for (size_t m = 0; m < media; ++m) {
    leaves_.push_back(kit.leaves(m));
    delay_.push_back(kit.optics.media()[m].group_index);
    index_.push_back(std::sqrt(double{kit.optics.media()[m].index_squared[0]}));
  }
}

FirstScattering::~FirstScattering() = default;

double FirstScattering::air(Vec3 from, Dir direction, double length) {
  float T = 1;
  if (air_ && length > 0) air_->transmittance(from, direction, length, {&T, 1});
  return double{T};
}

// What walk_ stands in.
void FirstScattering::add_stretch(double begin, double end) {
  Stretch s{};
  s.begin = begin, s.end = end;
  s.depth = depth_, s.leaf_depth = leaf_depth_, s.fall_depth = fall_depth_, s.media_depth = media_depth_;
  s.contents = contents_.size(), s.leg = legs_.size() - 1, s.layer = walk_.layer();
  for (const Constituent& c : walk_.contents()) {
    const BakedMedium& m = kit_.optics.media()[c.medium];
    const double scattering = c.density * double{m.scattering[0]},
                 all = scattering + c.density * double{m.absorption[0]};
    s.rate += scattering, s.extinction += all;
    if (leaves_[c.medium]) s.leaves += all;
    if (scattering > 0) contents_.push_back(c), ++s.count;
  }
  s.media = s.rate;
  const AirVertices* const places = legs_.back().airless ? nullptr : places_in(kit_.environment);
  if (places && s.layer != kNone)
    s.rate += double{places->medium(s.layer).scattering[0]};
  else
    s.layer = kNone;
  s.fall = std::max(s.extinction, s.rate);
  const double length = std::min(end - begin, kEndlessWay);
  depth_ += s.extinction * length, leaf_depth_ += s.leaves * length, fall_depth_ += s.fall * length;
  media_depth_ += s.media * length;
  if (s.extinction > 0 || s.rate > 0) stretches_.push_back(s);
}

void FirstScattering::walk_leg(const Ray& ray, double begin, double length) {
  const uint32_t medium = legs_.back().stack.medium(kit_.surface.tracer().scene().ambient);
  const Vec3 from = ray.origin + ray.direction * begin;
  if (const AirLayers* layers = kit_.optics.air())
    walk_.start(field_, from, ray.direction, length, medium, ray.time, &layers->shells, layers->first);
  else
    walk_.start(field_, from, ray.direction, length, medium, ray.time,
                air_ && !legs_.back().airless ? &air_->shells() : nullptr);
  while (walk_.next()) add_stretch(begin + walk_.begin(), begin + walk_.end());
}

// The ray up to the first surface that is no boundary.
void FirstScattering::walk(const Ray& first) {
  stretches_.clear(), legs_.clear(), contents_.clear();
  depth_ = leaf_depth_ = fall_depth_ = media_depth_ = 0;
  MediumStack stack;
  if (bodies_.any()) stack = bodies_.around(first.origin, first.time, statistics_);
  const uint32_t ambient = kit_.surface.tracer().scene().ambient;
  Ray ray = first;
  double gone = 0, gap = 0, arrival = 0, through = 1;
  for (int leg = 0; leg < kMostLegs; ++leg) {
    Hit hit;
    kit_.surface.tracer().nearest({&ray, 1}, {&hit, 1}, false, statistics_);
    if (gap > 0) bodies_.settle(hit, ray, gap);
    if (!hit.hit()) bodies_.leave_scene(stack);
    const uint32_t medium = stack.medium(ambient);
    const bool known = medium != kNone && !index_.empty();
    const double length = hit.hit() ? hit.distance : kForever, delay = known ? delay_[medium] : 1;
    legs_.push_back({gone, arrival, delay, through, known && index_[medium] != 1, stack});
    walk_leg(first, gone, length);
    surface_at_ = gone + length;
    if (!hit.hit() || !bodies_.is_boundary(kit_.surface.material(hit))) break;
    ray.origin -= ray.direction * gap;
    const auto onward = bodies_.pass(stack, hit, ray, length - gap, statistics_);
    if (!onward) break;
    if (!legs_.back().airless) through *= air(first.origin + first.direction * gone, first.direction, length);
    gone += length, arrival += delay * length;
    gap = onward->gap;
    ray.origin = onward->start;
  }
}

double FirstScattering::phase(const Stretch& s, double cosine) {
  double sum = 0;
  float p = 0;
  for (size_t c = s.contents; c < s.contents + s.count; ++c) {
    const BakedMedium& m = kit_.optics.media()[contents_[c].medium];
    m.phase->eval(cosine, {&p, 1});
    sum += contents_[c].density * double{m.scattering[0]} * double{p};
  }
  if (s.layer != kNone) {
    const BakedMedium& m = places_in(kit_.environment)->medium(s.layer);
    if (m.scatters()) {
      m.phase->eval(cosine, {&p, 1});
      sum += double{m.scattering[0]} * double{p};
    }
  }
  return sum;
}

// Over its m11, between the meridian frames of both directions of travel. What is not known depolarises.
Mueller FirstScattering::mueller(const Stretch& s, Dir out, Dir in) const {
  const double cosine = scattering_cosine(out, in);
  PlaneBlocks all{0, 0, 0, 0, 0, 0}, one;
  double sum = 0;
  for (size_t c = s.contents; c < s.contents + s.count; ++c) {
    const BakedMedium& m = kit_.optics.media()[contents_[c].medium];
    float p = 0;
    m.phase->eval(cosine, {&p, 1});
    m.phase->polarised(cosine, {&one, 1});
    const double mine = contents_[c].density * double{m.scattering[0]} * double{p};
    all = all + one * mine, sum += mine;
  }
  return sum > 0 ? ScatteringPlane(out, in).matrix(all * (1 / sum)) : Mueller::depolariser();
}

auto FirstScattering::stretch_at(double t) const -> const Stretch* {
  const auto after =
      std::upper_bound(stretches_.begin(), stretches_.end(), t, [](double x, const Stretch& s) { return x < s.begin; });
  return after == stretches_.begin() ? nullptr : &*(after - 1);
}

double FirstScattering::fall_to(double t) const {
  const Stretch* const s = stretch_at(t);
  return s ? s->fall_depth + s->fall * std::clamp(t - s->begin, 0.0, s->end - s->begin) : 0;
}

double FirstScattering::at_fall(double depth) const {
  const auto after = std::upper_bound(stretches_.begin(), stretches_.end(), depth,
                                      [](double x, const Stretch& s) { return x < s.fall_depth; });
  const Stretch& s = after == stretches_.begin() ? stretches_.front() : *(after - 1);
  return s.fall > 0 ? s.begin + (depth - s.fall_depth) / s.fall : s.begin;
}

// Where light that arrives within the gate may be scattered: both ways together are at least as long as twice the ray's
// less the baseline, and no delay is above the greatest.
auto FirstScattering::span(const Vec3& origin, Vec3 end_place, const Gate& gate) const -> Span {
  const double baseline = length(end_place - origin);
  double slowest = 1;
  for (const Leg& leg : legs_) slowest = std::max(slowest, leg.delay);
  Span s{kForever, 0, 0, 0, 0, 0};
  for (const Stretch& x : stretches_)
    if (x.rate > 0) s.low = std::min(s.low, x.begin), s.high = std::max(s.high, x.end);
  s.low = std::max(s.low, (gate.start / slowest - baseline) / 2);
  s.high = std::min(s.high, (gate.stop + baseline) / 2);
  if (s.high > s.low) s.before = fall_to(s.low), s.all = -std::expm1(-2 * (fall_to(s.high) - s.before));
  return s;
}

double FirstScattering::air_up_to(const Ray& ray, const Leg& leg, double t) {
  return leg.airless ? leg.air : leg.air * air(ray.origin + ray.direction * leg.begin, ray.direction, t - leg.begin);
}

auto FirstScattering::direction(Dir along, Vec3 place, const BakedMedium& by, Vec2 u, Directions directions) const
    -> DrawnDirection {
  constexpr double kGuided = 0.5;  // of the paths
  const Vec3 way = end_place_ - place;
  const double distance = length(way);
  float mean = 0;
  by.phase->asymmetry({&mean, 1});
  if (directions == Directions::by_scattering || !(double{mean} > kForwardScattering) || !(distance > 0))
    return {scattered_direction(-along, by.phase->sample(u.x, 0), u.y), 1};
  const Dir toward = way / distance;
  const bool guided = u.x < kGuided;
  const double left = guided ? u.x / kGuided : (u.x - kGuided) / (1 - kGuided);
  const Dir in = scattered_direction(guided ? -toward : -along, by.phase->sample(left, 0), u.y);
  float own = 0, other = 0;
  by.phase->pdf(scattering_cosine(-along, in), {&own, 1});
  by.phase->pdf(scattering_cosine(-toward, in), {&other, 1});
  return {in, double{own} / ((1 - kGuided) * double{own} + kGuided * double{other})};
}

auto FirstScattering::go_on(const Ray& ray, const std::array<double, 4>& u, Directions directions)
    -> std::optional<Onward> {
  constexpr double kDense = 1;  // depth at which free flights are scattered often enough
  const Stretch* const last = stretch_at(reach_);
  if (!last) return std::nullopt;
  const double all = last->media_depth + last->media * std::clamp(reach_ - last->begin, 0.0, last->end - last->begin);
  if (!(all > 0 && media_depth_ < kDense)) return std::nullopt;
  const double chance = -std::expm1(-all), depth = -std::log1p(-u[0] * chance);
  const auto after = std::upper_bound(stretches_.begin(), stretches_.end(), depth,
                                      [](double x, const Stretch& s) { return x < s.media_depth; });
  if (after == stretches_.begin()) return std::nullopt;
  const Stretch& s = *(after - 1);
  if (!(s.media > 0)) return std::nullopt;
  const double t = s.begin + (depth - s.media_depth) / s.media;
  double choice = u[3] * s.media;
  const BakedMedium* by = nullptr;
  for (size_t c = s.contents; c < s.contents + s.count; ++c) {
    by = &kit_.optics.media()[contents_[c].medium];
    if ((choice -= contents_[c].density * double{by->scattering[0]}) < 0) break;
  }
  const Leg& leg = legs_[s.leg];
  const double absorbed = s.depth - s.media_depth + (s.extinction - s.media) * (t - s.begin);
  Onward on;
  const Vec3 place = ray.origin + ray.direction * t;
  const DrawnDirection drawn = direction(ray.direction, place, *by, {u[1], u[2]}, directions);
  on.ray = {place, drawn.in, ray.time, ray.draw};
  if (laser_) {
    PlaneBlocks blocks;
    by->phase->polarised(scattering_cosine(-ray.direction, on.ray.direction), {&blocks, 1});
    on.scattered = ScatteringPlane(-ray.direction, on.ray.direction).matrix(blocks);
  }
  on.weight = drawn.weight * chance * std::exp(-absorbed) * air_up_to(ray, leg, t);
  on.arrival = leg.arrival + leg.delay * (t - leg.begin);
  return on;
}

// t: m along the ray.
void FirstScattering::place(const Ray& ray, Vec3 end_place, const Gate& gate, double t, const Span& span,
                            std::vector<Scattered>& to) {
  const Stretch* const at = stretch_at(t);
  if (!at || !(t < at->end) || !(at->rate > 0)) return;
  const Stretch& s = *at;
  const double fallen = std::exp(-2 * (s.fall_depth + s.fall * (t - s.begin) - span.before));
  const double density = span.evenly / (span.high - span.low) + span.by_fall * 2 * s.fall * fallen / span.all;
  const Leg& leg = legs_[s.leg];
  const Vec3 x = ray.origin + ray.direction * t;
  const auto seen = end_.sample({x, {}, true}, {}, ray.time);
  if (!seen) return;
  const double arrival = leg.arrival + leg.delay * (t - leg.begin + seen->distance);
  const bool same = length(end_place - ray.origin) <= kSameWay * t;
  const double there_and_back = same ? 2 * (leg.arrival + leg.delay * (t - leg.begin)) : arrival;
  if (!(there_and_back >= gate.start && there_and_back < gate.stop)) return;
  const double depth = s.depth + s.extinction * (t - s.begin), leaves = s.leaf_depth + s.leaves * (t - s.begin);
  const double left = air_up_to(ray, leg, t) * std::exp(-depth);
  double light = phase(s, scattering_cosine(-ray.direction, seen->direction)) * seen->scale * left / density;
  if (!(light > 0)) return;
  const Stokes stokes =
      laser_ ? mueller(s, -ray.direction, seen->direction) * LaserEnd::stokes_of(seen->spectrum) : Stokes{1, 0, 0, 0};
  if (same) {
    // Both ends near each other, from the ray's on.
    light *= left * std::exp(leaves);
    const double more = seen->distance - t;
    to.push_back({there_and_back + leg.delay * more, light, seen->spectrum, stokes});
    return;
  }
  waiting_.push_back(
      {{arrival, light, seen->spectrum, stokes}, {x, seen->direction, ray.time, ray.draw}, seen->distance, s.leg});
}

// Those whose end has to be looked for.
void FirstScattering::answer(std::vector<Scattered>& to) {
  if (waiting_.empty()) return;
  rays_.clear(), sight_.clear();
  rays_.expect(waiting_.size());
  for (const Waiting& w : waiting_) {
    sight_.add(legs_[w.leg].stack);
    rays_.add(w.distance, false) = w.ray;
  }
  sight_.begin(rays_);
  for (TraceRequest request; sight_.next(request);) serve(kit_.surface.tracer(), request, statistics_);
  for (size_t i = 0; i < waiting_.size(); ++i) {
    Waiting& w = waiting_[i];
    if (rays_.blocked()[i]) continue;
    float T = 1;
    if (flights_.transmittance(sight_.depths(i), {&T, 1})) w.what.light *= double{T};
    if (!legs_[w.leg].airless) w.what.light *= air(w.ray.origin, w.ray.direction, w.distance);
    to.push_back(w.what);
  }
  waiting_.clear();
}

void FirstScattering::trace(const Ray& ray, Vec3 end_place, const Gate& gate, const Strata& strata,
                            std::vector<Scattered>& to) {
  to.clear();
  end_place_ = end_place;
  walk(ray);
  reach_ = (gate.stop + length(end_place - ray.origin)) / 2;
  surface_share_ =
      leaf_depth_ > 0 && length(end_place - ray.origin) <= kSameWay * surface_at_ ? std::exp(leaf_depth_) : 1;
  Span s = span(ray.origin, end_place, gate);
  if (!(s.high > s.low && s.all > 0)) return;
  const uint32_t by_fall = strata.samples / 2, evenly = strata.samples - by_fall;
  s.evenly = evenly, s.by_fall = by_fall;
  const auto number = [&](uint32_t j, uint32_t samples, uint64_t key) {
    const uint32_t stratum = j * strata.count + strata.index;
    return (stratum + unit_double(hash_of(key, stratum))) / (static_cast<double>(strata.count) * samples);
  };
  for (uint32_t j = 0; j < evenly; ++j)
    place(ray, end_place, gate, s.low + (s.high - s.low) * number(j, evenly, strata.key), s, to);
  for (uint32_t j = 0; j < by_fall; ++j) {
    const double fallen = -0.5 * std::log1p(-s.all * number(j, by_fall, ~strata.key));
    place(ray, end_place, gate, std::clamp(at_fall(s.before + fallen), s.low, s.high), s, to);
  }
  answer(to);
}

}  // namespace suite
