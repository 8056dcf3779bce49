// Based on: the raster renderers of QGIS 3 as it writes them into its style files (multibandcolor, singlebandgray,
// singlebandpseudocolor, paletted).
#include "base/error.h"
#include "base/files.h"
#include "base/markup.h"
#include "formats/raster/raster_style.h"

namespace suite {

namespace {

std::string colour_text(const StyleColour& c) { return strf("#%02x%02x%02x", c.rgb[0], c.rgb[1], c.rgb[2]); }

// prefix: "red" and so on of three bands; none of one.
std::string stretch(const std::string& prefix, const RasterStyle& s) {
  const std::string name = prefix.empty() ? "contrastEnhancement" : prefix + "ContrastEnhancement";
  return "      <" + name +
         strf(">\n        <minValue>%.9g</minValue>\n        <maxValue>%.9g</maxValue>\n", s.ends[0], s.ends[1]) +
         "        <algorithm>StretchToMinimumMaximum</algorithm>\n      </" + name + ">\n";
}

std::string head(const char* type, const std::string& bands) {
  return strf("    <rasterrenderer type=\"%s\" %s opacity=\"1\" alphaBand=\"-1\" nodataColor=\"\">\n", type,
              bands.c_str()) +
         "      <rasterTransparency/>\n      <minMaxOrigin>\n        <limits>None</limits>\n      </minMaxOrigin>\n";
}

// Colours as elements of this name.
std::string colours(const char* element, const std::vector<StyleColour>& list) {
  std::string text;
  for (const StyleColour& c : list)
    text += strf("          <%s value=\"%.9g\" color=\"", element, c.value) + colour_text(c) + "\" label=\"" +
            in_markup(c.label) + strf("\" alpha=\"%d\"/>\n", c.seen ? 255 : 0);
  return text;
}

std::string ramp(const RasterStyle& s) {
  const std::string ends = strf("minimumValue=\"%.9g\" maximumValue=\"%.9g\"", s.ends[0], s.ends[1]);
  return "      <rastershader>\n        <colorrampshader colorRampType=\"INTERPOLATED\" classificationMode=\"1\" "
         "clip=\"0\" " +
         ends + ">\n" + colours("item", s.ramp) + "        </colorrampshader>\n      </rastershader>\n";
}

std::string renderer(const RasterStyle& s) {
  if (s.display.size() == 3)
    return head("multibandcolor", strf("redBand=\"%zu\" greenBand=\"%zu\" blueBand=\"%zu\"", s.display[0] + 1,
                                       s.display[1] + 1, s.display[2] + 1)) +
           stretch("red", s) + stretch("green", s) + stretch("blue", s);
  const size_t band = s.display[0] + 1;
  const std::string one = strf("band=\"%zu\"", band);
  if (!s.classes.empty())
    return head("paletted", one) + "      <colorPalette>\n" + colours("paletteEntry", s.classes) +
           "      </colorPalette>\n";
  if (s.ramp.empty())
    return head("singlebandgray", strf("grayBand=\"%zu\" gradient=\"BlackToWhite\"", band)) + stretch("", s);
  return head("singlebandpseudocolor",
              one + strf(" classificationMin=\"%.9g\" classificationMax=\"%.9g\"", s.ends[0], s.ends[1])) +
         ramp(s);
}

}  // namespace

void write_qgis_style(const std::string& path, const RasterStyle& s) {
  if (s.display.size() != 1 && s.display.size() != 3)
    throw Error(Where{path, 0, 0, {}, -1}, strf("a style shows one or three bands, not %zu", s.display.size()));
  write_file(
      path,
      "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
      "<qgis version=\"3.22.0\" styleCategories=\"Symbology\">\n  <pipe>\n" +
          renderer(s) +
          strf("    </rasterrenderer>\n    <brightnesscontrast brightness=\"0\" contrast=\"0\" gamma=\"%.9g\"/>\n",
               s.gamma) +
          "    <rasterresampler maxOversampling=\"2\"/>\n  </pipe>\n  <blendMode>0</blendMode>\n</qgis>\n");
}

}  // namespace suite
