#include "heat/point_heat.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/progress.h"
#include "heat/sunlight_wave.h"

namespace suite {

namespace {

// Whether elements of a material can have points.
bool has_points(const HeatedMaterial& m) { return !m.layers.empty() && !m.back_open; }

double most_of(std::span<const float> values) { return double{*std::ranges::max_element(values)}; }

// Air as means around the moments, as what it took was averaged.
std::vector<FaceWeather> air_by_moment(const WeatherLoads& weather) {
  const size_t n = weather.moments.size();
  const double begin = weather.moments.front(), end = weather.moments.back();
  const double half = (end - begin) / static_cast<double>(n - 1) / 2;
  std::vector<FaceWeather> out(n);
  const auto fill = [&](const std::vector<double>& values, double FaceWeather::*to) {
    const AveragedTable table(weather.air.times, values, AveragedTable::Between::linear, weather.air.repeat);
    for (size_t k = 0; k < n; ++k)
      out[k].*to =
          table.over(std::max(weather.moments[k] - half, begin), std::min(weather.moments[k] + half, end)).mean();
  };
  fill(weather.air.kelvin, &FaceWeather::air_kelvin), fill(weather.air.wind, &FaceWeather::wind);
  fill(weather.air.vapour_pressure, &FaceWeather::vapour_pressure);
  for (FaceWeather& w : out) w.pressure = weather.air.pressure;
  return out;
}

PointResponse::Around around_of(const HeatScene& scene, const HeatResult& r, const std::vector<FaceWeather>& air,
                                uint32_t element) {
  FaceTraits traits = scene.optics.heated[scene.elements[element].material].front;
  traits.emissivity = double{r.emissivity[element]};
  traits.cosine_up = std::clamp(scene.elements[element].normal.z, -1.0, 1.0);
  return {traits, {&r.kelvin[element * r.moments], r.moments}, air};
}

// Two numbers of 0 to 1 that belong to a place and to nothing else.
Vec2 numbers_of(const HeatedPlace& place) {
  const auto bits = [](double x) { return std::bit_cast<uint64_t>(x); };
  const uint64_t key = hash_of(bits(place.position.x), bits(place.position.y), bits(place.position.z), place.instance);
  return {static_cast<double>(key >> 32) * 0x1p-32, static_cast<double>(key & 0xffffffffu) * 0x1p-32};
}

}  // namespace

static std::atomic<uint64_t> heat_numbers = 1;

PointHeat::PointHeat(const HeatScene& scene, const WeatherLoads& weather, const HeatResult& result)
    : number_(heat_numbers++),
      scene_(scene),
      weather_(weather),
      result_(result),
      paths_{1, 1, 1},
      air_(air_by_moment(weather)) {
  if (!result.periodic)
    throw Error("points differ from elements in a span that repeats alone", "'repeats: true', or no final_gather");
  SUITE_CHECK_EQ(result.straight.size(), result.kelvin.size());
  SUITE_CHECK_EQ(result.moments, weather.moments.size());
  for (uint32_t e = 0; e < scene.elements.size(); ++e) {
    const uint32_t m = scene.elements[e].material;
    if (responses_.contains(m) || !has_points(scene.optics.heated[m])) continue;
    const auto around = around_of(scene, result, air_, e);
    double mean = 0;
    for (const float T : around.kelvin) mean += double{T} / static_cast<double>(around.kelvin.size());
    responses_[m] = std::make_unique<const PointResponse>(scene.optics.heated[m], result.step, result.moments - 1,
                                                          mean_loss(around), mean);
  }
}

PointHeat::~PointHeat() = default;

bool PointHeat::tells(uint32_t element, double time) const {
  return responses_.contains(scene_.elements[element].material) && result_.errors_at(element, time).size >= kLeast;
}

std::unique_ptr<SunlightWave> PointHeat::take_wave() const {
  const std::lock_guard lock(mutex_);
  if (waves_.empty())
    return std::make_unique<SunlightWave>(scene_.tracer, scene_.elements, scene_.faces, scene_.optics, weather_.course,
                                          paths_, kSunJoins, unused_);
  std::unique_ptr<SunlightWave> wave = std::move(waves_.back());
  waves_.pop_back();
  return wave;
}

std::optional<double> PointHeat::above(uint32_t element, const HeatedPlace& place, double time) const {
  struct Last {
    uint64_t of = 0;
    uint32_t element = 0, instance = 0, triangle = 0;
    Vec3 position;
    double time = 0;
    bool operator==(const Last&) const = default;
  };
  thread_local Last last;
  thread_local std::optional<double> answer;
  const Last asked{number_, element, place.instance, place.triangle, place.position, time};
  if (asked == last) return answer;
  answer = found(element, place, time);
  last = asked;
  return answer;
}

std::optional<double> PointHeat::found(uint32_t element, const HeatedPlace& place, double time) const {
  const auto begun = std::chrono::steady_clock::now();
  const std::optional<Hit> hit = scene_.elements.hit_at(place);
  if (!hit) {
    displaced_ += 1;
    return std::nullopt;
  }
  std::unique_ptr<SunlightWave> wave = take_wave();
  const size_t n = result_.moments;
  std::vector<float> more(n), kelvin(n);
  const Vec2 u = numbers_of(place);
  wave->of_point(*hit, false, disk_from_square(u), more);
  {
    const std::lock_guard lock(mutex_);
    waves_.push_back(std::move(wave));
  }
  for (size_t m = 0; m < n; ++m)
    more[m] = static_cast<float>(double{more[m]} * weather_.direct[m]) - result_.straight[element * n + m];
  const bool settled =
      responses_.at(scene_.elements[element].material)->above(around_of(scene_, result_, air_, element), more, kelvin);
  asked_ += 1;
  if (!settled) unsettled_ += 1;
  nanoseconds_ += static_cast<uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - begun).count());
  if (!settled) return std::nullopt;
  return result_.between_moments(kelvin, time);
}

std::vector<float> straight_sunlight(const HeatScene& scene, const WeatherLoads& weather, const HeatResult& result,
                                     const HeatSpec& spec) {
  const auto wanted = [&](size_t f) {
    return !scene.faces.is_back(f) &&
           has_points(scene.optics.heated[scene.elements[scene.faces.element(f)].material]) &&
           most_of({&result.size_error[f * kHeatParts], kHeatParts}) >= PointHeat::kLeast;
  };
  std::vector<float> out = trace_straight(scene.tracer, scene.elements, scene.faces, scene.optics, weather.course,
                                          path_options(spec), wanted);
  for (size_t f = 0; f < scene.faces.size(); ++f)
    for (size_t m = 0; m < result.moments; ++m)
      out[f * result.moments + m] = static_cast<float>(double{out[f * result.moments + m]} * weather.direct[m]);
  return out;
}

std::vector<Diagnostic> PointHeat::diagnostics() const {
  const auto count = [](uint64_t n) { return human_count(static_cast<double>(n)); };
  std::vector<Diagnostic> found;
  if (displaced() > 0)
    found.push_back({Dr::heat_points_displaced,
                     strf("heat: %s points lie on what stands elsewhere at other times: they have their elements' "
                          "temperatures",
                          count(displaced()).c_str())});
  if (unsettled() > 0)
    found.push_back({Dr::heat_points_unsettled,
                     strf("heat: the temperatures of %s points did not converge: they have their elements'",
                          count(unsettled()).c_str())});
  return found;
}

}  // namespace suite
