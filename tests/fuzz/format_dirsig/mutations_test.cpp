// Damaged files of DIRSIG: a text of ours with a complete account, whose values our reader takes or files, or one Error
// that says where.
#include "base/files.h"
#include "formats/scene_text/scene_text.h"
#include "scene/issues.h"
#include "support/dirsig_kit.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_dirsig_mutations_test {

namespace {

using test::bytes_of;
using test::fuzz;

const std::vector<std::string> kWords{"<",
                                      ">",
                                      "</",
                                      "\"",
                                      "{",
                                      "}",
                                      "=",
                                      "#",
                                      "-1",
                                      "0",
                                      "nan",
                                      "1e308",
                                      "true",
                                      "..",
                                      "$DIRSIG_HOME",
                                      "\\",
                                      "CURVE_BEGIN",
                                      "END",
                                      "FACE",
                                      "<point>",
                                      "<x>1</x>",
                                      "units=\"inches\"",
                                      "geodetic",
                                      "gaussian",
                                      "INFO = 1",
                                      "MATERIAL_ENTRY {",
                                      ", ",
                                      "\r\n",
                                      "\t"};

class DirsigMutations : public testing::TestWithParam<const char*> {};

TEST_P(DirsigMutations, GiveATextOrOneLocatedMessage) {
  const TempFolder folder;
  std::filesystem::copy(kDirsigData, folder.path(), std::filesystem::copy_options::recursive);
  const std::string name = GetParam();
  const bool simulation = name.ends_with("sim") || name.ends_with("atm") || name.ends_with("platform") ||
                          name.ends_with("ppd") || name.ends_with("tasks");
  const bool models = name.find("models") != name.npos || name.ends_with(".fit");
  const std::string start = folder / (name.ends_with("jsim") ? name
                                      : name == "warm.atm"   ? "warm.sim"
                                      : simulation           ? "plane.sim"
                                      : models               ? "models.scene"
                                                             : "range.scene");
  const auto read = [&](std::span<const std::byte> bytes) {
    test::put_file(folder / name, bytes);
    dirsig::Import import({}, folder.path());
    const dirsig::SimulationHelp help = dirsig_help();
    const dirsig::MadeText made =
        simulation ? dirsig::simulation_of(import, start, help) : dirsig::scene_of(import, start).text;
    import.ledger().close();
    const auto counts = import.ledger().counts();
    size_t sum = 0;
    for (const size_t c : counts) sum += c;
    ASSERT_EQ(sum, import.ledger().items());
    const Params root = params_of(made, start);
    if (simulation) return;
    Report report(scene_issues());
    TrackedInputs inputs(start, {});
    read_scene_tree(root, inputs, report);
  };
  fuzz(bytes_of(read_text(folder / name)), read, 20, 200, kWords);
}

INSTANTIATE_TEST_SUITE_P(Files, DirsigMutations,
                         testing::Values("range.scene", "geometry/range.glist", "geometry/range.odb",
                                         "geometry/hood.gdb", "geometry/drive.mov", "geometry/boxes.grid",
                                         "geometry/local.mat", "materials/range.mat", "materials/old.ems",
                                         "materials/several.ems", "materials/white.txt", "materials/models.mat",
                                         "materials/paint.fit", "warm.jsim", "warm.atm", "plane.sim", "plane.jsim",
                                         "uniform.atm", "camera.platform", "nadir.ppd", "noon.tasks"));

}  // namespace

}  // namespace suite::format_dirsig_mutations_test
