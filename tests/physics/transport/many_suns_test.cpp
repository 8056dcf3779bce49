// Many suns at once (Capture::BinBy::sun): each bin is the picture under its own sun, whatever else the job holds.
#include <gtest/gtest.h>

#include "tests/support/radiometry_kit.h"

namespace suite::many_suns_test {
namespace {

using namespace suite::test;

// Looks down at one place in captures that each have suns of their own, of one state.
class Suns final : public RaySensor {
 public:
  explicit Suns(const std::vector<std::vector<Dir>>& suns)
      : RaySensor({{{0, 0, 5}, {0, 0, -1}, 0}}, one_band(), 8, 0.01, 1) {
    Task task{"suns", {}, {}};
    for (const auto& of : suns) {
      Capture c = RaySensor::tasks()[0].captures[0];
      c.bin_by = Capture::BinBy::sun;
      c.suns = of;
      c.bins = static_cast<uint32_t>(of.size());
      task.captures.push_back(c);
    }
    own_.push_back(std::move(task));
  }
  std::span<const Task> tasks() const override { return own_; }
  void accept(CaptureResult&& r) override { results.push_back(std::move(r)); }
  std::vector<CaptureResult> results;

 private:
  std::vector<Task> own_;
};

// Bug: captures of one state share their pipeline, and it kept the suns of the first of them.
TEST(ManySuns, BelongToTheirCapture) {
  const double rho = 0.4;
  const auto scene = scene_of({quad(10, 0, 0)}, {material("ground", lambert(rho))});
  const auto at = [](double degrees) { return dir_from_angles(degrees * kDegree, 0.7); };
  const std::vector<std::vector<Dir>> suns{{at(10), at(50)}, {at(70), at(30)}, {at(20)}};
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<Suns>(suns));
  JobOptions job;
  job.progress = false;
  run_job(scene, {}, sensors, job);
  const auto& results = dynamic_cast<const Suns&>(*sensors[0]).results;
  ASSERT_EQ(results.size(), suns.size());
  for (const CaptureResult& r : results) {
    ASSERT_EQ(r.radiance.size(), suns[r.capture].size());
    for (size_t i = 0; i < r.radiance.size(); ++i)
      EXPECT_NEAR(r.radiance[i], rho / kPi * suns[r.capture][i].z, 1e-6) << r.capture << ' ' << i;
  }
}

}  // namespace
}  // namespace suite::many_suns_test
