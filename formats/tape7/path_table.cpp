#include "formats/tape7/path_table.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace suite {

std::optional<double> tape7_value(const Tape7Block& run, Tape7Axis axis) {
  const Tape7Geometry& g = *run.geometry;
  const bool sun = run.mode == Tape7Mode::irradiance;
  switch (axis) {
    case Tape7Axis::view_zenith:
      return sun ? std::nullopt : std::optional(g.zenith);
    case Tape7Axis::range:
      return g.range;
    case Tape7Axis::observer_height:
      return g.observer_height;
    case Tape7Axis::end_height:
      return g.end_height;
    case Tape7Axis::solar_zenith:
      return sun ? std::optional(g.zenith) : g.solar_zenith;
    case Tape7Axis::relative_azimuth:
      return g.relative_azimuth;
  }
  return std::nullopt;
}

namespace {

struct Row {
  Tape7Axis axis;
  const char *name, *unit, *shown_unit;
  double shown_per_unit;
};
constexpr Row kRows[] = {{Tape7Axis::view_zenith, "view zenith angle", "rad", "degrees", 1 / kDegree},
                         {Tape7Axis::range, "range", "m", "m", 1},
                         {Tape7Axis::observer_height, "observer's height", "m", "m", 1},
                         {Tape7Axis::end_height, "height of the path's end", "m", "m", 1},
                         {Tape7Axis::solar_zenith, "solar zenith angle", "rad", "degrees", 1 / kDegree},
                         {Tape7Axis::relative_azimuth, "relative azimuth", "rad", "degrees", 1 / kDegree}};

// Range and the height of the end follow from each other and the angle: either as an axis frees the other.
bool follows(Tape7Axis axis, std::span<const Tape7Axis> axes) {
  const auto has = [&](Tape7Axis a) { return std::find(axes.begin(), axes.end(), a) != axes.end(); };
  if (axis == Tape7Axis::range) return has(Tape7Axis::end_height) || has(Tape7Axis::view_zenith);
  if (axis == Tape7Axis::end_height) return has(Tape7Axis::range) || has(Tape7Axis::view_zenith);
  return false;
}

void check_alike(const Tape7Block& run, const Tape7Block& first, std::span<const Tape7Axis> axes) {
  if (run.mode != first.mode) throw Error(run.header, "this run is of another mode than the first of the table");
  if (run.wavenumber != first.wavenumber)
    throw Error(run.header, "this run has other wavenumbers than the first of the table");
  if (run.geometry->path_type != first.geometry->path_type)
    throw Error(run.header, "this run is of another type of path than the first of the table", "ITYPE of card 1");
  for (const Row& row : kRows) {
    if (std::find(axes.begin(), axes.end(), row.axis) != axes.end() || follows(row.axis, axes)) continue;
    const auto a = tape7_value(first, row.axis), b = tape7_value(run, row.axis);
    if (a.has_value() != b.has_value() || (a && std::fabs(*a - *b) > 1e-6 * (std::fabs(*a) + std::fabs(*b))))
      throw Error(run.header, strf("the %s of this run differs from that of the first and is no axis", row.name));
  }
}

bool written(const Tape7Block& run, const char* name) {
  const Tape7Column* c = run.find(name);
  return c && std::all_of(c->values.begin(), c->values.end(), [](double v) { return std::isfinite(v); });
}

PathSpectra spectra_of(const Tape7Block& run) {
  PathSpectra s;
  s.transmittance = run.transmittance().values;
  if (run.mode == Tape7Mode::radiance || run.mode == Tape7Mode::thermal_radiance) s.radiance = run.path_radiance();
  if (written(run, "REF_SOL") && written(run, "TOA_SUN")) s.two_way = run.two_way_transmittance();
  for (const char* name : {"SOL_TR", "SOL@OBS"})
    if (written(run, name)) s.irradiance = run.column(name).values;
  for (auto* values : {&s.transmittance, &s.radiance, &s.two_way, &s.irradiance})
    std::reverse(values->begin(), values->end());
  return s;
}

}  // namespace

PathTable tape7_path_table(std::span<const Tape7Block> runs, std::span<const Tape7Axis> axes) {
  if (runs.empty()) throw Error("a path table without a run");
  std::vector<PathAxis> named;
  for (const Tape7Axis axis : axes)
    for (const Row& row : kRows)
      if (row.axis == axis)
        named.push_back({row.name, row.unit, row.shown_per_unit, row.shown_unit, axis == Tape7Axis::range});
  std::vector<PathRun> nodes;
  for (const Tape7Block& run : runs) {
    if (!run.geometry)
      throw Error(run.header, "the cards before this run do not state its geometry",
                  "the cards as MODTRAN writes them");
    check_alike(run, runs[0], axes);
    PathRun node;
    for (size_t a = 0; a < axes.size(); ++a) {
      const auto value = tape7_value(run, axes[a]);
      if (!value) throw Error(run.header, "the cards before this run do not state its " + named[a].name);
      node.at.push_back(*value);
    }
    node.spectra = spectra_of(run);
    node.where = run.header;
    nodes.push_back(std::move(node));
  }
  std::vector<double> wavelength_um;
  for (auto nu = runs[0].wavenumber.rbegin(); nu != runs[0].wavenumber.rend(); ++nu) wavelength_um.push_back(1e4 / *nu);
  return PathTable(std::move(named), std::move(wavelength_um), std::move(nodes));
}

}  // namespace suite
