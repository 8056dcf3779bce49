// Damaged OBJ files through reading, checking, repairing, closing of holes and decimation: findings or one Error, never
// anything else.
#include "formats/obj/obj.h"
#include "base/files.h"
#include "mesh/check.h"
#include "mesh/repair.h"
#include "scene/issues.h"
#include "support/fuzz.h"

namespace suite {

namespace {
void read_and_check(std::span<const std::byte> bytes) {
  Report report(scene_issues());
  Draft draft;
  draft.geometry.resize(1);
  draft.geometry[0].mesh = parse_obj({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzz.obj", report);
  const SourceMesh& m = draft.geometry[0].mesh;
  for (const uint32_t v : m.indices)
    if (v >= m.positions.size()) throw std::runtime_error("an index that is not there came out");
  if (!m.normals.empty() && m.normals.size() != m.positions.size()) throw std::runtime_error("a normal is missing");
  check_draft_meshes(draft, {}, false, report);
  draft.geometry[0].fill_holes = 12;
  draft.geometry[0].decimate = DecimationRule{0.3, 0.05};
  check_draft_meshes(draft, {}, true, report);
}
const std::vector<std::string> kWords{
    "\nf 1 2 3", "\nf -1 -2 -3",         "/",    "//", "0",    "-0",       "nan",       "inf",        "1e308",
    "1e-400",    "99999999999999999999", "\\\n", "\r", "\ng ", "\nusemtl", "\nv 0 0 0", "\nvn 0 0 0", "\nvt",
    "#"};
}  // namespace

TEST(FuzzObj, Cube) {
  test::fuzz(test::bytes_of(read_text(SUITE_TEST_DATA "/odd/issue-138.obj")), read_and_check, 1, test::kMutations,
             kWords);
}
TEST(FuzzObj, Polygons) {
  test::fuzz(test::bytes_of(read_text(SUITE_TEST_DATA "/odd/issue-319-002.obj")), read_and_check, 2, test::kMutations,
             kWords);
}

}  // namespace suite
