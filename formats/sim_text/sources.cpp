#include "formats/sim_text/sources.h"

#include <cmath>

#include "base/files.h"
#include "formats/curve/curve.h"
#include "formats/raster/raster.h"
#include "formats/sqt/sqt.h"
#include "light/kinds/solar_spectrum.h"
#include "motion/time.h"
#include "optics/phase_function.h"

namespace suite {

namespace {
// A file that a value names, which must be there.
std::string file_of(const Params& p) {
  const std::string path = p.as_path();
  if (!file_exists(path))
    throw p.error("there is no file '" + path + "'", "relative names start at this file's folder");
  return path;
}
}  // namespace

Curve read_curve_value(const Params& p) {
  if (p.kind() == Params::Kind::list || (p.kind() == Params::Kind::map && p.has("join")))
    return read_joined(p, read_curve_value);
  if (p.kind() == Params::Kind::map) {
    if (const auto x = p.find("wavelength_um"))
      return Curve(x->as_numbers(), p.at("value").as_numbers(), read_outside(p), p.where());
    CurveOptions options;
    options.outside = read_outside(p);
    options.column = static_cast<int>(p.integer("column", 0, 10000, 0));
    options.scale = p.number("scale", 1);
    return read_curve(file_of(p.at("file")), options);
  }
  const std::string text = p.as_text();
  const bool number = text.find_first_not_of("0123456789.eE+-") == std::string::npos;
  return number ? Curve::constant(p.as_number()) : read_curve(file_of(p), {});
}

namespace {

Curve read_positive(const Params& p, const char* what, const char* unit, std::vector<AskedCurve>& asked) {
  Curve c = read_curve_value(p);
  if (c.min() < 0) throw p.error(std::string("the ") + what + " is negative", std::string(unit) + ", at least 0");
  asked.push_back({p.where(), what, c});
  return c;
}

// {zenith_deg, azimuth_deg} or {time_utc}, and the disk: half_angle_deg, collimated.
void read_disk(const Params& p, double usual_half_angle_deg, SunSpec& disk) {
  const auto d = p.find("direction");
  if (!d) throw p.error("the key 'direction' is missing", "give {zenith_deg, azimuth_deg} or {time_utc}");
  if (const auto time = d->find("time_utc")) {
    try {
      disk.time = SourceTime{time->as_text(), time->where()};
      instant_from_utc(parse_iso8601(disk.time->utc));
    } catch (const Error& e) {
      throw time->error(e.message(), e.hint());
    }
  } else {
    const double zenith = d->number_in("zenith_deg", 0, 180, "degrees") * kDegree;
    disk.direction = dir_from_angles(
        zenith, azimuth_from_compass_deg(d->number_in("azimuth_deg", -360, 360, "degrees clockwise from north")));
  }
  const bool collimated = p.boolean("collimated", false);
  const auto half = p.find("half_angle_deg");
  if (half && collimated) throw half->error("a collimated source has no half angle", "drop one of the two");
  disk.half_angle = collimated ? 0 : (half ? half->as_number_in(0, 90, "degrees") : usual_half_angle_deg) * kDegree;
  disk.disk_by_time = disk.time && !collimated && !half;
}

SunSpec read_sun(const Params& p, std::vector<AskedCurve>& asked) {
  SunSpec sun;
  const auto irradiance = p.find("irradiance");
  if (!irradiance || (irradiance->kind() == Params::Kind::scalar && irradiance->as_text() == "tsis")) {
    sun.irradiance = solar_irradiance();
    sun.at_1_au = true;
  } else {
    sun.irradiance = read_positive(*irradiance, "irradiance", "W/(m2 um)", asked);
  }
  read_disk(p, 0.26655, sun);  // at 1 AU: asin(6.957e8 m / 1.495978707e11 m)
  return sun;
}

MoonSpec read_moon(const Params& p, std::vector<AskedCurve>& asked) {
  MoonSpec moon;
  read_disk(p, 0.25896, moon.disk);  // at 384 400 km
  if (const auto irradiance = p.find("irradiance")) {
    moon.disk.irradiance = read_positive(*irradiance, "irradiance", "W/(m2 um)", asked);
    moon.by_phase = false;
  }
  const auto phase = p.find("phase_deg");
  if (phase && (!moon.by_phase || moon.disk.time))
    throw phase->error("a moon by date, or with its own irradiance, has its phase already", "drop one of the two");
  if (moon.by_phase && !moon.disk.time) {
    if (!phase)
      throw p.error("the moon's light is not given", "give phase_deg, irradiance, or a direction by time_utc");
    moon.geometry.phase = phase->as_number_in(0, 180, "degrees") * kDegree;
    moon.geometry.sun_longitude = moon.geometry.phase;
  }
  return moon;
}

// Rows of numbers of equal length.
void read_rows(const Params& table, size_t& rows, size_t& columns, std::vector<double>& values, const char* what) {
  for (const Params& row : table.items()) {
    const std::vector<double> v = row.as_numbers();
    if (v.empty() || (rows && v.size() != columns))
      throw row.error(std::string("the rows of ") + what + " must be equally long and not empty");
    for (const double x : v)
      if (x < 0) throw row.error(std::string(what) + " holds a negative value");
    columns = v.size();
    ++rows;
    values.insert(values.end(), v.begin(), v.end());
  }
}

ClearSkySpec read_clear(const Params& p) {
  ClearSkySpec c;
  c.pressure = p.number_in("pressure_pa", 1000, 120000, "Pa", c.pressure);
  c.water_cm = p.number_in("water_cm", 0, 10, "cm", c.water_cm);
  c.ozone_cm = p.number_in("ozone_cm", 0, 1, "atm-cm", c.ozone_cm);
  c.aerosol_depth_500 = p.number_in("aerosol_depth_500", 0, 2, "", c.aerosol_depth_500);
  c.angstrom = p.number_in("angstrom", -1, 4, "", c.angstrom);
  c.albedo_400 = p.number_in("albedo_400", 0, 1, "", c.albedo_400);
  c.asymmetry = p.number_in("asymmetry", 0, 0.95, "", c.asymmetry);
  c.ground_albedo = p.number_in("ground_albedo", 0, 1, "", c.ground_albedo);
  return c;
}

// A panorama: rows from the zenith down, columns clockwise from a compass azimuth.
SkySpec read_image(const Params& p, std::vector<AskedCurve>& asked) {
  SkySpec sky;
  const auto scale = p.find("radiance");
  sky.radiance = scale ? read_positive(*scale, "radiance", "W/(m2 sr um)", asked) : Curve::constant(1);
  const Params file = p.at("file");
  const Raster image = read_raster(file.as_path(), size_t{1} << 24);
  if (size_t{image.width} * image.height * image.channels > size_t{1} << 27)
    throw file.error(
        strf("%u x %u pixels of %u channels are too many for a sky", image.width, image.height, image.channels));
  if (const auto w = p.find("wavelength_um")) sky.wavelength_um = w->as_numbers();
  if (sky.wavelength_um.size() != (image.channels == 1 ? 0 : image.channels))
    throw p.error(strf("the image has %u channels and %zu wavelengths", image.channels, sky.wavelength_um.size()),
                  "give `wavelength_um`, ascending, one per channel of several");
  for (size_t i = 0; i < sky.wavelength_um.size(); ++i)
    if (!(sky.wavelength_um[i] > (i ? sky.wavelength_um[i - 1] : 0)))
      throw p.at("wavelength_um").error("the wavelengths are not positive and ascending");
  sky.full_sphere = true;
  if (const auto covers = p.find("covers")) sky.full_sphere = covers->as_choice({"sphere", "hemisphere"}) == 0;
  const double left = p.number_in("left_azimuth_deg", -360, 360, "degrees clockwise from north", 0);
  sky.cells = true;
  sky.zeniths = image.height, sky.azimuths = image.width;
  sky.table.resize(size_t{image.width} * image.height * image.channels);
  const double n = image.width;
  for (uint32_t j = 0; j < image.width; ++j) {
    // The pixel whose middle lies nearest to the middle of cell j.
    const double compass = 90 - (j + 0.5) / n * 360, turns = (compass - left) / 360;
    const auto column = std::min(image.width - 1, static_cast<uint32_t>((turns - std::floor(turns)) * n));
    for (uint32_t r = 0; r < image.height; ++r)
      for (uint32_t c = 0; c < image.channels; ++c) {
        const double v = static_cast<double>(image.values[(size_t{r} * image.width + column) * image.channels + c]);
        if (!(v >= 0) || !std::isfinite(v))
          throw file.error(strf("pixel (%u, %u) is negative or not finite", column, r));
        sky.table[(size_t{c} * image.height + r) * image.width + j] = v;
      }
  }
  return sky;
}

SkySpec read_thermal(const Params& p, std::vector<AskedCurve>& asked) {
  SkySpec sky;
  sky.zeniths = static_cast<size_t>(p.integer("zeniths", 2, 1000, 181));
  for (const Params& layer : p.at("layers").items())
    sky.layers.push_back({layer.number_in("temperature_k", 1e-3, 1e5, "K"),
                          read_positive(layer.at("optical_depth"), "optical depth", "vertical, of absorption", asked)});
  if (sky.layers.empty()) throw p.at("layers").error("a thermal sky needs at least one layer");
  return sky;
}

SkySpec read_tabulated(const Params& p, std::vector<AskedCurve>& asked) {
  SkySpec sky;
  sky.radiance = read_positive(p.at("radiance"), "radiance", "W/(m2 sr um)", asked);
  sky.full_sphere = p.boolean("full_sphere", false);
  const auto table = p.find("table");
  const auto tables = p.find("tables");
  if (table && tables) throw tables->error("`table` and `tables` exclude each other");
  const auto check_rows = [](const Params& at, size_t rows) {
    if (rows < 2)
      throw at.error("a sky table needs at least two rows",
                     "the first is the zenith, the last the horizon (the nadir with full_sphere)");
  };
  if (table) {
    read_rows(*table, sky.zeniths, sky.azimuths, sky.table, "a sky table");
    check_rows(*table, sky.zeniths);
  }
  if (!tables) return sky;
  // One table per wavelength, all of one size.
  for (const Params& one : tables->items()) {
    sky.wavelength_um.push_back(one.number_in("wavelength_um", 1e-3, 1e4, "um"));
    if (sky.wavelength_um.size() > 1 && !(sky.wavelength_um.back() > sky.wavelength_um[sky.wavelength_um.size() - 2]))
      throw one.error("the wavelengths of the tables are not ascending");
    size_t rows = 0, columns = 0;
    read_rows(one.at("table"), rows, columns, sky.table, "a sky table");
    check_rows(one, rows);
    if (sky.wavelength_um.size() > 1 && (rows != sky.zeniths || columns != sky.azimuths))
      throw one.error("the tables differ in size");
    sky.zeniths = rows, sky.azimuths = columns;
  }
  if (sky.wavelength_um.empty()) throw tables->error("no table is given");
  return sky;
}

void read_sky(const Params& p, SourceSpecs& sources, std::vector<AskedCurve>& asked) {
  const auto kind = p.find("kind");
  switch (kind ? kind->as_choice({"table", "clear", "image", "thermal"}) : 0) {
    case 1:
      sources.clear = read_clear(p);
      break;
    case 2:
      sources.sky = read_image(p, asked);
      break;
    case 3:
      sources.sky = read_thermal(p, asked);
      break;
    default:
      sources.sky = read_tabulated(p, asked);
  }
}

std::shared_ptr<const IntensityTable> read_distribution(const Params& p) {
  auto t = std::make_shared<IntensityTable>();
  if (const auto file = p.find("sqt")) {
    const SqtFile sqt = read_sqt(file->as_path());
    if (sqt.bundle->info().function.quantity != sqt::Quantity::intensity)
      throw file->error("this SQT holds no distribution of intensity");
    t->sqt = sqt.bundle;
    return t;
  }
  const Params table = p.at("table");
  read_rows(table, t->polars, t->azimuths, t->value, "a table of intensity");
  if (t->polars < 2)
    throw table.error("a table of intensity needs at least two rows", "the first is the axis, the last its opposite");
  return t;
}

LampSpec read_lamp(const Params& p, size_t number, std::vector<AskedCurve>& asked) {
  LampSpec lamp;
  lamp.where = p.where();
  lamp.name = p.text("name", strf("lamp %zu", number));
  const size_t kind = p.at("kind").as_choice({"point", "spot", "surface"});
  lamp.kind = static_cast<LampSpec::Kind>(kind);
  if (lamp.kind == LampSpec::Kind::surface) {
    lamp.material = p.text("material");
    lamp.radiance = read_positive(p.at("radiance"), "radiance", "W/(m2 sr um)", asked);
    lamp.both_sides = p.boolean("both_sides", false);
    return lamp;
  }
  const auto one = p.find("position_m");
  const auto many = p.find("positions_m");
  if (!one == !many) throw p.error("a lamp has either position_m or positions_m");
  auto place = [](const Params& at) {
    const auto v = at.as_vec3();
    return Vec3{v[0], v[1], v[2]};
  };
  if (one)
    lamp.positions.push_back(place(*one));
  else
    for (const Params& at : many->items()) lamp.positions.push_back(place(at));
  if (lamp.positions.empty()) throw many->error("a lamp needs at least one position");
  if (const auto axis = p.find("axis")) {
    const auto v = axis->as_vec3();
    lamp.axis = {v[0], v[1], v[2]};
    if (!(length(lamp.axis) > 0)) throw axis->error("the axis has no length");
  }
  lamp.intensity = read_positive(p.at("intensity"), "intensity", "W/(sr um)", asked);
  if (lamp.kind == LampSpec::Kind::spot) {
    const Params outer = p.at("outer_deg");
    lamp.outer = outer.as_number_in(0.01, 180, "degrees") * kDegree;
    lamp.inner = p.number_in("inner_deg", 0, 180, "degrees", 0.8 * lamp.outer / kDegree) * kDegree;
    if (lamp.inner > lamp.outer) throw outer.error("the outer cone is narrower than the inner one");
  }
  if (const auto distribution = p.find("distribution")) lamp.table = read_distribution(*distribution);
  return lamp;
}

ModelSpec read_phase(const Params& p) {
  ModelSpec spec;
  spec.model = p.text("model");
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

AtmosphereSpec read_atmosphere(const Params& p, std::vector<AskedCurve>& asked) {
  AtmosphereSpec a;
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
    aerosol.depth_550 = q->number_in("depth_550", 0, 100, "");
    aerosol.angstrom = q->number_in("angstrom", -1, 4, "", aerosol.angstrom);
    aerosol.scale_height = q->number_in("scale_height_m", 1, 1e6, "m", aerosol.scale_height);
    if (const auto albedo = q->find("albedo")) {
      aerosol.albedo = read_positive(*albedo, "albedo", "0 to 1", asked);
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
      const auto by_layer = g.find("layer_depths");
      if (by_layer) {
        for (const Params& c : by_layer->items())
          gas.layers.push_back(read_positive(c, "optical depth", "vertical, of the layer", asked));
        if (gas.layers.size() != layers)
          throw by_layer->error(strf("%zu optical depths for %zu layers", gas.layers.size(), layers));
      } else {
        gas.column = read_positive(g.at("column_depth"), "optical depth", "vertical, of the column", asked);
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
                  "give a longer curve, or declare 'outside: hold' or 'zero'");
    }
}

SourceSpecs read_sources(const Params& root, std::vector<AskedCurve>& asked) {
  SourceSpecs s;
  if (const auto sun = root.find("sun")) s.sun = read_sun(*sun, asked);
  if (const auto moon = root.find("moon")) s.moon = read_moon(*moon, asked);
  if (const auto sky = root.find("sky")) {
    read_sky(*sky, s, asked);
    if (s.clear && !s.sun) throw sky->error("a clear sky needs a sun", "give `sun`");
  }
  if (const auto lamps = root.find("lamps"))
    for (const Params& lamp : lamps->items()) s.lamps.push_back(read_lamp(lamp, s.lamps.size() + 1, asked));
  if (const auto air = root.find("atmosphere")) {
    s.atmosphere = read_atmosphere(*air, asked);
    if (s.clear) throw air->error("a clear sky stands for the atmosphere as well", "drop one of the two");
  }
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
