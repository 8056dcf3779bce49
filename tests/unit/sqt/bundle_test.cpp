// Values and densities are those of the pair of directions and the bundle asked, in whatever order and by whatever
// thread: a thread keeps its last answer.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "support/sqt_examples.h"

namespace suite::sqt::bundle_test {
namespace {

std::shared_ptr<const Bundle> fitted(double width) { return make_bundle(test::small_fit(test::glossy(width)).data); }

TEST(Bundle, AnswersForThePairAsked) {
  auto narrow = fitted(0.1);
  const auto wide = fitted(0.4);
  const Dir out = dir_from_angles(0.5, 0.2), mirror = dir_from_angles(0.5, 0.2 + kPi), other = dir_from_angles(0.9, 1);
  const double at_mirror = narrow->value(out, mirror, 0), at_other = narrow->value(out, other, 0),
               density = narrow->pdf(out, mirror, 0), of_wide = wide->value(out, mirror, 0);
  ASSERT_NE(at_mirror, at_other);
  ASSERT_NE(at_mirror, of_wide);
  for (int n = 0; n < 2; ++n) {
    EXPECT_EQ(narrow->value(out, mirror, 0), at_mirror);
    EXPECT_EQ(narrow->pdf(out, mirror, 0), density);
    EXPECT_EQ(wide->value(out, mirror, 0), of_wide);
    EXPECT_EQ(narrow->value(out, other, 0), at_other);
    EXPECT_EQ(narrow->value(out, -mirror, 0), 0);  // nothing there, and nothing is left of it
    EXPECT_EQ(narrow->pdf(out, -mirror, 0), 0);
  }
  std::thread([&] { EXPECT_EQ(narrow->value(out, mirror, 0), at_mirror); }).join();
  // A bundle that takes the place of one that is gone is another one.
  EXPECT_EQ(narrow->value(out, mirror, 0), at_mirror);
  narrow.reset();
  EXPECT_EQ(fitted(0.4)->value(out, mirror, 0), of_wide);
}

// All channels at once, by groups, are to the last bit what each is by itself, however many there are.
TEST(Bundle, TellsAllChannelsAsEach) {
  const Dir out = dir_from_angles(0.5, 0.2);
  for (const size_t channels : {2u, 9u}) {
    test::Analytic glossy = test::glossy(0.3, channels);
    for (size_t c = 0; c < channels; ++c) glossy.info().wavelength_um[c] = 0.7 - 0.02 * static_cast<double>(c);
    const auto bundle = make_bundle(test::small_fit(glossy).data);
    ASSERT_EQ(bundle->channels(), channels);
    std::vector<double> f(channels), p(channels), before(channels);
    for (const Dir& in : {dir_from_angles(0.5, 0.2 + kPi), dir_from_angles(0.9, 1), dir_from_angles(1.5, 4)}) {
      bundle->value(out, in, f);
      bundle->pdf(out, in, p);
      for (size_t c = 0; c < channels; ++c) {
        EXPECT_EQ(bundle->value(out, in, c), f[c]) << c << " of " << channels;
        EXPECT_EQ(bundle->pdf(out, in, c), p[c]) << c << " of " << channels;
        EXPECT_GT(f[c], 0);
        EXPECT_NE(f[c], c > 0 ? f[c - 1] : 0) << "channels that are alike show nothing";
      }
      EXPECT_NE(f, before);
      before = f;
    }
  }
}

}  // namespace
}  // namespace suite::sqt::bundle_test
