// The sun straight on faces: shadow rays at every moment of the day, edges to 10 s, integrals over what lies between.
#include <algorithm>

#include "heat/sunlight_wave.h"

namespace suite {

namespace {

constexpr uint64_t kPurpose = 0x6265616d;
constexpr double kFinest = 10;     // s, to which edges of shadows are found
constexpr size_t kWatches = 4096;  // at once

}  // namespace

SunlightWave::SunlightWave(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                           const HeatOptics& optics, const SunCourse& course, const PathOptions& options,
                           uint32_t joins, Sunlight& out)
    : tracer_(tracer),
      elements_(elements),
      faces_(faces),
      course_(course),
      options_(options),
      joins_(joins),
      out_(out),
      surface_(tracer, *optics.sun),
      bins_(optics.sun->state().size()),
      knots_(optics.sun->state().knots.size()),
      step_(course.moments.size() > 1 ? course.moments[1] - course.moments[0] : 1),
      W_(bins_),
      w_(bins_),
      p_(knots_) {
  for (uint32_t k = 0; k < course.moments.size(); ++k) {
    suns_.push_back(Frame::around(course.towards(course.moments[k])));
    if (suns_.back().z.z > 0) sunny_.push_back(k);
  }
}

SampleStream SunlightWave::stream(uint32_t slot, uint64_t purpose) const {
  const uint32_t each = options_.blocks * options_.paths;
  return SampleStream(options_.seed, purpose, slot / each, slot % each / options_.paths);
}

Dir SunlightWave::towards_sun(const Watch& watch, double t) const {
  return on_disk(Frame::around(course_.towards(t)), watch.disk_x, watch.disk_y, course_.angular_radius);
}

void SunlightWave::beam(size_t begin, size_t end) {
  if (sunny_.empty()) return;
  const size_t together = std::max<size_t>(1, kWatches / (size_t{options_.blocks} * watches_of_block()));
  for (size_t f = begin; f < end; f += together) beam_of(f, std::min(end, f + together));
}

void SunlightWave::beam_of(size_t begin, size_t end) {
  std::vector<Watch> watches;
  for (size_t f = begin; f < end; ++f)
    for (uint32_t b = 0; b < options_.blocks; ++b) {
      const auto face = static_cast<uint32_t>(f);
      const SampleStream numbers = stream((face * options_.blocks + b) * options_.paths, kPurpose);
      for (uint32_t k = 0; k < watches_of_block(); ++k) {
        Watch w;
        w.face = face, w.block = b;
        w.hit = elements_.point(faces_.element(face), {numbers, k, kPointBlock});
        w.normal = faces_.is_back(face) ? -w.hit.normal : w.hit.normal;
        const std::array<double, 4> u = numbers.draw(k, 0);
        const Vec2 d = disk_from_square({u[0], u[1]});
        w.disk_x = d.x, w.disk_y = d.y;
        watches.push_back(std::move(w));
      }
    }
  look(watches);
  std::vector<Edge> edges;
  find_edges(watches, edges);
  size_t from = 0;
  for (size_t k = 0; k < watches.size(); ++k) {
    size_t to = from;
    while (to < edges.size() && edges[to].watch == k) ++to;
    add_beam(watches[k], {edges.data() + from, to - from});
    from = to;
  }
}

float SunlightWave::taken(const Watch& watch, uint32_t moment, Dir d) {
  const double cosine = dot(d, watch.normal);
  if (!(cosine > 0)) return 0;
  surface_.interact(watch.hit, d, at_, course_.moments[moment]);
  if (!at_.baked || !at_.baked->model) return 0;
  at_.baked->model->total(at_.frame.to_local(d), W_);
  double kept = 0;
  for (size_t i = 0; i < bins_; ++i) kept += double{course_.beam[moment][i]} * (1 - double{std::min(1.0f, W_[i])});
  return static_cast<float>(cosine * kept);
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
    for (const uint32_t m : sunny_) {
      const Dir d = towards_sun(w, m);
      w.takes[m] = taken(w, m, d);
      if (w.takes[m] == 0) continue;
      sights_.push_back({tracer_.leave(w.hit, d), d, course_.moments[m], static_cast<uint32_t>(k)});
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
  const int rounds = std::max(0, static_cast<int>(std::ceil(std::log2(step_ / kFinest))));
  std::vector<size_t> asked;
  for (int round = 0; round < rounds; ++round) {
    sights_.clear(), asked.clear();
    for (size_t e = 0; e < edges.size(); ++e) {
      const double t = (edges[e].low + edges[e].high) / 2;
      const Watch& w = watches[edges[e].watch];
      const Dir d = towards_sun(w, t);
      if (d.z > 0 && dot(d, w.normal) > 0) {
        sights_.push_back({tracer_.leave(w.hit, d), d, t, static_cast<uint32_t>(edges[e].watch)});
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

// Puts the integral of what is taken onto the moments, by the hats of straight lines between them: a product of two
// lines over each lit piece, for which Simpson's rule is exact.
void SunlightWave::add_beam(const Watch& watch, std::span<const Edge> edges) {
  float* to = &out_.beam[watch.face * suns_.size()];
  float* parts = &out_.beam_of_block[(size_t{watch.face} * options_.blocks + watch.block) * Sunlight::kParts];
  const double weight = 1.0 / (1.0 * options_.blocks * watches_of_block());
  double lit_time = 0;
  size_t next = 0;
  for (size_t m = 0; m + 1 < suns_.size(); ++m) {
    double begin = watch.lit[m] ? 0 : 1,
           end = watch.lit[m] || watch.lit[m + 1] ? 1 : begin;  // the lit share of the step
    if (next < edges.size() && edges[next].moment == m) {
      const double at = ((edges[next].low + edges[next].high) / 2 - course_.moments[m]) / step_;
      (watch.lit[m] ? end : begin) = at;
      ++next;
    }
    if (!(end > begin)) continue;
    lit_time += (end - begin) * step_;
    // Where one end of the step takes nothing, the other's line is followed to it.
    const double a = watch.takes[m], b = watch.takes[m + 1];
    const auto value = [&](double s) { return a + (b - a) * s; };
    const double middle = (begin + end) / 2, width = (end - begin) / 6;
    const auto hat = [&](double s, bool late) { return value(s) * (late ? s : 1 - s); };
    for (const bool late : {false, true}) {
      const double share = width * (hat(begin, late) + 4 * hat(middle, late) + hat(end, late));
      const size_t moment = m + (late ? 1 : 0);
      // A hat's integral is a step, of the first and last moment half a one.
      const double hats = moment == 0 || moment + 1 == suns_.size() ? 2 : 1;
      to[moment] += static_cast<float>(weight * hats * share);
      parts[moment * Sunlight::kParts / suns_.size()] += static_cast<float>(share / watches_of_block());
    }
  }
  out_.sun_hours[watch.face] += static_cast<float>(weight * lit_time / 3600);
}

}  // namespace suite
