// The main program of all tests of ours: GoogleTest's, and --source=PLACE for programs of several sources, which runs
// the tests of the source whose path ends so, and fails when there are none. --gtest_filter is then as it was.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <string_view>

namespace {

// The names of all tests of one source as GoogleTest's filter has them; empty when there are none.
std::string filter_of(std::string_view source) {
  std::string filter;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestInfo& test = *suite.GetTestInfo(t);
      const std::string_view file = test.file();
      if (!file.ends_with(source) || (file.size() > source.size() && file[file.size() - source.size() - 1] != '/'))
        continue;
      filter += std::string(filter.empty() ? "" : ":") + suite.name() + '.' + test.name();
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  constexpr std::string_view option = "--source=";
  for (int a = 1; a < argc; ++a) {
    const std::string_view word = argv[a];
    if (!word.starts_with(option)) {
      std::fprintf(stderr, "%s: unknown option '%s'; there are --source=PLACE and those of --help\n", argv[0], argv[a]);
      return 2;
    }
    const std::string filter = filter_of(word.substr(option.size()));
    if (filter.empty()) {
      std::fprintf(stderr, "%s: no test is in '%s'\n", argv[0], argv[a] + option.size());
      return 2;
    }
    if (testing::GTEST_FLAG(filter) == "*") testing::GTEST_FLAG(filter) = filter;
  }
  return RUN_ALL_TESTS();
}
