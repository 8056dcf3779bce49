// Every legal-but-odd and malformed file of tinyobjloader's own tests has a documented outcome: tests/data/odd/<file>
// is read and checked, and what is found must be tests/data/odd_reports/<file>.txt. A missing report fails and leaves a
// candidate beside the test's working folder. MTL files are never opened by scene-prep; read as OBJ they hold no face.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/files.h"
#include "formats/obj/obj.h"
#include "mesh/check.h"
#include "scene/issues.h"

namespace suite::format_obj_odd_obj_test {
namespace {

std::vector<std::string> files() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SUITE_TEST_DATA "/odd"))
    if (entry.path().filename() != "LICENSE") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

class OddObj : public ::testing::TestWithParam<std::string> {};

TEST_P(OddObj, HasItsDocumentedOutcome) {
  const std::string name = GetParam();
  Report report(scene_issues());
  std::string outcome;
  try {
    Draft draft;
    draft.geometry.resize(1);
    draft.geometry[0].mesh = parse_obj(read_text(SUITE_TEST_DATA "/odd/" + name), name, report);
    check_draft_meshes(draft, {}, false, report);
    outcome = report.text() + strf("%zu vertices, %zu triangles, %zu runs\n", draft.geometry[0].mesh.positions.size(),
                                   draft.geometry[0].mesh.indices.size() / 3, draft.geometry[0].mesh.runs.size());
  } catch (const Error& e) {
    outcome = std::string(e.what()) + "\n";
  }
  const std::string expected = SUITE_TEST_DATA "/odd_reports/" + name + ".txt";
  if (!file_exists(expected)) {
    write_file(name + ".txt", outcome);
    FAIL() << "no expected report for " << name << "; a candidate was written to "
           << std::filesystem::absolute(name + ".txt");
  }
  EXPECT_EQ(outcome, read_text(expected));
}

INSTANTIATE_TEST_SUITE_P(All, OddObj, ::testing::ValuesIn(files()), [](const auto& row) {
  std::string name = row.param;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

}  // namespace
}  // namespace suite::format_obj_odd_obj_test
