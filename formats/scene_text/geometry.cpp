#include <algorithm>
#include <cmath>
#include <limits>

#include "base/files.h"
#include "base/placed.h"
#include "formats/raster/raster.h"
#include "formats/scene_text/reader.h"
#include "scene/primitives.h"

namespace suite::scene_text {

void Reader::read_geometry(const std::string& name, const Params& p) {
  DraftGeometry g;
  g.name = name;
  g.where = p.where();
  if (const auto material = p.find("material")) g.material = reference(*material);
  // The name is known from here on, so that one wrong value does not bring a second error per placement of the object.
  const size_t slot = draft_.geometry.size();
  draft_.geometry.push_back(g);
  draft_.geometry[slot].failed = true;
  std::vector<std::string> kinds{"obj",   "obj_text", "gdb",    "ply",     "stl",    "gltf",
                                 "model", "city",     "points", "terrain", "voxels", "waves"};
  for (const PrimitiveRow& row : primitive_rows()) kinds.push_back(row.name);
  std::string kind;
  for (const std::string& k : kinds)
    if (p.has(k)) {
      if (!kind.empty()) throw p.error("object '" + name + "' is both '" + kind + "' and '" + k + "'", "give one");
      kind = k;
    }
  if (kind.empty()) throw p.error("object '" + name + "' has no geometry", name_hint("", kinds));
  if (kind == "gltf" || kind == "model") return read_model(p, kind, std::move(g), slot);
  if (kind == "obj" || kind == "obj_text" || kind == "gdb" || kind == "ply" || kind == "stl" || kind == "city")
    read_mesh(p, kind, g);
  else if (kind == "terrain")
    read_terrain(p, g);
  else if (kind == "points")
    read_points(p, g);
  else if (kind == "voxels")
    read_voxel_geometry(p, g);
  else if (kind == "waves")
    read_waves(p, g);
  else
    read_primitive(p, g, kind);
  draft_.geometry[slot] = std::move(g);
}

namespace {

// A grid in scene ENU without any georeferencing of its own.
std::function<Vec3(double, double, double)> local_grid(const Params& p) {
  const std::vector<double> origin = p.at("origin").as_numbers();
  if (origin.size() != 2)
    throw p.at("origin").error("an origin is [x, y] in metres: the outer corner of the first pixel");
  const Params gsd = p.at("gsd");
  const std::vector<double> g =
      gsd.kind() == Params::Kind::list ? gsd.as_numbers() : std::vector<double>(2, gsd.as_number());
  if (g.size() != 2 || g[0] == 0 || g[1] == 0)
    throw gsd.error("a ground sample distance is one or two numbers other than 0, m");
  return [=](double column, double row, double height) {
    return Vec3{origin[0] + (column + 0.5) * g[0], origin[1] - (row + 0.5) * g[1], height};
  };
}

// Where a GeoTIFF's samples are, through `place` from its map.
std::function<Vec3(double, double, double)> georeferenced_grid(const GeoReference& ref,
                                                               std::function<Vec3(Vec3)> place) {
  return [ref, place = std::move(place)](double column, double row, double height) {
    const double c = column + 0.5, r = row + 0.5;  // samples are at pixel centres
    const double x = ref.to_map[0] + ref.to_map[1] * c + ref.to_map[2] * r,
                 y = ref.to_map[3] + ref.to_map[4] * c + ref.to_map[5] * r;
    return ref.geographic ? place({y, x, height}) : place({x, y, height});
  };
}

// A scale of the text replaces the file's own, which then has to be in it.
std::string cure_of_feet(const std::string& path, double unit) {
  const Raster raster = read_raster(path);
  if (raster.numbers.empty()) return strf("'height_scale: %.7g' makes metres of them", unit);
  return strf("'height_scale: %.7g, height_offset: %.7g' makes metres of the stored numbers",
              unit * raster.numbers[0].scale, unit * raster.numbers[0].offset);
}

}  // namespace

// Heights that are marks of missing ones in many rasters, and no land on Earth.
void Reader::report_marks(const Params& file, const Raster& raster) {
  for (const float mark : {-9999.0f, -32768.0f, -32767.0f, std::numeric_limits<float>::lowest()})
    if (const auto n = std::count(raster.values.begin(), raster.values.end(), mark); n && !is_no_data(raster, mark))
      report_.add("SP506", file.as_text(),
                  {file.where(), strf("%td pixels have the height %g, and no 'no_data' says that they are gaps", n,
                                      static_cast<double>(mark))});
}

// Heights from any raster; gaps become NaN.
void Reader::read_heights(const Params& p, SourceTerrain& terrain) {
  const Params file = p.at("terrain");
  MapRaster raster = pixels_of(p, file);
  if (raster.channels != 1) throw file.error(strf("%u channels", raster.channels), "heights are one channel", "SP504");
  terrain.width = raster.width;
  terrain.height = raster.height;
  report_marks(file, raster);
  if (raster.scale_z != 0 && raster.scale_z != 1)
    report_.add(
        "SP508", file.as_text(),
        {file.where(),
         strf("the file's pixel scale has a third number, %.9g, which is not applied to the heights", raster.scale_z)});
  terrain.heights = values_in(p, file, std::move(raster), "height_scale", "height_offset");
  const double scale = p.number("height_scale", 1), offset = p.number("height_offset", 0);
  for (float& h : terrain.heights) h = static_cast<float>(h * scale + offset);
}

void Reader::read_terrain(const Params& p, DraftGeometry& g) {
  g.kind = DraftGeometry::Kind::terrain;
  if (!g.material.given()) throw p.error("terrain '" + g.name + "' needs a 'material'");
  g.tile_m = p.number_in("tile_m", 1, 1e6, "m", 4000);
  const std::string path = input(p.at("terrain"));
  if (const auto local = p.find("local")) {
    g.terrain.place = local_grid(*local);
  } else {
    p.at("height").kind();  // it must be there
    const GeoidRule rule = read_heights_rule(p);
    if (!draft_.origin.given)
      throw p.error("a georeferenced terrain needs the scene's 'origin'", "or 'local: {origin, gsd}'", "SP504");
    const GeoReference ref = read_georeference(path);
    if (ref.height_unit_m != 1 && !p.has("height_scale"))
      throw Error(Where{path, 0, 0, {}, -1}, strf("its heights are in feet of %.7g m", ref.height_unit_m),
                  cure_of_feet(path, ref.height_unit_m), "SP504");
    g.terrain.georeferenced = true;
    const EarthMap map = earth_map(ref.epsg, Where{path, 0, 0, {}, -1});
    if (map.geographic() != ref.geographic)
      throw Error(Where{path, 0, 0, {}, -1}, strf("EPSG:%d is not of the kind that its keys say", ref.epsg),
                  "a projected code for ProjectedCSType, one of angles for GeographicType", "SP504");
    if (!rule.geoid && (ref.vertical_epsg || map.heights() == MapSystem::Heights::geoid))
      report_.add(
          "SP509", p.at("terrain").as_text(),
          {p.at("terrain").where(), "its heights count from " +
                                        (ref.vertical_epsg ? strf("EPSG:%d", ref.vertical_epsg) : map.heights_name()) +
                                        ", and 'height: ellipsoid' takes them as they are"});
    g.terrain.place = georeferenced_grid(ref, on_earth(map, rule));
    if (!map.projection) return read_heights(p, g.terrain);
    try {
      g.terrain.place(0, 0, 0);  // how it gets there is told of a place
    } catch (const Error& e) {
      throw placed(e, p.at("terrain").where());
    }
    report_projection(map, ref.epsg, p.at("terrain"));
  }
  read_heights(p, g.terrain);
}

void Reader::read_primitive(const Params& p, DraftGeometry& g, const std::string& kind) {
  g.kind = DraftGeometry::Kind::primitive;
  if (!g.material.given()) throw p.error("object '" + g.name + "' needs a 'material'");
  const auto row = std::find_if(primitive_rows().begin(), primitive_rows().end(),
                                [&](const PrimitiveRow& r) { return r.name == kind; });
  const Params values = p.at(kind);
  g.primitive.name = g.name;
  g.primitive.kind = row->kind;
  for (const PrimitiveParameter& parameter : row->parameters) {
    const double value = parameter.otherwise
                             ? values.number_in(parameter.name, parameter.low, parameter.high, parameter.unit.c_str(),
                                                *parameter.otherwise)
                             : values.number_in(parameter.name, parameter.low, parameter.high, parameter.unit.c_str());
    g.primitive.parameters.push_back(value);
  }
  if (row->kind == PrimitiveKind::sinusoid)
    for (const Params& term : values.at("terms").items())
      for (const char* name : {"amplitude", "kx", "ky", "phase"})
        g.primitive.parameters.push_back(term.number(name, 0));
  check_primitive(g.primitive, values.where());
}

}  // namespace suite::scene_text
