// Damaged scenes of HELIOS++: a text that is YAML, or one Error.
#include "formats/helios/helios.h"
#include "base/params.h"
#include "scene/issues.h"
#include "support/fuzz.h"
#include "support/helios_kit.h"

namespace suite {
namespace {

void read_and_check(std::span<const std::byte> bytes) {
  Report report(scene_issues());
  const HeliosText made = parse_helios(
      {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzz.xml",
      [](const std::string&) {
        return std::array<double, 4>{0, 0, 1, 1};
      },
      report);
  Params::parse_made(made.yaml, "fuzz.xml", made.origins);
}

const std::vector<std::string> kWords{
    "<part>", "</part>", "<filter type=\"scale\">", "1e999", "nan", ";;", "&#10;", "\" ", "objloader", "<scene/>"};

TEST(FuzzHelios, Scene) { test::fuzz(test::bytes_of(test::helios_scene()), read_and_check, 1, 20000, 4, kWords); }

}  // namespace
}  // namespace suite
