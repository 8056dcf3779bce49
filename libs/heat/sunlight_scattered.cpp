// Sunlight that reaches faces by reflection, and the light of the sky: paths from the faces, joined to the sun at every
// surface they meet.
#include <algorithm>

#include "heat/sunlight_wave.h"

namespace suite {

namespace {

constexpr uint64_t kPurpose = 0x73636174;
constexpr uint32_t kRouletteFrom = 2;  // reflections

}  // namespace

void SunlightWave::scattered(size_t begin, size_t end) {
  going_.clear(), rays_.clear(), spectra_.clear();
  for (size_t f = begin; f < end; ++f) start(static_cast<uint32_t>(f));
  sights_.clear(), asked_.clear();
  fly(
      tracer_, going_, rays_, hits_, trace_,
      [this](Going& path, Ray& ray, const Hit& hit, uint32_t n) { return go_on(path, ray, hit, n); },
      [this] { answer_sun(); });
}

// The throughput holds what the face keeps of each bin, times pi: the density of a cosine is 1/pi.
void SunlightWave::start(uint32_t face) {
  const uint32_t each = options_.blocks * options_.paths;
  double kept_of_sky = 0;
  for (uint32_t k = 0; k < each; ++k) {
    const uint32_t slot = face * each + k;
    const SampleStream numbers = stream(slot, kPurpose);
    const Hit hit = elements_.point(faces_.element(face), {numbers, sample(slot), kPointBlock});
    const std::array<double, 4> u = numbers.draw(sample(slot), 0);
    const Dir normal = faces_.is_back(face) ? -hit.normal : hit.normal;
    const Dir d = normalized(Frame::around(normal).to_world(cosine_hemisphere({u[0], u[1]})));
    surface_.interact(hit, d, at_, hit.time);
    if (!at_.baked || !at_.baked->model) continue;
    at_.baked->model->total(at_.frame.to_local(d), W_);
    Going path;
    path.slot = slot;
    path.knot = std::min(static_cast<int>(u[2] * static_cast<double>(knots_)), static_cast<int>(knots_) - 1);
    path.spectrum = static_cast<uint32_t>(spectra_.size() / bins_);
    path.ratios.fill(1);
    double any = 0;
    for (size_t i = 0; i < bins_; ++i) {
      const float kept = 1 - std::min(1.0f, W_[i]);
      any += double{kept}, kept_of_sky += double{kept} * course_.sky[i];
      spectra_.push_back(kept * static_cast<float>(kPi));
    }
    if (!(any > 0)) continue;
    going_.push_back(path);
    rays_.push_back({tracer_.leave(hit, d), d, time_of_path(tracer_, numbers, sample(slot), hit.time), slot});
  }
  out_.absorptance[face] = static_cast<float>(kept_of_sky / each);
}

void SunlightWave::leave(const Going& path, Dir d) {
  const uint32_t each = options_.blocks * options_.paths, face = path.slot / each;
  const std::span<const float> T = throughput(path);
  double value = 0;
  for (size_t i = 0; i < bins_; ++i) value += double{T[i]} * course_.sky[i];
  value *= mean_ratio(path) / each;
  const size_t block = path.slot % each / options_.paths;
  const auto of_block = static_cast<float>(value * options_.blocks);
  if (d.z > 0) {
    out_.sky[size_t{face} * kSkyPatches + sky_patch(d)] += static_cast<float>(value);
    out_.diffuse_of_block[size_t{face} * options_.blocks + block] += of_block;
  } else {
    out_.below[face] += static_cast<float>(value);
    out_.below_of_block[size_t{face} * options_.blocks + block] += of_block;
  }
}

void SunlightWave::add_to_beam(uint32_t face, uint32_t block, uint32_t moment, double value) {
  out_.beam[size_t{face} * suns_.size() + moment] += static_cast<float>(value);
  out_.beam_of_block[(size_t{face} * options_.blocks + block) * Sunlight::kParts +
                     moment * Sunlight::kParts / suns_.size()] += static_cast<float>(value * options_.blocks);
}

bool SunlightWave::go_on(Going& path, Ray& ray, const Hit& hit, uint32_t n) {
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
  ask_sun(path, hit, out, n);
  const SampleStream numbers = stream(path.slot, kPurpose);
  const std::array<double, 4> u = numbers.draw(sample(path.slot), 1 + n);
  const auto drawn = draw_reflection(model, out, u, path.knot, w_, p_);
  if (!drawn) return false;
  const double own = static_cast<double>(p_[static_cast<size_t>(path.knot)]);
  const std::span<float> T = throughput(path);
  float most = 0;
  for (size_t i = 0; i < bins_; ++i) {
    T[i] *= static_cast<float>(static_cast<double>(w_[i]) / own);
    most = std::max(most, T[i]);
  }
  for (size_t k = 0; k < knots_; ++k) path.ratios[k] *= static_cast<double>(p_[k]) / own;
  if (n >= kRouletteFrom) {
    const double survives = std::min(1.0, static_cast<double>(most) * mean_ratio(path) / kPi);
    if (!(u[3] < survives)) return false;
    for (float& t : T) t = static_cast<float>(static_cast<double>(t) / survives);
  }
  if (!(most > 0)) return false;
  if (n >= kMostReflections) {
    unfinished_ += static_cast<double>(most) * mean_ratio(path) / kPi;
    return false;
  }
  const Dir d = at_.frame.to_world(drawn->in);
  ray.origin = tracer_.leave(hit, d), ray.direction = d;
  return true;
}

// Joins the surface to the sun at some moments: those of a block's paths go through the day in turn.
void SunlightWave::ask_sun(const Going& path, const Hit& hit, Dir out, uint32_t n) {
  if (sunny_.empty()) return;
  const ScatterModel& model = *at_.baked->model;
  const uint32_t each = options_.blocks * options_.paths, face = path.slot / each, within = path.slot % each;
  const SampleStream numbers = stream(path.slot, kPurpose);
  const auto number = [&](uint32_t what, uint32_t j) {
    return numbers.hashed(sample(path.slot), 64 + 64 * n + 3 * j + what);
  };
  const auto count = static_cast<double>(sunny_.size());
  const double weight = mean_ratio(path) * count / (1.0 * joins_ * each);
  const std::span<const float> T = throughput(path);
  for (uint32_t j = 0; j < joins_; ++j) {
    // Even over the joins of a block's paths, so that each has the whole day, shifted at random for each surface on the
    // way.
    const uint32_t of_block = faces_.number(face) * options_.blocks + within / options_.paths;
    const double shift = unit_double(hash_of(options_.seed, of_block, n));
    double at = (sample(path.slot) * joins_ + j + number(0, j)) / (1.0 * options_.paths * joins_) + shift;
    at -= std::floor(at);
    const uint32_t moment = sunny_[std::min(sunny_.size() - 1, static_cast<size_t>(at * count))];
    const Vec2 disk = disk_from_square({number(1, j), number(2, j)});
    const Dir d = on_disk(suns_[moment], disk.x, disk.y, course_.angular_radius);
    model.eval(out, at_.frame.to_local(d), w_);
    double value = 0;
    for (size_t i = 0; i < bins_; ++i) value += double{T[i]} * double{w_[i]} * double{course_.beam[moment][i]};
    if (!(value > 0)) continue;
    asked_.push_back({face, within / options_.paths, moment, value * weight});
    sights_.push_back({tracer_.leave(hit, d), d, course_.moments[moment], path.slot});
  }
}

void SunlightWave::answer_sun() {
  reach_.assign(sights_.size(), INFINITY), blocked_.assign(sights_.size(), 0);
  if (!sights_.empty()) tracer_.occluded(sights_, reach_, blocked_, false, trace_);
  for (size_t i = 0; i < asked_.size(); ++i) {
    if (blocked_[i]) continue;
    const Join& j = asked_[i];
    add_to_beam(j.face, j.block, j.moment, j.value);
  }
  sights_.clear(), asked_.clear();
}

}  // namespace suite
