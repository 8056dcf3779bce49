#include "sensor/sensors.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/required.h"
#include "sensor/kinds/rows.h"
#include "spectral/wavelength.h"

namespace suite {

namespace {
constexpr double kSpectralError = 1e-3, kLeastSpectralError = 1e-5;

void refuse_geodetic_keys(const Params& params, const std::string& kind) {
  for (const std::string& key : params.keys()) {
    const bool is_place = key == "position" || key == "position_m" || key == "look_at" || key == "look_at_m";
    const Params value = params.at(key);
    if (key != "latitude_deg" && key != "longitude_deg" && !(is_place && value.has("latitude_deg"))) continue;
    throw Error(params.where(key), "a " + kind + " has no geodetic place",
                "give position_m (and look_at_m) as [east, north, up] in the scene's metres, or use kind: platform");
  }
}
// Why a sensor could not be made, if it was given a place on the Earth: only platforms have one, the others of our
// kinds stand in the scene's metres.
void refuse_geodetic(const Params& params, const std::string& kind) {
  for (const char* fixed : {"frame_camera", "orthographic", "fisheye", "point", "goniometer", "rami"})
    if (kind == fixed) return refuse_geodetic_keys(params, kind);
}
}  // namespace

Registry<SensorRow>& sensor_kinds() {
  static Registry<SensorRow> table("sensor kind", "SE101",
                                   {frame_camera_row(), platform_row(), orthographic_row(), fisheye_row(), point_row(),
                                    goniometer_row(), rami_row()});
  return table;
}

std::unique_ptr<Sensor> make_sensor(const Params& params, const SensorContext& context) {
  const std::string kind = required(params, "kind", sensor_kinds().names()).as_text();
  const SensorRow& row = sensor_kinds().find(kind, params.at("kind").where());
  try {
    return row.make(params, context);
  } catch (const Error&) {
    refuse_geodetic(params, kind);
    throw;
  }
}

double read_spectral_error(const Params& p) {
  const double error = p.number_in("spectral_error", 0, 0.5, "(fraction)", kSpectralError);
  if (error > 0 && error < kLeastSpectralError)
    throw p.at("spectral_error")
        .error(strf("the spectral error %g is too small for single precision", error),
               strf("at least %g, or 0 for even bins of spectral_step_um", kLeastSpectralError));
  return error;
}

SpectralState state_for(std::span<const Band> bands, double spectral_error, double step_um, double reference_um,
                        size_t knots) {
  SpectralState state = make_state(bands, step_um > 0 ? step_um : kDefaultStep, reference_um, knots);
  state.choice = {spectral_error, step_um, knots};
  return state;
}

SpectralState read_state(const Params& p, std::span<const Band> bands) {
  const auto step = p.find("spectral_step_um");
  return state_for(bands, read_spectral_error(p), step ? step->as_number_in(1e-6, 1000, "um") : 0,
                   p.number_in("reference_um", 0, 10000, "um", 0),
                   static_cast<size_t>(p.integer("hero_wavelengths", 1, 8, 4)));
}

namespace {

// Adds the names of a list; none may be there already.
void add_names(const Params& list, const char* what, std::vector<std::string>& names) {
  for (const Params& item : list.items()) {
    std::string name = item.as_text();
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw item.error(strf("the %s '%s' is listed twice", what, name.c_str()));
    names.push_back(std::move(name));
  }
}

}  // namespace

std::vector<std::string> read_truth(const Params& params) {
  const auto list = params.find("truth");
  if (!list) return {default_truth().begin(), default_truth().end()};
  std::vector<std::string> names;
  add_names(*list, "truth", names);
  return names;
}

std::vector<std::string> read_channels(const Params& params) {
  std::vector<std::string> names(default_channels().begin(), default_channels().end());
  if (const auto list = params.find("channels")) add_names(*list, "channel", names);
  return names;
}

TimeWindow read_window(const Params& params) {
  const double time = params.number("time_s", 0);
  return {time, time + params.number_in("integration_time_s", 0, 86400, "s", 0)};
}

namespace {

Band band_of_shape(const Params& item, const std::string& name, double center, double width) {
  const auto shape = item.find("shape");
  switch (shape ? shape->as_choice({"gaussian", "rectangular", "triangular"}) : 0) {
    case 0:
      return Band::gaussian(name, center, width);
    case 1:
      return Band::rectangular(name, center, width);
    default:
      return Band::triangular(name, center, width);
  }
}

double read_center(const Params& p) {
  const double center = p.as_number();
  if (!(center >= 0.01 && center <= kLongestWave))
    throw p.error("the band's centre is " + wavelengths_text(center, center),
                  strf("0.01 to %g um are possible", kLongestWave));
  return center;
}

// Bands in bulk: even centres, named by them.
void add_even_bands(const Params& item, std::vector<Band>& bands) {
  const double first = read_center(item.at("from_um")), last = read_center(item.at("to_um"));
  const auto count = static_cast<int>(item.integer("count", 2, 10000));
  if (!(last > first)) throw item.at("to_um").error("the last centre is not beyond the first");
  const double step = (last - first) / (count - 1),
               width = item.number_in("fwhm_um", 1e-6, 2 * first * 0.999, "um", step);
  for (int i = 0; i < count; ++i) {
    const double center = std::round((first + i * step) * 1e9) / 1e9;
    bands.push_back(band_of_shape(item, strf("%.10g nm", std::round(center * 1e6) / 1e3), center, width));
  }
}

Band read_band(const Params& item, const SensorContext& context) {
  const std::string name = item.text("name");
  if (const auto response = item.find("response")) {
    const Curve curve = context.curve(*response);
    if (curve.low_um() > kLongestWave)
      throw response->error("the response is given from " + curve.range_text(),
                            strf("0.01 to %g um are possible", kLongestWave));
    return Band::tabulated(name, curve, response->where());
  }
  const double center = read_center(item.at("center_um"));
  return band_of_shape(item, name, center, item.number_in("fwhm_um", 1e-6, 2 * center * 0.999, "um"));
}

// Bands of a file of responses, all or those that are listed.
void add_bands_of_file(const Params& item, const SensorContext& context, std::vector<Band>& bands) {
  const Params file = item.at("responses");
  const std::vector<NamedResponse> there = context.responses(file);
  const auto take = [&](const NamedResponse& r) { bands.push_back(Band::tabulated(r.name, r.curve, file.where())); };
  const auto names = item.find("names");
  if (!names) {
    std::ranges::for_each(there, take);
    return;
  }
  std::vector<std::string> known;
  for (const NamedResponse& r : there) known.push_back(r.name);
  for (const Params& name : names->items()) {
    const auto at = std::ranges::find(known, name.as_text());
    if (at == known.end()) {
      const std::string near = nearest_name(name.as_text(), known);
      throw name.error(
          "the file has no band '" + name.as_text() + "'",
          near.empty() ? "it has '" + known.front() + "' to '" + known.back() + "'" : "did you mean '" + near + "'?");
    }
    take(there[static_cast<size_t>(at - known.begin())]);
  }
}

// Error: an item of no kind, at the first of its keys: a missing 'name' would hide keys such as 'from_nm'.
void check_says_which(const Params& item) {
  constexpr const char* kKinds =
      "give name, center_um and fwhm_um; name and response; from_um, to_um and count; or responses";
  if (item.has("center_um") || item.has("response")) return;
  const std::vector<std::string> keys = item.keys();
  for (const std::string& key : keys)
    if (key != "name" && key != "fwhm_um" && key != "shape")
      throw Error(item.where(key), "a band has no key '" + key + "'",
                  std::string(kKinds) + "; wavelengths are in micrometres");
  throw item.error("the band has no wavelengths", kKinds);
}

}  // namespace

std::vector<Band> read_bands(const Params& list, const SensorContext& context) {
  std::vector<Band> bands;
  std::set<std::string> names;
  for (const Params& item : list.items()) {
    const size_t before = bands.size();
    if (item.has("from_um"))
      add_even_bands(item, bands);
    else if (item.has("responses"))
      add_bands_of_file(item, context, bands);
    else {
      check_says_which(item);
      bands.push_back(read_band(item, context));
    }
    for (size_t i = before; i < bands.size(); ++i)
      if (!names.insert(bands[i].name).second)
        throw item.error("two bands are named '" + bands[i].name + "'", "give each its own name");
  }
  if (bands.empty()) throw list.error("a sensor needs at least one band");
  return bands;
}

Convergence read_convergence(const Params& params) {
  Convergence c;
  const auto paths = params.find("paths");
  if (!paths) return c;
  constexpr long long most = 1LL << 30;
  if (paths->kind() == Params::Kind::scalar) {
    c.min_paths = c.max_paths = static_cast<uint32_t>(paths->as_integer(1, most));
    return c;
  }
  c.min_paths = static_cast<uint32_t>(paths->integer("min", 1, most, 32));
  c.max_paths = static_cast<uint32_t>(paths->integer("max", 1, most, 1024));
  c.relative_error = paths->number_in("relative_error", 0, 1, "(fraction)", 0.01);
  c.absolute_floor = paths->number_in("absolute_floor", 0, 1e30, "W/(m2 sr um)", 0);
  if (c.max_paths < c.min_paths) throw paths->error("max is less than min");
  return c;
}

std::vector<double> read_band_targets(const Params& params, std::span<const Band> bands, Convergence& convergence) {
  const auto paths = params.find("paths");
  const auto list = paths && paths->kind() == Params::Kind::map ? paths->find("bands") : std::nullopt;
  if (!list) return {};
  if (list->kind() != Params::Kind::map || list->size() == 0)
    throw list->error("targets of bands are names with relative errors", "bands: {red: 0.01}");
  if (paths->has("relative_error"))
    throw paths->at("relative_error").error("there are targets for bands already", "leave relative_error out");
  std::vector<double> targets;
  std::vector<std::string> names;
  double least = 1;
  for (const Band& band : bands) {
    names.push_back(band.name);
    targets.push_back(list->has(band.name) ? list->number_in(band.name, 1e-9, 1, "(fraction)") : 0);
    if (targets.back() > 0) least = std::min(least, targets.back());
  }
  for (const std::string& key : list->keys())
    if (std::find(names.begin(), names.end(), key) == names.end())
      throw Error(list->where(key), "there is no band '" + key + "'", name_hint(key, names));
  convergence.relative_error = least;
  return targets;
}

}  // namespace suite
