#include "formats/sim_text/air_tables.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/files.h"
#include "formats/four_curve/four_curve.h"
#include "formats/libradtran/libradtran.h"
#include "formats/tape7/modtran6.h"
#include "formats/tape7/path_table.h"

namespace suite {

namespace {

enum class Role { sights, sky, sun };

// A coordinate of runs, in tape7's words, in ours, and as the text gives it.
struct Coordinate {
  Tape7Axis tape7;
  SightAxis axis;
  const char* key;
  double low, high, unit;  // of the text's values; the unit in SI
  const char* unit_text;
};
constexpr Coordinate kCoordinates[] = {
    {Tape7Axis::view_zenith, SightAxis::view_zenith, "zenith_deg", 0, 180, kDegree, "degrees"},
    {Tape7Axis::range, SightAxis::range, "range_m", 1e-3, 1e9, 1, "m"},
    {Tape7Axis::observer_height, SightAxis::observer_height, "observer_height_m", -1000, 1e9, 1, "m above sea level"},
    {Tape7Axis::end_height, SightAxis::end_height, "end_height_m", -1000, 1e9, 1, "m above sea level"},
    {Tape7Axis::solar_zenith, SightAxis::solar_zenith, "solar_zenith_deg", 0, 180, kDegree, "degrees"},
    {Tape7Axis::relative_azimuth, SightAxis::relative_azimuth, "relative_azimuth_deg", -360, 360, kDegree,
     "degrees from the Sun's"}};

SightAxis axis_of(Tape7Axis axis) {
  for (const Coordinate& c : kCoordinates)
    if (c.tape7 == axis) return c.axis;
  throw Bug("an axis of tape7 that is none");
}

bool ends_with_any(std::string path, std::initializer_list<const char*> endings) {
  std::transform(path.begin(), path.end(), path.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::any_of(endings.begin(), endings.end(), [&](const char* e) { return path.ends_with(e); });
}

// Runs of tape7 and MODTRAN 6, by what they are runs of.
struct Runs {
  std::vector<Tape7Block> of[3];
};

// What the text says of a run's geometry stands in place of what the file says.
void complete(const Params& p, Tape7Block& run) {
  const bool has_cards = run.geometry.has_value();
  Tape7Geometry g = run.geometry.value_or(Tape7Geometry{2, 0, 0, 0, {}, {}, {}});
  const auto given = [&](const char* key) -> std::optional<double> {
    if (p.kind() != Params::Kind::map) return std::nullopt;
    for (const Coordinate& c : kCoordinates)
      if (std::string_view(c.key) == key && p.has(key)) return p.number_in(key, c.low, c.high, c.unit_text) * c.unit;
    return std::nullopt;
  };
  const bool sun = run.mode == Tape7Mode::irradiance;
  const auto height = given("observer_height_m"), end = given("end_height_m"), zenith = given("zenith_deg"),
             range = given("range_m"), solar = given("solar_zenith_deg"), azimuth = given("relative_azimuth_deg");
  if (!has_cards && !(height && (sun ? solar : zenith) && (sun || end || range)))
    throw Error(run.header, "the cards before this run do not state its geometry",
                sun ? "give observer_height_m and solar_zenith_deg beside the file"
                    : "give observer_height_m, zenith_deg, and end_height_m or range_m beside the file");
  if (!has_cards) g.path_type = range && !end ? 1 : end && *end >= kTopOfAir ? 3 : 2;
  if (height) g.observer_height = *height;
  if (end) g.end_height = *end;
  if (zenith) g.zenith = *zenith;
  if (range) g.range = *range;
  if (solar) (sun ? g.zenith : g.solar_zenith.emplace()) = *solar;
  if (azimuth) g.relative_azimuth = *azimuth;
  if (g.relative_azimuth) g.relative_azimuth = std::fabs(std::remainder(*g.relative_azimuth, 2 * kPi));
  if (run.mode == Tape7Mode::thermal_radiance) g.solar_zenith.reset(), g.relative_azimuth.reset();
  run.geometry = g;
}

// A path that rises out of the air looks at the sky.
Role role_of(const Tape7Block& run) {
  if (run.mode == Tape7Mode::irradiance) return Role::sun;
  const Tape7Geometry& g = *run.geometry;
  return g.zenith < kPi / 2 + 1e-9 && (g.path_type == 3 || g.end_height >= kTopOfAir) ? Role::sky : Role::sights;
}

void read_tape7_runs(const Params& p, const Params& file, const std::string& path, Runs& runs) {
  const std::optional<Params> as = p.kind() == Params::Kind::map ? p.find("as") : std::nullopt;
  std::vector<Tape7Block> blocks = ends_with_any(path, {".json"}) ? read_modtran6(path) : read_tape7(path);
  if (blocks.empty()) throw file.error("there is no run in it");
  for (Tape7Block& run : blocks) {
    if (run.mode == Tape7Mode::transmittance)
      throw Error(run.header, "a run of transmittances alone (IEMSCT 0) has no path radiance",
                  "a run with radiance: IEMSCT 1 (thermal) or 2 (with the Sun)");
    complete(p, run);
    const Role role = as ? static_cast<Role>(as->as_choice({"sights", "sky", "sun"})) : role_of(run);
    if ((role == Role::sun) != (run.mode == Tape7Mode::irradiance))
      throw as->error("only runs of the Sun's irradiance (IEMSCT 3) are `as: sun`, and they are nothing else",
                      "the run in line " + std::to_string(run.header.line) + " of " + path);
    runs.of[static_cast<size_t>(role)].push_back(std::move(run));
  }
}

size_t values_of(const std::vector<Tape7Block>& runs, Tape7Axis axis) {
  std::set<double> values;
  for (const Tape7Block& run : runs)
    if (const auto v = tape7_value(run, axis)) values.insert(std::round(*v * 1e7) / 1e7);
  return values.size();
}

// The axes of a grid that the runs fill. Of angle, range and height of the end some follow from the others.
std::vector<Tape7Axis> axes_of(const std::vector<Tape7Block>& runs) {
  using A = Tape7Axis;
  std::vector<A> own;
  size_t nodes = 1;
  for (const A axis : {A::observer_height, A::solar_zenith, A::relative_azimuth})
    if (const size_t n = values_of(runs, axis); n > 1) own.push_back(axis), nodes *= n;
  const bool level = runs[0].geometry->path_type == 1;
  const std::vector<std::vector<A>> tries =
      level ? std::vector<std::vector<A>>{{A::range}} : std::vector<std::vector<A>>{{},
                                                                                    {A::view_zenith},
                                                                                    {A::range},
                                                                                    {A::end_height},
                                                                                    {A::view_zenith, A::range},
                                                                                    {A::view_zenith, A::end_height}};
  for (const std::vector<A>& axes : tries) {
    size_t all = nodes;
    for (const A axis : axes) all *= values_of(runs, axis);
    if (all != runs.size()) continue;
    own.insert(own.end(), axes.begin(), axes.end());
    return own;
  }
  // No grid: the table says which run is missing.
  own.push_back(A::view_zenith);
  return own;
}

SightTable table_of(const std::vector<Tape7Block>& runs) {
  const std::vector<Tape7Axis> axes = axes_of(runs);
  SightTable table{tape7_path_table(runs, axes), {}, {}, 0, false};
  for (const Tape7Axis axis : axes) table.axes.push_back(axis_of(axis));
  for (const Coordinate& c : kCoordinates)
    if (!table.has(c.axis) && values_of(runs, c.tape7) == 1) table.alike[c.axis] = tape7_value(runs[0], c.tape7);
  if (!table.has(SightAxis::range)) return table;
  table.least_range = INFINITY;
  for (const Tape7Block& run : runs) table.least_range = std::min(table.least_range, *run.geometry->range);
  return table;
}

bool has_irradiance(const SightTable& table) {
  PathSpectra path;
  table.table.at(place_of(table, {}), path);
  return !path.irradiance.empty();
}

void take(std::optional<SightTable>& to, SightTable table, const char* what, const Params& entry) {
  if (to) throw entry.error(strf("a second table of %s", what), "drop one of the two");
  to = std::move(table);
}

// A sky over zenith angle and azimuth, with the Sun where the direct irradiance was asked for.
void read_libradtran_sky(const Params& p, const std::string& path, TabledAirSpec& air) {
  const Params input = p.at("input");
  LibradtranPower power = LibradtranPower::milliwatt;
  if (const auto given = p.find("power")) power = given->as_choice({"mW", "W"}) ? LibradtranPower::watt : power;
  const std::string input_path = input.as_path();
  if (!file_exists(input_path)) throw input.error("there is no file '" + input_path + "'");
  const LibradtranRun run = read_libradtran(input_path, path, power);
  SightTable sky{libradtran_sky(run, static_cast<size_t>(p.integer("level", 0, 1000, 0)), true),
                 {SightAxis::view_zenith, SightAxis::relative_azimuth},
                 {},
                 0,
                 false};
  if (p.has("observer_height_m"))
    sky.alike[SightAxis::observer_height] = p.number_in("observer_height_m", -1000, 1e6, "m above sea level");
  sky.alike[SightAxis::solar_zenith] = run.solar_zenith;
  air.notes.push_back("atmosphere: " + path + ": the sky at one altitude, and " +
                      (has_irradiance(sky) ? "the Sun there" : "no Sun (without edir)"));
  take(air.sky, std::move(sky), "the sky", p);
}

// Air that is the same everywhere, under an even sky.
void read_four_curve_air(const Params& p, const std::string& path, TabledAirSpec& air) {
  const std::vector<FourCurve> all = read_four_curve(path);
  std::vector<std::string> names;
  for (const FourCurve& c : all) names.push_back(c.name);
  const FourCurve& c = all[all.size() == 1 && !p.has("condition") ? 0 : p.at("condition").as_choice(names)];
  SightTable sights{four_curve_paths(c, p.number_in("max_range_m", 1, 1e6, "m")),
                    {SightAxis::solar_zenith, SightAxis::range},
                    {},
                    0,
                    true};
  const PathAxis angle{"solar zenith angle", "rad", 1 / kDegree, "degrees", false};
  std::vector<PathRun> sky, sun;
  const Where where{path, 0, 0, {}, -1};
  for (size_t i = 0; i < c.at.size(); ++i) {
    std::vector<double> even = c.at[i].sky;
    for (double& v : even) v /= kPi;
    sky.push_back({{c.solar_zenith[i]}, {{}, even, {}, {}}, where});
    sun.push_back({{c.solar_zenith[i]}, {{}, {}, {}, c.at[i].sun}, where});
  }
  take(air.sights, std::move(sights), "sights", p);
  take(air.sky, {PathTable({angle}, c.wavelength_um, sky), {SightAxis::solar_zenith}, {}, 0, true}, "the sky", p);
  take(air.sun, {PathTable({angle}, c.wavelength_um, sun), {SightAxis::solar_zenith}, {}, 0, true}, "the sun", p);
  air.notes.push_back("atmosphere: " + path + ", condition '" + c.name +
                      "': the same air everywhere and in all directions, under a sky of even radiance");
}

void read_entry(const Params& p, TabledAirSpec& air, Runs& runs) {
  const bool map = p.kind() == Params::Kind::map;
  const Params file = map ? p.at("file") : p;
  const std::string path = file.as_path();
  if (!file_exists(path)) throw file.error("there is no file '" + path + "'");
  if (map && p.has("input")) return read_libradtran_sky(p, path, air);
  if (!ends_with_any(path, {".h5", ".hdf", ".hdf5"})) return read_tape7_runs(p, file, path, runs);
  if (!map) throw file.error("how far paths go does not stand in a FourCurve file", "{file: ..., max_range_m: N}");
  read_four_curve_air(p, path, air);
}

std::string over(const SightTable& table, size_t runs) {
  std::string text = strf("%zu run%s", runs, runs == 1 ? "" : "s");
  for (size_t a = 0; a < table.axes.size(); ++a) {
    const PathAxis& axis = table.table.axes()[a];
    const auto [low, high] = table.table.covered(a);
    text += (a ? ", " : " over ") + axis.name +
            strf(" %.6g to %.6g ", low * axis.shown_per_unit, high * axis.shown_per_unit) +
            (axis.shown_unit.empty() ? axis.unit : axis.shown_unit);
  }
  const std::vector<double>& w = table.table.wavelength_um();
  return text + strf(", %.6g to %.6g um", w.front(), w.back());
}

void note_runs(TabledAirSpec& air, const Runs& runs) {
  const auto note = [&](const std::string& text) { air.notes.push_back("atmosphere: " + text); };
  constexpr const char* kNames[] = {"lines of sight", "the sky", "sunlight"};
  const std::optional<SightTable>* tables[] = {&air.sights, &air.sky, &air.sun};
  for (size_t r = 0; r < 3; ++r) {
    const std::vector<Tape7Block>& of = runs.of[r];
    if (of.empty()) continue;
    note(std::string(kNames[r]) + ": " + over(**tables[r], of.size()));
    if (of[0].mode != Tape7Mode::radiance) continue;
    if (!of[0].many_scatterings) note(std::string(kNames[r]) + ": the runs scatter light once (IMULT 0)");
    for (const SightAxis axis : {SightAxis::solar_zenith, SightAxis::relative_azimuth})
      if (!(*tables[r])->covered(axis))
        note(std::string(kNames[r]) + ": the runs do not say the Sun's " +
             (axis == SightAxis::solar_zenith ? "zenith angle" : "azimuth") +
             ", which is not compared with that of `sun`");
  }
}

// What tables leave out, and which of their columns serves.
void note_neglected(TabledAirSpec& air) {
  const auto note = [&](const std::string& text) { air.notes.push_back("atmosphere: " + text); };
  if (!air.sights) note("no run is a line of sight: between the sensors and what they see there is no air");
  if (!air.sky)
    note("no run is of the sky: a `sky` of the simulation, or none, is what comes from above at the ground");
  if (air.two_way())
    note(
        "sunlight goes both ways by the runs' own two-way column (REF_SOL over TOA_SUN): at a place it counts that "
        "over the transmittance of the line of sight from the middle of the sensors");
  else if (air.sights && air.sun)
    note(
        "the runs have no two-way column: the Sun's irradiance at the ground is dimmed on its way to the sensors by "
        "means over bins, which is too much where the same lines dim both ways");
  note(std::string("left out: ") + (air.sights && air.sights->everywhere ? "" : "air between surfaces of the scene, ") +
       "what single places of the ground send into the air (adjacency: the runs have one ground), changes of the air "
       "from place to place, shadows in it, and lines that the light of the sky shares with the line of sight");
}

}  // namespace

std::shared_ptr<const TabledAirSpec> read_tabled_air(const Params& p) {
  auto air = std::make_shared<TabledAirSpec>();
  air->where = p.where();
  const Params list = p.at("tables");
  Runs runs;
  for (const Params& entry : list.items()) read_entry(entry, *air, runs);
  std::optional<SightTable>* tables[] = {&air->sights, &air->sky, &air->sun};
  constexpr const char* kNames[] = {"sights", "the sky", "the sun"};
  for (size_t r = 0; r < 3; ++r)
    if (!runs.of[r].empty()) take(*tables[r], table_of(runs.of[r]), kNames[r], list);
  if (air->sun && !has_irradiance(*air->sun))
    throw list.error("the runs of sunlight have no irradiance (SOL_TR)", "runs of mode IEMSCT 3");
  if (!air->sun && air->sky && has_irradiance(*air->sky)) air->sun = air->sky;
  if (!air->sights && !air->sky && !air->sun) throw list.error("no table is given");
  air->within_angle = p.number_in("angle_tolerance_deg", 0, 180, "degrees", 0.5) * kDegree;
  air->within_height = p.number_in("height_tolerance_m", 0, 1e5, "m", 100);
  if (p.has("scene_height_m")) air->scene_height = p.number_in("scene_height_m", -1000, 20000, "m above sea level");
  if (const auto [low, high] = air->covered_um(); !(low < high))
    throw list.error(
        strf("the tables have no wavelengths in common: one begins at %g um, another ends at %g um", low, high));
  note_runs(*air, runs);
  note_neglected(*air);
  return air;
}

void check_coverage(const TabledAirSpec& air, const Sensor& sensor, const Where& where) {
  constexpr double kRounding = 1e-9;
  const auto [low, high] = air.covered_um();
  for (size_t state = 0; state < sensor.states().size(); ++state)
    for (const Band& b : sensor.bands(state))
      if (!(b.low_um() >= low * (1 - kRounding) && b.high_um() <= high * (1 + kRounding)))
        throw Error(air.where,
                    strf("the tables of the atmosphere reach from %.6g to %.6g um, and band '%s' of sensor '%s'", low,
                         high, b.name.c_str(), sensor.name().c_str()) +
                        (where.line > 0 ? strf(" (line %d)", where.line) : "") +
                        strf(" from %.6g to %.6g um", b.low_um(), b.high_um()),
                    "runs over more wavelengths, or other bands");
}

}  // namespace suite
