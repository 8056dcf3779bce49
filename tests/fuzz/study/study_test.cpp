// Damaged tables of studies, which a later study goes on from: rows or one located Error.
#include "study/rows.h"
#include "support/fuzz.h"

namespace suite::study_test {

TEST(FuzzStudy, Table) {
  StudyRow row;
  row.budget = 8, row.seed = 3, row.seconds = 0.5, row.paths = 1e4;
  row.ended = "by the plan";
  row.figures.series = "a";
  const std::string text = rows_to_csv({row, row, row}, "id");
  test::fuzz(test::bytes_of(text),
             [](std::span<const std::byte> b) {
               rows_from_csv({reinterpret_cast<const char*>(b.data()), b.size()}, "id", "study.csv");
             },
             1, test::kMutations, {",", "\n", "nan", "-1", "1e999", "\"", "id", "#"});
}

}  // namespace suite::study_test
