// Scenes of DIRSIG become scene texts; every element and key is accounted for.
#include <cmath>

#include "base/files.h"
#include "formats/scene_text/scene_text.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "support/dirsig_kit.h"
#include "support/temp_folder.h"

namespace suite::format_dirsig_scene_test {

namespace {

class DirsigScene : public testing::Test {
 protected:
  Params read(const std::string& file) {
    file_ = file;
    made_ = dirsig::scene_of(import_, file);
    expect_accounted(import_.ledger());
    return params_of(made_.text, file);
  }
  dirsig::Import import_{{}, kDirsigData};
  dirsig::SceneMade made_;
  std::string file_;
};

TEST_F(DirsigScene, HasItsHeadItsPlaceAndItsThings) {
  const Params root = read(kDirsigData + "range.scene");
  EXPECT_EQ(root.text("name"), "range");
  EXPECT_EQ(root.text("author"), "the tests");
  EXPECT_DOUBLE_EQ(root.at("origin").number("latitude_deg"), 39);
  EXPECT_DOUBLE_EQ(root.at("origin").number("height_m"), 1900);
  EXPECT_EQ(root.at("world").size(), 18u);
  const Params first = root.at("world")[0];
  EXPECT_EQ(first.text("place"), "panel");
  EXPECT_EQ(first.at("scale").as_numbers(), (std::vector<double>{2, 2, 2}));
  EXPECT_NEAR(first.at("rotate").at("euler_deg").as_numbers()[2], 90, 1e-12);
  EXPECT_EQ(root.at("world")[1].at("matrix").as_numbers().size(), 16u);
}

TEST_F(DirsigScene, EveryFateOccursAndNamesItsLine) {
  read(kDirsigData + "range.scene");
  const dirsig::Ledger& ledger = import_.ledger();
  for (const size_t count : ledger.counts()) EXPECT_GT(count, size_t{0});
  EXPECT_EQ(fate_of(ledger, "sceneorigin/location/latitude"), "exact");
  EXPECT_EQ(fate_of(ledger, "TEMP_SOLVER/THERMAL_CONDUCTIVITY"), "converted");
  EXPECT_EQ(fate_of(ledger, "SECCHI_DISK"), "approximated");
  EXPECT_EQ(fate_of(ledger, "MATERIAL_ENTRY/EDITOR_COLOR"), "ignored-harmless");
  EXPECT_EQ(fate_of(ledger, "CURVED_FRUSTUM/RAMP"), "unsupported");
  for (const dirsig::Entry& e : ledger.entries()) {
    EXPECT_FALSE(e.where.file.empty()) << e.path;
    EXPECT_GT(e.where.line, 0) << e.path;
    const bool changed = e.fate == dirsig::Fate::approximated || e.fate == dirsig::Fate::unsupported;
    EXPECT_FALSE(changed && e.note.empty()) << e.path;
  }
}

TEST_F(DirsigScene, NothingIsSilentlyLost) {
  // A key that nobody knows shows, with the name that may be meant.
  const TempFolder folder;
  std::filesystem::copy(kDirsigData, folder.path(), std::filesystem::copy_options::recursive);
  std::string text = read_text(folder / "range.scene");
  text.insert(text.find("<mapdirectory>"),
              "<emsdirektory>x</emsdirektory>\n  <moonbase radius=\"3\">yes</moonbase>\n  ");
  write_file(folder / "range.scene", std::string_view(text));
  dirsig::Import import({}, folder.path());
  dirsig::scene_of(import, folder / "range.scene");
  expect_accounted(import.ledger());
  EXPECT_EQ(fate_of(import.ledger(), "classicscene/moonbase"), "unsupported");
  EXPECT_EQ(fate_of(import.ledger(), "moonbase/@radius"), "unsupported");
  bool near = false;
  for (const dirsig::Entry& e : import.ledger().entries())
    near = near || (e.path == "classicscene/emsdirektory" && e.note.find("'emsdirectory'") != std::string::npos);
  EXPECT_TRUE(near);
}

TEST_F(DirsigScene, MaterialsAreWhatTheirEntriesSay) {
  const Params materials = read(kDirsigData + "range.scene").at("materials");
  EXPECT_EQ(materials.at("grey").text("model"), "lambert");
  EXPECT_EQ(materials.at("local/36").text("model"), "mirror");
  EXPECT_EQ(materials.at("white").text("model"), "lambert");
  EXPECT_EQ(materials.at("white").at("transmittance").at("value").as_numbers()[0], 0.1);
  EXPECT_EQ(materials.at("100").text("map"), "fields");
  // One quarter is mirrored, of the mean of two curves.
  const Params dirt = materials.at("13");
  EXPECT_EQ(dirt.text("model"), "ward");
  EXPECT_NEAR(dirt.at("diffuse").at("value").as_numbers()[0], 0.75 * 0.2, 1e-12);
  EXPECT_NEAR(dirt.at("specular").at("value").as_numbers()[1], 0.25 * 0.3, 1e-12);
  EXPECT_EQ(dirt.number("temperature_k"), 310);
  EXPECT_EQ(materials.at("4").at("temperature").text("model"), "heat");
  EXPECT_FALSE(materials.has("unused"));
  EXPECT_EQ(materials.at("camouflage").text("map"), "paint");
}

// Plates in files of one part, whose facets say -23.15 C and 76.85 C, and one that says nothing (-1).
TEST(DirsigFacets, TheirTemperatures) {
  const TempFolder folder;
  const auto plate = [&](const char* name, double celsius) {
    write_file(folder / (std::string(name) + ".gdb"),
               std::string_view(
                   strf("OBJECT\nplate\n1-0-0\nPART\n%s\n1-1-0\nFACE\nf\n1-1-1\nblackbody\nblack\nFACET\n%g\n0.0\n0.0"
                        "\n0.0\nNULL\nNULL\nNULL\n4\n-5 -5 0\n5 -5 0\n5 5 0\n-5 5 0\n0 0 1\n0.0\n0.0\n0.0\nEND\n",
                        name, celsius)));
    return strf(
        "OBJECT {\n GDB_FILENAME = %s.gdb\n UNITS = METERS\n INSTANCES {\n  INFO = 0, 0, 1, 1, 1, 1, 0, 0, 0\n }\n}\n",
        name);
  };
  const std::string list = "DIRSIG_ODB = 1.0\n" + plate("cold", -23.15) + plate("hot", 76.85) + plate("free", -1);
  write_file(folder / "plates.odb", std::string_view(list));
  std::string ems = "1\n";
  for (int k = 0; k < 91; ++k) ems += "1\n";
  write_file(folder / "black.ems", std::string_view(ems + "CURVE_BEGIN\n0.3 1\n20 1\nCURVE_END\n"));
  write_file(
      folder / "p.mat",
      "MATERIAL_ENTRY {\n ID = black\n NAME = blackbody\n TEMP_SOLVER_NAME = Therm\n TEMP_SOLVER {\n SPECIFIC_HEAT = "
      "0.2\n MASS_DENSITY = 1.35\n THERMAL_CONDUCTIVITY = 15.48\n THICKNESS = 5\n }\n SURFACE_PROPERTIES {\n"
      "EMISSIVITY_PROP_NAME = ClassicEmissivity\n EMISSIVITY_PROP {\n FILENAME = black.ems\n SPECULAR_FRACTION = 0\n "
      "}\n }\n}\n");
  write_file(folder / "plates.scene",
             "<classicscene name=\"p\"><sceneorigin><location frame=\"geodetic\"><latitude>39</latitude><longitude>-120"
             "</longitude><altitude>0</altitude></location></sceneorigin><odbdirectory>.</odbdirectory><gdbdirectory>."
             "</gdbdirectory><matfilename>p.mat</matfilename><emsdirectory>.</emsdirectory><geometrylist "
             "enabled=\"true\"><geometrylistinclude name=\"p\" enabled=\"true\">plates.odb</geometrylistinclude>"
             "</geometrylist></classicscene>");
  dirsig::Import import({}, folder.path());
  const dirsig::SceneMade made = dirsig::scene_of(import, folder / "plates.scene");
  const std::string file = folder / "plates.scene";
  const Params root = params_of(made.text, file);
  const Params materials = root.at("materials");
  EXPECT_NEAR(materials.at("black_at_250K").number("temperature_k"), 250, 1e-9);
  EXPECT_NEAR(materials.at("black_at_350K").number("temperature_k"), 350, 1e-9);
  EXPECT_FALSE(materials.at("black_at_350K").has("temperature"));
  EXPECT_EQ(materials.at("black").at("temperature").text("model"), "heat");
  EXPECT_EQ(root.at("objects").at("cold").at("materials").at("black@-23.15C").as_text(), "black_at_250K");
  EXPECT_FALSE(root.at("objects").at("free").has("materials"));
}

TEST_F(DirsigScene, MovesStepByStep) {
  const Params world = read(kDirsigData + "range.scene").at("world");
  EXPECT_EQ(made_.epoch, "2009-06-23T17:00:00.000Z");
  const Params keys = world[3].at("motion").at("keys");
  ASSERT_EQ(keys.size(), 5u);  // three, and the ends are held
  EXPECT_EQ(keys[2].number("time_s"), 10);
  EXPECT_EQ(keys[3].at("position_m").as_numbers(), (std::vector<double>{5, -5, 1}));
  EXPECT_NEAR(keys[3].at("quaternion").as_numbers()[3], std::sin(2.07 / 2), 1e-12);
  EXPECT_EQ(world[4].at("motion").text("kind"), "composed");
  EXPECT_NEAR(world[4].at("motion").at("inner").number("rate_deg_s"), 30, 1e-12);
}

TEST_F(DirsigScene, LampsGoToTheSimulation) {
  read(kDirsigData + "range.scene");
  ASSERT_EQ(made_.lamps.entries.size(), 1u);
  EXPECT_NE(made_.lamps.entries[0].second.find("intensity"), nullptr);
}

TEST_F(DirsigScene, BecomesASceneWithTheRightAreas) {
  const Params root = read(kDirsigData + "range.scene");
  Report report(scene_issues());
  TrackedInputs inputs(file_, {});
  Draft draft = read_scene_tree(root, inputs, report);
  ASSERT_TRUE(report.ok()) << report.text();
  const auto area = [&](const std::string& name, double unit) {
    for (const DraftGeometry& g : draft.geometry)
      if (g.name == name) {
        double sum = 0;
        const auto at = [&](size_t i) { return g.to_local.point(g.mesh.positions[g.mesh.indices[i]]); };
        for (size_t i = 0; i < g.mesh.indices.size(); i += 3)
          sum += length(cross(at(i + 1) - at(i), at(i + 2) - at(i))) / 2;
        return sum / (unit * unit);
      }
    return -1.0;
  };
  EXPECT_NEAR(area("hood", 1), 1.5, 1e-12);
  EXPECT_NEAR(area("hood_2", 0.0254), 1.5, 1e-12);  // of the object database, in inches
  EXPECT_NEAR(area("secchi_disk", 1), kPi * 0.25, 1e-3);
  EXPECT_NEAR(area("ground_2", 1), 4e6, 1e-3);
  EXPECT_NEAR(area("boxes", 1), 3 * (2 * 1 + 4 * 0.5) - 2 * 0.5, 1e-9);  // two of the three boxes share a side
  EXPECT_NEAR(area("box_2", 1), 6, 1e-12);
}

TEST_F(DirsigScene, BundlesHaveMaterialsOfTheirOwn) {
  const TempFolder folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(folder / name).parent_path());
    write_file(folder / name, std::string_view(text));
  };
  const auto entry = [](const std::string& id, const std::string& rest) {
    return "MATERIAL_ENTRY {\n ID = " + id + "\n " + rest + "\n}\n";
  };
  const std::string ward =
      "SURFACE_PROPERTIES {\n REFLECTANCE_PROP_NAME = WardBRDF\n REFLECTANCE_PROP {\n DS_WEIGHTS = 0.3, "
      "0.1\n XSIGMA = 0.1\n YSIGMA = 0.1\n }\n }";
  write("x.scene",
        "<classicscene><gdbdirectory>$SCENE_DIR/geometry</gdbdirectory><geometrylist><geometrylistinclude>lists/l.glist"
        "</geometrylistinclude></geometrylist><matfilename>$SCENE_DIR/s.mat</matfilename></classicscene>");
  write("s.mat", entry("w", ward));
  write("geometry/lists/l.glist",
        "<geometrylist><object><basegeometry><glist><filename>bundles/b/b.glist</filename></glist>"
        "</basegeometry><staticinstance/></object></geometrylist>");
  write("geometry/bundles/b/b.glist",
        "<geometrylist><object search_paths='local'><localmaterials>b.mat</localmaterials>"
        "<basegeometry><obj><filename>q.obj</filename></obj></basegeometry><staticinstance/>"
        "</object></geometrylist>");
  write("geometry/bundles/b/b.mat",
        entry("p", "MATERIAL_MAP {\n IMAGE_FILENAME = m.pgm\n LUT {\n 0:v\n 255:w\n }\n }") + entry("v", ward) +
            entry("nobody", ward));
  write("geometry/bundles/b/m.pgm", "P2\n1 1\n255\n0\n");
  write("geometry/bundles/b/q.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl p\nf 1 2 3\n");
  dirsig::Import import({}, folder.path());
  const dirsig::SceneMade made = dirsig::scene_of(import, folder / "x.scene");
  expect_accounted(import.ledger());
  const Params root = params_of(made.text, folder / "x.scene");
  EXPECT_EQ(root.at("maps").at("MATERIAL_MAP").at("materials").text("0"), "b/v");
  EXPECT_EQ(root.at("maps").at("MATERIAL_MAP").at("materials").text("255"), "w");  // of the scene's own database
  EXPECT_EQ(root.at("materials").at("b/v").number("diffuse"), 0.3);
  EXPECT_EQ(import.ledger().counts()[static_cast<size_t>(dirsig::Fate::unsupported)], size_t{0})
      << import.ledger().text();
}

TEST_F(DirsigScene, TextsMayBeLatin1) {
  const TempFolder folder;
  std::filesystem::copy(kDirsigData, folder.path(), std::filesystem::copy_options::recursive);
  std::string text = read_text(folder / "range.scene");
  write_file(folder / "range.scene", std::string_view(text.replace(text.find("the tests"), 9, "M\xfcller")));
  dirsig::Import import({}, folder.path());
  const dirsig::SceneMade made = dirsig::scene_of(import, folder / "range.scene");
  EXPECT_EQ(params_of(made.text, folder / "range.scene").text("author"), "M\xc3\xbcller");
  expect_accounted(import.ledger());
  EXPECT_EQ(fate_of(import.ledger(), "classicscene"), "converted");
}

TEST_F(DirsigScene, FaultsStandInDirsigsOwnLines) {
  const TempFolder folder;
  std::filesystem::copy(kDirsigData, folder.path(), std::filesystem::copy_options::recursive);
  std::string text = read_text(folder / "geometry/range.odb");
  text.replace(text.find("RADIUS       = 1.0"), 18, "RADIUS       = one");
  write_file(folder / "geometry/range.odb", std::string_view(text));
  dirsig::Import import({}, folder.path());
  try {
    dirsig::scene_of(import, folder / "range.scene");
    FAIL();
  } catch (const Error& e) {
    EXPECT_TRUE(e.where().file.ends_with("range.odb"));
    EXPECT_EQ(e.where().line, 13);
  }
}

TEST_F(DirsigScene, ConfigurationsOfDirsig3HaveAScene) {
  const TempFolder folder;
  std::filesystem::copy(kDirsigData, folder.path(), std::filesystem::copy_options::recursive);
  write_file(
      folder / "old.cfg",
      std::string_view(
          "# of DIRSIG3\nPATHS {\n EMISSIVITY_PATH = materials\n ODB_PATH = geometry\n}\nSCENE {\n ODB_FILENAME = "
          "plane.odb\n GDB_FILENAME = geometry/hood.gdb\n GDB_UNITS = FEET\n MATERIAL_FILENAME = "
          "materials/range.mat\n DATE = 6 24 1996\n GMT_TIME = 17.50\n LATITUDE = 43.00\n LONGITUDE = "
          "78.00\n GROUND_ALTITUDE = 0.218\n}\nPLATFORM {\n FOCAL_LENGTH = 50\n}\n"));
  dirsig::Import import({}, folder.path());
  const dirsig::SceneMade made = dirsig::scene_of(import, folder / "old.cfg");
  expect_accounted(import.ledger());
  const Params root = params_of(made.text, folder / "old.cfg");
  EXPECT_EQ(root.at("origin").number("longitude_deg"), -78);
  EXPECT_EQ(root.at("origin").number("height_m"), 218);
  EXPECT_EQ(root.at("world").size(), 2u);
  EXPECT_EQ(root.at("objects").at("hood").number("unit_m"), 0.3048);
  EXPECT_EQ(fate_of(import.ledger(), "PLATFORM/FOCAL_LENGTH"), "unsupported");
}

TEST_F(DirsigScene, RealFilesAreAccountedFor) {
  const TempFolder folder;
  const std::string shared = kDirsigData + "shared/";
  std::filesystem::create_directories(folder / "emissivity");
  for (const char* name : {"muddy_water", "grass_texture", "grass_dirt"})
    std::filesystem::copy(shared + "ideal_mat_1.ems", folder / ("emissivity/" + std::string(name) + ".ems"));
  std::filesystem::copy(shared + "anadirsig.mat", folder / "anadirsig.mat");
  std::string odb = "DIRSIG_ODB = 1.0\n";
  for (const char* id : {"2", "4", "13", "100"})
    odb += std::string("SPHERE {\n CENTER = 0, 0, 1\n RADIUS = 1\n MATERIAL_IDS = ") + id + "\n}\n";
  write_file(folder / "all.odb", std::string_view(odb));
  write_file(folder / "all.scene",
             std::string_view("<classicscene><matfilename>anadirsig.mat</matfilename><geometrylist>"
                              "<geometrylistinclude>all.odb</geometrylistinclude></geometrylist></classicscene>"));
  dirsig::Import import({}, folder.path());
  const dirsig::SceneMade made = dirsig::scene_of(import, folder / "all.scene");
  expect_accounted(import.ledger());
  const Params materials = params_of(made.text, folder / "all.scene").at("materials");
  EXPECT_EQ(materials.at("2").text("model"), "mirror");
  EXPECT_EQ(materials.at("4").text("model"), "ward");
  EXPECT_GT(import.ledger().items(), size_t{60});
}

}  // namespace

}  // namespace suite::format_dirsig_scene_test
