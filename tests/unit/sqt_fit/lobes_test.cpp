// Frames and azimuths follow from the function: lobes in the mirror direction, back to the viewer, both, off-specular,
// at a fixed place and none; and the frame that is found is the one that codes best.
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "sqt_fit/fit.h"
#include "sqt_fit/lobe_detection.h"
#include "support/sqt_examples.h"

namespace suite::sqt::lobes_test {
namespace {

using test::Analytic;

double lobe(Dir out, Dir in, double width) { return 0.3 * (test::glossy_value(out, in, width) - 0.1); }
Dir across(Dir d) { return {-d.x, -d.y, d.z}; }

// GGX without Fresnel: its peak leaves the mirror direction towards the horizon as the view gets low, until the horizon
// cuts it.
double rough_metal(Dir out, Dir in, double alpha) {
  const Dir h = normalized(out + in);
  const double a2 = alpha * alpha, d = 1 + (a2 - 1) * h.z * h.z;
  auto lambda = [&](double z) { return 0.5 * (std::sqrt(1 + a2 * (1 - z * z) / (z * z)) - 1); };
  return a2 / (kPi * d * d) / (1 + lambda(out.z) + lambda(in.z)) / (4 * out.z * in.z);
}

struct Case {
  const char* name;
  Analytic function;
};
std::vector<Case> cases() {
  return {{"mirror", Analytic([](Dir o, Dir i) { return 0.05 + lobe(o, i, 0.12); })},
          {"retro", Analytic([](Dir o, Dir i) { return 0.05 + lobe(across(o), i, 0.12); })},
          {"both", Analytic([](Dir o, Dir i) { return 0.05 + lobe(o, i, 0.15) + 0.4 * lobe(across(o), i, 0.15); })},
          {"off_specular", Analytic([](Dir o, Dir i) { return rough_metal(o, i, 0.45); })},
          {"fixed", Analytic([](Dir, Dir i) { return 0.02 + std::exp(-(1 - i.z * i.z) / 0.02); })},
          {"none", Analytic([](Dir o, Dir i) { return 0.1 + 0.05 * o.z * i.z; })}};
}

TEST(SqtLobes, FramesAreFound) {
  const LobeFrame expected[] = {LobeFrame::half,   LobeFrame::retro,  LobeFrame::direct,
                                LobeFrame::direct, LobeFrame::direct, LobeFrame::half};
  const auto all = cases();
  for (size_t i = 0; i < all.size(); ++i) {
    std::printf("%-13s change with the view: half %.4f, retro %.4f, direct %.4f\n", all[i].name,
                change_with_view(all[i].function, LobeFrame::half), change_with_view(all[i].function, LobeFrame::retro),
                change_with_view(all[i].function, LobeFrame::direct));
    EXPECT_EQ(detect_frame(all[i].function), expected[i]) << all[i].name;
  }
  EXPECT_EQ(detect_frame(Analytic([](Dir, Dir) { return 0.0; })), LobeFrame::half);
  EXPECT_EQ(detect_frame(Analytic([](Dir, Dir) { return std::nan(""); })), LobeFrame::half);
}

// What a frame costs: bytes, brought to one error by l1 ~ bytes^(-3/4), as fits of one function at several qualities
// go.
double cost(const Function& function, LobeFrame frame) {
  AlignedSource::Options options = test::small_options();
  options.views = 0;
  options.max_order = 6;
  options.frame = frame;
  const AlignedFit fit = encode_aligned(AlignedSource(function, options), 0.2);
  const double l1 = Reference(function, 6000).l1(*make_bundle(fit.data));
  std::printf("  %zu bytes at %.2f %%", fit.sheets_bytes.size(), 100 * l1);
  return static_cast<double>(fit.sheets_bytes.size()) * std::pow(l1, 4.0 / 3);
}

TEST(SqtLobes, TheFrameFoundCodesBest) {
  for (const Case& c : cases()) {
    if (std::string_view(c.name) == "none") continue;  // a few dozen bytes in any frame
    const LobeFrame found = detect_frame(c.function);
    double best = 1e300, mine = 0;
    std::printf("%-13s", c.name);
    for (const LobeFrame frame : {LobeFrame::half, LobeFrame::retro, LobeFrame::direct}) {
      const double here = cost(c.function, frame);
      best = std::min(best, here);
      if (frame == found) mine = here;
    }
    std::printf("\n");
    EXPECT_LE(mine, 1.2 * best) << c.name;
  }
}

// A brushed surface whose half-vector lobe does not turn with the view takes the fewest azimuths; one whose colour
// turns quickly with the view's azimuth needs many; and what is chosen keeps the error between them.
TEST(SqtLobes, AzimuthsFollowTheFunction) {
  const Analytic brushed(
      [](Dir o, Dir i) {
        const Dir h = normalized(o + i);
        return 0.05 + std::exp(-(h.x * h.x / 0.16 + h.y * h.y / 0.01) / (h.z * h.z));
      },
      1, Domain::hemisphere, Quantity::bsdf, false);
  const Analytic ribbed([](Dir o, Dir) { return 0.1 * (1.2 + std::sin(3 * std::atan2(o.y, o.x))); }, 1,
                        Domain::hemisphere, Quantity::bsdf, false);
  const size_t few = count_azimuths(brushed, LobeFrame::half, 0.015),
               many = count_azimuths(ribbed, LobeFrame::half, 0.015);
  std::printf("azimuths: brushed %zu, ribbed %zu\n", few, many);
  EXPECT_EQ(few, 16u);  // the least
  EXPECT_GE(many, 24u);
  const Reference reference(ribbed, 8000);
  AlignedSource::Options options = test::small_options();
  options.views = 2;
  options.base_order = 2;
  options.max_order = 4;
  const double l1 = reference.l1(*make_bundle(encode_aligned(AlignedSource(ribbed, options), 0.05).data));
  std::printf("ribbed: l1 %.2f %%\n", 100 * l1);
  EXPECT_LT(l1, 0.05);
}

}  // namespace
}  // namespace suite::sqt::lobes_test
