// Pulses a second of the processor: an airborne scanner over terrain of a mesh by single scattering, and one over a
// canopy by all orders. Usage: lidar_bench [pulses = 20000]
// Beside it, what is public of HELIOS++ 2.0, which meets one surface a sub-ray and takes no further order: 32 698 963
// shots in 947 s of wall time, a tripod scanner over 3 standing and 25 small moving objects, processor and cores not
// told (github.com/3dgeo-heidelberg/helios, issue 581, 2025). Its sub-rays are 19 a pulse unless asked otherwise.
#include <cstdio>
#include <cstdlib>

#include "base/parallel.h"
#include "lidar/trace.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "tests/support/cpu_clock.h"
#include "tests/support/lidar_kit.h"

using namespace suite;
using namespace suite::test;

namespace {

// Every pulse looks elsewhere: a zigzag of 30 degrees over a line of flight.
struct Zigzag final : PulseTrain {
  ResponsePulse like;
  uint64_t count = 0;
  uint64_t size() const override { return count; }
  std::optional<ResponsePulse> pulse(uint64_t i, double round_trip) const override {
    ResponsePulse p = like;
    p.time = 1e-5 * static_cast<double>(i);
    const double angle = 0.26 * (4 * std::fabs(std::fmod(0.0007 * static_cast<double>(i), 1.0) - 0.5) - 1);
    p.emission.rotation = quat_about({0, 1, 0}, angle);
    p.emission.translation += Vec3{0, 60 * p.time, 0};
    p.reception = p.emission;
    p.reception.translation += Vec3{0, 60 * round_trip, 0};
    return p;
  }
};

struct Counting final : ResponseSink {
  double photons = 0, relative = 0;
  uint64_t bins = 0;
  void take(ResponseBlock&& b) override {
    for (size_t e = 0; e < b.entries(); ++e) photons += b.value[2 * e] + b.value[2 * e + 1];
    bins += b.entries();
  }
};

std::shared_ptr<Scene> hills() {
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  constexpr uint32_t n = 501;
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const double x = 2.0 * i - n, y = 2.0 * j - n;
      v.push_back({x, y, 20 * std::sin(x / 60) * std::cos(y / 80) + 0.5 * std::sin(1.7 * x + 0.9 * y)});
      if (i + 1 == n || j + 1 == n) continue;
      const uint32_t a = j * n + i;
      for (const uint32_t k : {a, a + 1, a + n + 1, a, a + n + 1, a + n}) f.push_back(k);
    }
  return scene_of({mesh_of(v, f, 0)}, {material("soil", lambert(0.3))});
}

std::shared_ptr<Scene> canopy() {
  Pcg32 random(1);
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  for (int leaf = 0; leaf < 100000; ++leaf) {
    const Vec3 at{100 * random.uniform() - 50, 100 * random.uniform() - 50, 2 + 10 * random.uniform()};
    const Frame frame = Frame::around(uniform_sphere({random.uniform(), random.uniform()}));
    const auto n = static_cast<uint32_t>(v.size());
    for (const Vec2 q : {Vec2{-0.25, -0.25}, {0.25, -0.25}, {0.25, 0.25}, {-0.25, 0.25}})
      v.push_back(at + frame.x * q.x + frame.y * q.y);
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) f.push_back(n + i);
  }
  return scene_of({quad(1000, 0, 0), mesh_of(v, f, 1)},
                  {material("soil", lambert(0.2)), material("leaf", lambert(0.45, 0.4))});
}

void measure(const char* what, const std::shared_ptr<const Scene>& scene, uint64_t pulses, double height,
             uint32_t paths, uint32_t orders, double spread) {
  DownLidar lidar(height);
  auto train = std::make_shared<Zigzag>();
  train->like = lidar.train->like, train->count = pulses;
  lidar.pulses = train;
  lidar.laser.beam.full_angle_1_e2 = spread;
  lidar.receiver.field_of_view = 2 * spread;
  lidar.gate = {2 * (0.6 * height) / kSpeedOfLight, 2 * (1.4 * height) / kSpeedOfLight, 5e-10};
  train->like.start = lidar.gate.start;
  lidar.paths = paths, lidar.orders = orders;
  Counting sink;
  TraceOptions options;
  options.count = 256;
  trace_pulses(scene, {}, lidar, options, sink);  // what is built once
  const double before = cpu_seconds();
  options.count = pulses;
  const PulseReport report = trace_pulses(scene, {}, lidar, options, sink);
  const double seconds = cpu_seconds() - before;
  std::printf("%-28s %8llu pulses of %u paths: %9.0f pulses a CPU second, %.3f us a path (scene built again)\n", what,
              static_cast<unsigned long long>(report.pulses), paths, static_cast<double>(report.pulses) / seconds,
              1e6 * seconds / static_cast<double>(report.paths));
}

}  // namespace

int main(int argc, char** argv) {
  const uint64_t pulses = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 20000;
  set_threads(1);
  measure("terrain, single scattering", hills(), 10 * pulses, 400, 7, 1, 0.5e-3);
  measure("terrain, single scattering", hills(), 4 * pulses, 400, 19, 1, 0.5e-3);
  measure("canopy, all orders", canopy(), pulses, 200, 64, 16, 1e-3);
  std::printf("%-28s 32698963 pulses of about 19 sub-rays: %.0f pulses a second of wall time, cores not told\n",
              "HELIOS++, public", 32698963 / 947.0);
}
