// What a batch of slabs refuses, and that its elements do not feel each other.
#include "heat/slab_batch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/heat_kit.h"
#include "support/message_of.h"
#include "support/slab_kit.h"

namespace suite::slab_batch_test {
namespace {

using namespace test;
using testing::HasSubstr;

TEST(SlabBatch, RefusesWhatItCannotDo) {
  const auto make = [](std::vector<SlabLayer> layers, size_t elements) {
    return message_of([&] { SlabBatch(layers, elements); });
  };
  const SlabLayer good = uniform(0.1, 1000, 1000, 1);
  EXPECT_THAT(make({}, 1), HasSubstr("without a layer"));
  EXPECT_THAT(make({good}, 0), HasSubstr("without an element"));
  EXPECT_THAT(make({uniform(-1, 1000, 1000, 1)}, 1), HasSubstr("thickness"));
  SlabBatch batch({good}, 2);
  EXPECT_THAT(message_of([&] { batch.start(0, -5); }), HasSubstr("-5 K"));
  EXPECT_THAT(message_of([&] { batch.step(1, steady({{{NAN, 0, 0}, {}}})); }), HasSubstr("no loads"));
  EXPECT_THAT(message_of([&] { batch.step(1, steady({{{0, -1, 0}, {}}})); }), HasSubstr("no loads"));
  EXPECT_EQ(message_of([&] { batch.step(1, steady({{{0, 1, 0}, {}}})); }), "no error");
  // Ten kilowatts that are drawn for a day are more than it holds: next to nothing is left, which exchanges of elements
  // refuse (change_in_kelvin).
  batch.step(86400, steady({{{-1e4, 0, kStefanBoltzmann}, {}}}));
  EXPECT_LT(batch.top(0), 1e-3);
}

// The same element alone and among wild neighbours.
TEST(SlabBatch, ElementsDoNotFeelEachOther) {
  const FaceBalance face = facing(0.9, 310);
  std::vector<std::pair<FaceBalance, FaceBalance>> many;
  for (int e = 0; e < 40; ++e) many.push_back({e == 17 ? face : facing(1, 100 + 40 * e), {}});
  SlabBatch alone({uniform(0.1, 1000, 1000, 1)}, 1), among({uniform(0.1, 1000, 1000, 1)}, 40);
  alone.start(0, 290);
  among.start(0, 290);
  for (int k = 0; k < 10; ++k) {
    alone.step(600, steady({{face, {}}}));
    among.step(600, steady(many));
  }
  for (size_t i = 0; i < alone.nodes(); ++i) EXPECT_NEAR(alone.kelvin(0, i), among.kelvin(17, i), 1e-9);
  EXPECT_NEAR(alone.estimate(0), among.estimate(17), 1e-12);
}

// Steps before what is asked for are cut eightfold; the others stay, and so does the time.
TEST(SlabBatch, RefinesStepsBeforeWhatIsAsked) {
  const std::vector<double> steps{600, 600, 1800}, asked{700, 1200};  // 700 s is no end of a step
  const std::vector<double> refined = refine_steps(0, steps, asked, 1);
  EXPECT_THAT(refined,
              testing::Pointwise(testing::DoubleNear(1e-9), {600.0, 525.0, 65.625, 8.203125, 1.171875, 1800.0}));
}

// The estimate of an element is of its own error: within a factor of the difference to much shorter steps.
TEST(SlabBatch, EstimateTellsTheErrorOfAStep) {
  SlabBatch long_step({uniform(0.1, 1000, 1000, 1)}, 2), short_steps({uniform(0.1, 1000, 1000, 1)}, 2);
  const auto loads = steady({{{800, 10, 0}, {}}, {{8, 10, 0}, {}}});
  for (SlabBatch* b : {&long_step, &short_steps}) {
    b->start(0, 290);
    for (int k = 0; k < 100; ++k) b->step(10, loads);
  }
  long_step.step(1000, loads);
  for (int k = 0; k < 1000; ++k) short_steps.step(1, loads);
  for (size_t e = 0; e < 2; ++e) {
    double error = 0;
    for (size_t i = 0; i < long_step.nodes(); ++i)
      error = std::fmax(error, std::fabs(long_step.kelvin(e, i) - short_steps.kelvin(e, i)));
    std::printf("estimate %.4f K of an error of %.4f K\n", long_step.estimate(e), error);
    EXPECT_GT(long_step.estimate(e), 0.3 * error);
    EXPECT_LT(long_step.estimate(e), 10 * error);
  }
}

}  // namespace
}  // namespace suite::slab_batch_test
