// --memory as a user meets it: the same bytes with little room, plain and packed, any threads; bad values refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/driving_car.h"
#include "support/programs_kit.h"

namespace suite::memory_test {
namespace {

using testing::HasSubstr;

class Memory : public ProgramsTest<Memory> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    prepare(kDrivingCar);
    const CommandResult packed = run("scene-prep scene.yaml -o packed.h5 --compress deflate:1 -q");
    ASSERT_EQ(packed.code, 0) << packed.err;
    const std::string sim = kDay + camera("a", 40, 27, 2, "16");
    write_file(*folder_ / "sim.yaml", std::string_view(sim));
    ASSERT_NE(sim.find("scene.h5"), std::string::npos);
    write_file(*folder_ / "packed.yaml", std::string_view(replaced(sim)));
    const CommandResult r = run("dirsig-render sim.yaml -o whole -q");
    ASSERT_EQ(r.code, 0) << r.err;
  }
  static std::string replaced(std::string text) { return text.replace(text.find("scene.h5"), 8, "packed.h5"); }
};

TEST_F(Memory, ResultsAreTheSame) {
  int n = 0;
  for (const char* how : {"sim.yaml --memory 1GiB", "sim.yaml --memory 1KiB", "sim.yaml --memory 1KiB -j 5",
                          "packed.yaml --memory 1KiB", "packed.yaml"}) {
    const std::string out = strf("out%d", n++);
    const CommandResult r = run(std::string("dirsig-render ") + how + " -o " + out);
    ASSERT_EQ(r.code, 0) << r.err;
    for (const char* file : {"a.img", "a_error.img", "a_truth.img"})
      EXPECT_EQ(read_bytes(*folder_ / ("whole/" + std::string(file))), read_bytes(*folder_ / (out + "/" + file)))
          << how << " " << file;
    if (std::string(how).find("1KiB") != std::string::npos) {
      EXPECT_THAT(r.err, HasSubstr("it is held all the same, alone [DR901]"));
    }
  }
}

TEST_F(Memory, BadValuesAreRefusedAndTheForecastIsTold) {
  for (const char* wrong : {"5", "0MiB", "-3MiB", "many", "5TB", "1e30GiB"}) {
    const CommandResult r = run(std::string("dirsig-render sim.yaml -o never --memory=") + wrong);
    EXPECT_EQ(r.code, 2) << wrong;
    EXPECT_THAT(r.err, HasSubstr("--memory")) << wrong;
  }
  const CommandResult r = run("dirsig-render sim.yaml --dry-run --memory 1KiB");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, HasSubstr("of the ray tracer's structures"));
  EXPECT_THAT(r.out, HasSubstr("about 0 of them fit"));
}

}  // namespace
}  // namespace suite::memory_test
