// The sun straight on faces, what points that look at it all day miss: edges of shadows that pass are told from what
// other blocks' points see; where those do not agree with what is told, more points look, once each.
#include <algorithm>
#include <cmath>

#include "heat/sunlight_wave.h"

namespace suite {

namespace {

constexpr uint64_t kTold = 0x746f6c64;  // purpose of points whose days are told from others'
constexpr uint32_t kToldPoints = 64;    // of a block
constexpr uint64_t kMore = 0x6d6f7265;  // of points that look once
constexpr double kMoreEvery = 150;      // s, between the looks of one point's share where nothing is certain
constexpr double kAgreed = 1e-3;        // mean square of what is not told of a step that is lit or dark

double step_of(const SunCourse& course) {
  return course.moments.size() > 1 ? course.moments[1] - course.moments[0] : 1;
}
uint32_t most_more(const SunCourse& course) {
  return static_cast<uint32_t>(std::max(1.0, std::round(step_of(course) / kMoreEvery)));
}

}  // namespace

PathOptions asking_more(const PathOptions& watching, const SunCourse& course) {
  const auto steps = static_cast<uint32_t>(course.moments.size());
  return {watching.blocks, 2 * watching.half() * most_more(course) * std::max(1u, steps), watching.seed};
}

// A hat's integral is a step, of the first and last moment half a one.
void SunlightWave::put_lit(uint32_t block, double sign, size_t moment, double value) {
  const size_t moments = suns_.size();
  const double hats = moment == 0 || moment + 1 == moments ? 2 : 1;
  beam_[moment] += static_cast<float>(hats * value / options_.blocks);
  parts_[block * Sunlight::kParts + moment * Sunlight::kParts / moments] += static_cast<float>(sign * value);
}

// Puts the integral of what is taken onto the moments, by the hats of straight lines between them.
void SunlightWave::add_lit(uint32_t face, uint32_t block, double sign, std::span<const float> takes,
                           std::span<const float> shares) {
  lit_.spread(takes, shares, [&](size_t moment, double value) { put_lit(block, sign, moment, value); });
  out_.sun_hours[face] += static_cast<float>(lit_.total(shares) * step_ / 3600 / options_.blocks);
}

SunlightWave::Told SunlightWave::told_of(const BlockOfFace& of) const {
  std::vector<const PointDay*> others;
  for (size_t k = 0; k < of.watches.size(); ++k)
    if (!of.own(k)) others.push_back(&of.days[k]);
  Told told{PassingEdges(others, course_.angular_radius > 0, kFinestEdge), {}, {}, {}, {}, false};
  const bool change = std::ranges::any_of(
      others, [&](const PointDay* d) { return !d->changes.empty() || d->lit_first != others.front()->lit_first; });
  if (!change) return told;
  told.takes.assign(suns_.size(), 0.0f);
  for (size_t k = 0; k < of.watches.size(); ++k)
    for (size_t m = 0; m < told.takes.size() && !of.own(k); ++m)
      told.takes[m] += of.watches[k].takes[m] / static_cast<float>(others.size());
  plan_more(of, told);
  return told;
}

// Where the other blocks' points were not lit as told, in proportion to what they scatter by.
void SunlightWave::plan_more(const BlockOfFace& of, Told& told) const {
  const size_t steps = suns_.size() - 1, n = of.watches.size();
  const float one = 1.0f / static_cast<float>(n - n / options_.blocks);
  LitTime as_told = lit_;
  std::vector<float> off(steps), square(steps, 0.0f);
  told.even.assign(steps, 0.0f);
  for (size_t k = 0; k < n && !told.edges.moves(); ++k)
    for (size_t m = 0; m < steps && !of.own(k); ++m) told.even[m] += one * lit_by_step_[k * steps + m];
  for (size_t k = 0; k < n; ++k) {
    if (of.own(k)) continue;
    if (told.edges.moves()) {
      as_told.clear();
      as_told.add(told.edges.at(of.days[k].place, course_.moments.front(), course_.moments.back()), 1);
      as_told.by_step(off);
    } else {
      off = told.even;
    }
    for (size_t m = 0; m < steps; ++m) {
      const float d = lit_by_step_[k * steps + m] - off[m];
      square[m] += one * d * d;
    }
  }
  const double most = most_more(course_);
  told.more.assign(steps, 0), told.own_day.assign(steps, 1.0f);
  for (size_t m = 0; m < steps; ++m) {
    if (!(double{square[m]} > kAgreed) || told.takes[m] + told.takes[m + 1] == 0) {
      told.even[m] = 0;
      continue;
    }
    told.more[m] = static_cast<uint32_t>(std::ceil(most * std::min(1.0, 2 * std::sqrt(double{square[m]}))));
    told.own_day[m] = 1 / (1.0f + static_cast<float>(told.more[m]));
    told.any = true;
  }
}

// All of a block is what is told of many points, and what its own find less what is told of them: those that look all
// day and those that look once. All that is told takes what the other blocks' points do.
void SunlightWave::add_block(const BlockOfFace& of) {
  const Told told = told_of(of);
  for (size_t k = 0; k < of.watches.size(); ++k) {
    if (!of.own(k) || (!of.days[k].lit_first && of.days[k].changes.empty())) continue;
    lit_.clear();
    lit_.add(of.days[k], 1.0 / watches_of_block());
    add_lit(of.watches[k].face, of.block, of.watches[k].half ? -1 : 1, of.watches[k].takes, told.own_day);
  }
  if (told.takes.empty()) return;
  for (const uint32_t half : {0u, 1u}) add_told(of, told, half);
  if (told.any) ask_more(of, told);
}

void SunlightWave::add_told(const BlockOfFace& of, const Told& told, uint32_t half) {
  const double begin = course_.moments.front(), end = course_.moments.back(), sign = half ? -1 : 1;
  const uint32_t face = of.watches.front().face;
  if (!told.edges.moves()) {
    // The same of all points: of those that look once, which add to 1 with those that look all day.
    for (size_t m = 0; m < told.more.size(); ++m) {
      const double share = 0.5 * double{told.even[m]} * (1 - double{told.own_day[m]});
      if (share == 0) continue;
      put_lit(of.block, sign, m, share * (told.takes[m] / 3.0 + told.takes[m + 1] / 6.0));
      put_lit(of.block, sign, m + 1, share * (told.takes[m] / 6.0 + told.takes[m + 1] / 3.0));
      out_.sun_hours[face] += static_cast<float>(share * step_ / 3600 / options_.blocks);
    }
    return;
  }
  lit_.clear();
  for (size_t k = 0; k < of.watches.size(); ++k)
    if (of.own(k) && of.watches[k].half == half)
      lit_.add(told.edges.at(of.days[k].place, begin, end), -1.0 / watches_of_block());
  add_lit(face, of.block, sign, told.takes, told.own_day);
  lit_.clear();
  const PathOptions many{options_.blocks, kToldPoints, options_.seed};
  for (uint32_t k = 0; k < many.half(); ++k) {
    const PathNumbers numbers(many, kTold, faces_.number(face), of.block * many.paths + half * many.half() + k);
    const Hit hit = elements_.point(faces_.element(face), numbers.first_point());
    const std::array<double, 4> u = numbers.net().draw(numbers.sample(), 0);
    const Vec2 d = disk_from_square({u[0], u[1]});
    lit_.add(told.edges.at(place_of(face, hit.position, d.x, d.y), begin, end), 1.0 / kToldPoints);
  }
  add_lit(face, of.block, sign, told.takes, {});
}

// Points that look once go on through the same parts of the element and of the step from one step to the next.
void SunlightWave::ask_more(const BlockOfFace& of, const Told& told) {
  struct Look {
    size_t step;
    double at, takes, told, sign;  // at: of the step, 0 to 1
    bool seen;
  };
  std::vector<Look> looks;
  std::vector<size_t> asked;
  sights_.clear();
  const uint32_t face = of.watches.front().face;
  for (const uint32_t half : {0u, 1u}) {
    uint32_t next = of.block * more_.paths + half * more_.half();
    for (size_t m = 0; m < told.more.size(); ++m)
      for (uint32_t k = 0; k < told.more[m] * watching_.half(); ++k, ++next) {
        const PathNumbers numbers(more_, kMore, faces_.number(face), next);
        const std::array<double, 4> u = numbers.net().draw(numbers.sample(), 0);
        const Watch w = watch_of(face, numbers, u);
        const double t = course_.moments[m] + u[2] * step_;
        Look look{m, u[2], 0, double{told.even[m]}, half ? -1.0 : 1.0, false};
        if (told.edges.moves())
          look.told = told.edges.lit_at(place_of(face, w.hit.position, w.disk_x, w.disk_y), t) ? 1 : 0;
        const Dir d = towards_sun(w, t);
        if (d.z > 0 && dot(d, normal_at(w, t)) > 0) {
          look.takes = takes_between(w, m, u[2], d);
          sights_.push_back({tracer_.leave(hit_at(w, t), d), d, t, 0});
          asked.push_back(looks.size());
        }
        looks.push_back(look);
      }
  }
  reach_.assign(sights_.size(), INFINITY), blocked_.assign(sights_.size(), 0);
  tracer_.occluded(sights_, reach_, blocked_, true, trace_);
  for (size_t i = 0; i < asked.size(); ++i) looks[asked[i]].seen = !blocked_[i];
  for (const Look& look : looks) {
    const size_t m = look.step;
    const double weight = double{told.own_day[m]} / watches_of_block();
    const double as_told = (1 - look.at) * double{told.takes[m]} + look.at * double{told.takes[m + 1]};
    const double value = weight * ((look.seen ? look.takes : 0) - look.told * as_told);
    put_lit(of.block, look.sign, m, value * (1 - look.at));
    put_lit(of.block, look.sign, m + 1, value * look.at);
    out_.sun_hours[face] +=
        static_cast<float>(weight * ((look.seen ? 1 : 0) - look.told) * step_ / 3600 / options_.blocks);
  }
}

}  // namespace suite
