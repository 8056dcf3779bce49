#include "headers.h"

#include <algorithm>
#include <cmath>

#include "sensor/quality.h"

namespace suite {

namespace {

constexpr double kRed = 0.65, kGreen = 0.55, kBlue = 0.45, kInfrared = 0.85, kWindow = 10;  // um
constexpr double kReach = 0.07, kInfraredReach = 0.15;                                      // um, from there

std::optional<size_t> nearest(std::span<const Band> bands, double wanted, double reach) {
  std::optional<size_t> best;
  for (size_t b = 0; b < bands.size(); ++b) {
    const double far = std::fabs(bands[b].center_um - wanted);
    if (far <= reach && (!best || far < std::fabs(bands[*best].center_um - wanted))) best = b;
  }
  return best;
}

std::vector<size_t> named(std::span<const Band> bands, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Band& b : bands) known.push_back(b.name);
  std::vector<size_t> chosen;
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end())
      throw Error("the preview names a band '" + name + "' that the sensor does not have", name_hint(name, known));
    chosen.push_back(static_cast<size_t>(found - known.begin()));
  }
  return chosen;
}

// The tangent plane at the scene's origin as a coordinate system that other programs know.
std::string tangent_wkt(const GeodeticOrigin& o) {
  return strf(
      "PROJCS[\"scene ENU\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
      "84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
      "UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Orthographic\"],PARAMETER[\"latitude_of_origin\",%.12g],"
      "PARAMETER[\"central_meridian\",%.12g],PARAMETER[\"false_easting\",0],PARAMETER[\"false_northing\",0],UNIT["
      "\"metre\",1]]",
      o.latitude_deg, o.longitude_deg);
}

// Colours that neighbours in a list tell apart: hues by the golden section, in three steps of brightness.
std::array<uint8_t, 3> class_colour(size_t i) {
  const double hue = 6 * std::fmod(0.11 + 0.6180339887498949 * static_cast<double>(i), 1.0);
  const double bright = 255 - 55 * static_cast<double>(i % 3);
  std::array<uint8_t, 3> rgb{};
  for (int c = 0; c < 3; ++c) {
    const double from = std::fmod(hue + 6 - 2 * c, 6.0);  // distance around the circle from the primary
    const double share = std::clamp(2 - std::min(from, 6 - from), 0.0, 1.0);
    rgb[static_cast<size_t>(c)] = static_cast<uint8_t>(bright * (0.15 + 0.85 * share));
  }
  return rgb;
}

}  // namespace

Display display_of(std::span<const Band> bands, const PreviewSpec& spec) {
  const auto red = nearest(bands, kRed, kReach), green = nearest(bands, kGreen, kReach),
             blue = nearest(bands, kBlue, kReach), infrared = nearest(bands, kInfrared, kInfraredReach);
  const bool apart = red && green && *red != *green,
             thermal = spec.show == PreviewSpec::Show::kelvin ||
                       std::all_of(bands.begin(), bands.end(), [](auto&b) { return b.center_um > kThermalFrom; });
  Display display;
  if (thermal)
    display = {{*nearest(bands, kWindow, INFINITY)}, false};
  else if (apart && blue && *blue != *green)
    display = {{*red, *green, *blue}, true};
  else if (apart && infrared)
    display = {{*infrared, *red, *green}, false};
  else
    display = {{(bands.size() - 1) / 2}, false};
  if (spec.bands.empty()) return display;
  const std::vector<size_t> chosen = named(bands, spec.bands);
  return {chosen, display.true_colour && chosen == display.bands};
}

EnviHeader bare(EnviHeader h) {
  h.extra.clear(), h.wavelength_um.clear(), h.fwhm_um.clear(), h.data_units.clear(), h.default_bands.clear();
  h.ignore_value.reset();
  return h;
}

void add_map(const MapGrid& map, const GeodeticOrigin& origin, EnviHeader& h) {
  h.map_info = {origin.given ? "Orthographic" : "Arbitrary",
                "1",
                "1",
                strf("%.10g", map.origin.x),
                strf("%.10g", map.origin.y),
                strf("%.10g", map.gsd_x),
                strf("%.10g", map.gsd_y),
                origin.given ? "WGS-84" : "0",
                "units=Meters"};
  if (origin.given) h.coordinate_system = tangent_wkt(origin);
}

std::string map_offset(const MapGrid& map, uint32_t columns, uint32_t rows, const GeodeticOrigin& origin) {
  constexpr double kEarth = 6.378e6;  // m
  double farthest = 0;
  for (const double x : {map.origin.x, map.origin.x + columns * map.gsd_x})
    for (const double y : {map.origin.y, map.origin.y - rows * map.gsd_y})
      farthest = std::max(farthest, std::hypot(x, y));
  const double h = origin.ellipsoid_height_m, off = std::fabs(h) / (kEarth + h) * farthest;
  if (!origin.given || !(off > 0.5 * std::min(map.gsd_x, map.gsd_y))) return "";
  return strf(
      "other programs put the map's farthest corner %.2g m off: they take its coordinates for those of points on "
      "the ellipsoid, which are counted at the origin's height of %g m; `geolocation: true` has every pixel's place",
      off, h);
}

EnviHeader quality_header(EnviHeader header, const std::string& about) {
  EnviHeader h = bare(std::move(header));
  h.type = EnviType::uint8;
  h.bands = 1;
  h.band_names = {"quality"};
  h.description = "quality" + about + "; a pixel is the sum of the bits that hold, 0 = none:";
  std::string bits = "{";
  for (const QualityBit& b : quality_bits()) {
    h.description += strf("\n%d = %s: %s", b.bit, b.name.c_str(), b.meaning.c_str());
    bits += strf("%s%d %s", bits.size() > 1 ? ", " : "", b.bit, b.name.c_str());
  }
  h.extra.push_back({"quality bits", bits + "}"});
  return h;
}

RasterStyle quality_style() {
  const std::span<const QualityBit> bits = quality_bits();
  RasterStyle style{{0}, {}, 1, {}, {{0, "no flag", {}, false}}};
  for (int sum = 1; sum < 1 << bits.size(); ++sum) {
    StyleColour c{static_cast<double>(sum), "", {}};
    std::array<int, 3> mixed{};
    int held = 0;
    for (size_t i = 0; i < bits.size(); ++i) {
      if (!(sum & bits[i].bit)) continue;
      c.label += (held++ ? " + " : "") + bits[i].name;
      for (size_t k = 0; k < 3; ++k) mixed[k] += class_colour(i)[k];
    }
    for (size_t k = 0; k < 3; ++k) c.rgb[k] = static_cast<uint8_t>(mixed[k] / held);
    style.classes.push_back(std::move(c));
  }
  return style;
}

EnviHeader truth_header(EnviHeader header, const std::vector<std::string>& names, const SceneNotes& notes,
                        const std::string& about) {
  EnviHeader h = bare(std::move(header));
  h.type = EnviType::float64;  // positions and indices keep every digit
  h.bands = names.size();
  h.band_names = names;
  h.ignore_value = std::nan("");
  if (const GeodeticOrigin& o = notes.origin; o.given)
    h.extra.push_back(
        {kSceneOrigin, strf("{%.12g, %.12g, %.10g}", o.latitude_deg, o.longitude_deg, o.ellipsoid_height_m)});
  h.description = "truth" + about + "; materials:";
  for (size_t i = 0; i < notes.materials.size(); ++i) h.description += strf(" %zu=%s", i, notes.materials[i].c_str());
  if (!notes.tags.empty()) h.description += "; tags:";
  for (size_t i = 0; i < notes.tags.size(); ++i) h.description += strf(" %zu=%s", i, notes.tags[i].c_str());
  return h;
}

EnviHeader class_header(EnviHeader header, const ClassSource& source, const std::string& about) {
  const std::vector<std::string>& names = source.names;
  EnviHeader h = bare(std::move(header));
  h.type = names.size() < 256 ? EnviType::uint8 : names.size() < 65536 ? EnviType::uint16 : EnviType::uint32;
  h.bands = 1;
  h.band_names = {source.truth};
  h.ignore_value = 0;
  h.description = source.truth + about + "; the most frequent one of a pixel, numbers are those of the truth plus 1";
  h.classes.push_back({source.none, {0, 0, 0}});
  for (size_t i = 0; i < names.size(); ++i) h.classes.push_back({names[i], class_colour(i)});
  return h;
}

}  // namespace suite
