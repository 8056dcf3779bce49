// Materials of a model from its display colours: reflectances that show them, texel by texel or class by class.
#include <algorithm>
#include <cmath>

#include "formats/scene_text/reader.h"
#include "optics/models.h"
#include "scene/colour_classes.h"
#include "scene/source_model.h"
#include "spectral/display_colour.h"

namespace suite::scene_text {

namespace {

// Of one image, as it is unpacked; of all images of an object, of which a texel is kept as 17 numbers of 4 bytes, or
// one.
constexpr size_t kMostUnpacked = size_t{1} << 25, kMostTexels = size_t{1} << 24, kMostInClasses = size_t{1} << 27;
constexpr size_t kChannels = kUpliftedWaves;

UpliftRule rule_of(const Params& p) {
  UpliftRule rule;
  rule.by_texel = p.at("uplift").as_choice({"texel", "classes"}) == 0;
  if (const auto classes = p.find("classes")) {
    if (rule.by_texel) throw classes->error("'classes' goes with 'uplift: classes'");
    rule.classes = static_cast<size_t>(p.integer("classes", 1, 1024));
  }
  return rule;
}

// Three display values a texel, times the linear factor; a grey picture has one channel or two, the last is its alpha.
std::vector<float> coloured(const Raster& picture, const LinearRgb& factor) {
  const size_t texels = size_t{picture.width} * picture.height, channels = picture.channels;
  std::vector<float> display;
  display.reserve(3 * texels);
  const bool plain = factor == LinearRgb{1, 1, 1};
  for (size_t i = 0; i < texels; ++i)
    for (size_t c = 0; c < 3; ++c) {
      const float v = picture.values[i * channels + (channels < 3 ? 0 : c)];
      display.push_back(plain ? v : static_cast<float>(srgb_from_linear(linear_from_srgb(double{v}) * factor[c])));
    }
  return display;
}

LinearRgb mean_of(std::span<const float> display) {
  LinearRgb sum{};
  for (size_t i = 0; i < display.size(); ++i) sum[i % 3] += linear_from_srgb(double{display[i]});
  for (double& v : sum) v /= std::max(1.0, static_cast<double>(display.size()) / 3);
  return sum;
}

// Where the picture lies on the surface, its texels still missing.
PropertyMap laid(const SourceTexture& texture, const Raster& picture, const std::string& name) {
  PropertyMap map;
  map.name = name;
  map.width = picture.width, map.height = picture.height;
  map.projection = Projection::uv;
  map.drape.extend = texture.extend == SourceTexture::Extend::clamp ? Drape::Extend::clamp : Drape::Extend::repeat;
  map.parameter = "reflectance";
  return map;
}

void fill_texels(std::span<const float> display, bool smooth, PropertyMap& map) {
  const auto waves = uplifted_wavelengths_um();
  map.kind = MapKind::cube;
  map.channels = kChannels;
  map.wavelength_um.assign(waves.begin(), waves.end());
  map.outside = Outside::hold;
  if (smooth) map.filter = PropertyMap::Filter::linear;
  map.values.reserve(display.size() / 3 * kChannels);
  for (size_t i = 0; i + 2 < display.size(); i += 3) {
    LinearRgb colour;
    for (size_t c = 0; c < 3; ++c) colour[c] = linear_from_srgb(double{display[i + c]});
    for (const double v : uplifted_values(colour)) map.values.push_back(static_cast<float>(v));
  }
}

}  // namespace

// The map of a material's texture; its mean is where the material has no map.
LinearRgb Reader::read_texture(const Params& p, const SourceMaterial& from, const std::string& id, UpliftRule& rule) {
  const SourceTexture& texture = *from.texture;
  const Raster picture = read_picture(texture.bytes, texture.name, kMostUnpacked);
  rule.texels += size_t{picture.width} * picture.height;
  if (rule.by_texel && rule.texels > kMostTexels)
    throw p.error(strf("the textures up to '%s' have %zu texels, at most %zu become spectra one by one",
                       printable(texture.name).c_str(), rule.texels, kMostTexels),
                  "'uplift: classes', or smaller images");
  if (rule.texels > kMostInClasses)
    throw p.error(strf("the textures up to '%s' have %zu texels, at most %zu are read", printable(texture.name).c_str(),
                       rule.texels, kMostInClasses),
                  "smaller images");
  const std::vector<float> display = coloured(picture, from.rgb);
  DraftPropertyMap m;
  m.where = p.where();
  m.map = laid(texture, picture, id);
  const Where where{texture.name, 0, 0, {}, -1};
  if (rule.by_texel) {
    fill_texels(display, texture.smooth, m.map);
  } else {
    const ColourClasses found = classify_colours(display, rule.classes);
    m.map.kind = MapKind::curve_index;
    m.map.channels = 1;
    m.map.values.assign(found.number.begin(), found.number.end());
    for (const LinearRgb& colour : found.colours) m.map.family.push_back(uplifted(colour));
    report_.add("SP707", draft_.file,
                {where, strf("%zu classes of colours: texels are %.2g levels of 255 from theirs (rms), %.2g at most",
                             found.colours.size(), 255 * found.rms, 255 * found.worst)});
  }
  draft_.property_maps.push_back(std::move(m));
  return mean_of(display);
}

// Of the model's materials those that the text has not: NAME/MATERIAL, matte, with the spectra of their colours.
void Reader::read_textures(const Params& p, const SourceModel& model, DraftGeometry& g) {
  UpliftRule rule = rule_of(p);
  size_t made = 0, textured = 0;
  std::string first;
  std::map<std::pair<std::string, LinearRgb>, std::pair<std::string, LinearRgb>> known_maps;  // id and mean
  for (const SourceMaterial& from : model.materials) {
    const auto known = [&](const DraftMaterial& m) { return m.material.id == from.name; };
    if (g.materials.count(from.name) || std::ranges::any_of(draft_.materials, known)) continue;
    const std::string id = g.name + "/" + from.name;
    if (std::ranges::any_of(draft_.materials, [&](const DraftMaterial& m) { return m.material.id == id; }) ||
        std::ranges::any_of(draft_.property_maps, [&](const DraftPropertyMap& m) { return m.map.name == id; }) ||
        std::ranges::any_of(draft_.class_maps, [&](const DraftClassMap& m) { return m.map.name == id; }))
      throw p.error("the name '" + printable(id) + "' is taken", "rename that material or map, or the object");
    DraftMaterial m;
    m.where = p.where();
    m.material.id = id;
    LinearRgb colour = from.rgb;
    if (from.texture) {
      const auto [known_map, fresh] = known_maps.try_emplace({from.texture->name, from.rgb});
      if (fresh) known_map->second = {id, read_texture(p, from, id, rule)};
      colour = known_map->second.second;
      m.property_maps.push_back({known_map->second.first, p.where()});
    }
    m.material.description = strf("%s %.3f %.3f %.3f%s", kUplifted, colour[0], colour[1], colour[2],
                                  from.texture ? " (mean of its texture)" : "");
    m.material.surface.model = "lambert";
    m.material.surface.curves["reflectance"] = uplifted(colour);
    check_model(m.material.surface, p.where());
    m.has_model = true;
    if (first.empty()) first = id;
    draft_.materials.push_back(std::move(m));
    g.materials[from.name] = {id, p.where()};
    ++made, textured += from.texture != nullptr;
  }
  if (made)
    report_.add("SP707", draft_.file,
                {p.where(), strf("%zu materials are matte with reflectances uplifted from display colours, %zu of them "
                                 "from textures (the first is '%s'): a guess from 0.38 to 0.78 um; what is there at "
                                 "either end holds beyond",
                                 made, textured, first.c_str())},
                made);
}

}  // namespace suite::scene_text
