// What --max-error takes when the frame that codes best cannot keep the promise.
#include <gtest/gtest.h>

#include <cmath>

#include "formats/merl/merl.h"
#include "sqt_fit/fit.h"
#include "sqt_fit/lobe_detection.h"

namespace suite::sqt::target_test {
namespace {

// A rough surface whose wide lobe leans towards the horizon, with a bump over half vectors; three channels alike.
class Leaning final : public Function {
 public:
  Leaning() { info_.wavelength_um = {0.65, 0.55, 0.45}; }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    const double along = -(in.x * out.x + in.y * out.y), t = std::acos(std::min(1.0, normalized(in + out).z)) / 0.15;
    for (double& v : f) v = in.z > 0 ? 0.08 * std::exp(2.5 * along) + 0.05 * std::exp(-t * t) : NAN;
  }

 private:
  Info info_;
};

FitResult fitted(const Function& function, const FitTarget& target, std::optional<LobeFrame> frame = {}) {
  static const Reference reference(function, 20000);
  AlignedSource::Options options;
  options.frame = frame;
  return fit_to(function, reference, options, target, [](const AlignedSource&) { return size_t{1000}; });
}
TEST(FitTarget, StepsOverHalfVectorsAreCodedOverHalfVectors) {
  // In the MERL layout the table has steps. The direct frame codes its shape best, and is kept while that is all that
  // is asked for; close to the steps it can no longer keep its promise, and half vectors can.
  const MerlTable table("leaning", 180, merl_raw(Leaning()));
  ASSERT_EQ(detect_frame(table), LobeFrame::direct);
  EXPECT_EQ(fitted(table, {0.03, 0}).source->layout().frame, LobeFrame::direct);
  constexpr double kTight = 0.0134;
  EXPECT_FALSE(fitted(table, {kTight, 0}, LobeFrame::direct).error_met);
  const FitResult best = fitted(table, {kTight, 0});
  EXPECT_TRUE(best.error_met);
  EXPECT_LE(best.l1, kTight);
  EXPECT_EQ(best.source->layout().frame, LobeFrame::half);
}

}  // namespace
}  // namespace suite::sqt::target_test
