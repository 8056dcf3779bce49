// What a job would take on several ranks: `--dry-run --ranks`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "support/driving_car.h"
#include "support/programs_kit.h"

namespace suite::forecast_test {
namespace {

using testing::HasSubstr;

struct Row {
  int ranks = 0;
  double blocks, load, build, prepare, trace, gather, write, whole, tracing, all;
};

class Forecast : public ProgramsTest<Forecast> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    prepare(kDrivingCar);
    write_file(*folder_ / "sim.yaml",
               std::string_view(kDay + camera("a", 40, 27, 2, "32") + camera("small", 5, 3, 8, "2000") +
                                camera("t", 33, 20, 7, "{min: 8, max: 600, relative_error: 0.01}")));
    write_file(*folder_ / "large.yaml", std::string_view(kDay + camera("a", 256, 256, 2, "64")));
  }
  static std::vector<Row> rows(const std::string& arguments) {
    const CommandResult r = run("dirsig-render " + arguments);
    EXPECT_EQ(r.code, 0) << r.err;
    std::vector<Row> rows;
    std::istringstream lines(r.out);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      Row x;
      if (words >> x.ranks >> x.blocks >> x.load >> x.build >> x.prepare >> x.trace >> x.gather >> x.write >> x.whole >>
          x.tracing >> x.all)
        rows.push_back(x);
    }
    return rows;
  }
};

TEST_F(Forecast, HasARowForEachNumberOfRanks) {
  const std::vector<Row> r = rows("sim.yaml -o nowhere --dry-run --ranks 1,2,64 -j 1 -q");
  ASSERT_EQ(r.size(), 3u);
  EXPECT_EQ(r[0].tracing, 100);
  EXPECT_EQ(r[0].gather, 0);
  // 5 x 4 blocks, one, and 5 x 3 of another camera.
  EXPECT_EQ(r[0].blocks, 36);
  EXPECT_EQ(r[2].blocks, 0.5625);
  EXPECT_LT(r[1].trace, 0.8 * r[0].trace);
  EXPECT_LT(r[2].tracing, 100) << "fewer blocks than threads";
  for (const Row& x : r) {
    EXPECT_GT(x.trace, 0);
    EXPECT_NEAR(x.whole, x.load + x.build + x.prepare + x.trace + x.gather + x.write, 0.02 * x.whole);
    EXPECT_LE(x.all, x.tracing);
  }
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "nowhere")) << "a dry run writes nothing";
}

// 1024 blocks, of which half are run; every block looks at much the same.
TEST_F(Forecast, OfManyBlocksRunsFew) {
  const std::vector<Row> r = rows("large.yaml --dry-run --ranks 1,16,2048 -j 1 -q");
  ASSERT_EQ(r.size(), 3u);
  EXPECT_NEAR(r[0].trace, 16 * r[1].trace, 0.1 * r[0].trace);
  EXPECT_GT(r[1].tracing, 90);
  EXPECT_LT(r[2].tracing, 50);
}

TEST_F(Forecast, WhatTalkingCostsIsGiven) {
  const double own = rows("sim.yaml --dry-run --ranks 4 -j 1 -q").at(0).gather,
               slow = rows("sim.yaml --dry-run --ranks 4 -j 1 -q --link 2,1e4,1,1").at(0).gather;
  EXPECT_GT(slow, own + 0.02) << "messages of 10 ms";
}

TEST_F(Forecast, BadUsageIsRefused) {
  for (const auto& [arguments, message] :
       std::vector<std::pair<std::string, std::string>>{{"--dry-run --ranks 0", "whole numbers from 1 to 65536"},
                                                        {"--dry-run --ranks 2,x", "found '2,x'"},
                                                        {"--dry-run --ranks 2,", "whole numbers"},
                                                        {"--ranks 2", "mpirun -n N"},
                                                        {"--dry-run --ranks 2 --time 10s", "leave out --time"},
                                                        {"--dry-run --ranks 2 --part 1/2", "leave out --part"},
                                                        {"--dry-run --ranks 2 --resume", "leave out --resume"},
                                                        {"--dry-run --link 1,1,1,1", "belongs to --ranks"},
                                                        {"--dry-run --ranks 2 --link 1,1,1", "four positive"}}) {
    const CommandResult r = run("dirsig-render sim.yaml -q " + arguments);
    EXPECT_EQ(r.code, 2) << arguments;
    EXPECT_THAT(r.err, HasSubstr(message)) << arguments;
  }
}

}  // namespace
}  // namespace suite::forecast_test
