#include <cmath>
#include <limits>
#include <set>

#include "formats/curve/curve.h"
#include "formats/sim_text/sim_text.h"

namespace suite {

namespace {

// A number, a file name, or a map {file, column, scale, outside} / {wavelength_um: [...], value: [...], outside}.
Curve read_curve_value(const Params& p) {
  auto outside_of = [](const Params& map) {
    const auto rule = map.find("outside");
    return rule ? static_cast<Outside>(rule->as_choice({"error", "hold", "zero"})) : Outside::error;
  };
  if (p.kind() == Params::Kind::map) {
    if (const auto x = p.find("wavelength_um")) return Curve(x->as_numbers(), p.at("value").as_numbers(), outside_of(p), p.where());
    CurveOptions options;
    options.outside = outside_of(p);
    options.column = static_cast<int>(p.integer("column", 0, 10000, 0));
    options.scale = p.number("scale", 1);
    return read_curve(p.at("file").as_path(), options);
  }
  const std::string text = p.as_text();
  const bool number = text.find_first_not_of("0123456789.eE+-") == std::string::npos;
  return number ? Curve::constant(p.as_number()) : read_curve(p.as_path(), {});
}

void read_sun(const Params& p, Simulation& sim) {
  SunSpec sun;
  sun.irradiance = read_curve_value(p.at("irradiance"));
  if (sun.irradiance.min() < 0) throw p.at("irradiance").error("the irradiance is negative", "W/(m2 um), at least 0");
  if (const auto d = p.find("direction")) {
    if (const auto time = d->find("time_utc")) {
      try {
        sim.sun_by_time = SunByTime{parse_iso8601(time->as_text()), time->where(), true};
      } catch (const Error& e) {
        throw time->error(e.message(), e.hint());
      }
    } else {
      const double zenith = d->number_in("zenith_deg", 0, 180, "degrees") * kDegree;
      sun.direction = dir_from_angles(zenith, azimuth_from_compass_deg(d->number_in("azimuth_deg", -360, 360, "degrees clockwise from north")));
    }
  } else {
    throw p.error("the key 'direction' is missing", "give {zenith_deg, azimuth_deg} or {time_utc}");
  }
  const bool collimated = p.boolean("collimated", false);
  if (const auto half = p.find("half_angle_deg")) {
    if (collimated) throw half->error("a collimated sun has no half angle", "drop one of the two");
    sun.half_angle = half->as_number_in(0, 90, "degrees") * kDegree;
    if (sim.sun_by_time) sim.sun_by_time->disk_from_distance = false;
  } else if (collimated) {
    sun.half_angle = 0;
    if (sim.sun_by_time) sim.sun_by_time->disk_from_distance = false;
  } else {
    sun.half_angle = 0.26655 * kDegree;  // at 1 AU: asin(6.957e8 m / 1.495978707e11 m)
  }
  sim.sources.sun = sun;
}

void read_sky(const Params& p, Simulation& sim) {
  SkySpec sky;
  sky.radiance = read_curve_value(p.at("radiance"));
  if (sky.radiance.min() < 0) throw p.at("radiance").error("the radiance is negative", "W/(m2 sr um), at least 0");
  sky.full_sphere = p.boolean("full_sphere", false);
  if (const auto table = p.find("table")) {
    // Rows from the zenith down, each a list over azimuths.
    for (const Params& row : table->items()) {
      const std::vector<double> values = row.as_numbers();
      if (values.empty() || (sky.zeniths && values.size() != sky.azimuths)) throw row.error("the rows of a sky table must be equally long and not empty");
      for (const double v : values)
        if (v < 0) throw row.error("a sky table holds a negative value");
      sky.azimuths = values.size();
      ++sky.zeniths;
      sky.table.insert(sky.table.end(), values.begin(), values.end());
    }
    if (sky.zeniths < 2) throw table->error("a sky table needs at least two rows", "the first is the zenith, the last the horizon (the nadir with full_sphere)");
  }
  sim.sources.sky = sky;
}

void read_output(const Params& p, OutputSpec& out) {
  if (const auto type = p.find("type")) out.type = static_cast<OutputSpec::Type>(type->as_choice({"float32", "float64"}));
  if (const auto order = p.find("interleave")) out.order = static_cast<OutputSpec::Order>(order->as_choice({"bsq", "bil", "bip"}));
  if (const auto preview = p.find("preview")) {
    for (const Params& band : preview->items()) out.preview.push_back(band.as_text());
    if (out.preview.size() != 1 && out.preview.size() != 3) throw preview->error(strf("a preview has one band or three, found %zu", out.preview.size()));
  }
}

}  // namespace

Simulation read_simulation(const std::string& path, const std::function<void(const Sensor&, const CaptureResult&)>& deliver) {
  const Params root = Params::parse_file(path);
  Simulation sim;
  sim.path = path;
  sim.scene_path = root.at("scene").as_path();
  sim.pipeline.seed = static_cast<uint64_t>(root.integer("seed", 0, 1LL << 53, 1));
  sim.pipeline.max_nodes = static_cast<int>(root.integer("max_nodes", 1, kMaxNodes, 16));
  sim.pipeline.max_scatterings = static_cast<uint32_t>(root.integer("max_scatterings", 1, 10000000, 10000));
  if (const auto sun = root.find("sun")) read_sun(*sun, sim);
  if (const auto sky = root.find("sky")) read_sky(*sky, sim);
  if (const auto p = root.find("periodic")) {
    const std::vector<double> low = p->at("origin_m").as_numbers(), size = p->at("size_m").as_numbers();
    if (low.size() != 2 || size.size() != 2) throw p->error("origin_m and size_m are two numbers each: east, north");
    if (!(size[0] > 0 && size[1] > 0)) throw p->at("size_m").error("the cell needs a positive size");
    sim.periodic = Periodic{{low[0], low[1]}, {size[0], size[1]}};
  }
  if (const auto output = root.find("output")) read_output(*output, sim.output);
  const SensorContext context{read_curve_value, deliver};
  std::set<std::string> names;
  const Params sensors = root.at("sensors");
  for (const Params& p : sensors.items()) {
    sim.sensors.push_back(make_sensor(p, context));
    if (!names.insert(sim.sensors.back()->name()).second) throw p.error("two sensors are named '" + sim.sensors.back()->name() + "'", "give each its own `name`: it names the output files");
  }
  if (sim.sensors.empty()) throw sensors.error("a simulation needs at least one sensor");
  root.reject_unread();
  return sim;
}

}  // namespace suite
