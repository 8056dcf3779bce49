// Files of DIRSIG from any editor, with what nobody knows, more often than once, or with other numbers: the same text
// of ours, another one, one message with its place, or an account that says what is lost.
#include <cstdlib>
#include <map>
#include <regex>
#include <set>

#include "base/files.h"
#include "formats/dirsig/texts.h"
#include "support/dirsig_kit.h"
#include "support/temp_folder.h"

namespace suite::format_dirsig_nothing_lost_test {

namespace {

using dirsig::Fate;

class DirsigOddFiles : public testing::Test {
 protected:
  DirsigOddFiles() { std::filesystem::copy(kDirsigData, folder_.path(), std::filesystem::copy_options::recursive); }
  // The text of a scene or simulation, lamps included.
  std::string read(const std::string& top) {
    import_ = std::make_unique<dirsig::Import>(std::vector<std::string>{}, folder_.path());
    std::string made;
    if (top.ends_with(".scene")) {
      const dirsig::SceneMade scene = dirsig::scene_of(*import_, folder_ / top);
      made = scene.text.yaml + print(scene.lamps, {}).yaml;
    } else {
      made = dirsig::simulation_of(*import_, folder_ / top, dirsig_help()).yaml;
    }
    expect_accounted(import_->ledger());
    return made;
  }
  std::string text_of(const std::string& name) const { return read_text(folder_ / name); }
  void write(const std::string& name, const std::string& text) { write_file(folder_ / name, std::string_view(text)); }
  void change(const std::string& name, const std::string& from, const std::string& to) {
    std::string text = text_of(name);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(name, text.replace(at, from.size(), to));
  }
  std::string fault_of(const std::string& top) {
    try {
      made_ = read(top);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
  std::string fate(const std::string& end) const { return fate_of(import_->ledger(), end); }
  // One place in four is tried, SUITE_LONG tries all.
  bool tried() { return std::getenv("SUITE_LONG") || places_++ % 4 == 0; }
  TempFolder folder_;
  std::unique_ptr<dirsig::Import> import_;
  std::string made_;  // by fault_of() where there is none
  size_t places_ = 0;
};

using Change = std::function<std::string(std::string)>;

std::string replaced(const std::string& text, const char* pattern, const char* with) {
  return std::regex_replace(text, std::regex(pattern), with);
}

std::string utf16(const std::string& text, bool big) {
  std::string out = big ? "\xfe\xff" : "\xff\xfe";
  for (const char c : text) out += big ? std::string{'\0', c} : std::string{c, '\0'};
  return out;
}

TEST_F(DirsigOddFiles, FromAnyEditorSayTheSame) {
  const std::string plain = read("range.scene");
  const std::set<std::string> xml{"range.scene", "geometry/range.glist"};
  const std::set<std::string> sections{"materials/range.mat", "geometry/range.odb", "geometry/local.mat",
                                       "geometry/drive.mov"};
  const auto same = [&](const char* what, const std::set<std::string>& names, const Change& made) {
    std::map<std::string, std::string> before;
    for (const std::string& name : names) {
      before[name] = text_of(name);
      write(name, made(replaced(before[name], "\r", "")));
    }
    EXPECT_EQ(read("range.scene"), plain) << what;
    for (const auto& [name, text] : before) write(name, text);
  };
  std::set<std::string> all = xml;
  all.insert(sections.begin(), sections.end());
  all.insert("geometry/hood.gdb");
  same("Windows", all, [](const std::string& t) { return replaced(t, "\n", "\r\n"); });
  same("carriage returns", all, [](const std::string& t) { return replaced(t, "\n", "\r"); });
  same("a byte order mark", all, [](const std::string& t) { return "\xef\xbb\xbf" + t; });
  same("UTF-16", all, [](const std::string& t) { return utf16(t, false); });
  same("UTF-16, big end first", all, [](const std::string& t) { return utf16(t, true); });
  same("blanks at the ends", all, [](const std::string& t) { return replaced(t, "\n", " \t \n"); });
  same("no last line end", all, [](const std::string& t) { return t.substr(0, t.find_last_not_of(" \n") + 1); });
  same("comments of XML", xml, [](const std::string& t) { return replaced(t, ">\n", "><!-- a > b { # -->\n"); });
  same("lines within values", xml, [](const std::string& t) { return replaced(t, ">([^<>\n]+)</", ">\n \t$1\n</"); });
  same("CDATA", xml, [](const std::string& t) { return replaced(t, ">([^<>&\n]+)</", "><![CDATA[$1]]></"); });
  same("comments", sections, [](const std::string& t) { return "# a\n" + replaced(t, "\n", " # b = { }\n\t#\n"); });
  same("no blanks", sections, [](const std::string& t) {
    return replaced(replaced(t, "(\n\\s*[A-Z_0-9]+) *= *", "$1="), "(\n\\s*[A-Z_0-9]+) *\\{", "$1{");
  });
  same("braces below", sections, [](const std::string& t) { return replaced(t, "\\{ *\n", "\n{\n"); });
  same("sections in a line", sections,
       [](const std::string& t) { return replaced(t, "\\{ *\n\\s*([^{}\n]*[^{}\\s])\\s*\n\\s*\\}", "{ $1 }"); });
  same("small letters", sections, [](std::string t) {
    const std::regex key("(^|\n)([ \t]*)([A-Z_0-9]+)(?=[ \t]*[={])");
    std::string out;
    std::sregex_iterator at(t.begin(), t.end(), key), end;
    size_t from = 0;
    for (; at != end; ++at) {
      out += t.substr(from, static_cast<size_t>(at->position()) - from) + dirsig::lower_case(at->str());
      from = static_cast<size_t>(at->position() + at->length());
    }
    return out + t.substr(from);
  });
  // The control: another value is another text.
  change("geometry/range.glist", "<x>8</x>", "<x>8.5</x>");
  EXPECT_NE(read("range.scene"), plain);
}

TEST_F(DirsigOddFiles, ThatAreNoTextsAreRefusedWithTheirPlace) {
  const auto refused = [&](const char* name, const std::string& text, const char* why) {
    const std::string before = text_of(name);
    write(name, text);
    const std::string fault = fault_of("range.scene");
    EXPECT_NE(fault.find(name), std::string::npos) << why << ": " << fault;
    EXPECT_NE(fault.find(why), std::string::npos) << fault;
    write(name, before);
  };
  refused("materials/range.mat", utf16("ID = 1", false) + "x", "UTF-16 that is cut");
  refused("materials/range.mat", "\xff\xfe" + std::string("\x00\xd8\x41\x00", 4), "UTF-16 that is cut or damaged");
  refused("materials/range.mat", "MATERIAL_ENTRY\nID = 1\n", "neither KEY = VALUE nor SECTION");
  refused("materials/range.mat", "MATERIAL_ENTRY", "neither KEY = VALUE nor SECTION");
  refused("materials/range.mat", "A { B { C = 1 } }\n", "more than one section in a line");
  refused("materials/range.mat", "A { B = 1, C = 2 }\n", "more than one key in a line");
  refused("materials/range.mat", "// old\n", "neither KEY = VALUE nor SECTION");
  for (const char* name : {"range.scene", "geometry/hood.gdb", "materials/grey.ems", "materials/old.ems"})
    for (const char* empty : {"", "\n \n", "\xef\xbb\xbf"}) refused(name, empty, "");
  for (const char* empty : {"", "# nothing\n"}) {
    write("geometry/range.glist", empty);
    read("range.scene");
    EXPECT_EQ(fate("odb"), "unsupported");
  }
}

// What nobody knows shows wherever it stands, unless what it stands in does not matter.
TEST_F(DirsigOddFiles, ShowWhatNobodyKnows) {
  const std::pair<const char*, std::vector<const char*>> plan[] = {
      {"range.scene", {"range.scene", "geometry/range.glist", "geometry/range.odb", "materials/range.mat"}},
      {"models.scene", {"materials/models.mat", "geometry/models.odb"}},
      {"maps.scene", {"maps.scene", "geometry/maps.glist", "materials/maps.mat"}},
      {"plane.sim", {"plane.sim", "plane.scene", "uniform.atm", "camera.platform", "nadir.ppd", "noon.tasks"}},
      {"scan.sim", {"scan.platform", "swarm.ppd", "passes.tasks"}}};
  size_t shown = 0;
  for (const auto& [top, names] : plan)
    for (const char* name : names) {
      const std::string before = text_of(name);
      const bool xml = before.find('<') < 2;
      const std::regex spot(xml ? "<[a-zA-Z_]+[^<>/]*>" : "\\{[ \t]*\r?\n");
      for (std::sregex_iterator at(before.begin(), before.end(), spot), end; at != end; ++at) {
        if (!tried()) continue;
        std::string text = before;
        text.insert(static_cast<size_t>(at->position() + at->length()),
                    xml ? "<zzq a=\"1\"><zzr>2</zzr></zzq>" : "ZZQ {\n ZZR = 6\n}\n");
        write(name, text);
        if (!fault_of(top).empty()) continue;  // where one value alone may stand
        Fate outer = Fate::exact, inner = Fate::exact;
        std::string note;
        for (const dirsig::Entry& e : import_->ledger().entries()) {
          const std::string path = dirsig::lower_case(e.path);
          if (path.ends_with("zzq")) outer = e.fate, note = e.note;
          if (path.ends_with("zzr")) inner = e.fate;
        }
        EXPECT_TRUE((outer == Fate::unsupported && inner == Fate::unsupported) ||
                    (outer == Fate::ignored && inner == Fate::ignored && !note.empty()))
            << name << " at " << at->position() << ": " << at->str();
        ++shown;
      }
      write(name, before);
    }
  EXPECT_GT(shown, size_t{37});
}

// A number that is said to hold holds: another one makes another text.
TEST_F(DirsigOddFiles, EveryNumberCountsOrIsToldNotTo) {
  const std::pair<const char*, std::vector<const char*>> plan[] = {
      {"range.scene", {"range.scene", "geometry/range.glist", "geometry/range.odb", "materials/range.mat"}},
      {"models.scene", {"materials/models.mat", "materials/paint.fit", "geometry/models.odb"}},
      {"maps.scene", {"maps.scene", "geometry/maps.glist", "materials/maps.mat"}},
      {"plane.sim", {"uniform.atm", "camera.platform", "nadir.ppd", "noon.tasks"}},
      {"scan.sim", {"scan.platform", "swarm.ppd", "passes.tasks"}},
      {"warm.sim", {"thermal.platform", "warm.atm"}}};
  const std::regex number(">\\s*([-+0-9.eE]+)\\s*</|=[ \t]*([-+0-9.eE]+)[ \t]*\r?\n|=\"([-+0-9.eE]+)\"");
  // BIAS: a lobe with a DHR has the height that gives it. datetime: a single record holds always. minimum: cuts
  // nothing.
  const std::regex allowed("BIAS|<datetime type=\"relative\">0|<minimum>");
  size_t counted = 0, told = 0;
  for (const auto& [top, names] : plan) {
    const std::string plain = read(top);
    for (const char* name : names) {
      const std::string before = text_of(name);
      for (std::sregex_iterator at(before.begin(), before.end(), number), end; at != end; ++at) {
        const int group = (*at)[1].matched ? 1 : (*at)[2].matched ? 2 : 3;
        const auto value = dirsig::number_in_text((*at)[group].str());
        if (!value || !tried()) continue;
        const size_t from = static_cast<size_t>(at->position(group)), length = static_cast<size_t>(at->length(group));
        const bool whole = (*at)[group].str().find('.') == std::string::npos;
        const std::string other = whole ? strf("%.0f", *value + 1) : strf("%g", *value == 0 ? 0.37 : *value * 1.37);
        write(name, std::string(before).replace(from, length, other));
        if (!fault_of(top).empty()) continue;
        if (made_ != plain) {
          ++counted;
          continue;
        }
        const int line = static_cast<int>(std::count(before.begin(), before.begin() + at->position(group), '\n')) + 1;
        const std::string around = before.substr(from > 40 ? from - 40 : 0, 50);
        bool said = std::regex_search(around, allowed);
        for (const dirsig::Entry& e : import_->ledger().entries())
          said = said || (e.where.line == line && e.where.file.ends_with(name) && e.fate >= Fate::approximated);
        EXPECT_TRUE(said) << name << ":" << line << ": " << around;
        ++told;
      }
      write(name, before);
    }
  }
  EXPECT_GT(counted, size_t{30});
  EXPECT_GT(told, size_t{2});
}

// Who wrote another name is told the right one, or those that there are.
TEST_F(DirsigOddFiles, HaveNamesThatAreToldTheRightOnes) {
  const std::string right = text_of("plane.scene");
  change("plane.scene", "<odbdirectory>", "<origin/><odbdirectory>");
  EXPECT_EQ(fault_of("plane.scene"), "");
  const auto note_of = [&](const std::string& end) {
    std::string note;
    for (const dirsig::Entry& e : import_->ledger().entries())
      if (e.path.ends_with(end)) note = e.note;
    return note;
  };
  EXPECT_EQ(note_of("classicscene/origin"), "not known here; is 'sceneorigin' meant?");
  write("plane.scene", right);
  change("plane.scene", "plane.odb</geometrylistinclude>", "plane.odb</geometrylistinclude><zzz>plane.odb</zzz>");
  EXPECT_EQ(fault_of("plane.scene"), "");
  EXPECT_EQ(note_of("geometrylist/zzz"), "not known here; 'geometrylist' has geometrylistinclude");
  write("plane.scene", right);
  change("plane.scene", "plane.odb</", "<filename>plane.odb</filename></");
  EXPECT_NE(fault_of("plane.scene").find("the name is its own text, not that of 'filename' in it"), std::string::npos);
}

TEST_F(DirsigOddFiles, HaveUnitsOfTheirOwn) {
  change("camera.platform", "<time>", "<time units=\"milliseconds\">");
  const std::string milli = read("plane.sim");
  EXPECT_EQ(fate("temporalintegration/time"), "converted");
  change("camera.platform", "<time units=\"milliseconds\">", "<time>");
  const std::string whole = read("plane.sim");
  const auto seconds = [](const std::string& text) {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(text, found, std::regex("integration_time_s: ([0-9.e-]+)")));
    return std::stod(found[1].str());
  };
  EXPECT_DOUBLE_EQ(seconds(milli), 1e-3 * seconds(whole));
  change("camera.platform", "<time>", "<time units=\"fortnights\">");
  EXPECT_NE(fault_of("plane.sim").find("fortnights"), std::string::npos);
}

TEST_F(DirsigOddFiles, HaveWordsThatAreNotKnown) {
  change("camera.platform", "<capturemethod type=\"simple\">", "<capturemethod type=\"magic\">");
  read("plane.sim");
  EXPECT_EQ(fate("capturemethod/@type"), "unsupported");
  change("geometry/drive.mov", "DIRSIG_MOV = 1.0", "DIRSIG_MOV = 2.0");
  change("range.scene", "<materialmap", "<decalmap name=\"paint\"><blend>0.5</blend></decalmap><materialmap");
  change("range.scene", "<odbdirectory>", "<odbdirectory>nowhere</odbdirectory><odbdirectory>");
  read("range.scene");
  EXPECT_EQ(fate("DIRSIG_MOV"), "unsupported");
  EXPECT_EQ(fate("maplist/decalmap"), "unsupported");
  EXPECT_EQ(fate("decalmap/blend"), "unsupported");
  EXPECT_EQ(fate("odbdirectory"), "ignored-harmless");
}

TEST_F(DirsigOddFiles, HaveEmissivitiesJustBeyondOne) {
  const std::string ems = text_of("materials/grey.ems");
  const size_t row = ems.find("CURVE_BEGIN");
  ASSERT_NE(row, std::string::npos);
  const auto curve = [&](const char* value) {
    write("materials/grey.ems", ems.substr(0, row) + "CURVE_BEGIN\n\n 0.3\t" + value + "\t\n 30.0 0.5\nCURVE_END\n\n");
  };
  curve("1.0003");
  const std::string made = read("range.scene");
  EXPECT_EQ(fate("ems/curve"), "approximated");
  EXPECT_NE(made.find("[0, 0.5]"), std::string::npos) << made;  // reflectances
  curve("0.9");
  EXPECT_EQ(read("range.scene").find("[0, 0.5]"), std::string::npos);
  EXPECT_EQ(fate("ems/curve"), "exact");
}

// A second entry of an ID that is used is lost, which is not harmless; that of one that is not used is.
TEST_F(DirsigOddFiles, HaveMaterialsTwice) {
  const std::string first = text_of("materials/range.mat"), once = read("range.scene");
  write("materials/range.mat", first + "\nMATERIAL_ENTRY {\n ID = grey\n NAME = again\n}\n");
  EXPECT_EQ(read("range.scene"), once);
  std::map<std::string, std::string> fates;
  for (const dirsig::Entry& e : import_->ledger().entries())
    if (e.path.ends_with("MATERIAL_ENTRY/NAME")) fates[e.value] = dirsig::to_text(e.fate) + std::string(": ") + e.note;
  EXPECT_EQ(fates.at("grey"), "exact: ");
  EXPECT_EQ(fates.at("again").substr(0, 34), "unsupported: 'grey' is given in li");
  EXPECT_EQ(fates.at("nobody"), "ignored-harmless: no geometry and no map has this material");
}

// What DIRSIG's own editors and public files write around what counts.
TEST_F(DirsigOddFiles, HaveEmptyElementsAndConstraints) {
  change("camera.platform", "<attachment", "<clocktable/><attachment");
  change("camera.platform", "</mount>", "<rotationdeviates/></mount>");
  change("camera.platform", "<capturemethod ", "<capturemethod name=\"Simple\" ");
  change("plane.jsim", "\"scene_list\"", "\"medium_list\": [], \"scene_list\"");
  read("plane.jsim");
  for (const dirsig::Entry& e : import_->ledger().entries()) EXPECT_NE(e.fate, Fate::unsupported) << e.path;
  change("camera.platform", "<rotationdeviates/>", "<rotationdeviates><x>1</x></rotationdeviates>");
  read("plane.jsim");
  EXPECT_EQ(fate("rotationdeviates/x"), "unsupported");

  const std::string list = text_of("geometry/range.glist");
  const size_t begin = list.find("<orientationengine"), end = list.find("</orientationengine>");
  for (const auto& [vector, kept] : {std::pair{"0,0,1", "exact"}, {"0, 0.6, 0.8", "approximated"}}) {
    write("geometry/range.glist",
          list.substr(0, begin) +
              "<orientationengine type=\"velocity\"><constraint type=\"constant\" frame=\"scene\" "
              "vector=\"" +
              vector + "\"/>" + list.substr(end));
    EXPECT_NE(read("range.scene").find("pointing: velocity"), std::string::npos);
    EXPECT_EQ(fate("constraint/@vector"), kept);
  }
}

// The Sun that is fixed holds wherever it is listed, which is not what DIRSIG does.
TEST_F(DirsigOddFiles, HaveEphemeridesInAnyOrder) {
  const std::string made = read("plane.jsim");
  EXPECT_EQ(fate("inputs/solar_zenith"), "exact");
  const std::string text = text_of("plane.jsim");
  const size_t at = text.find("{ \"name\": \"BasicAtmosphere\""), next = text.find("{ \"name\": \"FixedEphemeris\""),
               third = text.find("{ \"name\": \"BasicPlatform\"");
  write("plane.jsim",
        text.substr(0, at) + text.substr(next, third - next) + text.substr(at, next - at) + text.substr(third));
  const std::string turned = read("plane.jsim");
  for (const std::string& text_made : {made, turned})
    EXPECT_NE(text_made.find("zenith_deg: 60\n    azimuth_deg: 0\n"), std::string::npos) << text_made;
  EXPECT_EQ(fate("inputs/solar_zenith"), "approximated");
}

TEST_F(DirsigOddFiles, HavePopulations) {
  std::string list = "<geometrylist enabled=\"true\"><object>";
  for (const auto& [radius, weight] : {std::pair{1, " weight=\"3\""}, {2, ""}, {3, " weight=\"0\""}})
    list +=
        strf("<basegeometry%s><sphere><radius>%d</radius><matid>grey</matid></sphere></basegeometry>", weight, radius);
  for (int i = 0; i < 400; ++i)
    list +=
        strf("<staticinstance><translation><point><x>%d</x><y>0</y><z>0</z></point></translation></staticinstance>", i);
  write("geometry/range.glist", list + "</object></geometrylist>");
  const std::string made = read("range.scene");
  EXPECT_EQ(made, read("range.scene"));
  const auto count = [&](const std::string& what) {
    const std::regex word(what + "\n");
    return std::distance(std::sregex_iterator(made.begin(), made.end(), word), std::sregex_iterator());
  };
  // Objects are named in the order in which they are met first; 300 +- 8.7 of 400, within four of those.
  const auto first = count("place: sphere"), second = count("place: sphere_2");
  EXPECT_NEAR(static_cast<double>(std::max(first, second)), 300, 35);
  EXPECT_NEAR(static_cast<double>(first + second), 400, 8);  // other lists place spheres, too
  EXPECT_EQ(made.find("radius: 3\n"), std::string::npos);
  EXPECT_EQ(fate("object/basegeometry"), "approximated");
}

}  // namespace

}  // namespace suite::format_dirsig_nothing_lost_test
