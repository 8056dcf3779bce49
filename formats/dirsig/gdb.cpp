#include "formats/dirsig/gdb.h"

#include <algorithm>
#include <array>
#include <map>

#include "formats/dirsig/texts.h"
#include "math/vec.h"

namespace suite::dirsig {

namespace {

constexpr size_t kMostCorners = 10000;

class GdbReader {
 public:
  GdbReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Gdb run() {
    made_.account.name = "gdb";
    made_.account.where = {file_, 1, 1, {}, -1};
    for (;;) {
      const std::string_view word = line("a keyword");
      if (word == "END") break;
      if (word == "OBJECT") {
        object_ = line("the object's name");
        entry(made_.account, "OBJECT", std::string(object_), Fate::exact);
        line("the object's id");
      } else if (word == "PART") {
        part();
      } else if (word == "FACE") {
        facet();
      } else {
        throw fault("'" + std::string(word.substr(0, 60)) + "' is no keyword here", "OBJECT, PART, FACE or END");
      }
    }
    add_part();
    if (!facets_) throw fault("there is no facet");
    return std::move(made_);
  }

 private:
  Error fault(std::string what, std::string hint = {}) const {
    return Error(Where{file_, number_, 1, SourceLine(line_), -1}, std::move(what), std::move(hint));
  }
  // The next line that is not empty.
  std::string_view line(const char* what) {
    while (at_ < text_.size()) {
      const size_t end = std::min(text_.find('\n', at_), text_.size());
      line_ = trimmed(text_.substr(at_, end - at_));
      at_ = end + 1;
      ++number_;
      if (!line_.empty()) return line_;
    }
    throw fault(std::string("the file ends where ") + what + " should be", "the last line is END");
  }
  double number(const char* what) {
    const auto value = number_in_text(line(what));
    if (!value) throw fault(std::string(what) + " is no number");
    return *value;
  }
  Vec3 triple(const char* what) {
    const auto words = words_of(line(what), " \t,");
    Vec3 v;
    for (int i = 0; i < 3; ++i) {
      const auto value = words.size() == 3 ? number_in_text(words[static_cast<size_t>(i)]) : std::nullopt;
      if (!value) throw fault(std::string(what) + " is three numbers");
      v[i] = *value;
    }
    return v;
  }
  Item& entry(Item& to, const char* name, std::string value, Fate fate, std::string note = {}) const {
    Item& item = to.children.emplace_back();
    item.name = name;
    item.value = std::move(value);
    item.where = {file_, number_, 1, {}, -1};
    item.mark(fate, std::move(note));
    return item;
  }

  void part() {
    add_part();
    const std::string name(line("the part's name"));
    line("the part's id");
    part_ = &entry(made_.account, "PART", name, Fate::exact);
    made_.obj += "g " + name + "\n";
  }
  // Fields of the facets of a part, each said once.
  void add_part() {
    if (!in_part_) return;
    Item& to = part_ ? *part_ : made_.account;
    const std::string many = strf("%zu facets", in_part_);
    entry(to, "material ID", many, Fate::exact);
    entry(to, "material name", many, Fate::ignored, "the ID decides");
    entry(to, "FACET", many, Fate::ignored, "unused");
    if (warm_)
      entry(to, "temperature", strf("%zu facets", warm_), Fate::exact, "degrees Celsius, of materials of their own");
    else
      entry(to, "temperature", many, Fate::ignored, "none is given");
    entry(to, "thickness", many, Fate::ignored, "THERM's alone, which the materials' entries state");
    entry(to, "unused fields", many, Fate::ignored, "DIRSIG does not use them either");
    entry(to, "vertices", many, Fate::exact);
    entry(to, "normal", many, Fate::converted,
          strf("the order of the corners says it; %zu facets are turned", turned_));
    entry(to, "zenith and azimuth", many, Fate::ignored, "the normal has them");
    facets_ += in_part_;
    in_part_ = warm_ = turned_ = 0;
  }

  void facet() {
    line("the facet's name"), line("the facet's id"), line("the material's name");
    const std::string id(line("the material's ID"));
    line("the facet's unused name");
    // -1: by the material's solver; 0 is what files have that say nothing.
    const double celsius = number("the temperature");
    const bool warm = celsius != 0 && celsius != -1;
    if (warm && !(celsius > -273.15 && celsius < 1e5)) throw fault(strf("a facet of %g degrees Celsius", celsius));
    warm_ += warm;
    number("the thickness");
    for (const char* unused : {"the power", "the area", "a field", "a field", "a field"}) line(unused);
    const double count = number("the number of vertices");
    if (!(count >= 3 && count <= kMostCorners) || count != static_cast<double>(static_cast<size_t>(count)))
      throw fault(strf("a facet of %g vertices", count), strf("3 to %zu", kMostCorners));
    std::vector<Vec3> corners;
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) corners.push_back(triple("a vertex"));
    const Vec3 normal = triple("the normal");
    for (const char* rest : {"the zenith angle", "the azimuth angle", "an unused number"}) line(rest);
    put(warm ? warm_name(id, celsius) : id, corners, normal);
  }

  void put(const std::string& id, const std::vector<Vec3>& corners, Vec3 normal) {
    if (id != material_) made_.obj += "usemtl " + (material_ = id) + "\n";
    made_.materials.insert(id);
    Vec3 area;  // Newell
    for (size_t i = 0; i < corners.size(); ++i) area = area + cross(corners[i], corners[(i + 1) % corners.size()]);
    const bool turn = dot(area, normal) < 0;
    turned_ += turn;
    std::string face = "f";
    std::string vertices;
    for (size_t i = 0; i < corners.size(); ++i) {
      const Vec3 c = corners[turn ? corners.size() - 1 - i : i];
      const auto [there, fresh] = index_.try_emplace({c.x, c.y, c.z}, index_.size() + 1);
      if (fresh) vertices += strf("v %.17g %.17g %.17g\n", c.x, c.y, c.z);
      face += strf(" %zu", there->second);
    }
    made_.obj += vertices + face + "\n";
    ++in_part_;
  }

  std::string_view text_;
  const std::string& file_;
  size_t at_ = 0;
  int number_ = 0;
  std::string_view line_, object_;
  Gdb made_;
  Item* part_ = nullptr;
  std::string material_;
  size_t facets_ = 0, in_part_ = 0, warm_ = 0, turned_ = 0;
  std::map<std::array<double, 3>, size_t> index_;
};

}  // namespace

std::string warm_name(const std::string& id, double celsius) { return id + strf("@%.9gC", celsius); }

std::optional<WarmName> warm_name_of(std::string_view name) {
  const size_t at = name.rfind('@');
  if (at == name.npos || !name.ends_with('C')) return std::nullopt;
  const auto celsius = number_in_text(name.substr(at + 1, name.size() - at - 2));
  if (!celsius) return std::nullopt;
  return WarmName{std::string(name.substr(0, at)), *celsius};
}

Gdb parse_gdb(std::string_view text, const std::string& file) {
  std::string how;
  const std::string plain = plain_text(std::string(text), file, how);
  Gdb made = GdbReader(plain, file).run();
  if (!how.empty()) made.account.mark(Fate::converted, how);
  return made;
}

ObjAccount account_of_obj(std::string_view text, const std::string& file) {
  struct Kind {
    size_t count = 0;
    int line = 0;
  };
  std::map<std::string, Kind> kinds;
  ObjAccount made;
  int number = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = trimmed(text.substr(at, end - at));
    at = end + 1;
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const std::string word(line.substr(0, std::min({line.find(' '), line.find('\t'), size_t{40}})));
    Kind& kind = kinds[word];
    if (!kind.count++) kind.line = number;
    if (word == "usemtl") made.materials.insert(std::string(trimmed(line.substr(word.size()))));
    if (word == "f") made.unnamed = made.unnamed || made.materials.empty();
  }
  made.account.name = "obj";
  made.account.where = {file, 1, 1, {}, -1};
  for (const auto& [word, kind] : kinds) {
    Item& item = made.account.children.emplace_back();
    item.name = word;
    item.value = strf("%zu lines", kind.count);
    item.where = {file, kind.line, 1, {}, -1};
    const bool geometry = word == "v" || word == "vt" || word == "vn" || word == "f" || word == "g" || word == "o" ||
                          word == "s" || word == "usemtl";
    if (geometry)
      item.mark(Fate::exact);
    else if (word == "mtllib")
      item.mark(Fate::ignored, "DIRSIG's materials come by their IDs");
    else
      item.mark(Fate::unsupported, "only faces are geometry here");
  }
  return made;
}

}  // namespace suite::dirsig
