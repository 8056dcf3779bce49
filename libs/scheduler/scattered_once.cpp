#include "scheduler/scattered_once.h"

#include <algorithm>

#include "light/scattered_again.h"
#include "scheduler/moments.h"
#include "scheduler/sensor_diagnostics.h"

namespace suite {

namespace {

constexpr double kThermal = 3;  // um: beyond it little is scattered
constexpr double kGrey = 0.3;   // albedo of the ground that is not black

struct Missing {
  std::string band;
  double black = 0, grey = 0;  // shares, over grounds of albedo 0 and kGrey
  double worst() const { return std::max(black, grey); }
};

SpectralState middle_of(const Band& band) {
  constexpr double kWidth = 1e-3;  // um
  return make_state(std::vector<Band>{Band::rectangular(band.name, band.center_um, kWidth)}, 1);
}

// The brightest sun or moon above the horizon.
const FarDisk* brightest(const SourceSpecs& now) {
  const FarDisk* found = nullptr;
  for (const LightSpecPtr& light : now.lights)
    if (const FarDisk* disk = light->disk(); disk && disk->direction.z > 0)
      if (!found || disk->irradiance.max() > found->irradiance.max()) found = disk;
  return found;
}

Missing missing(const AtmosphereSpec& air, const Band& band, const AirView& view, Dir sun) {
  const float one[] = {1};
  const SpectralState state = middle_of(band);
  const Beam beam{normalized(sun), one};
  const ScatteredAgain black = scattered_again(air, state, beam, view, 0),
                       grey = scattered_again(air, state, beam, view, kGrey);
  Missing m{band.name, black.missing(), grey.missing()};
  // Over a ground that is not quite black nothing is seen of so little.
  if (black.all - black.once < kLeastNotShown * grey.all) m.black = 0;
  return m;
}

// Of a capture's middle ray, band by band.
void add(const AtmosphereSpec& air, const Sensor& sensor, const Capture& capture, Dir sun, std::vector<Missing>& all) {
  constexpr size_t kMostBands = 8;
  const SensorRay ray = middle_ray(sensor, capture, (capture.rows / 2) * capture.columns + capture.columns / 2);
  if (ray.receiver != SensorRay::Receiver::none) return;
  const auto bands = sensor.bands(capture.state);
  const size_t n = std::min<size_t>(kMostBands, bands.size());
  for (size_t i = 0; i < n; ++i) {
    const Band& band = bands[n > 1 ? i * (bands.size() - 1) / (n - 1) : 0];
    if (band.center_um >= kThermal) continue;
    const Missing m = missing(air, band, {ray.ray.origin, ray.ray.direction}, sun);
    const auto same = std::find_if(all.begin(), all.end(), [&](const Missing& o) { return o.band == m.band; });
    if (same == all.end())
      all.push_back(m);
    else
      same->black = std::max(same->black, m.black), same->grey = std::max(same->grey, m.grey);
  }
}

std::string shares(const Missing& m) {
  return strf("%.2g %% of band '%s' over a black ground, %.2g %% over one of albedo %.1g", 100 * m.black,
              m.band.c_str(), 100 * m.grey, kGrey);
}

}  // namespace

std::vector<Diagnostic> diagnose_scattered_once(const SourceSpecs& written, const Scene& scene,
                                                std::span<const std::unique_ptr<Sensor>> sensors) {
  std::vector<Diagnostic> found;
  if (!written.atmosphere) return found;
  SourcesInTime in_time(written, scene);
  for (const auto& sensor : sensors) {
    std::vector<const Capture*> captures;
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures)
        if (c.problems() > 0) captures.push_back(&c);
    if (captures.empty()) continue;
    std::vector<Missing> all;
    for (const size_t i : {size_t{0}, captures.size() / 2, captures.size() - 1}) {
      if (i > 0 && captures[i] == captures[0]) continue;
      if (const FarDisk* sun = brightest(in_time.at(in_time.on_grid(moment_of(*captures[i])))))
        add(*written.atmosphere, *sensor, *captures[i], sun->direction, all);
    }
    const auto less = [](const Missing& a, const Missing& b) { return a.worst() < b.worst(); };
    if (all.empty()) continue;
    const auto [least, most] = std::minmax_element(all.begin(), all.end(), less);
    if (most->worst() < kLeastNotShown) continue;
    std::string text = "air: the atmosphere scatters sunlight once; sensor '" + sensor->name() +
                       "' lacks what is scattered again, in the middle of its view " + shares(*most);
    if (least != most) text += "; " + shares(*least);
    found.push_back(
        {Dr::scattered_once, text + ". No standard error contains it; an atmosphere with a `profile` has that light"});
  }
  return found;
}

}  // namespace suite
