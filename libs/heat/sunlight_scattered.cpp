// Sunlight that reaches faces by reflection, and the light of the sky: paths from the faces, joined to the sun at every
// surface they meet.
#include <algorithm>

#include "heat/sunlight_wave.h"

namespace suite {

namespace {

constexpr uint64_t kSunlightScatteredPurpose = 0x73636174;
constexpr uint32_t kRouletteFrom = 2;  // reflections
constexpr uint32_t kToldJoins = 2;     // where what is sent on is told

}  // namespace

void SunlightWave::scattered(size_t begin, size_t end) {
  going_.clear(), rays_.clear(), spectra_.clear();
  changing_ = begin < faces_.size() ? elements_.changing() : nullptr;
  for (size_t row = begin; row < end; ++row) start(static_cast<uint32_t>(row));
  sights_.clear(), asked_.clear();
  first_ = static_cast<uint32_t>(begin), rows_.assign((end - begin) * 2 * options_.blocks * sunny_.size(), 0.0f);
  sky_.assign((end - begin) * kSkyPatches, 0.0f);
  sky_of_block_.assign((end - begin) * options_.blocks * kSkyShapes, 0.0f);
  walk(
      tracer_, going_, rays_, hits_, false, trace_,
      [this](Going& path, Ray& ray, const Hit& hit, uint32_t n) { return go_on(path, ray, hit, n); },
      [this] { answer_sun(); });
  add_scattered(begin, end);
  add_sky(begin, end);
}

// The throughput holds what the face keeps of each bin, times pi: the density of a cosine is 1/pi.
void SunlightWave::start(uint32_t row) {
  const uint32_t each = options_.blocks * options_.paths, face = out_.rows.face(row),
                 interval = out_.rows.interval(row);
  const std::optional<TimeSpan> window = path_window(tracer_, elements_, interval);
  double kept_of_sky = 0;
  for (uint32_t k = 0; k < each; ++k) {
    const uint32_t slot = row * each + k;
    const PathNumbers numbers = numbers_of(slot, kSunlightScatteredPurpose);
    const Hit hit =
        elements_.point(faces_.element(face), {numbers.net(), numbers.sample(), kPointBlock, 0, 1, interval});
    const std::array<double, 4> u = numbers.net().draw(numbers.sample(), 0);
    const Dir normal = faces_.is_back(face) ? -hit.normal : hit.normal;
    const Dir d = normalized(Frame::around(normal).to_world(cosine_hemisphere(numbers.first_direction())));
    surface_.interact(hit, d, at_, hit.time);
    if (!at_.baked || !at_.baked->model) continue;
    at_.baked->model->total(at_.frame.to_local(d), W_);
    Going path;
    path.slot = slot;
    path.drawn.start(u[2], knots_);
    path.spectrum = static_cast<uint32_t>(spectra_.size() / bins_);
    double any = 0;
    for (size_t i = 0; i < bins_; ++i) {
      const float kept = 1 - std::min(1.0f, W_[i]);
      any += double{kept}, kept_of_sky += double{kept} * course_.sky[i];
      spectra_.push_back(kept * static_cast<float>(kPi));
    }
    if (!(any > 0)) continue;
    going_.push_back(path);
    rays_.push_back({tracer_.leave(hit, d), d, time_of_path(window, numbers.net(), numbers.sample(), hit.time), slot});
  }
  if (interval == 0) out_.absorptance[face] = static_cast<float>(kept_of_sky / each);
  // Whatever changes around what changes its place.
  if (changing_ && elements_.changes_place(faces_.element(face))) out_.rows.changing[face] = 1;
}

void SunlightWave::leave(const Going& path, Dir d) {
  const uint32_t each = options_.blocks * options_.paths, row = path.slot / each;
  const std::span<const float> T = throughput(path);
  double value = 0;
  for (size_t i = 0; i < bins_; ++i) value += double{T[i]} * course_.sky[i];
  value *= mean_ratio(path) / each;
  const size_t block = path.slot % each / options_.paths;
  const bool second = path.slot % options_.paths >= options_.half();
  const auto of_block = static_cast<float>(value * options_.blocks * (second ? -1 : 1));
  if (d.z > 0) {
    const uint32_t patch = sky_patch(d);
    sky_[(row - first_) * kSkyPatches + patch] += static_cast<float>(value);
    float* shapes = &sky_of_block_[((row - first_) * options_.blocks + block) * kSkyShapes];
    for (const float shape : sky_shapes(patch)) *shapes++ += of_block * shape;
  } else {
    out_.below[row] += static_cast<float>(value);
    out_.below_of_block[size_t{row} * options_.blocks + block] += of_block;
  }
}

void SunlightWave::add_scattered(size_t begin, size_t end) {
  const size_t n = sunny_.size(), moments = suns_.size();
  for (size_t f = begin; f < end && n > 0; ++f) {
    clear_rows();
    out_.beam.get(f, beam_);
    const bool within = out_.rows.changes(f);
    const auto share = [&](size_t k) { return within ? shares_[out_.rows.interval(f)][sunny_[k]] : 1.0f; };
    for (size_t b = 0; b < options_.blocks; ++b) {
      const float *row = &rows_[((f - begin) * options_.blocks + b) * 2 * n], *second = row + n;
      float* parts = &parts_[b * Sunlight::kParts];
      out_.beam_of_block.get(f * options_.blocks + b, {parts, Sunlight::kParts});
      for (size_t k = 0; k < n; ++k) {
        beam_[sunny_[k]] += share(k) * (row[k] + second[k]) / static_cast<float>(options_.blocks);
        parts[sunny_[k] * Sunlight::kParts / moments] += share(k) * (row[k] - second[k]);
      }
    }
    // What is scattered alone adds to what is straight.
    if (f < faces_.size()) lift_beam();
    keep_rows(static_cast<uint32_t>(f));
  }
}

void SunlightWave::add_sky(size_t begin, size_t end) {
  for (size_t f = begin; f < end; ++f) out_.sky.set(f, {&sky_[(f - begin) * kSkyPatches], kSkyPatches});
  for (size_t b = begin * options_.blocks; b < end * options_.blocks; ++b)
    out_.sky_of_block.set(b, {&sky_of_block_[(b - begin * options_.blocks) * kSkyShapes], kSkyShapes});
}

bool SunlightWave::go_on(Going& path, Ray& ray, const Hit& hit, uint32_t n) {
  if (changing_ && changing_->meets(ray, hit.hit() ? hit.distance : INFINITY))
    out_.rows.changing[path.slot / (options_.blocks * options_.paths)] = 1;
  if (!hit.hit()) {
    leave(path, ray.direction);
    return false;
  }
  surface_.interact(hit, -ray.direction, at_, ray.time);
  if (!at_.baked || !at_.baked->model) {
    ray.origin = tracer_.leave(hit, ray.direction);
    return true;
  }
  const ScatterModel& model = *at_.baked->model;
  const Dir out = at_.frame.to_local(-ray.direction);
  ask_sun(path, hit, ray.direction, n);
  const PathNumbers numbers = numbers_of(path.slot, kSunlightScatteredPurpose);
  const std::array<double, 4> u = numbers.net().draw(numbers.sample(), 1 + n);
  const auto drawn = walk_.draw(model, out, u, path.drawn.knot);
  if (!drawn) return false;
  const std::span<float> T = throughput(path);
  const double most = walk_.take(path.drawn, T), left = most * mean_ratio(path) / kPi;
  if (n >= kRouletteFrom && !SurfaceWalk::survives(T, left, u[3])) return false;
  if (!(most > 0)) return false;
  if (n >= kMostReflections) {
    unfinished_ += left;
    return false;
  }
  const Dir d = at_.frame.to_world(drawn->in);
  ray.origin = tracer_.leave(hit, d), ray.direction = d;
  return true;
}

// What the surface sends on of the sun through the day.
void SunlightWave::ask_sun(const Going& path, const Hit& hit, Dir direction, uint32_t n) {
  if (sunny_.empty()) return;
  const uint32_t each = options_.blocks * options_.paths;
  const Dir out = at_.frame.to_local(-direction);
  const uint32_t end = faces_.end_at(hit, direction, at_.material);
  const uint8_t *lit = lit_on(end), *beyond = nullptr;
  if (lit) beyond = faces_.is_back(end) ? lit_on(faces_.element(end)) : lit_on(faces_.back_of(end));
  // What mirrors send on besides is neither told nor found here.
  if (lit) {
    told_sun_.tell(at_, out, throughput(path), lit, beyond, told_);
    const auto weight = static_cast<float>(mean_ratio(path) * options_.blocks / each);
    float* row = &rows_[row_of(path.slot) * sunny_.size()];
    for (size_t k = 0; k < sunny_.size(); ++k) row[k] += told_[k] * weight;
  }
  join_sun(path, hit, out, n, lit, beyond);
}

// Joins the surface to the sun at some moments, for what was not told: those of a half's paths go through the day in
// turn.
void SunlightWave::join_sun(const Going& path, const Hit& hit, Dir out, uint32_t n, const uint8_t* lit,
                            const uint8_t* beyond) {
  const ScatterModel& model = *at_.baked->model;
  const uint32_t half = options_.blocks * options_.half();
  const uint32_t joins = lit ? std::min(kToldJoins, joins_) : joins_;
  const PathNumbers numbers = numbers_of(path.slot, kSunlightScatteredPurpose);
  const auto number = [&](uint32_t what, uint32_t j) {
    return numbers.net().hashed(numbers.sample(), 64 + 64 * n + 4 * j + what);
  };
  const uint32_t interval = out_.rows.interval(path.slot / (options_.blocks * options_.paths));
  // Those of later intervals ask for moments of these.
  const std::vector<uint32_t>* within = interval > 0 ? &sunny_within_[interval] : nullptr;
  const auto count = static_cast<double>(within ? within->size() : sunny_.size());
  if (count == 0) return;
  const double weight = mean_ratio(path) * count * options_.blocks / (2.0 * joins * half);
  const std::span<const float> T = throughput(path);
  for (uint32_t j = 0; j < joins; ++j) {
    // Even over the joins of a half's paths, so that each has the whole day, shifted at random for each surface on the
    // way.
    const double shift = unit_double(hash_of(options_.seed, numbers.net().key(), n));
    double at = (numbers.sample() * joins + j + number(0, j)) / (1.0 * half * joins) + shift;
    at -= std::floor(at);
    const auto number_of = static_cast<uint32_t>(std::min(count - 1, at * count));
    const uint32_t k = within ? (*within)[number_of] : number_of;
    const uint32_t moment = sunny_[k];
    const Vec2 disk = disk_from_square({number(1, j), number(2, j)});
    const Dir d = on_disk(suns_[moment], disk.x, disk.y, course_.angular_radius), in = at_.frame.to_local(d);
    const uint8_t* side = in.z * out.z > 0 ? lit : beyond;
    const double asked = side ? told_sun_.asked(side[k]) : 1, told = lit ? double{told_[k]} : 0;
    if (!(number(3, j) < asked)) continue;
    model.eval(out, in, w_);
    double value = 0;
    for (size_t i = 0; i < bins_; ++i) value += double{T[i]} * double{w_[i]} * double{course_.beam[moment][i]};
    if (!(value > 0) && told == 0) continue;
    asked_.push_back({row_of(path.slot), k, value * weight / asked, told * weight / asked});
    sights_.push_back({tracer_.leave(hit, d), d, course_.moments[moment], path.slot});
  }
}

void SunlightWave::answer_sun() {
  reach_.assign(sights_.size(), INFINITY), blocked_.assign(sights_.size(), 0);
  if (!sights_.empty()) tracer_.occluded(sights_, reach_, blocked_, false, trace_);
  for (size_t i = 0; i < asked_.size(); ++i) {
    const Join& j = asked_[i];
    rows_[size_t{j.row} * sunny_.size() + j.sunny] += static_cast<float>((blocked_[i] ? 0 : j.value) - j.told);
  }
  sights_.clear(), asked_.clear();
}

}  // namespace suite
