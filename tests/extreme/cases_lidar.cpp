// Laser radars: from arm's length to a geostationary orbit, beams of no width, gates of many bins, targets at a gate's
// edge, receivers that move while the light is under way.
#include <algorithm>
#include <cmath>

#include "extreme/case.h"
#include "lidar/laser_beam.h"
#include "tests/support/lidar_kit.h"

namespace suite::extreme {

namespace {

using namespace test;

constexpr double kReflectance = 0.3, kAperture = 0.15;

// Hits on a triangle are exact to 1e-7 of its size, and a beam of 1e-6 rad has to know them better than its width.
std::shared_ptr<Scene> plate(double range, double full_angle = 1e-6) {
  return scene_of({quad(0.5 + std::max(1e-4, 3 * full_angle) * range, 0, 0)},
                  {material("plate", lambert(kReflectance))});
}

DownLidar narrow(double height) {
  DownLidar lidar(height, 4);
  lidar.laser.beam.full_angle_1_e2 = 1e-6;
  lidar.receiver.aperture = kAperture, lidar.receiver.field_of_view = 2e-5;
  lidar.orders = 1, lidar.paths = 64;
  return lidar;
}

// Photons of a plate at a distance: rho / pi times the aperture's solid angle.
double off_plate(const DownLidar& lidar, double range) {
  const double wanted = lidar.photons() * kReflectance * kAperture * kAperture / 4 / (range * range);
  return std::fabs(receive(plate(range, lidar.laser.beam.full_angle_1_e2), lidar).rows().mean() / wanted - 1);
}

double off_far(double range) {
  DownLidar lidar = narrow(range);
  lidar.gate_of(range - 20, range + 20, 1e-9);
  return off_plate(lidar, range);
}

double off_narrow(double full_angle) {
  DownLidar lidar = narrow(1000);
  lidar.laser.beam.full_angle_1_e2 = full_angle;
  lidar.receiver.field_of_view = 10 * std::max(full_angle, 2 * LaserBeam::kNarrowest);
  lidar.gate_of(980, 1020, 1e-9);
  return off_plate(lidar, 1000);
}

double off_many_bins(double bins) {
  DownLidar lidar = narrow(1000);
  lidar.gate_of(900, 1100, 400 / kSpeedOfLight / bins);
  return off_plate(lidar, 1000);
}

// The plate stands so far behind the gate's begin.
double off_gate(double behind) {
  DownLidar lidar = narrow(1000);
  lidar.gate_of(1000 - behind, 1020, 1e-9);
  return off_plate(lidar, 1000);
}

// A receiver that falls towards the plate is nearer when light comes back: t = 2 h / (c + v). Off by so much of a bin
// of 0.1 ns, where the bin's middle may be half of one away.
double off_falling(double speed) {
  DownLidar lidar = narrow(3e5);
  lidar.train->count = 1;
  lidar.train->velocity = {0, 0, -speed};
  lidar.gate_of(3e5 - 50, 3e5 + 10, 1e-10);
  const Received got = receive(plate(3e5), lidar);
  const double wanted = 2 * 3e5 / (kSpeedOfLight + speed);
  double sum = 0, photons = 0;
  for (const ResponseBlock& b : got.blocks)
    for (size_t e = 0; e < b.entries(); ++e) {
      if (b.bin[e] == 0) continue;
      photons += b.value[2 * e];
      sum += b.value[2 * e] * (lidar.gate.start + (b.bin[e] - 0.5) * lidar.gate.bin - wanted);
    }
  return photons > 0 ? std::fabs(sum / photons) / lidar.gate.bin : NAN;
}

}  // namespace

std::vector<Case> lidar_cases() {
  using N = const Numerics&;
  return {
      {"laser radar",
       "photons of a plate far away",
       "closed form",
       "1",
       0.002,
       [](N, double x) { return off_far(x); },
       {"range", "m", 100, 1e8, 10},
       {}},
      {"laser radar",
       "photons of a plate in a narrow beam",
       "closed form",
       "1",
       0.002,
       [](N, double x) { return off_narrow(x); },
       {"full angle of the beam", "rad", 1e-3, 1e-12, 10},
       {}},
      {"laser radar",
       "photons in a gate of many bins",
       "closed form",
       "1",
       0.002,
       [](N, double x) { return off_many_bins(x); },
       {"bins", "1", 100, 1e6, 10},
       {}},
      {"laser radar",
       "a plate at the begin of the gate",
       "closed form",
       "1",
       0.002,
       [](N, double x) { return off_gate(x); },
       {"distance behind the begin", "m", 1, 1e-6, 10},
       {}},
      {"laser radar",
       "arrival at a receiver that falls",
       "2 h / (c + v)",
       "bins of 0.1 ns",
       0.6,
       [](N, double x) { return off_falling(x); },
       {"speed", "m/s", 1, 1e4, 10},
       {}},
  };
}

}  // namespace suite::extreme
