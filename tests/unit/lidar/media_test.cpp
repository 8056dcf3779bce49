// Pulses through matter and by many orders against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/support/lidar_kit.h"

namespace suite::test::media_test {
namespace {

// A layer of 100 m with a backscatter coefficient beta = extinction / S: photons of single scattering
// N0 beta A (exp(-2 alpha (R - R0)) / R^2 integrated): 48 688.9 for N0 = 1e15, 88.2697 in the first ns (16 significant
// digits by quadrature).
TEST(LidarMedia, ALayerReturnsItsAttenuatedBackscatter) {
  const double alpha = 1e-3, S = 30, low = 1000, high = 1100;
  const double scattering = 4 * kPi * alpha / S;  // isotropic
  const auto scene = slab_scene(medium(Curve::constant(alpha - scattering), Curve::constant(scattering)), high - low);
  for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
    DownLidar lidar(high, 16);
    lidar.train->like.energy *= 1e15 / lidar.photons();
    lidar.laser.beam.full_angle_1_e2 = 0.5e-3;
    lidar.receiver.aperture = 0.15, lidar.receiver.field_of_view = 2e-3;
    lidar.gate_of(low - 1, high + 1, 1e-9);
    lidar.start_from = from;
    lidar.paths = 256, lidar.orders = 1;
    const Received got = receive(scene, lidar);
    const RunningStats rows = got.rows();
    EXPECT_NEAR(rows.mean(), 48688.9, 4 * rows.stderr_of_mean());
    EXPECT_LT(rows.stderr_of_mean(), 2e-3 * 48688.9);
    // The first ns of light that is scattered in the layer.
    lidar.gate_of(low, low + 2, 1e-9);
    const Received start = receive(scene, lidar);
    const auto cut = start.bin(1);
    EXPECT_NEAR(cut.photons / 16, 88.2697, 4 * cut.error() / 16 + 1e-3 * 88.2697);
    EXPECT_LT(cut.error(), 0.01 * cut.photons);
  }
}

// Water of group index n_g under a flat surface: the bed's return comes 2 D n_g / c after the surface's place, weakened
// by T^2 exp(-2 K D) (H / (n H + D))^2 against the same bed in air at H. For H 400 m, D 10 m, n 1.33, K 0.05 1/m:
// 0.192409.
std::shared_ptr<Scene> bed(double depth, const Curve& index, double absorption) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("bed", lambert(0.3)),
                      material("water", {"dielectric", {}, {{"index", index}}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -depth}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  scene->media = {medium(Curve::constant(absorption), Curve::constant(0))};
  scene->media[0].index = index;
  scene->materials[1].inside = 0;
  check_scene(*scene, "bed");
  return scene;
}

TEST(LidarMedia, TheBedUnderFlatWaterReturnsLateAndWeak) {
  const double H = 400, D = 10, n = 1.33, K = 0.05;
  for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
    DownLidar lidar(H, 16);
    lidar.laser.beam.full_angle_1_e2 = 0.5e-3;
    lidar.receiver.aperture = 0.15, lidar.receiver.field_of_view = 2e-3;
    lidar.gate_of(H - 1, H + 30, 1e-10);
    lidar.start_from = from;
    lidar.paths = 256, lidar.orders = 1;
    const Received got = receive(bed(D, Curve::constant(n), K), lidar);
    const double in_air = lidar.photons() * 0.3 / kPi / (H * H) * kPi * 0.15 * 0.15 / 4;
    const RunningStats rows = got.rows();
    EXPECT_NEAR(rows.mean(), 0.192409 * in_air, 4 * rows.stderr_of_mean() + 1e-4 * in_air);
    EXPECT_LT(rows.stderr_of_mean(), 2e-3 * rows.mean());
    EXPECT_EQ(got.total(kMultiple).photons, 0) << "the bed is seen by single scattering";
    double sum = 0, first = 0;
    for (const ResponseBlock& b : got.blocks)
      for (size_t e = 0; e < b.entries(); ++e) {
        const double v = b.value[2 * e] + b.value[2 * e + 1];
        sum += v, first += v * (lidar.gate.start + (b.bin[e] - 0.5) * lidar.gate.bin);
      }
    EXPECT_NEAR(first / sum, 2 * (H + n * D) / kSpeedOfLight, 1e-12 + 2e-14);
  }
}

// A beam that is 20 degrees off the zenith comes from the bed 91.81587 ns after the surface's place, 2 D n / (c cos w).
TEST(LidarMedia, ABeamOffTheZenithIsLateByItsWayInWater) {
  const double H = 400, D = 10, a = 20 * kDegree;
  DownLidar lidar(H, 16);
  lidar.laser.offset = lidar.receiver.offset = {quat_about({0, 1, 0}, a), {}};
  lidar.laser.beam.full_angle_1_e2 = 2e-5;
  lidar.receiver.field_of_view = 1e-3;
  lidar.gate_of(H / std::cos(a) - 1, H / std::cos(a) + 30, 1e-10);
  const Received got = receive(bed(D, Curve::constant(1.33), 0.05), lidar);
  double sum = 0, first = 0;
  for (const ResponseBlock& b : got.blocks)
    for (size_t e = 0; e < b.entries(); ++e) {
      sum += b.value[2 * e];
      first += b.value[2 * e] * (lidar.gate.start + (b.bin[e] - 0.5) * lidar.gate.bin);
    }
  EXPECT_NEAR(first / sum - 2 * H / std::cos(a) / kSpeedOfLight, 91.81587e-9, 5e-12);
}

// n = 1.33 + 0.02 / wavelength^2 at 0.532 um: n_g = n - wavelength dn/dwavelength = 1.33 + 3 x 0.02 / wavelength^2.
TEST(LidarMedia, TimeGoesByTheGroupIndex) {
  const double H = 100, D = 10, um = 0.532;
  std::vector<double> x, y;
  for (double w = 0.4; w < 0.8; w += 0.002) x.push_back(w), y.push_back(1.33 + 0.02 / (w * w));
  const Curve index(x, y, Outside::hold);
  const double group = 1.33 + 0.06 / (um * um);
  EXPECT_NEAR(group_index(index, um), group, 1e-4);
  DownLidar lidar(H, 4);
  lidar.train->like.wavelength_um = um;
  lidar.laser.beam.full_angle_1_e2 = 0.5e-3;
  lidar.receiver.field_of_view = 2e-3;
  lidar.gate_of(H - 1, H + 30, 1e-10);
  lidar.orders = 3;
  const Received got = receive(bed(D, index, 0.05), lidar);
  double sum = 0, first = 0;
  for (const ResponseBlock& b : got.blocks)
    for (size_t e = 0; e < b.entries(); ++e) {
      const double v = b.value[2 * e] + b.value[2 * e + 1];
      sum += v, first += v * (lidar.gate.start + (b.bin[e] - 0.5) * lidar.gate.bin);
    }
  const double phase = 1.33 + 0.02 / (um * um);
  EXPECT_NEAR(first / sum, 2 * (H + group * D) / kSpeedOfLight, 2 * 1e-4 * D / kSpeedOfLight + 1e-12);
  EXPECT_GT(std::fabs(first / sum - 2 * (H + phase * D) / kSpeedOfLight), 1e-9) << "not the phase index";
}

std::shared_ptr<Scene> half_space(double scattering, double absorption) {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(absorption), Curve::constant(scattering))};
  scene->materials = {boundary(0)};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  check_scene(*scene, "half space");
  return scene;
}

// Matter everywhere: absorption takes exp(-mu_a c t) from each bin. Free flights are drawn by scattering alone, and
// without roulette the paths are the same.
TEST(LidarMedia, AbsorptionWeakensEveryBinByItsTime) {
  const double mu = 0.1;
  DownLidar lidar(0, 8);
  lidar.laser.beam.full_angle_1_e2 = 0.1;
  lidar.receiver.field_of_view = 1;
  lidar.gate_of(0.5, 15, 1e-10);
  lidar.paths = 512, lidar.orders = 32;
  TraceOptions options;
  options.method.roulette_after = 1000;
  const auto fog = [&](double absorption) {
    auto scene = std::make_shared<Scene>();
    scene->media = {medium(Curve::constant(absorption), Curve::constant(0.5), hg(0.5))};
    scene->ambient = 0;
    scene->groups.push_back({"root", {}});
    check_scene(*scene, "fog");
    return receive(scene, lidar, {}, options);
  };
  const Received clear = fog(0), dim = fog(mu);
  int compared = 0;
  for (uint32_t bin = 1; bin < clear.head.bins; ++bin)
    for (const int channel : {int(kSingle), int(kMultiple)}) {
      const auto a = clear.bin(bin, channel), b = dim.bin(bin, channel);
      if (!(a.photons > 0)) continue;
      const double t = lidar.gate.start + (bin - 0.5) * lidar.gate.bin;
      // Within the widths of a bin and its neighbour; places of single scattering follow the extinction.
      const double error = channel == kSingle ? 4 * std::hypot(a.error() / a.photons, b.error() / b.photons) : 0;
      EXPECT_NEAR(std::log(b.photons / a.photons), -mu * kSpeedOfLight * t,
                  1.1 * mu * kSpeedOfLight * lidar.gate.bin + error)
          << bin;
      ++compared;
    }
  EXPECT_GT(compared, 1500);
}

// An isotropic half space under a wide field: all orders together are f = w H(mu_0) H(mu) / (4 pi (mu + mu_0)), with
// Chandrasekhar's H; the single part is w / (4 pi (mu + mu_0)). The laser is met at mu_0, the receiver looks down.
// Expected: f, 16 significant digits by quadrature. Near albedo 1 H(x) falls as 1 - x sqrt(3 (1 - w)), so that of the
// coefficients of f in powers of w, which are the orders, those above N hold (mu + mu_0) sqrt(3 / pi / N) of it.
struct HalfSpace {
  double mu_0, albedo, expected;
  uint32_t orders, paths, pulses;
};
void check_half_space(const HalfSpace& c, double within) {
  const double R = 1000, scattering = 1000, slant = std::acos(c.mu_0);
  DownLidar lidar(R, c.pulses);
  lidar.laser.beam.full_angle_1_e2 = 1e-4;
  lidar.laser.offset = {quat_about({0, 1, 0}, slant), {R * std::tan(slant), 0, 0}};
  lidar.receiver.field_of_view = 2e-2;
  lidar.gate_of(R - 1, R + 100000, 1e-6);
  lidar.paths = c.paths, lidar.orders = c.orders;
  const Received got = receive(half_space(scattering * c.albedo, scattering * (1 - c.albedo)), lidar);
  const double unit = lidar.photons() * kPi * lidar.receiver.aperture * lidar.receiver.aperture / 4 / (R * R);
  const RunningStats rows = got.rows();
  const double error = rows.stderr_of_mean() / unit;
  const double cut = c.albedo < 1 ? 0 : (1 + c.mu_0) * std::sqrt(3 / kPi / c.orders);
  if (within > 0) {
    std::printf("albedo %g at %g: %.7g +- %.2g, expected %.7g (%+.3f %%)\n", c.albedo, c.mu_0, rows.mean() / unit,
                error, c.expected, 100 * (rows.mean() / unit / c.expected - 1));
    EXPECT_LT(3 * error, within * c.expected) << "the bound is that of the noise";
    EXPECT_NEAR(rows.mean() / unit, c.expected, within * c.expected) << c.albedo;
    EXPECT_NEAR(rows.mean() / unit, c.expected * (1 - cut), 3 * error + 1e-4 * c.expected) << c.albedo;
  } else {
    EXPECT_NEAR(rows.mean() / unit, c.expected * (1 - cut), 4 * error + 1e-3 * c.expected) << c.albedo;
  }
  const auto single = got.total(kSingle);
  const double once = c.albedo / (4 * kPi * (1 + c.mu_0));
  EXPECT_NEAR(single.photons / c.pulses / unit, once, 4 * single.error() / c.pulses / unit + 1e-5 * once) << c.albedo;
}

TEST(LidarMedia, AHalfSpaceReturnsItsReflectance) {
  for (const HalfSpace& c : {HalfSpace{1, 0.5, 0.0311476, 64, 512, 64},
                             {1, 0.9, 0.1225723, 400, 1024, 64},
                             {1, 0.99, 0.2408634, 4000, 256, 64},
                             {1, 1, 0.3364282, 1000000, 16, 64}})
    check_half_space(c, 0);
}

// Three albedos, two slants, within 0.5 % that are known to a third of that.
TEST(LidarMedia, HalfSpacesToHalfAPercent) {
  if (!std::getenv("SUITE_LONG")) GTEST_SKIP() << "in the long run";
  for (const HalfSpace& c : {HalfSpace{1, 0.5, 0.0311476, 64, 1024, 256},
                             {1, 0.9, 0.1225723, 400, 1024, 512},
                             {1, 0.99, 0.2408634, 4000, 1024, 512},
                             {0.5, 0.5, 0.0394217, 64, 1024, 256},
                             {0.5, 0.9, 0.1374533, 400, 1024, 512},
                             {0.5, 0.99, 0.2400850, 4000, 1024, 512}})
    check_half_space(c, 5e-3);
}

// The same of albedo 1, of which the orders above 1e6 hold 0.2 %.
TEST(LidarMedia, HalfSpacesWithoutLossesToHalfAPercent) {
  if (!std::getenv("SUITE_LONG")) GTEST_SKIP() << "in the long run";
  for (const HalfSpace& c : {HalfSpace{1, 1, 0.3364282, 1000000, 1024, 512}, {0.5, 1, 0.3104996, 1000000, 1024, 512}})
    check_half_space(c, 5e-3);
}

// Paths that are scattered for certain in thin matter bring the same light of further orders, with less noise.
TEST(LidarMedia, ForcedScatteringIsTheSameWithLessNoise) {
  auto scene = slab_scene(medium(Curve::constant(0.002), Curve::constant(0.02), hg(0.2)), 5);  // depth 0.1
  scene->materials.push_back(material("soil", lambert(0.3)));
  place(*scene, PrimitiveKind::plane, {0, 0}, 2, translation({0, 0, -0.5}));
  check_scene(*scene, "mist over soil");
  DownLidar lidar(10, 128);
  lidar.laser.beam.full_angle_1_e2 = 0.6;
  lidar.receiver.field_of_view = 0.8;
  lidar.gate_of(4, 16, 2e-9);
  lidar.paths = 128, lidar.orders = 5;
  for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
    lidar.start_from = from;
    TraceOptions free;
    free.forced_scattering = false;
    const auto forced = receive(scene, lidar).total(kMultiple),
               chance = receive(scene, lidar, {}, free).total(kMultiple);
    EXPECT_NEAR(forced.photons, chance.photons, 4 * std::hypot(forced.error(), chance.error()));
    EXPECT_LT(chance.error(), 0.05 * chance.photons);
    EXPECT_LT(forced.error(), 0.8 * chance.error());
  }
}

// Branches towards the other end bring the same light of further orders, from either end, with less noise: 4 sigma, and
// as a negative control not what is 10 % more. Paths that are scattered for certain (thin fog) draw such directions,
// too.
TEST(LidarMedia, BranchesToTheEndAreTheSameWithLessNoise) {
  for (const double depth : {0.5, 1.5}) {
    auto scene = slab_scene(medium(Curve::constant(0.005), Curve::constant(depth / 5), hg(0.8)), 5);
    scene->materials.push_back(material("soil", lambert(0.3)));
    place(*scene, PrimitiveKind::plane, {0, 0}, 2, translation({0, 0, -0.5}));
    check_scene(*scene, "fog over soil");
    DownLidar lidar(20, 256);
    lidar.laser.beam.full_angle_1_e2 = 0.04;
    lidar.receiver.field_of_view = 0.12;
    lidar.gate_of(14, 22, 2e-9);
    lidar.paths = 64, lidar.orders = 6;
    TraceOptions off;
    off.method.side_flights = false;
    for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
      lidar.start_from = from;
      const auto branched = receive(scene, lidar).total(kMultiple),
                 chance = receive(scene, lidar, {}, off).total(kMultiple);
      const double error = std::hypot(branched.error(), chance.error());
      EXPECT_NEAR(branched.photons, chance.photons, 4 * error) << depth;
      EXPECT_GT(std::fabs(1.1 * branched.photons - chance.photons), 0.5 * error) << depth;
      EXPECT_LT(branched.error(), 0.8 * chance.error()) << depth;
    }
  }
}

// A sphere with a Lambert wall, seen from its middle by a cone in every direction: of an impulse that a point of the
// wall sends, energy per 0.5 m of path that arrives at the wall (n-fold convolutions of the chords' density l / 2, to
// 2e-5).
TEST(LidarMedia, AnIntegratingSphereRings) {
  constexpr double kExpected[] = {0.06309, 0.19643, 0.35206, 0.54768, 0.22292, 0.31310,
                                  0.35130, 0.31000, 0.27437, 0.29191, 0.27768, 0.25512};
  struct Turning final : PulseTrain {
    ResponsePulse like;
    uint64_t size() const override { return 1024; }
    std::optional<ResponsePulse> pulse(uint64_t i, double) const override {
      ResponsePulse p = like;
      p.time = 1e-6 * static_cast<double>(i);
      // Fibonacci's lattice on the sphere.
      const double z = 1 - (2.0 * static_cast<double>(i) + 1) / 1024,
                   phi = kPi * (3 - std::sqrt(5.0)) * static_cast<double>(i), s = std::sqrt(1 - z * z);
      const Dir to{s * std::cos(phi), s * std::sin(phi), z};
      const Vec3 axis = cross({0, 0, -1}, to);
      p.reception.rotation = length(axis) > 0 ? quat_about(normalized(axis), angle_between({0, 0, -1}, to)) : Quat{};
      return p;
    }
  };
  const double rho = 0.9;
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("wall", lambert(rho))};
  place(*scene, PrimitiveKind::sphere, {1}, 0);
  check_scene(*scene, "sphere");
  DownLidar lidar(0);
  auto train = std::make_shared<Turning>();
  train->like = lidar.train->like;
  lidar.pulses = train;
  lidar.laser.beam.full_angle_1_e2 = 1e-3;
  lidar.receiver.field_of_view = 1.5;
  lidar.gate = {0, 9 / kSpeedOfLight, 0.005 / kSpeedOfLight};
  lidar.paths = 32, lidar.orders = 64;
  lidar.start_from = StartFrom::laser;
  const Received got = receive(scene, lidar);
  // Importance times solid angle times the mean radiance rho / pi x energy per area.
  const double solid = 2 * kPi * (1 - std::cos(0.75)),
               area = kPi * lidar.receiver.aperture * lidar.receiver.aperture / 4;
  const double unit = 1024 * lidar.photons() * rho * area * solid * rho / kPi / (4 * kPi);
  for (size_t k = 0; k < std::size(kExpected); ++k) {
    const auto in = got.sum(
        [&](uint32_t b) {
          const double way = (b - 0.5) * 0.005 - 2;
          return way > 0.5 * static_cast<double>(k) && way < 0.5 * static_cast<double>(k + 1);
        },
        kMultiple);
    EXPECT_NEAR(in.photons / unit, kExpected[k], 4 * in.error() / unit + 5e-3 * kExpected[k]) << k;
  }
}

}  // namespace
}  // namespace suite::test::media_test
