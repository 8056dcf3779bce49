// A camera circling a stare point (Goodenough & Brown, section V-C): what is at the stare point stays sharp, what is in
// front of it or behind is blurred by the velocity of its image times the integration time.
#include <gtest/gtest.h>

#include <cmath>

#include "sensor/lens.h"
#include "support/platform_kit.h"

namespace suite::uas_test {
namespace {

using test::PlatformKit;

constexpr int kColumns = 121;
constexpr const char* kTrack =
    "{kind: circle, position_m: [0, 0, 42], radius_m: 100, speed_m_s: 12, start_azimuth_deg: 180, pointing: {look_at: "
    "{position_m: [0, 0, 0]}}}";

// White boards with a left edge through x = 0 on the ground, 3 m long: at the stare point, 12 m behind, 12 m in front.
// The edges are oblique, so that the rows of a picture cut them at all phases of a pixel.
std::shared_ptr<Scene> boards() {
  std::vector<Mesh> meshes;
  for (const double y : {0.0, 12.0, -12.0})
    meshes.push_back(test::mesh_of({{-0.5, y - 1.5, 0}, {6, y - 1.5, 0}, {6, y + 1.5, 0}, {0.5, y + 1.5, 0}},
                                   {0, 1, 2, 0, 2, 3}, 0));
  return test::scene_of(meshes, {test::material("white", test::lambert(0.8))});
}

std::string camera(double integration) {
  return strf(
      "kind: platform\nmotion: %s\ntasks: [{start: -%g}]\ntruth: []\ninstruments: [{focal_length_mm: 35, arrays: "
      "[{columns: %d, rows: 720, pitch_um: 6.5, integration_time_s: %g, paths: 64, bands: [{name: pan, center_um: 0.6, "
      "fwhm_um: 0.02, shape: rectangular}]}]}]\n",
      kTrack, integration / 2, kColumns, integration);
}

// Variance, in square pixels, of the line spread across the edge in a row of the picture.
double edge_variance(const std::vector<double>& picture, int row) {
  double all = 0, first = 0, second = 0;
  for (int c = 1; c < kColumns; ++c) {
    const double d =
        picture[static_cast<size_t>(row * kColumns + c)] - picture[static_cast<size_t>(row * kColumns + c - 1)];
    all += d, first += d * c, second += d * c * c;
  }
  return second / all - first / all * first / all;
}

TEST(Uas, TheStarePointStaysSharpAndTheRestIsBlurredByItsVelocity) {
  constexpr double integration = 0.05;
  SourceSpecs sources;
  sources.add(test::uniform_sky(1, false));
  PlatformKit still, moving;
  still.render(boards(), sources, camera(0));
  moving.render(boards(), sources, camera(integration));
  // The still picture is the one of the middle of the exposure.
  const TrackPtr track = track_from(Params::parse_text(kTrack, "track"), {});
  Lens lens;
  lens.focal_length = 0.035;
  auto image_of = [&](Vec3 p, double t) {
    const Vec2 at = lens.image_of(normalized(track->at(t).inverse().point(p)));
    return Vec2{at.x / 6.5e-6 + 0.5 * kColumns, at.y / 6.5e-6 + 360};
  };
  for (const double y : {0.0, 12.0, -12.0}) {
    const Vec2 from = image_of({0, y, 0}, -integration / 2), to = image_of({0, y, 0}, integration / 2);
    const int row = static_cast<int>(image_of({0, y, 0}, 0).y);
    double sharp = 0, blurred = 0;
    for (int r = row - 12; r <= row + 12; ++r) {
      sharp += edge_variance(still.shots[0].result.radiance, r) / 25;
      blurred += edge_variance(moving.shots[0].result.radiance, r) / 25;
    }
    const double length_seen = std::sqrt(std::max(0.0, 12 * (blurred - sharp))),
                 length_expected = std::fabs(to.x - from.x);
    std::printf("edge at %+.0f m: %.3f px wide still, %.3f px moving; blur %.3f px, velocity times time %.3f px\n", y,
                std::sqrt(sharp), std::sqrt(blurred), length_seen, length_expected);
    if (y == 0)
      EXPECT_NEAR(std::sqrt(blurred / sharp), 1, 0.05);
    else
      EXPECT_NEAR(length_seen / length_expected, 1, 0.05);
  }
}

}  // namespace
}  // namespace suite::uas_test
