#include <algorithm>
#include <cmath>
#include <map>

#include "base/files.h"
#include "base/number_text.h"
#include "formats/city/internal.h"
#include "scene/mesh_builder.h"

namespace suite {

namespace city {

std::optional<double> level_of(std::string_view text) {
  const auto value = number_of(text);
  return value && *value >= 0 && *value < 10 ? value : std::nullopt;
}

bool place_copy(CityModel::Surface& surface, const Affine3& turn, Vec3 at, size_t& corners) {
  constexpr size_t kMostCorners = 20'000'000;
  for (std::vector<Vec3>& ring : surface.rings) {
    corners += ring.size();
    for (Vec3& p : ring) p = turn.point(p) + at;
  }
  return corners <= kMostCorners;
}

std::optional<double> chosen(const std::vector<double>& levels, const std::optional<std::string>& wanted) {
  std::optional<double> best;
  const double low = wanted ? level_of(*wanted).value_or(-1) : -1;
  const bool whole = wanted && wanted->find('.') == wanted->npos;
  for (const double level : levels) {
    if (wanted && !(whole ? std::floor(level) == low : level == low)) continue;
    if (!best || level > *best) best = level;
  }
  return best;
}

namespace {

// Objects whose parts say the same more exactly.
void leave_to_parts(CityModel& model, Report& report) {
  constexpr int kDeepest = 64;  // generations; parents may lead in a circle
  std::map<std::string, size_t> number;
  for (size_t k = 0; k < model.objects.size(); ++k) number[model.objects[k].id] = k;
  std::vector<double> of_parts(model.objects.size(), -1);
  for (const CityModel::Object& object : model.objects) {
    if (object.surfaces.empty()) continue;
    const CityModel::Object* at = &object;
    for (int k = 0; k < kDeepest && !at->parent.empty(); ++k) {
      const auto parent = number.find(at->parent);
      if (parent == number.end()) break;
      of_parts[parent->second] = std::max(of_parts[parent->second], object.lod);
      at = &model.objects[parent->second];
    }
  }
  size_t left = 0;
  for (size_t k = 0; k < model.objects.size(); ++k)
    if (!model.objects[k].surfaces.empty() && of_parts[k] > model.objects[k].lod)
      model.objects[k].surfaces.clear(), ++left;
  if (left)
    report.add("SP706", model.file,
               {Where{model.file, 0, 0, {}, -1},
                strf("%zu objects are left to their parts, which are of a higher level of detail", left)},
               left);
}

}  // namespace
}  // namespace city

CityModel parse_city(std::string_view text, const std::string& file, const std::optional<std::string>& lod,
                     Report& report) {
  const size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  const bool xml = first != text.npos && text[first] == '<';
  CityModel model = xml ? city::parse_gml(text, file, lod, report) : city::parse_json(text, file, lod, report);
  city::leave_to_parts(model, report);
  return model;
}

CityModel read_city(const std::string& path, const std::optional<std::string>& lod, Report& report) {
  return parse_city(read_text(path, size_t{8} << 30), path, lod, report);
}

SourceMesh mesh_of(const CityModel& model, const std::function<Vec3(Vec3)>& place, Report& report) {
  MeshBuilder builder(model.file, report);
  std::vector<uint32_t> corners;
  std::vector<size_t> ends;
  for (const CityModel::Object& object : model.objects) {
    builder.forget();
    for (const CityModel::Surface& surface : object.surfaces) {
      const Where where{model.file, surface.line, 0, {}, -1};
      builder.part(object.id, surface.kind, surface.line);
      corners.clear(), ends.clear();
      bool sound = true;
      for (const std::vector<Vec3>& ring : surface.rings) {
        for (const Vec3& p : ring) {
          sound = sound && builder.is_place(p, where);
          if (sound) corners.push_back(builder.vertex(place(p), where));
        }
        ends.push_back(corners.size());
      }
      if (sound) builder.holed_polygon(corners, ends, where);
    }
  }
  if (builder.empty()) builder.add("SP204", Where{model.file, 0, 0, {}, -1}, "no surface");
  return builder.take();
}

Box3 extent_of(const CityModel& model) {
  Box3 box;
  for (const CityModel::Object& object : model.objects)
    for (const CityModel::Surface& surface : object.surfaces)
      for (const std::vector<Vec3>& ring : surface.rings)
        for (const Vec3& p : ring) box.grow(p);
  return box;
}

std::string city_format(const std::string& path, std::string_view head) {
  std::string name = path;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool json = name.ends_with(".json") || name.ends_with(".jsonl") || name.ends_with(".cityjson");
  const bool named = name.ends_with(".city.json") || name.ends_with(".city.jsonl") || name.ends_with(".cityjson");
  if (named || (json && (head.find("\"CityJSON") != head.npos || head.find("\"CityObjects\"") != head.npos)))
    return "cityjson";
  if ((name.ends_with(".gml") || name.ends_with(".xml") || name.ends_with(".citygml")) &&
      head.find("CityModel") != head.npos)
    return "citygml";
  return "";
}

}  // namespace suite
