#include <cmath>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "formats/raster/raster.h"
#include "formats/scene_text/reader.h"
#include "scene/texture.h"

namespace suite::scene_text {

namespace {

// IEC 61966-2-1: display values to linear ones.
float linear_from_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

// value = transfer(raw) * scale + offset; `transfer: srgb` takes 8 bit display values.
void apply_transfer(const Params& p, std::vector<float>& values) {
  const bool srgb = p.has("transfer") && p.at("transfer").as_choice({"linear", "srgb"}) == 1;
  const double scale = p.number("scale", 1), offset = p.number("offset", 0);
  for (float& v : values) v = static_cast<float>((srgb ? linear_from_srgb(v / 255) : v) * scale + offset);
}

// Fractions of a pixel are scaled to sum to 1; a pixel of zeros has no meaning.
void normalise_fractions(const Params& p, PropertyMap& map) {
  for (size_t i = 0; i < map.values.size(); i += map.channels) {
    float sum = 0;
    for (size_t c = 0; c < map.channels; ++c) {
      if (!(map.values[i + c] >= 0))
        throw p.error(strf("pixel %zu has a fraction of %g", i / map.channels, map.values[i + c]));
      sum += map.values[i + c];
    }
    if (!(sum > 0))
      throw p.error(strf("pixel %zu has no material", i / map.channels), "fractions of a pixel must not all be 0");
    for (size_t c = 0; c < map.channels; ++c) map.values[i + c] /= sum;
  }
}

void check_values(const Params& p, const PropertyMap& map, double low, double high, const char* what) {
  for (const float v : map.values)
    if (!(v >= low && v <= high))
      throw p.error(strf("a value of %g", v), strf("%s from %g to %g; see 'scale' and 'offset'", what, low, high));
}

}  // namespace

// A list of curves, or one file of several.
std::vector<Curve> Reader::read_family(const Params& p) {
  std::vector<Curve> family;
  if (p.kind() == Params::Kind::list) {
    for (const Params& c : p.items()) family.push_back(read_curve_value(c));
    return family;
  }
  CurveOptions options;
  if (p.kind() == Params::Kind::scalar) return read_curve_family(input(p), options);
  options.outside = read_outside(p);
  options.scale = p.number("scale", 1);
  return read_curve_family(input(p.at("file")), options);
}

void Reader::read_cube(const Params& p, PropertyMap& map) {
  map.outside = read_outside(p);
  const Params file = p.at("file");
  const EnviImage cube(input(file));
  header_input(file.as_text());
  const EnviHeader& h = cube.header();
  if (h.wavelength_um.empty())
    throw file.error("the cube has no wavelengths", "its header needs 'wavelength' and 'wavelength units'");
  if (h.values() > size_t{1} << 31) throw file.error("the cube is too large to be baked");
  map.width = static_cast<uint32_t>(h.samples);
  map.height = static_cast<uint32_t>(h.lines);
  map.channels = static_cast<uint32_t>(h.bands);
  map.wavelength_um = h.wavelength_um;
  for (size_t k = 1; k < h.wavelength_um.size(); ++k)
    if (!(h.wavelength_um[k] > h.wavelength_um[k - 1])) throw file.error("the wavelengths of the cube do not ascend");
  map.values.reserve(h.values());
  for (size_t line = 0; line < h.lines; ++line)
    for (const double v : cube.read_lines(line, 1)) map.values.push_back(static_cast<float>(v));
}

namespace {
void read_filter(const Params& p, const std::string& type, PropertyMap& map) {
  const bool smooth = type == "temperature" || type == "bump" || type == "normal";
  if (type == "texture" || type == "curve_index") {
    if (p.has("filter"))
      throw p.at("filter").error("the pixels of a " + type + " map are numbers of curves, which cannot be mixed");
  } else {
    const auto filter = p.find("filter");
    if (filter ? filter->as_choice({"nearest", "linear"}) == 1 : smooth) map.filter = PropertyMap::Filter::linear;
    if (type == "bump" && map.filter == PropertyMap::Filter::nearest)
      throw p.error("the heights of a bump map are always linear between pixels");
  }
}

std::vector<std::array<double, 2>> read_bands_um(const Params& p) {
  std::vector<std::array<double, 2>> bands;
  for (const Params& band : p.items()) {
    const std::vector<double> edges = band.as_numbers();
    if (edges.size() != 2 || !(edges[0] > 0 && edges[0] < edges[1]))
      throw band.error("a band is [low, high] in micron");
    bands.push_back({edges[0], edges[1]});
  }
  return bands;
}
}  // namespace

void Reader::read_property_map(const std::string& name, const Params& p, const std::string& type) {
  DraftPropertyMap m;
  PropertyMap& map = m.map;
  m.where = p.where();
  map.name = name;
  read_projection(p, map.projection, map.drape);
  if (type == "cube") {
    map.kind = MapKind::cube;
    read_cube(p, map);
  } else {
    Raster raster = pixels_of(p.at("file"));
    map.width = raster.width;
    map.height = raster.height;
    map.channels = raster.channels;
    map.values = std::move(raster.values);
  }
  apply_transfer(p, map.values);
  read_filter(p, type, map);
  const auto one_channel = [&](size_t count) {
    if (map.channels != count)
      throw p.error(strf("map '%s' has %u channels, %zu are needed", name.c_str(), map.channels, count));
  };
  if (type == "cube" || type == "texture" || type == "curve_index") map.parameter = p.text("parameter", "reflectance");
  if (type == "cube") {
    check_values(p, map, 0, 1, "shares");
  } else if (type == "mixture") {
    for (const Params& id : p.at("materials").items()) m.materials.push_back(reference(id));
    one_channel(m.materials.size());
    normalise_fractions(p, map);
  } else if (type == "texture") {
    map.kind = MapKind::curve_index;
    map.family = read_family(p.at("family"));
    const std::vector<std::array<double, 2>> bands = read_bands_um(p.at("bands_um"));
    one_channel(bands.size());
    const std::vector<uint16_t> chosen = choose_curves(map.values, map.channels, map.family, bands);
    map.values.assign(chosen.begin(), chosen.end());
    map.channels = 1;
  } else if (type == "curve_index") {
    map.kind = MapKind::curve_index;
    one_channel(1);
    map.family = read_family(p.at("family"));
    for (const float v : map.values)
      if (!(v >= 0 && v < static_cast<float>(map.family.size()) && v == std::floor(v)))
        throw p.error(strf("curve %g of a family of %zu", v, map.family.size()), "numbers start at 0");
  } else if (type == "normal") {
    map.kind = MapKind::normal;
    one_channel(3);
  } else {
    one_channel(1);
    map.kind = type == "temperature" ? MapKind::temperature : type == "bump" ? MapKind::bump : MapKind::opacity;
    if (type == "temperature") check_values(p, map, 1, 1e5, "kelvin");
    if (type == "opacity") check_values(p, map, 0, 1, "shares");
  }
  draft_.property_maps.push_back(std::move(m));
}

}  // namespace suite::scene_text
