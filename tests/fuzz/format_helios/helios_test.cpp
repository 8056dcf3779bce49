// Damaged scenes of HELIOS++: a text that is YAML, or one Error.
#include "formats/helios/helios.h"
#include "base/params.h"
#include "formats/helios/xyz.h"
#include "scene/issues.h"
#include "support/fuzz.h"
#include "support/helios_kit.h"

namespace suite {
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
}  // namespace suite
