#include <cmath>
#include <map>

#include "base/files.h"
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
  for (const float v : values)
    if (srgb && !std::isnan(v) && !(v >= 0 && v <= 255))
      throw p.at("transfer").error(strf("a pixel of %g", v), "'srgb' takes display values from 0 to 255");
  for (float& v : values) v = static_cast<float>((srgb ? linear_from_srgb(v / 255) : v) * scale + offset);
}

// Fractions of a pixel are scaled to sum to 1; a pixel of zeros has no meaning.
void normalise_fractions(const Params& p, PropertyMap& map) {
  for (size_t i = 0; i < map.values.size(); i += map.channels) {
    float sum = 0;
    if (std::isnan(map.values[i])) continue;  // a gap
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
    if (!std::isnan(v) && !(v >= low && v <= high))
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
  CurveOptions options = curve_options();
  if (p.kind() == Params::Kind::scalar) return read_curve_family(input(p), options);
  options.outside = read_outside(p);
  options.scale = p.number("scale", 1);
  return read_curve_family(input(p.at("file")), options);
}

void Reader::check_cube(const Params& p, const MapRaster& cube, PropertyMap& map) {
  map.outside = read_outside(p);
  const Params file = p.at("file");
  if (cube.wavelength_um.empty())
    throw file.error("the cube has no wavelengths",
                     "an ENVI image whose header has 'wavelength' and 'wavelength units'");
  for (size_t k = 1; k < cube.wavelength_um.size(); ++k)
    if (!(cube.wavelength_um[k] > cube.wavelength_um[k - 1]))
      throw file.error("the wavelengths of the cube do not ascend");
}

namespace {
MapKind kind_of(const std::string& type) {
  static const std::map<std::string, MapKind> kinds{
      {"mixture", MapKind::mixture}, {"texture", MapKind::curve_index},     {"curve_index", MapKind::curve_index},
      {"cube", MapKind::cube},       {"temperature", MapKind::temperature}, {"bump", MapKind::bump},
      {"normal", MapKind::normal},   {"opacity", MapKind::opacity}};
  return kinds.at(type);
}

// Curves for the pixels that are no gaps.
void choose(PropertyMap& map, const std::vector<std::array<double, 2>>& bands) {
  std::vector<float> there;
  for (const float v : map.values)
    if (!std::isnan(v)) there.push_back(v);
  const std::vector<uint16_t> chosen = choose_curves(there, map.channels, map.family, bands);
  std::vector<float> numbers;
  size_t next = 0;
  for (size_t i = 0; i < map.values.size(); i += map.channels)
    numbers.push_back(std::isnan(map.values[i]) ? NAN : static_cast<float>(chosen[next++]));
  map.values = std::move(numbers);
  map.channels = 1;
}

// Curves of shares are held to their range here, as those of materials are.
void check_family(const Params& p, const PropertyMap& map) {
  if (map.parameter != "reflectance" && map.parameter != "transmittance") return;
  for (size_t k = 0; k < map.family.size(); ++k)
    if (!(map.family[k].min() >= 0 && map.family[k].max() <= 1))
      throw p.at("family").error(strf("curve %zu of the family: a %s from %g to %g", k, map.parameter.c_str(),
                                      map.family[k].min(), map.family[k].max()),
                                 "shares from 0 to 1 are expected");
}

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
  map.kind = kind_of(type);
  const Params file = p.at("file");
  MapRaster raster = pixels_of(p, file, type == "cube" ? Pixels::cube : Pixels::any);
  if (type == "cube") {
    check_cube(p, raster, map);
    leave_bad_bands(file, raster);
    map.wavelength_um = raster.wavelength_um;
  }
  map.width = raster.width;
  map.height = raster.height;
  map.channels = raster.channels;
  const double mark = raster.no_data.value_or(NAN);
  refuse_nan(p, file, raster);
  map.values = values_in(p, file, std::move(raster), "scale", "offset");
  apply_transfer(p, map.values);
  close_gaps(p, file, mark, map);
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
    map.family = read_family(p.at("family"));
    check_family(p, map);
    const std::vector<std::array<double, 2>> bands = read_bands_um(p.at("bands_um"));
    one_channel(bands.size());
    choose(map, bands);
  } else if (type == "curve_index") {
    one_channel(1);
    map.family = read_family(p.at("family"));
    check_family(p, map);
    for (const float v : map.values)
      if (!std::isnan(v) && !(v >= 0 && v < static_cast<float>(map.family.size()) && v == std::floor(v)))
        throw p.error(strf("curve %g of a family of %zu", v, map.family.size()), "numbers start at 0");
  } else if (type == "normal") {
    one_channel(3);
  } else {
    one_channel(1);
    if (type == "temperature") check_values(p, map, 1, 1e5, "kelvin");
    if (type == "opacity") check_values(p, map, 0, 1, "shares");
  }
  draft_.property_maps.push_back(std::move(m));
}

}  // namespace suite::scene_text
