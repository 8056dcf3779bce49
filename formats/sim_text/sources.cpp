#include "formats/sim_text/sources.h"

#include <cmath>

#include "base/files.h"
#include "base/required.h"
#include "base/run_app.h"
#include "formats/curve/curve.h"
#include "formats/ies/ies.h"
#include "formats/motion/motion.h"
#include "formats/raster/raster.h"
#include "formats/sim_text/air.h"
#include "formats/sim_text/air_tables.h"
#include "formats/sim_text/lamp_map.h"
#include "formats/sqt/sqt.h"
#include "formats/star_catalogue/star_catalogue.h"
#include "formats/tle/tle.h"
#include "optics/phase_function.h"
#include "spectral/lamp_spectra.h"

namespace suite {

namespace {
// A file that a value names, which must be there.
std::string file_of(const Params& p) {
  const std::string path = p.as_path();
  if (!file_exists(path))
    throw p.error("there is no file '" + path + "'", "relative names start at this file's folder");
  return path;
}

CurveOptions with_warnings() {
  CurveOptions options;
  options.on_warning = [](const std::string& path, const std::string& what) { warn(path + ": " + what); };
  return options;
}
}  // namespace

Curve read_curve_value(const Params& p) {
  if (p.kind() == Params::Kind::list || (p.kind() == Params::Kind::map && p.has("join")))
    return read_joined(p, read_curve_value);
  if (p.kind() == Params::Kind::map) {
    if (const auto lamp = p.find("lamp")) {
      const std::vector<std::string> names = lamp_names();
      return lamp_spectrum(names[lamp->as_choice(names)]).scaled(p.number_in("scale", 0, 1e30, "W", 1));
    }
    if (const auto x = p.find("wavelength_um"))
      return Curve(x->as_numbers(), p.at("value").as_numbers(), read_outside(p), p.where());
    CurveOptions options = with_warnings();
    options.outside = read_outside(p);
    options.column = static_cast<int>(p.integer("column", 0, 10000, 0));
    options.scale = p.number("scale", 1);
    return read_curve(file_of(p.at("file")), options);
  }
  const std::string text = p.as_text();
  const bool number = text.find_first_not_of("0123456789.eE+-") == std::string::npos;
  return number ? Curve::constant(p.as_number()) : read_curve(file_of(p), with_warnings());
}

namespace {

LightImage read_image(const std::string& path) {
  Raster raster = read_raster(path, size_t{1} << 24);
  return {raster.width, raster.height, raster.channels, std::move(raster.values)};
}

std::shared_ptr<const sqt::Bundle> read_intensity(const Params& file) {
  const SqtFile sqt = read_sqt(file.as_path());
  if (sqt.bundle->info().function.quantity != sqt::Quantity::intensity)
    throw file.error("this SQT holds no distribution of intensity");
  return sqt.bundle;
}

IntensityTable read_candela(const Params& file) {
  double lost = 0;
  const std::string path = file_of(file);
  IntensityTable table = intensity_table(read_ies(path), lost);
  if (std::fabs(lost) > 1e-4)
    warn(strf("%s: on the even table of a lamp its lumens change by %+.2g %%", path.c_str(), 100 * lost));
  return table;
}

std::vector<CatalogueStar> read_stars(const Params& file) {
  const std::string path = file.as_path();
  if (!file_exists(path))
    throw file.error("there is no star catalogue '" + path + "'", "'builtin', 'none', or a CSV file");
  return read_star_catalogue(path);
}

OrbitElements read_orbit(const Params& p) {
  const auto lines = p.find("tle_lines");
  if (!lines) return read_tle_of(p.at("tle").as_path(), p.text("satellite")).elements;
  if (lines->size() != 2) throw lines->error("'tle_lines' are the two lines of an element set");
  return parse_tle((*lines)[0].as_text() + "\n" + (*lines)[1].as_text() + "\n", lines->where().file).at(0).elements;
}

ModelSpec read_phase(const Params& p) {
  ModelSpec spec;
  spec.model = required(p, "model", phases().names()).as_text();
  for (const Parameter& parameter : phases().find(spec.model, p.at("model").where()).parameters) {
    const auto value = p.find(parameter.name);
    if (!value) continue;
    if (parameter.kind == Parameter::Kind::number)
      spec.numbers[parameter.name] = value->as_number();
    else if (parameter.kind == Parameter::Kind::curve)
      spec.curves[parameter.name] = read_curve_value(*value);
    else
      spec.texts[parameter.name] = value->as_text();
  }
  check_phase(spec, p.where());
  return spec;
}

// The date of second 0, which may stand with the lights that are being read.
std::optional<Params> date_of(const Params& root) {
  auto date = root.find("epoch");
  for (const char* body : {"sun", "moon"})
    if (const auto light = date ? std::nullopt : root.find(body))
      if (const auto direction = light->find("direction")) date = direction->find("time_utc");
  if (const auto sky = date ? std::nullopt : root.find("night_sky")) date = sky->find("time_utc");
  return date;
}

std::optional<Clock> clock_of(const std::optional<Params>& date) {
  if (!date) return std::nullopt;
  try {
    return Clock(parse_iso8601(date->as_text()));
  } catch (const Error& e) {
    throw date->error(e.message(), e.hint());
  }
}

std::shared_ptr<const LampSchedule> read_lamp_schedule(const Params& p, const MotionContext& context) {
  constexpr const char* kColumns[] = {"on", "scale"};
  const TimedTable table = timetable_from(p, context, kColumns);
  auto made = std::make_shared<LampSchedule>();
  made->when = table.when;
  for (const TimedRow& row : table.rows) {
    const auto on = row.cells.find("on"), scale = row.cells.find("scale");
    const bool dark = on != row.cells.end() && !on->second.truth();
    if (dark && scale != row.cells.end()) throw Error(row.where, "a lamp that is off has a scale", "leave it out");
    made->scale.push_back(dark ? 0 : scale != row.cells.end() ? scale->second.number_in(0, 1e12, "(of the light)") : 1);
  }
  return made;
}

AtmosphereSpec read_atmosphere(const Params& p, const LightContext& context) {
  AtmosphereSpec a;
  a.where = p.where();
  if (const auto heights = p.find("heights_m")) {
    a.heights = heights->as_numbers();
    if (a.heights.size() < 2 || a.heights.size() > 201)
      throw heights->error(strf("%zu heights bound no layers", a.heights.size()), "give 2 to 201, ascending");
    for (size_t i = 1; i < a.heights.size(); ++i)
      if (!(a.heights[i] > a.heights[i - 1])) throw heights->error("the heights are not ascending");
  }
  const size_t layers = a.heights.size() - 1;
  if (const auto t = p.find("temperature_k")) {
    a.temperature_k = t->as_numbers();
    if (a.temperature_k.size() != layers)
      throw t->error(strf("%zu temperatures for %zu layers", a.temperature_k.size(), layers));
    for (const double v : a.temperature_k)
      if (!(v > 0)) throw t->error("a temperature is not positive");
  }
  a.scene_height = p.number_in("scene_height_m", -1000, 20000, "m above sea level", 0);
  a.rayleigh = p.boolean("rayleigh", true);
  a.pressure = p.number_in("pressure_pa", 0, 200000, "Pa at sea level", a.pressure);
  if (const auto q = p.find("aerosol")) {
    AtmosphereSpec::Aerosol aerosol;
    aerosol.depth_550 = q->number_in("optical_depth_550", 0, 100, "");
    aerosol.angstrom = q->number_in("angstrom", -1, 4, "", aerosol.angstrom);
    aerosol.scale_height = q->number_in("scale_height_m", 1, 1e6, "m", aerosol.scale_height);
    if (const auto albedo = q->find("albedo")) {
      aerosol.albedo = context.positive(*albedo, "albedo", "0 to 1");
      if (aerosol.albedo.max() > 1) throw albedo->error("the albedo exceeds 1");
    }
    if (const auto phase = q->find("phase"))
      aerosol.phase = read_phase(*phase);
    else {
      aerosol.phase.model = "hg";
      aerosol.phase.numbers["g"] = 0.65;
      check_phase(aerosol.phase);
    }
    a.aerosol = aerosol;
  }
  if (const auto gases = p.find("gases"))
    for (const Params& g : gases->items()) {
      AtmosphereSpec::Gas gas;
      gas.name = g.text("name");
      const auto by_layer = g.find("layer_optical_depths");
      if (by_layer) {
        for (const Params& c : by_layer->items())
          gas.layers.push_back(context.positive(c, "optical depth", "vertical, of the layer"));
        if (gas.layers.size() != layers)
          throw by_layer->error(strf("%zu optical depths for %zu layers", gas.layers.size(), layers));
      } else {
        gas.column = context.positive(g.at("column_optical_depth"), "optical depth", "vertical, of the column");
        gas.scale_height = g.number_in("scale_height_m", 1, 1e6, "m");
      }
      a.gases.push_back(std::move(gas));
    }
  return a;
}

}  // namespace

void check_coverage(const AskedCurve& curve, const Sensor& sensor, const Where& where) {
  for (size_t state = 0; state < sensor.states().size(); ++state)
    for (const Band& b : sensor.bands(state)) {
      if (curve.curve.covers(b.low_um(), b.high_um())) continue;
      throw Error(curve.where,
                  curve.what + " is given from " + curve.curve.range_text() + ", and band '" + b.name +
                      "' of sensor '" + sensor.name() + "'" + (where.line > 0 ? strf(" (line %d)", where.line) : "") +
                      strf(" reaches from %.4g to %.4g um", b.low_um(), b.high_um()),
                  curve.hint);
    }
}

void check_coverage(const AskedCurve& curve, const LidarInstrument& lidar) {
  const double low = lidar.laser.wavelength_um - 0.5 * lidar.receiver.filter_um,
               high = lidar.laser.wavelength_um + 0.5 * lidar.receiver.filter_um;
  if (curve.curve.covers(low, high)) return;
  throw Error(curve.where,
              curve.what + " is given from " + curve.curve.range_text() + ", and the filter of laser radar '" +
                  lidar.name + strf("' reaches from %.6g to %.6g um", low, high),
              curve.hint);
}

SourceSpecs read_sources(const Params& root, std::vector<AskedCurve>& asked) {
  SourceSpecs s;
  MotionContext motion;
  const std::optional<Params> date = date_of(root);
  motion.clock = clock_of(date);
  LightContext context{read_curve_value,
                       read_image,
                       read_intensity,
                       read_candela,
                       [&](const Params& p) { return read_lamp_schedule(p, motion); },
                       read_lamp_map,
                       read_stars,
                       read_orbit,
                       date ? std::optional(SourceTime{date->as_text(), date->where()}) : std::nullopt,
                       &asked};
  for (const LightRow* key : light_keys()) {
    const auto value = root.find(key->key());
    if (!value) continue;
    std::vector<LightSpecPtr> lights;
    context.number = 1;
    for (const Params& entry : key->list ? value->items() : std::vector<Params>{*value}) {
      lights.push_back(make_light(*key, entry, context));
      ++context.number;
    }
    s.add(std::move(lights));
  }
  if (const auto air = root.find("atmosphere")) {
    if (air->has("tables")) {
      s.tabled = read_tabled_air(*air);
      if (const auto sky = root.find("sky"); sky && s.tabled->sky)
        throw sky->error("a sky stands beside an atmosphere whose tables have one", "drop one of the two");
    } else if (air->has("profile")) {
      s.air = read_air(*air, context);
      if (const auto sky = root.find("sky"))
        throw sky->error("a sky stands beside an atmosphere with a profile, which makes its own",
                         "drop one of the two");
    } else {
      s.atmosphere = read_atmosphere(*air, context);
    }
  }
  for (const LightSpecPtr& light : s.lights) light->check_beside(s);
  if (const auto earth = root.find("earth")) {
    EarthSpec e;
    e.material = earth->text("material");
    e.where = earth->at("material").where();
    if (const auto height = earth->find("height_m")) e.height = height->as_number_in(-10000, 10000, "m above WGS84");
    s.earth = e;
  }
  return s;
}

}  // namespace suite
