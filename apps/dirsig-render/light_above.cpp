#include "light_above.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

// Of each plane, whatever the budget of the pictures: their common error is to be small beside their own.
constexpr Convergence kGoal{1 << 15, 1 << 15, 0, 0};

template <class T, class Same>
size_t place_in(std::vector<T>& list, const T& value, const Same& same) {
  const auto at = std::find_if(list.begin(), list.end(), [&](const T& x) { return same(x, value); });
  const auto index = static_cast<size_t>(at - list.begin());
  if (at == list.end()) list.push_back(value);
  return index;
}
bool same_place(const Vec3& a, const Vec3& b) { return length(a - b) == 0; }
bool same_window(const TimeWindow& a, const TimeWindow& b) { return a.begin == b.begin && a.end == b.end; }
bool same_band(const Band& a, const Band& b) {
  return a.name == b.name && a.center_um == b.center_um && a.fwhm_um == b.fwhm_um;
}

}  // namespace

void LightAbove::Asked::add(const Capture& capture, Vec3 place) {
  place_in(places, place, same_place);
  place_in(states, capture.state, std::equal_to<size_t>());
  place_in(windows, capture.window, same_window);
}

void LightAbove::Asked::measure(std::vector<std::unique_ptr<Sensor>>& passes) {
  std::vector<Prepass::Element> planes;
  for (const Vec3& place : places) planes.push_back({place, {0, 0, 1}});
  std::vector<Prepass::Spectrum> spectra;
  for (const size_t s : states) {
    const std::span<const Band> bands = sensor->bands(s);
    SpectralState state = sensor->states()[s];
    state.choice = {};  // its bins are chosen
    spectra.push_back({std::move(state), {bands.begin(), bands.end()}});
  }
  auto made = std::make_unique<Prepass>("light above '" + sensor->name() + "'", std::move(planes), std::move(spectra),
                                        windows, kGoal);
  pass = made.get();
  passes.push_back(std::move(made));
}

LightAbove::LightAbove(std::span<const std::unique_ptr<Sensor>> sensors) {
  for (const auto& sensor : sensors) {
    Asked asked;
    asked.sensor = sensor.get();
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures)
        if (const ImageWishes wishes = sensor->wishes(c); wishes.quantity == Quantity::remote_sensing_reflectance)
          asked.add(c, wishes.irradiance_at);
    if (!asked.windows.empty()) asked_.push_back(std::move(asked));
  }
  for (Asked& asked : asked_) asked.measure(passes_);
}

LightAbove::Irradiance LightAbove::of(const Delivery& d, const Band& band) const {
  const auto asked = std::find_if(asked_.begin(), asked_.end(), [&](const Asked& a) { return a.sensor == &d.sensor; });
  SUITE_CHECK(asked != asked_.end());
  const Capture& capture = d.sensor.tasks()[d.result.task].captures[d.result.capture];
  const ImageWishes wishes = d.sensor.wishes(capture);
  Asked known = *asked;
  const size_t place = place_in(known.places, wishes.irradiance_at, same_place),
               window = place_in(known.windows, capture.window, same_window);
  for (size_t s = 0; s < known.states.size(); ++s) {
    const std::span<const Band> bands = d.sensor.bands(known.states[s]);
    const auto at = std::find_if(bands.begin(), bands.end(), [&](const Band& b) { return same_band(b, band); });
    if (at == bands.end()) continue;
    const size_t i = place * bands.size() + static_cast<size_t>(at - bands.begin());
    const Irradiance found{known.pass->irradiance(window, s)[i], known.pass->standard_error(window, s)[i]};
    if (found.mean > 0) return found;
    throw Error(wishes.where,
                strf("units: remote_sensing_reflectance: in the band '%s' no light comes down on (%g, %g, %g) m",
                     band.name.c_str(), wishes.irradiance_at.x, wishes.irradiance_at.y, wishes.irradiance_at.z),
                "a place in the open, just above the water, by day (irradiance_at_m); or leave the units at radiance");
  }
  SUITE_CHECK(!"a band that no state of the sensor has");
  return {};
}

}  // namespace suite
