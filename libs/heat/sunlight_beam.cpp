// The sun straight on faces: shadow rays at every moment of the day, edges to 10 s, integrals over what lies between.
#include <algorithm>

#include "heat/sunlight_wave.h"

namespace suite {

namespace {

constexpr uint64_t kPurpose = 0x6265616d;
constexpr size_t kWatches = 4096;  // at once

std::vector<Frame> suns_of(const SunCourse& course) {
  std::vector<Frame> out;
  for (const double t : course.moments) out.push_back(Frame::around(course.towards(t)));
  return out;
}

PathOptions watching(const PathOptions& options) { return {options.blocks, points_of_beam(options), options.seed}; }

}  // namespace

SunlightWave::SunlightWave(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                           const HeatOptics& optics, const SunCourse& course, const PathOptions& options,
                           uint32_t joins, Sunlight& out)
    : tracer_(tracer),
      elements_(elements),
      faces_(faces),
      course_(course),
      options_(options),
      watching_(watching(options)),
      more_(asking_more(watching_, course)),
      joins_(joins),
      out_(out),
      surface_(tracer, *optics.sun),
      bins_(optics.sun->state().size()),
      knots_(optics.sun->state().knots.size()),
      step_(course.moments.size() > 1 ? course.moments[1] - course.moments[0] : 1),
      sunny_(course.sunny()),
      suns_(suns_of(course)),
      told_sun_(course, suns_, sunny_, options.blocks * points_of_beam(options)),
      told_(sunny_.size()),
      W_(bins_),
      w_(bins_),
      walk_(optics.sun->state()),
      lit_(course.moments.empty() ? 0 : course.moments.front(), step_, std::max<size_t>(1, course.moments.size()) - 1) {
  if (elements.rests().empty()) return;
  shares_ = interval_shares(elements.rests(), course.moments);
  for (const std::vector<float>& share : shares_) {
    std::vector<uint32_t>& within = sunny_within_.emplace_back();
    for (uint32_t k = 0; k < sunny_.size(); ++k)
      if (share[sunny_[k]] > 0) within.push_back(k);
  }
}

Dir SunlightWave::towards_sun(const Watch& watch, double t) const {
  return on_disk(Frame::around(course_.towards(t)), watch.disk_x, watch.disk_y, course_.angular_radius);
}

void SunlightWave::beam(size_t begin, size_t end) {
  if (sunny_.empty()) return;
  const size_t together = std::max<size_t>(1, kWatches / (size_t{options_.blocks} * watches_of_block()));
  for (size_t f = begin; f < end; f += together) beam_of(f, std::min(end, f + together));
}

SunlightWave::Watch SunlightWave::watch_of(uint32_t face, const PathNumbers& numbers,
                                           const std::array<double, 4>& disk) const {
  Watch w;
  w.face = face, w.block = numbers.block(), w.half = numbers.half();
  w.hit = elements_.point(faces_.element(face), numbers.first_point(0));
  w.normal = faces_.is_back(face) ? -w.hit.normal : w.hit.normal;
  if (!elements_.rests().empty() && elements_.changes_place(faces_.element(face)))
    for (uint32_t k = 0; k < elements_.rests().size(); ++k) {
      const Hit hit = elements_.point(faces_.element(face), numbers.first_point(k));
      w.stands.push_back({hit, faces_.is_back(face) ? -hit.normal : hit.normal});
    }
  const Vec2 d = disk_from_square({disk[0], disk[1]});
  w.disk_x = d.x, w.disk_y = d.y;
  return w;
}

void SunlightWave::beam_of(size_t begin, size_t end) {
  std::vector<Watch> watches;
  for (size_t f = begin; f < end; ++f)
    for (uint32_t k = 0; k < watching_.blocks * watching_.paths; ++k) {
      const auto face = static_cast<uint32_t>(f);
      const PathNumbers numbers(watching_, kPurpose, faces_.number(face), k);
      watches.push_back(watch_of(face, numbers, numbers.net().draw(numbers.sample(), 0)));
    }
  look(watches);
  std::vector<Edge> edges;
  find_edges(watches, edges);
  std::vector<PointDay> days;
  size_t from = 0;
  for (size_t k = 0; k < watches.size(); ++k) {
    size_t to = from;
    while (to < edges.size() && edges[to].watch == k) ++to;
    days.push_back(day_of(watches[k], {edges.data() + from, to - from}));
    from = to;
  }
  const size_t each = size_t{options_.blocks} * watches_of_block();
  for (size_t k = 0; k < watches.size(); k += each) add_face({&watches[k], each}, {&days[k], each});
}

// What even, opaque surfaces keep of the beam depends on nothing but the moment; empty for others.
std::span<const float> SunlightWave::kept_by(const Watch& watch) {
  surface_.interact(watch.hit, watch.normal, at_, watch.hit.time);
  const bool of_a_map = at_.own && at_.baked == &at_.own->made;
  const float* diffuse = at_.baked && at_.baked->model && !of_a_map ? at_.baked->model->diffuse() : nullptr;
  if (!diffuse) return {};
  if (diffuse == kept_of_) return kept_;
  kept_of_ = diffuse, kept_.assign(suns_.size(), 0.0f);
  for (size_t m = 0; m < kept_.size(); ++m)
    for (size_t i = 0; i < bins_; ++i) kept_[m] += course_.beam[m][i] * (1 - std::min(1.0f, diffuse[i]));
  return kept_;
}

float SunlightWave::taken(const Watch& watch, uint32_t moment, Dir d) {
  const double t = course_.moments[moment], cosine = dot(d, normal_at(watch, t));
  surface_.interact(hit_at(watch, t), d, at_, t);
  if (!at_.baked || !at_.baked->model) return 0;
  at_.baked->model->total(at_.frame.to_local(d), W_);
  double kept = 0;
  for (size_t i = 0; i < bins_; ++i) kept += double{course_.beam[moment][i]} * (1 - double{std::min(1.0f, W_[i])});
  return static_cast<float>(cosine * kept);
}

// At a time between a moment and the next one, of a beam of 1 that is not hidden.
double SunlightWave::takes_between(const Watch& watch, size_t moment, double late, Dir d) {
  const std::span<const float> kept = kept_by(watch);
  if (kept.empty()) return double{taken(watch, static_cast<uint32_t>(late < 0.5 ? moment : moment + 1), d)};
  return dot(d, normal_at(watch, course_.moments[moment] + late * step_)) *
         ((1 - late) * double{kept[moment]} + late * double{kept[moment + 1]});
}

// Fills what each point sees at every moment.
void SunlightWave::look(std::vector<Watch>& watches) {
  struct At {
    size_t watch, moment;
  };
  std::vector<At> asked;
  sights_.clear();
  for (size_t k = 0; k < watches.size(); ++k) {
    Watch& w = watches[k];
    w.lit.assign(suns_.size(), 0), w.takes.assign(suns_.size(), 0.0f);
    const std::span<const float> kept = kept_by(w);
    for (const uint32_t m : sunny_) {
      const Dir d = towards_sun(w, m);
      const double t = course_.moments[m], cosine = dot(d, normal_at(w, t));
      if (!(cosine > 0)) continue;
      w.takes[m] = kept.empty() ? taken(w, m, d) : static_cast<float>(cosine) * kept[m];
      sights_.push_back({tracer_.leave(hit_at(w, t), d), d, t, static_cast<uint32_t>(k)});
      asked.push_back({k, m});
    }
  }
  reach_.assign(sights_.size(), INFINITY), blocked_.assign(sights_.size(), 0);
  tracer_.occluded(sights_, reach_, blocked_, true, trace_);
  for (size_t i = 0; i < asked.size(); ++i) watches[asked[i].watch].lit[asked[i].moment] = !blocked_[i];
}

// Halves the time between moments that differ. What a point takes goes to 0 with its cosine, which is no edge.
void SunlightWave::find_edges(std::vector<Watch>& watches, std::vector<Edge>& edges) {
  for (size_t k = 0; k < watches.size(); ++k)
    for (size_t m = 0; m + 1 < suns_.size(); ++m) {
      const Watch& w = watches[k];
      if (w.lit[m] != w.lit[m + 1] && (w.takes[m] > 0 || w.takes[m + 1] > 0))
        edges.push_back({k, m, course_.moments[m], course_.moments[m + 1], w.lit[m]});
    }
  const int rounds = std::max(0, static_cast<int>(std::ceil(std::log2(step_ / kFinestEdge))));
  std::vector<size_t> asked;
  for (int round = 0; round < rounds; ++round) {
    sights_.clear(), asked.clear();
    for (size_t e = 0; e < edges.size(); ++e) {
      const double t = (edges[e].low + edges[e].high) / 2;
      const Watch& w = watches[edges[e].watch];
      const Dir d = towards_sun(w, t);
      if (d.z > 0 && dot(d, normal_at(w, t)) > 0) {
        sights_.push_back({tracer_.leave(hit_at(w, t), d), d, t, static_cast<uint32_t>(edges[e].watch)});
        asked.push_back(e);
      } else {
        (edges[e].lit_low ? edges[e].high : edges[e].low) = t;
      }
    }
    reach_.assign(sights_.size(), INFINITY), blocked_.assign(sights_.size(), 0);
    tracer_.occluded(sights_, reach_, blocked_, true, trace_);
    for (size_t i = 0; i < asked.size(); ++i) {
      Edge& e = edges[asked[i]];
      ((blocked_[i] == 0) == (e.lit_low != 0) ? e.low : e.high) = (e.low + e.high) / 2;
    }
  }
}

std::array<double, 4> SunlightWave::place_of(uint32_t face, Vec3 position, double disk_x, double disk_y) const {
  const HeatElement& e = elements_[faces_.element(face)];
  const Vec3 on_it = Frame::around(e.normal).to_local(position - e.centre);
  return {on_it.x, on_it.y, disk_x, disk_y};
}

PointDay SunlightWave::day_of(const Watch& watch, std::span<const Edge> edges) const {
  PointDay day;
  day.place = place_of(watch.face, watch.hit.position, watch.disk_x, watch.disk_y);
  day.lit_first = watch.lit.front();
  for (const Edge& e : edges) day.changes.push_back((e.low + e.high) / 2);
  return day;
}

void SunlightWave::add_face(std::span<const Watch> watches, std::span<const PointDay> days) {
  clear_rows();
  const size_t steps = suns_.size() - 1;
  lit_by_step_.resize(watches.size() * steps);
  for (size_t k = 0; k < watches.size(); ++k) {
    lit_.clear();
    lit_.add(days[k], 1);
    lit_.by_step({&lit_by_step_[k * steps], steps});
  }
  for (uint32_t b = 0; b < options_.blocks; ++b) add_block({watches, days, b});
  add_spread(watches, days);
  const uint32_t face = watches.front().face;
  for (size_t k = 0; k < sunny_.size(); ++k) {
    size_t lit = 0;
    for (const Watch& w : watches) lit += w.lit[sunny_[k]];
    out_.lit[face * sunny_.size() + k] = static_cast<uint8_t>((lit * 255 + watches.size() / 2) / watches.size());
  }
  lift_beam();
  keep_rows(face);
  out_.sun_hours[face] = std::max(out_.sun_hours[face], 0.0f);
}

void SunlightWave::clear_rows() {
  beam_.assign(suns_.size(), 0.0f), parts_.assign(size_t{options_.blocks} * Sunlight::kParts, 0.0f);
}

void SunlightWave::keep_rows(uint32_t face) {
  out_.beam.set(face, beam_);
  for (uint32_t b = 0; b < options_.blocks; ++b)
    out_.beam_of_block.set(size_t{face} * options_.blocks + b, {&parts_[b * Sunlight::kParts], Sunlight::kParts});
}

// The difference of two means may be less than no light; it is taken from the moments beside it.
void SunlightWave::lift_beam() {
  const std::span<float> row = beam_;
  const auto move = [&](size_t moment, size_t beside) {
    if (row[moment] >= 0) return;
    row[beside] += row[moment], row[moment] = 0;
  };
  for (size_t m = 0; m + 1 < row.size(); ++m) move(m, m + 1);
  for (size_t m = row.size(); m-- > 1;) move(m, m - 1);
  row[0] = std::max(row[0], 0.0f);
}

// How much points differ, as a few sums of them with random signs: whatever is linear in them has the mean square of
// its answers to these as its variance (M. F. Hutchinson, Commun. Stat. Simul. 18, 1989). The variance itself is met
// exactly.
void SunlightWave::add_spread(std::span<const Watch> watches, std::span<const PointDay> days) {
  constexpr uint32_t kParts = Sunlight::kParts, kContrasts = Sunlight::kContrasts;
  const size_t n = watches.size();
  std::vector<std::array<double, kParts>> takes(n);
  std::array<double, kParts> mean{};
  for (size_t k = 0; k < n; ++k) {
    lit_.clear();
    lit_.add(days[k], 1);
    lit_.spread(watches[k].takes, {},
                [&](size_t moment, double value) { takes[k][moment * kParts / suns_.size()] += value; });
    for (uint32_t p = 0; p < kParts; ++p) mean[p] += takes[k][p] / static_cast<double>(n);
  }
  std::array<std::array<double, kParts>, kContrasts> sums{};
  double variance = 0, met = 0;
  for (size_t k = 0; k < n; ++k)
    for (uint32_t p = 0; p < kParts; ++p) {
      const double off = takes[k][p] - mean[p];
      variance += off * off / static_cast<double>(n);
      for (uint32_t c = 0; c < kContrasts; ++c)
        sums[c][p] += hash_of(options_.seed, faces_.number(watches.front().face), k, c) & 1 ? off : -off;
    }
  for (const auto& contrast : sums)
    for (const double v : contrast) met += v * v / kContrasts;
  if (!(met > 0)) return;
  for (uint32_t c = 0; c < kContrasts; ++c) {
    std::array<float, kParts> row;
    for (uint32_t p = 0; p < kParts; ++p) row[p] = static_cast<float>(sums[c][p] * std::sqrt(variance / met));
    out_.beam_spread.set(size_t{watches.front().face} * kContrasts + c, row);
  }
}

void SunlightWave::of_point(const Hit& hit, bool back, Vec2 disk, std::span<float> takes) {
  std::ranges::fill(takes, 0.0f);
  if (sunny_.empty()) return;
  std::vector<Watch> one(1);
  one[0].face = 0, one[0].block = 0, one[0].hit = hit, one[0].normal = back ? -hit.normal : hit.normal;
  one[0].disk_x = disk.x, one[0].disk_y = disk.y;
  look(one);
  std::vector<Edge> edges;
  find_edges(one, edges);
  const PointDay day = day_of(one[0], edges);
  if (!day.lit_first && day.changes.empty()) return;
  lit_.clear();
  lit_.add(day, 1);
  lit_.spread(one[0].takes, {}, [&](size_t moment, double value) {
    takes[moment] += static_cast<float>((moment == 0 || moment + 1 == takes.size() ? 2 : 1) * value);
  });
}

}  // namespace suite
