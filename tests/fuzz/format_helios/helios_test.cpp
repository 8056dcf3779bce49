// Damaged scenes of HELIOS++: a text that is YAML, or one Error.
#include "formats/helios/helios.h"
#include "base/params.h"
#include "formats/helios/survey.h"
#include "formats/helios/xyz.h"
#include "scene/issues.h"
#include "support/fuzz.h"
#include "support/helios_kit.h"

namespace suite::format_helios_helios_test {
namespace {

void read_and_check(std::span<const std::byte> bytes) {
  Report report(scene_issues());
  const HeliosText made = parse_helios({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzz.xml",
                                       {.grid_of =
                                            [](const std::string&) {
                                              return HeliosGrid{{0, 0}, {1, 1}, {}};
                                            },
                                        .text_of = [](const std::string&) { return std::string("0 0 0\n3 2 1\n"); },
                                        .heights_of =
                                            [](const std::string&) {
                                              return HeliosHeights{{{0, 0}, {1, 1}, {}}, 2, 2, {1, NAN, 2, 3}};
                                            },
                                        .mesh_of =
                                            [](const std::string&) {
                                              SourceMesh mesh;
                                              mesh.positions = {{0, 0, 0}, {1, 2, 3}, {3, 1, 2}};
                                              mesh.indices = {0, 1, 2};
                                              return mesh;
                                            }},
                                       report);
  Params::parse_made(made.yaml, "fuzz.xml", made.origins);
}

const std::vector<std::string> kWords{
    "<part>",   "</part>", "<filter type=\"scale\">", "1e999", "nan", ";;", "&#10;", "\" ", "objloader", "<scene/>",
    "onGround", "-1"};

TEST(FuzzHelios, Scene) {
  test::fuzz(test::bytes_of(test::helios_scene()), read_and_check, 1, test::kMutations, kWords);
}

TEST(FuzzHelios, Survey) {
  const std::string text =
      R"(<document><scannerSettings id="b" pulseFreq_hz="1000" scanFreq_hz="20"/>
<scanner id="s" optics="risley" pulseLength_ns="4" rotorFreq1_Hz="-77" rotorFreq2_Hz="121" angle1_deg="-29" angle2_deg="18" refrIndex1="1.5" refrIndex2="1.5">
<beamOrigin z="0.2"><rot axis="y" angle_deg="10"/></beamOrigin><channels><channel id="a"><incidentBeam x="0" y="1" z="0"/></channel></channels></scanner>
<platform id="p" type="linearpath"><scannerMount z="0.7"><rot axis="x" angle_deg="-90"/></scannerMount></platform>
<survey scene="x.xml#s" platform="#p" scanner="#s"><leg><platformSettings x="0" y="5" z="400" movePerSec_m="50"/><scannerSettings template="b" headRotateStop_deg="9"/></leg>
<leg><platformSettings x="20" y="45" z="400"/></leg></survey></document>)";
  test::fuzz(
      test::bytes_of(text),
      [](std::span<const std::byte> bytes) {
        const HeliosSurvey made =
            parse_helios_survey({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzz.xml",
                                {[](const std::string& name) -> HeliosSurveyFiles::Named {
                                   throw Error(Where{name, 0, 0, {}, -1}, "is not there");
                                 },
                                 [](const std::string& scene) { return scene + ".h5"; }});
        Params::parse_made(made.text.yaml, "fuzz.xml", made.text.origins);
      },
      1, test::kMutations, kWords);
}

TEST(FuzzHelios, Points) {
  test::fuzz(
      test::bytes_of(std::string("# x y z r g b\n0.5 1.25 -3 10 20 30\n1.5;2;7\n//\n2 2 2\n")),
      [](std::span<const std::byte> bytes) {
        const helios::Cubes cubes =
            helios::cubes_of_xyz({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzz.xyz", ";", 0.5);
        EXPECT_GE(cubes.points, cubes.centres.size());
        EXPECT_GT(cubes.centres.size(), size_t{0});
      },
      1, test::kMutations, kWords);
}

}  // namespace
}  // namespace suite::format_helios_helios_test
