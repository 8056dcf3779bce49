#include <algorithm>
#include <cmath>

#include "formats/obj/obj.h"
#include "formats/raster/raster.h"
#include "formats/scene_text/reader.h"
#include "scene/primitives.h"

namespace suite::scene_text {

void Reader::read_geometry(const std::string& name, const Params& p) {
  DraftGeometry g;
  g.name = name;
  g.where = p.where();
  if (const auto material = p.find("material")) g.material = reference(*material);
  std::vector<std::string> kinds{"obj", "terrain"};
  for (const PrimitiveRow& row : primitive_rows()) kinds.push_back(row.name);
  std::string kind;
  for (const std::string& k : kinds)
    if (p.has(k)) {
      if (!kind.empty()) throw p.error("object '" + name + "' is both '" + kind + "' and '" + k + "'", "give one");
      kind = k;
    }
  if (kind.empty()) throw p.error("object '" + name + "' has no geometry", name_hint("", kinds));
  if (kind == "obj")
    read_obj_geometry(p, g);
  else if (kind == "terrain")
    read_terrain(p, g);
  else
    read_primitive(p, g, kind);
  draft_.geometry.push_back(std::move(g));
}

void Reader::read_obj_geometry(const Params& p, DraftGeometry& g) {
  g.kind = DraftGeometry::Kind::mesh;
  if (const auto materials = p.find("materials"))
    for (const std::string& name : materials->keys()) g.materials[name] = reference(materials->at(name));
  constexpr NormalRule rules[] = {NormalRule::file, NormalRule::facet, NormalRule::smooth};
  if (const auto normals = p.find("normals")) g.normals = rules[normals->as_choice({"file", "facet", "smooth"})];
  const double unit = p.number_in("unit_m", 1e-9, 1e9, "m", 1);
  g.to_local = scaling({unit, unit, unit});
  // y up, z towards the viewer (the usual modelling tools) becomes z up, -y towards the viewer.
  if (const auto up = p.find("up"))
    if (up->as_choice({"z", "y"}) == 1) g.to_local = g.to_local * Affine3{{1, 0, 0, 0, 0, -1, 0, 1, 0}, {}};
  g.mesh = read_obj(input(p.at("obj")), report_);
}

void Reader::read_terrain(const Params& p, DraftGeometry& g) {
  g.kind = DraftGeometry::Kind::terrain;
  if (!g.material.given()) throw p.error("terrain '" + g.name + "' needs a 'material'");
  g.tile_m = p.number_in("tile_m", 1, 1e6, "m", 4000);
  const std::string path = input(p.at("terrain"));
  const Params datum = p.at("height");
  const bool geoid = datum.as_choice({"ellipsoid", "geoid"}) == 1;
  const double separation = geoid ? p.number_in("geoid_separation_m", -200, 200, "m, geoid above ellipsoid") : 0;
  if (!draft_.origin.given) throw p.error("a georeferenced terrain needs the scene's 'origin'", {}, "SP504");
  const Where where{path, 0, 0, {}, -1};
  const GeoReference ref = read_georeference(path);
  const auto zone = ref.geographic ? std::nullopt : utm_zone_of_epsg(ref.epsg);
  if (ref.geographic ? ref.epsg != 4326 && ref.epsg != 4258 : !zone)
    throw Error(where, strf("EPSG:%d is not known here", ref.epsg), "WGS84 or ETRS89, geographic or UTM, are", "SP504");
  const Raster raster = read_raster(path);
  g.terrain.width = raster.width;
  g.terrain.height = raster.height;
  g.terrain.heights.resize(size_t{raster.width} * raster.height);
  for (size_t i = 0; i < g.terrain.heights.size(); ++i) {
    const float h = raster.values[i * raster.channels];
    g.terrain.heights[i] = ref.no_data && h == static_cast<float>(*ref.no_data) ? NAN : h;
  }
  const SceneFrame frame({draft_.origin.latitude_deg, draft_.origin.longitude_deg, draft_.origin.ellipsoid_height_m});
  g.terrain.place = [=](double column, double row, double height) {
    const double c = column + 0.5, r = row + 0.5;  // samples are at pixel centres
    const double x = ref.to_map[0] + ref.to_map[1] * c + ref.to_map[2] * r,
                 y = ref.to_map[3] + ref.to_map[4] * c + ref.to_map[5] * r;
    const double h = height + separation;
    return zone ? frame.enu_from_utm({*zone, x, y, h}) : frame.enu_from_geodetic({y, x, h});
  };
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
