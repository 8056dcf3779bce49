#include <cmath>

#include "formats/raster/raster.h"
#include "formats/scene_text/reader.h"

namespace suite::scene_text {

namespace {

uint16_t class_of(const std::string& key, const Params& where) {
  if (key.empty() || key.size() > 5 || key.find_first_not_of("0123456789") != std::string::npos ||
      std::stol(key) > 65535)
    throw where.error("class '" + key + "' is not a number from 0 to 65535");
  return static_cast<uint16_t>(std::stol(key));
}

void read_extend(const Params& p, Drape& drape) {
  constexpr Drape::Extend rules[] = {Drape::Extend::clamp, Drape::Extend::repeat, Drape::Extend::none};
  if (const auto extend = p.find("extend")) drape.extend = rules[extend->as_choice({"clamp", "repeat", "none"})];
}

void read_drape(const Params& p, Drape& drape) {
  const std::vector<double> origin = p.at("origin").as_numbers();
  if (origin.size() != 2)
    throw p.at("origin").error("an origin is [x, y] in metres: the outer corner of the first pixel");
  drape.origin_x = origin[0];
  drape.origin_y = origin[1];
  const Params gsd = p.at("gsd");
  std::vector<double> g = gsd.kind() == Params::Kind::list ? gsd.as_numbers() : std::vector<double>(2, gsd.as_number());
  if (g.size() != 2 || g[0] == 0 || g[1] == 0)
    throw gsd.error("a ground sample distance is one or two numbers other than 0, m");
  drape.gsd_x = g[0];
  drape.gsd_y = g[1];
  read_extend(p, drape);
}

}  // namespace

void read_projection(const Params& p, Projection& projection, Drape& drape) {
  if (const auto named = p.find("projection"); named && named->as_choice({"drape", "uv"}) == 1)
    projection = Projection::uv;
  if (projection == Projection::drape)
    read_drape(p.at("drape"), drape);
  else
    read_extend(p, drape);
}

void Reader::read_map(const std::string& name, const Params& p) {
  static constexpr std::initializer_list<const char*> types{"class",       "mixture", "texture", "curve_index", "cube",
                                                            "temperature", "bump",    "normal",  "opacity"};
  draft_.failed_maps.insert(name);
  const size_t type = p.at("type").as_choice(types);
  if (type == 0)
    read_class_map(name, p);
  else
    read_property_map(name, p, types.begin()[type]);
  draft_.failed_maps.erase(name);
}

void Reader::read_class_map(const std::string& name, const Params& p) {
  DraftClassMap m;
  m.where = p.where();
  m.map.name = name;
  read_projection(p, m.map.projection, m.map.drape);
  const Params materials = p.at("materials");
  for (const std::string& key : materials.keys()) m.materials[class_of(key, materials)] = reference(materials.at(key));
  if (m.materials.empty()) throw materials.error("a class map needs at least one class");
  const Params file = p.at("file");
  const Raster raster = pixels_of(p, file);
  if (!raster.integer || raster.channels != 1)
    throw file.error(strf("a class map is one channel of whole numbers, '%s' has %u%s", file.as_text().c_str(),
                          raster.channels, raster.integer ? "" : " of floats"));
  m.map.width = raster.width;
  m.map.height = raster.height;
  m.map.classes.reserve(raster.values.size());
  for (const RasterNumbers& n : raster.numbers)
    if (n != RasterNumbers{})
      throw file.error(
          strf("by the file a value is stored * %g + %g, but classes are the stored numbers", n.scale, n.offset),
          "take scale and offset out of the file");
  for (const float v : raster.values) {
    if (is_no_data(raster, v) && !m.materials.count(static_cast<uint16_t>(v >= 0 && v <= 65535 ? v : 0)))
      throw file.error(strf("some pixels hold the mark of a missing class, %g", v),
                       "list a material for it, or fill them");
    if (!(v >= 0 && v <= 65535)) throw file.error(strf("class %g is not a number from 0 to 65535", v));
    m.map.classes.push_back(static_cast<uint16_t>(v));
  }
  draft_.class_maps.push_back(std::move(m));
}

}  // namespace suite::scene_text
