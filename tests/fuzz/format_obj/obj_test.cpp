// Damaged OBJ files through reading, checking, repairing, closing of holes and decimation: findings or one Error, never
// anything else.
#include "formats/obj/obj.h"

#include <cmath>

#include "base/files.h"
#include "formats/obj/mtl.h"
#include "mesh/check.h"
#include "mesh/repair.h"
#include "scene/issues.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_obj_obj_test {

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

// Libraries of materials, of which a mesh names two.
TEST(FuzzObj, Mtl) {
  const TempFolder folder;
  Report unheard(scene_issues());
  ObjLook look;
  const SourceMesh mesh = parse_obj(
      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl leaf\nf 1/1 2/2 3/3\nusemtl red\nf 1/1 "
      "3/3 "
      "2/2\n",
      "fuzz.obj", unheard, &look);
  write_file(folder / "a b.png", std::string_view("no picture"));
  const auto resolve = [&](const std::string& name) {
    if (name == "m.mtl") return folder / "m.mtl";
    if (name == "a b.png") return folder / "a b.png";
    throw Error("'" + printable(name) + "': no such file");
  };
  const auto read = [&](std::span<const std::byte> bytes) {
    test::put_file(folder / "m.mtl", bytes);
    SourceMesh laid = mesh;
    Report report(scene_issues());
    for (const SourceMaterial& m : read_mtl(laid, look, resolve, report))
      for (const double c : m.rgb)
        if (!(c >= 0 && c <= 1)) throw std::runtime_error("a colour that is none came out");
    for (const uint32_t v : laid.indices)
      if (v >= laid.positions.size()) throw std::runtime_error("an index that is not there came out");
    if (laid.uvs.size() != 2 * laid.positions.size()) throw std::runtime_error("a texture coordinate is missing");
    for (const float c : laid.uvs)
      if (!std::isfinite(c)) throw std::runtime_error("a texture coordinate that is none came out");
  };
  test::fuzz(
      test::bytes_of(
          "# looks\nnewmtl leaf\nKa 0 0 0\nKd 0.5 1 1\nNs 12\nd 0.5\nillum 2\nKs 0.1 0.1 0.1\nmap_Kd -s 2 3 1 "
          "-o 0.25 0.5 -clamp on -mm 0 1 a b.png\nmap_Bump -bm 0.3 a b.png\n\nnewmtl red\nKd 0.6 0.1 0.1\nKe 1 0 0\n"),
      read, 3, test::kMutations,
      {"nan", "inf", "1e308", "-1", "1e-400", " -s ", " -o ", " -t", " -clamp", " -mm", "\nnewmtl ", "\nKd ",
       "\nmap_Kd ", "leaf", "red", "\r", "#", "a b.png", "99999999999999999999"});
}

}  // namespace suite::format_obj_obj_test
