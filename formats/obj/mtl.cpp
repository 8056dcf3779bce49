// tinyobjloader reads the statements. It gives materials without Kd a colour of its own, so that those are looked for
// before.
#include "formats/obj/mtl.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

#include "base/files.h"
#include "scene/left_out_look.h"

namespace suite {

namespace {

constexpr size_t kMostText = size_t{1} << 26, kMostImage = size_t{1} << 30;  // bytes

std::string trimmed_name(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == text.npos ? std::string() : std::string(text.substr(first, last - first + 1));
}

struct Library {
  std::string file;
  std::vector<tinyobj::material_t> materials;
  std::map<std::string, Where> places;   // of `newmtl NAME`
  std::set<std::string> with_kd, black;  // black: Kd 0 0 0
};

// Where materials begin, which have a Kd, and numbers of it that are none.
void look_through(std::string_view text, Library& to) {
  std::string name;
  int line = 0;
  for (size_t start = 0; start < text.size(); ++line) {
    const size_t end = std::min(text.find('\n', start), text.size());
    std::istringstream words(std::string(text.substr(start, std::min<size_t>(end - start, 4096))));
    start = end + 1;
    std::string word;
    words >> word;
    const Where where{to.file, line + 1, 1, {}, -1};
    if (word == "newmtl") {
      std::string rest;
      std::getline(words, rest);
      name = trimmed_name(rest);
      to.places.try_emplace(name, where);
    } else if (word == "Kd") {
      double rgb[3] = {NAN, NAN, NAN};
      words >> rgb[0] >> rgb[1] >> rgb[2];
      if (!words && std::isfinite(rgb[0]) && !std::isfinite(rgb[1])) rgb[1] = rgb[2] = rgb[0];  // one number: grey
      if (!(std::fabs(rgb[0]) + std::fabs(rgb[1]) + std::fabs(rgb[2]) < 1e6))
        throw Error(where, "Kd of '" + printable(name).substr(0, 80) + "' is no colour", "three numbers, 0 to 1");
      to.with_kd.insert(name);
      if (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) to.black.insert(name);
    }
  }
}

bool is_number(const std::string& word) {
  char* end = nullptr;
  std::strtod(word.c_str(), &end);
  return !word.empty() && *end == '\0';
}

// Of the numbers of -s, -o and -t only the first must be there; the loader wants three. Blanks of the name stay.
std::string with_three_numbers(std::string line) {
  for (const auto& [option, otherwise] : {std::pair{" -s ", " 1"}, {" -o ", " 0"}, {" -t ", " 0"}})
    for (size_t at = line.find(option); at != line.npos; at = line.find(option, at + 1)) {
      size_t numbers = 0, end = at + 3;
      while (numbers < 3) {
        const size_t first = line.find_first_not_of(" \t", end),
                     last = std::min(line.find_first_of(" \t", first), line.size());
        if (first == line.npos || !is_number(line.substr(first, last - first))) break;
        end = last, ++numbers;
      }
      for (; numbers < 3; ++numbers) line.insert(end, otherwise);
    }
  return line;
}

std::string for_the_loader(const std::string& text) {
  std::string made;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    made += (line.find(" -") == line.npos ? line : with_three_numbers(std::move(line))) + "\n";
  return made;
}

Library read_library(const std::string& path) {
  Library made;
  made.file = path;
  const std::string text = read_text(path, kMostText);
  if (const size_t zero = text.find('\0'); zero != text.npos)
    throw Error(Where{path, 0, 0, {}, static_cast<long long>(zero)}, "is not a text file", "MTL is expected", "SP003");
  look_through(text, made);
  std::istringstream stream(for_the_loader(text));
  std::map<std::string, int> numbers;
  std::string warnings, errors;
  tinyobj::LoadMtl(&numbers, &made.materials, &stream, &warnings, &errors);
  for (tinyobj::material_t& m : made.materials) m.name = trimmed_name(m.name);
  return made;
}

// A library's name may have blanks, or there are several.
std::vector<std::string> paths_of(const std::string& named,
                                  const std::function<std::string(const std::string&)>& resolve) {
  if (named.find_first_of(" \t") == named.npos) return {resolve(named)};
  try {
    return {resolve(named)};
  } catch (const Error&) {
    std::vector<std::string> paths;
    std::istringstream words(named);
    for (std::string word; words >> word;) paths.push_back(resolve(word));
    return paths;
  }
}

void count(const tinyobj::material_t& m, LeftOutLook& look) {
  const auto any = [](const auto& rgb) { return rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0; };
  look.see_through += m.dissolve < 1 || !m.alpha_texname.empty();
  look.shining += any(m.emission) || !m.emissive_texname.empty();
  look.bumps += !m.bump_texname.empty() || !m.normal_texname.empty() || !m.displacement_texname.empty();
  look.gloss += (m.illum >= 2 && any(m.specular)) || m.metallic > 0 || !m.specular_texname.empty() ||
                !m.specular_highlight_texname.empty() || !m.roughness_texname.empty() || !m.metallic_texname.empty() ||
                !m.reflection_texname.empty();
}

bool is_laid_out(const tinyobj::texture_option_t& o) {
  return o.scale[0] != 1 || o.scale[1] != 1 || o.origin_offset[0] != 0 || o.origin_offset[1] != 0;
}

// Options that change colours or that no rule here stands for.
bool is_changed(const tinyobj::texture_option_t& o) {
  return o.brightness != 0 || o.contrast != 1 || o.turbulence[0] != 0 || o.turbulence[1] != 0;
}

// Texture coordinates of the faces of some materials, scaled and moved as their images are. A vertex that other faces
// have too gets a copy.
void lay_out(SourceMesh& mesh, const std::map<std::string, tinyobj::texture_option_t>& rules) {
  if (rules.empty() || mesh.uvs.empty()) return;
  const size_t vertices = mesh.positions.size();
  std::map<std::pair<std::string, uint32_t>, uint32_t> made;
  for (size_t r = 0; r < mesh.runs.size(); ++r) {
    const auto rule = rules.find(mesh.runs[r].material);
    if (rule == rules.end()) continue;
    const size_t end = r + 1 < mesh.runs.size() ? 3 * size_t{mesh.runs[r + 1].first_triangle} : mesh.indices.size();
    for (size_t i = 3 * size_t{mesh.runs[r].first_triangle}; i < end; ++i) {
      const uint32_t from = mesh.indices[i];
      const auto [copy, fresh] = made.try_emplace({rule->first, from}, static_cast<uint32_t>(mesh.positions.size()));
      mesh.indices[i] = copy->second;
      if (!fresh) continue;
      mesh.positions.push_back(mesh.positions[from]);
      if (mesh.normals.size() >= vertices && !mesh.normals.empty()) mesh.normals.push_back(mesh.normals[from]);
      for (size_t c = 0; c < 2; ++c)
        mesh.uvs.push_back(
            static_cast<float>(mesh.uvs[2 * size_t{from} + c] * rule->second.scale[c] + rule->second.origin_offset[c]));
    }
  }
}

// The materials of one library that are still wanted.
class Taker {
 public:
  Taker(const std::function<std::string(const std::string&)>& resolve, std::set<std::string> wanted, Report& report)
      : resolve_(resolve), wanted_(std::move(wanted)), report_(report) {}
  void take(const Library& library) {
    for (const tinyobj::material_t& m : library.materials) {
      const bool coloured = library.with_kd.count(m.name) || !m.diffuse_texname.empty();
      if (!coloured || !wanted_.erase(m.name)) continue;
      count(m, look_);
      SourceMaterial& made = materials_.emplace_back();
      made.name = m.name;
      const bool black = !m.diffuse_texname.empty() && library.black.count(m.name);
      if (black) ++black_;
      if (library.with_kd.count(m.name) && !black)
        for (size_t c = 0; c < 3; ++c) made.rgb[c] = std::clamp(m.diffuse[c], 0.0, 1.0);
      if (!m.diffuse_texname.empty()) made.texture = texture(m, library);
    }
    look_.report(library.file, report_);
    look_ = {};
    const Where whole{library.file, 0, 0, {}, -1};
    if (black_)
      report_.add("SP707", library.file,
                  {whole, strf("%zu images of colours have a Kd of 0: it is taken as 1", black_)}, black_);
    if (changed_)
      report_.add("SP705", library.file, {whole, strf("%zu images have -mm or -t: they are taken unchanged", changed_)},
                  changed_);
    black_ = changed_ = 0;
  }
  std::vector<SourceMaterial> take_materials() { return std::move(materials_); }
  const std::map<std::string, tinyobj::texture_option_t>& rules() const { return rules_; }

 private:
  // Names have slashes of either kind.
  std::string image_path(const tinyobj::material_t& m, const Where& place) const {
    std::string name = trimmed_name(m.diffuse_texname);
    std::ranges::replace(name, '\\', '/');
    try {
      return resolve_(name);
    } catch (const Error& e) {
      throw Error(place, e.message(), e.hint(), "SP003");
    }
  }
  std::shared_ptr<const SourceTexture> texture(const tinyobj::material_t& m, const Library& library) {
    const tinyobj::texture_option_t& o = m.diffuse_texopt;
    const auto at = library.places.find(m.name);
    const Where place = at == library.places.end() ? Where{library.file, 0, 0, {}, -1} : at->second;
    for (size_t c = 0; c < 2; ++c)
      if (!(std::fabs(o.scale[c]) < 1e6 && std::fabs(o.origin_offset[c]) < 1e6))
        throw Error(place, "map_Kd of '" + printable(m.name).substr(0, 80) + "': -s or -o is no number, or beyond 1e6");
    const std::string path = image_path(m, place);
    if (is_laid_out(o)) rules_[m.name] = o;
    changed_ += is_changed(o);
    auto& known = images_[{path, o.clamp}];
    if (known) return known;
    auto made = std::make_shared<SourceTexture>();
    made->name = path + (o.clamp ? " (clamped)" : "");
    made->bytes = read_bytes(path, kMostImage);
    made->extend = o.clamp ? SourceTexture::Extend::clamp : SourceTexture::Extend::repeat;
    return known = std::move(made);
  }

  const std::function<std::string(const std::string&)>& resolve_;
  std::set<std::string> wanted_;
  Report& report_;
  LeftOutLook look_;
  size_t black_ = 0, changed_ = 0;
  std::vector<SourceMaterial> materials_;
  std::map<std::string, tinyobj::texture_option_t> rules_;
  std::map<std::pair<std::string, bool>, std::shared_ptr<const SourceTexture>> images_;
};

}  // namespace

std::vector<SourceMaterial> read_mtl(SourceMesh& mesh, const ObjLook& look,
                                     const std::function<std::string(const std::string&)>& resolve, Report& report) {
  std::set<std::string> wanted;
  for (const SourceMesh::Run& run : mesh.runs) wanted.insert(run.material);
  Taker taker(resolve, std::move(wanted), report);
  for (const std::string& named : look.libraries)
    for (const std::string& path : paths_of(named, resolve)) taker.take(read_library(path));
  LeftOutLook left;
  left.coloured = look.coloured;
  left.report(mesh.file, report);
  lay_out(mesh, taker.rules());
  return taker.take_materials();
}

void report_left_out(const ObjLook& look, const std::string& file, Report& report) {
  const Where whole{file, 0, 0, {}, -1};
  if (!look.libraries.empty())
    report.add("SP706", file,
               {whole, "mtllib " + printable(look.libraries[0]).substr(0, 80) +
                           ": its display colours are no spectra ('textures: {uplift: texel}' guesses some)"});
  LeftOutLook left;
  left.coloured = look.coloured;
  if (look.coloured) report.add("SP706", file, {whole, left.text()});
}

}  // namespace suite
