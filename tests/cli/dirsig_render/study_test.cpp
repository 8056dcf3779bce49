// dirsig-render --study: its three results, going on from an interrupted study, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "base/files.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "page/page.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

namespace suite::test::study_test {
namespace {

const std::string kBin = SUITE_BIN_DIR "/";

// A small copy of a scene to study, prepared.
std::string prepared(const TempFolder& folder, const std::string& name) {
  const std::string from = SUITE_SOURCE_DIR "/sample_scenes/study/" + name;
  std::string sim = read_text(from + "/sim.yaml");
  for (const char* what : {"columns: ", "rows: "}) {
    const size_t at = sim.find(what);
    sim.replace(at, sim.find('\n', at) - at, std::string(what) + "12");
  }
  write_file(folder / "sim.yaml", sim);
  EXPECT_EQ(run_command(kBin + "scene-prep " + from + "/scene.yaml -o " + (folder / "scene.h5")).code, 0);
  return folder / "sim.yaml";
}
long lines_of(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(Study, WritesItsResultsAndGoesOn) {
  const TempFolder folder;
  const std::string sim = prepared(folder, "smooth"), out = folder / "study";
  const std::string command = kBin + "dirsig-render " + sim + " --study " + out + " --study-seeds 2 --study-budgets ";
  const CommandResult first = run_command(command + "4,8");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("bias: smallest p"), std::string::npos);
  const std::string before = read_text(out + "/study.csv");
  EXPECT_EQ(lines_of(before), 2 + 2 * 2 * 2);  // two lines of head; budgets, seeds, bands
  const std::string html = read_text(out + "/study.html");
  EXPECT_NE(html.find("<svg"), std::string::npos);
  for (const char* part : {"Where the time goes", "trace %", "sample %", "shade %", "sensor %", "I/O s"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_EQ(html.find("src="), std::string::npos) << "the page must need nothing else";
  EXPECT_NE(read_text(out + "/study.json").find("\"slope_paths\""), std::string::npos);
  // Going on keeps the rows that are there, to the last digit, and adds the new budget.
  const CommandResult second = run_command(command + "4,8,16");
  ASSERT_EQ(second.code, 0) << second.err;
  const std::string after = read_text(out + "/study.csv");
  EXPECT_EQ(after.substr(0, before.size()), before);
  EXPECT_EQ(lines_of(after), 2 + 3 * 2 * 2);
  EXPECT_NE(second.err.find("kept from before"), std::string::npos);
  // A table of another simulation is refused.
  EXPECT_EQ(run_command(command + "4,8 --stop change").code, 1);
}

// The cells of a goniometer are one series a band, though its values make no picture.
TEST(Study, OfAGoniometer) {
  const TempFolder folder;
  prepared(folder, "smooth");
  write_file(
      folder / "sim.yaml",
      "scene: scene.h5\nsky: {radiance: 1, full_sphere: true}\nsensors:\n  - {kind: goniometer, name: brdf, patch: "
      "{origin_m: [-1, -1], size_m: [2, 2]}, height_m: 1, view_zenith_deg: [0, 40], rings: 3, azimuths: 6, paths: 64, "
      "bands: "
      "[{name: a, center_um: 0.55, fwhm_um: 0.02}, {name: b, center_um: 0.6, fwhm_um: 0.02}]}\n");
  const CommandResult r = run_command(kBin + "dirsig-render " + (folder / "sim.yaml") + " --study " +
                                      (folder / "study") + " --study-seeds 2 --study-budgets 256,1024");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("brdf: a: "), std::string::npos) << r.out;
  EXPECT_EQ(lines_of(read_text(folder / "study/study.csv")), 2 + 2 * 2 * 2);
  EXPECT_NE(read_text(folder / "study/reference.img.hdr").find("samples = 36"), std::string::npos);
}

TEST(Method, ThePapersBringsItsRuleOfStopping) {
  const TempFolder folder;
  const std::string command = kBin + "dirsig-render " + prepared(folder, "smooth") + " -o " + (folder / "out");
  const CommandResult paper = run_command(command + " --method paper");
  EXPECT_EQ(paper.code, 0) << paper.err;
  EXPECT_NE((paper.out + paper.err).find("one more path changed its mean"), std::string::npos)
      << paper.out << paper.err;
  const CommandResult planned = run_command(command + " --method paper --stop plan");
  EXPECT_EQ(planned.code, 0) << planned.err;
  EXPECT_EQ((planned.out + planned.err).find("one more path changed its mean"), std::string::npos);
  EXPECT_EQ(run_command(command + " --method papr").code, 2);
  EXPECT_EQ(run_command(command + " --method paper --stop plan --state").code, 2);
}

TEST(Study, RefusesWhatItCannotStudy) {
  const TempFolder folder;
  const std::string sim = prepared(folder, "smooth");
  auto refused = [&](const std::string& arguments, const std::string& message) {
    const CommandResult r = run_command(kBin + "dirsig-render " + sim + " --study " + arguments);
    EXPECT_EQ(r.code, 1) << arguments << "\n" << r.err;
    EXPECT_NE(r.err.find(message), std::string::npos) << r.err;
  };
  const std::string out = folder / "study";
  refused(out + " --study-budgets 0,4", "gives nothing to study");
  refused(out + " --study-budgets 8,4", "do not ascend");
  refused(out + " --study-budgets 4,8s", "all in paths or all in seconds");
  refused("/proc/nowhere", "");
  ASSERT_EQ(run_command(kBin + "dirsig-render " + sim + " --paths 1 -o " + (folder / "one")).code, 0);
  refused(out + " --reference " + (folder / "one/camera_truth.img"), "units");
  refused(out + " --reference " + (folder / "missing.img"), "missing.img");
  // The right units, another size.
  std::string small = read_text(folder / "one/camera.img.hdr");
  small.replace(small.find("lines = 12"), 10, "lines = 6");
  write_file(folder / "one/less.img.hdr", small);
  auto half = read_bytes(folder / "one/camera.img");
  half.resize(half.size() / 2);
  write_file(folder / "one/less.img", half);
  refused(out + "2 --reference " + (folder / "one/less.img"), "pixels");
  // Nothing in the scene, which scene-prep would not have made.
  Scene empty;
  empty.groups.emplace_back();
  empty.groups[0].name = "root";
  write_scene(empty, {}, folder / "scene.h5");
  refused(out + "3", "empty");
  EXPECT_EQ(run_command(kBin + "dirsig-render " + sim + " --study-seeds 3").code, 2);
}

// Other programs' tables become the same kind of page.
TEST(Page, FromATable) {
  const std::string csv = "# a note <&>\nmethod,bytes,l1\naligned,1000,0.1\naligned,2000,0.05\npaper,4000,0.1\n";
  const std::string html = html_of(page_of_csv(csv, "size & error", {"bytes"}, {"l1"}, "method", "c.csv"));
  EXPECT_NE(html.find("a note &lt;&amp;&gt;"), std::string::npos);
  EXPECT_NE(html.find("aligned</text>"), std::string::npos);
  EXPECT_NE(html.find("paper</text>"), std::string::npos);
  // On phones, too: as wide as they are, and no title is cut.
  EXPECT_NE(html.find("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"), std::string::npos);
  const auto title_size = [](size_t length) {
    const std::string svg = svg_of({std::string(length, 'm'), "x", "y", false, false, {}});
    return std::stod(svg.substr(svg.find("font-size=\"", svg.find("y=\"20\"")) + 11));
  };
  EXPECT_EQ(title_size(20), 15);
  EXPECT_LE(title_size(80) * 0.62 * 80, 640 - 78);
  EXPECT_THROW(page_of_csv(csv, "t", {"byte"}, {"l1"}, "", "c.csv"), Error);
  EXPECT_THROW(page_of_csv("a,b\n1\n", "t", {"a"}, {"b"}, "", "c.csv"), Error);
}

}  // namespace
}  // namespace suite::test::study_test
