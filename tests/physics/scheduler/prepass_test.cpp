// A pre-pass finds the irradiance of a tilted plate in the shadow of a wall before cameras look at it, in two windows
// between which the sun moves: it is what plane receivers get, whoever runs it and however often it is interrupted, and
// the plate's temperatures follow from it.
#include "scheduler/prepass.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "formats/render_state/render_state.h"
#include "scheduler/moments.h"
#include "spectral/planck.h"
#include "support/message_of.h"
#include "support/radiometry_kit.h"
#include "support/temp_folder.h"

namespace suite::test::prepass_test {
namespace {

using testing::HasSubstr;

constexpr double kSlope = 0.3, kSun = 400, kSky = 20;        // 1; W/(m2 um); W/(m2 sr um)
constexpr double kLongwave = 300, kStefan = 5.670374419e-8;  // W/m2; W/(m2 K4)
constexpr uint32_t kPlate = 1;                               // number of the instance
const std::vector<TimeWindow> kWindows{{0, 0}, {4 * 3600.0, 4 * 3600.0 + 60}};
const Vec3 kWallLow{1.2, -2, 0}, kWallHigh{1.4, 2, 2};

Dir normal() { return normalized(Vec3{-kSlope, 0, 1}); }
double height(double x) { return 1 + kSlope * x; }

// A plate over ground beside a wall in the east. The plate is black; heated: by what has to be found.
std::shared_ptr<const Scene> scene(bool heated = true) {
  const auto corner = [](double x, double y) { return Vec3{x, y, height(x)}; };
  auto s = scene_of(
      {quad(5, 0, 0), mesh_of({corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}, {0, 1, 2, 0, 2, 3}, 1),
       box(kWallLow, kWallHigh, 2, true)},
      {material("ground", lambert(0.3)), material("plate", lambert(0)), material("wall", lambert(0.6))});
  s->origin = {48.5, 9.1, 400, true};
  if (!heated) return s;
  // A foil: within a minute it is as warm as its loads make it.
  s->temperatures = {{1,
                      {"slab",
                       {{"thickness_m", 1e-4},
                        {"density_kg_m3", 2700},
                        {"specific_heat_j_kg_k", 900},
                        {"conductivity_w_m_k", 200},
                        {"emissivity", 1},
                        {"initial_k", 300},
                        {"start_s", -3600}},
                       {},
                       {},
                       false,
                       {}}}};
  check_scene(*s, "plate");
  return s;
}

SourceSpecs sources() {
  SourceSpecs s;
  SunSpec sun;
  sun.irradiance = Curve::constant(kSun);
  sun.time = SourceTime{"2026-06-21T07:00:00Z", {}};
  s.add(sun);
  s.add(uniform_sky(kSky, false));
  return s;
}

// Three blocks of them on the plate, from the side of the wall to the other.
std::vector<Prepass::Element> elements() {
  std::vector<Prepass::Element> all;
  for (int i = 0; i < 24; ++i) {
    const double x = 0.9 - 0.15 * (i % 12), y = i < 12 ? -0.35 : 0.4;
    all.push_back({Vec3{x, y, height(x)} + normal() * 1e-5, normal()});
  }
  return all;
}

std::vector<Prepass::Spectrum> spectra() {
  const std::vector<Band> visible{Band::rectangular("green", 0.55, 0.1)},
      infrared{Band::rectangular("h", 1.6, 0.2), Band::rectangular("k", 2.2, 0.2)};
  return {{make_state(visible, 0.05), visible}, {make_state(infrared, 0.1), infrared}};
}

std::unique_ptr<Prepass> pass() {
  return std::make_unique<Prepass>("light", elements(), spectra(), kWindows, Convergence{64, 64, 0, 0});
}

// Plane receivers at the elements, written without a pre-pass.
class Receivers final : public Sensor {
 public:
  explicit Receivers(double later = 0) {
    for (const Prepass::Spectrum& s : spectra()) states_.push_back(s.state), bands_.push_back(s.bands);
    for (const TimeWindow& w : kWindows) {
      Task task{"receive", {w.begin + later, w.end + later}, {}};
      for (size_t s = 0; s < 2; ++s) {
        Capture c;
        c.window = task.window, c.state = s;
        c.columns = 1, c.rows = 24;
        c.neighbours = false;
        c.convergence = {64, 64, 0, 0};
        task.captures.push_back(c);
      }
      tasks_.push_back(task);
    }
  }
  std::string name() const override { return "receivers"; }
  std::span<const SpectralState> states() const override { return states_; }
  std::span<const Band> bands(size_t s) const override { return bands_[s]; }
  std::span<const Task> tasks() const override { return tasks_; }
  std::span<const std::string> truth() const override { return {}; }
  int numbers() const override { return 1; }
  SensorRay ray(const RayRequest& r) const override {
    const TimeWindow& w = r.capture.window;
    SensorRay out{{elements_[r.problem].position, normal(), w.begin + r.u[0] * (w.end - w.begin)}, kPi};
    out.receiver = SensorRay::Receiver::plane;
    return out;
  }
  void accept(CaptureResult&& r) override { results[2 * r.task + r.capture] = std::move(r); }
  std::vector<CaptureResult> results = std::vector<CaptureResult>(4);

 private:
  std::vector<Prepass::Element> elements_ = elements();
  std::vector<SpectralState> states_;
  std::vector<std::vector<Band>> bands_;
  std::vector<Task> tasks_;
};

// Looks at some elements from above in the thermal infrared, and at the wall, once in each window.
class Camera final : public Sensor {
 public:
  static constexpr std::array<size_t, 4> kSeen{0, 5, 10, 23};
  Camera() {
    Task task{"look", {0, kWindows[1].end}, {}};
    for (const TimeWindow& w : kWindows) {
      Capture c;
      c.window = w;
      c.columns = 5, c.rows = 1;
      c.convergence.min_paths = c.convergence.max_paths = 16;
      task.captures.push_back(c);
    }
    tasks_.push_back(task);
  }
  std::string name() const override { return "camera"; }
  std::span<const SpectralState> states() const override { return {&state_, 1}; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  std::span<const Task> tasks() const override { return tasks_; }
  SensorRay ray(const RayRequest& r) const override {
    if (r.problem == kSeen.size()) return {{{0, 0, 1.8}, normalized(Vec3{1, 0.1 * r.u[0], 0}), r.capture.window.begin}};
    const Vec3 p = elements_[kSeen[r.problem]].position;
    return {{{p.x, p.y, 3}, {0, 0, -1}, r.capture.window.begin}};
  }
  void accept(CaptureResult&& r) override { results[r.capture] = std::move(r); }
  std::vector<CaptureResult> results = std::vector<CaptureResult>(2);

 private:
  std::vector<Prepass::Element> elements_ = elements();
  std::vector<Band> bands_{Band::rectangular("t", 10, 0.1)};
  SpectralState state_ = make_state(bands_, 0.05);
  std::vector<Task> tasks_;
};

// What the elements absorb in a window, W/m2: two bands stand for 0.5 um of spectrum each.
std::vector<double> absorbed(const Prepass& p, size_t window) {
  std::vector<double> all;
  for (size_t i = 0; i < 24; ++i)
    all.push_back(0.5 * (p.irradiance(window, 0)[i] + p.irradiance(window, 1)[2 * i + 1]));
  return all;
}

// Loads of the nearest element, linear between the windows. wrong: counts places that are not on the plate as said.
LoadsAt loads_from(std::vector<double> first, std::vector<double> second, std::atomic<int>& wrong) {
  return [first, second, &wrong, at = elements()](const HeatedPlace& place) -> Loads {
    size_t best = 0;
    for (size_t i = 1; i < at.size(); ++i)
      if (length(at[i].position - place.position) < length(at[best].position - place.position)) best = i;
    const uint32_t triangle = place.position.x >= place.position.y ? 0 : 1;
    if (length(place.normal - normal()) > 1e-6 || place.instance != kPlate || place.triangle != triangle) ++wrong;
    return [a = first[best], b = second[best]](double t) {
      const double share = std::clamp(t / kWindows[1].begin, 0.0, 1.0);
      return SurfaceLoad{a + share * (b - a), kLongwave, 0, 0};
    };
  };
}

struct Ran {
  std::vector<std::vector<double>> light;  // means, then errors, of each window and spectrum
  std::vector<CaptureResult> pictures;
  std::vector<double> first, second;  // absorbed in the windows
  JobReport report;
  int asked = 0, wrong = 0;  // for loads; about places
};

// The whole job. given: loads known already, without a pre-pass.
Ran run(JobOptions job = {}, const Ran* given = nullptr) {
  Ran ran;
  std::vector<std::unique_ptr<Sensor>> before, cameras;
  if (!given) before.push_back(pass());
  cameras.push_back(std::make_unique<Camera>());
  job.progress = false;
  job.prepasses = before;
  std::atomic<int> wrong = 0;
  job.loads = [&] {
    ++ran.asked;
    if (given) return loads_from(given->first, given->second, wrong);
    const Prepass& p = static_cast<const Prepass&>(*before[0]);
    ran.first = absorbed(p, 0), ran.second = absorbed(p, 1);
    for (size_t i = 0; i < 4; ++i)
      for (const auto& values : {p.irradiance(i / 2, i % 2), p.standard_error(i / 2, i % 2)})
        ran.light.emplace_back(values.begin(), values.end());
    return loads_from(ran.first, ran.second, wrong);
  };
  ran.report = run_job(scene(), sources(), cameras, job);
  ran.pictures = std::move(static_cast<Camera&>(*cameras[0]).results);
  ran.wrong = wrong;
  return ran;
}

void expect_same_pictures(const Ran& a, const Ran& b) {
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.pictures[i].radiance, b.pictures[i].radiance);
    EXPECT_EQ(a.pictures[i].standard_error, b.pictures[i].standard_error);
    EXPECT_EQ(a.pictures[i].radiance.size(), 5u);
  }
}
void expect_same(const Ran& a, const Ran& b) {
  EXPECT_EQ(a.light, b.light);
  EXPECT_EQ(a.light.size(), 8u);
  expect_same_pictures(a, b);
}

std::vector<CaptureResult> received(double later = 0) {
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<Receivers>(later));
  JobOptions job;
  job.progress = false;
  run_job(scene(false), sources(), sensors, job);
  return std::move(static_cast<Receivers&>(*sensors[0]).results);
}

// The pre-pass as a job of its own, so that its captures have the numbers of the receivers'; what waits for loads is
// dark to it, as what has no temperature.
TEST(Prepass, receives_what_plane_receivers_do) {
  std::vector<std::unique_ptr<Sensor>> before;
  before.push_back(pass());
  JobOptions job;
  job.progress = false;
  job.prepasses = before;
  const JobReport report = run_job(scene(), sources(), {}, job);
  EXPECT_EQ(report.captures, 4u);
  EXPECT_EQ(report.optics_bakes, 2u);
  const Prepass& p = static_cast<const Prepass&>(*before[0]);
  const auto same = received(), later = received(600);
  for (size_t i = 0; i < 4; ++i) {
    const auto mean = p.irradiance(i / 2, i % 2), error = p.standard_error(i / 2, i % 2);
    EXPECT_EQ(std::vector<double>(mean.begin(), mean.end()), same[i].radiance);
    EXPECT_EQ(std::vector<double>(error.begin(), error.end()), same[i].standard_error);
    EXPECT_NE(same[i].radiance, later[i].radiance) << "nothing was tested";
  }
}

// The sun's share by hand. What the sky and the ground add is at most what an unobstructed one of each could, and the
// wall's, which is turned to the plate in the shade in the morning and grazed by the sun at noon.
TEST(Prepass, has_the_shadow_where_it_is) {
  const Ran ran = run();
  const auto at = elements();
  const SourceSpecs written = sources();
  const auto place = scene();
  SourcesInTime in_time(written, *place);
  for (size_t w = 0; w < 2; ++w) {
    const Dir sun = in_time.at(in_time.on_grid(0.5 * (kWindows[w].begin + kWindows[w].end))).sun()->disk()->direction;
    size_t lit = 0;
    for (size_t i = 0; i < at.size(); ++i) {
      const double way = (kWallLow.x - at[i].position.x) / sun.x;
      const Vec3 there = at[i].position + sun * way;
      const bool shaded = way > 0 && there.z < kWallHigh.z && std::fabs(there.y) < kWallHigh.y;
      const double direct = shaded ? 0 : kSun * dot(sun, normal()), rest = ran.light[4 * w][i] - direct;
      lit += !shaded;
      EXPECT_GT(rest, 0.3 * kPi * kSky) << w << " " << i;
      EXPECT_LT(rest, kPi * kSky + 0.35 * kSun * 0.6 * 0.3) << w << " " << i;
    }
    EXPECT_GE(lit, w == 0 ? 2u : 24u);
    EXPECT_LE(lit, w == 0 ? 22u : 24u);
  }
}

// sigma T^4 = what is absorbed; the plate knows where it is asked.
TEST(Prepass, heats_what_cameras_see) {
  const Ran ran = run();
  EXPECT_EQ(ran.asked, 1);
  EXPECT_EQ(ran.wrong, 0);
  EXPECT_EQ(ran.report.captures, 6u);
  ASSERT_EQ(ran.report.log.size(), 6u);
  EXPECT_EQ(ran.report.log[0].sensor, "light") << "pre-passes come first";
  EXPECT_GE(ran.report.log[0].id, 2u) << "and are numbered last";
  double coldest = 1000, hottest = 0;
  for (size_t w = 0; w < 2; ++w)
    for (size_t k = 0; k < Camera::kSeen.size(); ++k) {
      const double load = (w == 0 ? ran.first : ran.second)[Camera::kSeen[k]] + kLongwave,
                   kelvin = std::pow(load / kStefan, 0.25), seen = ran.pictures[w].radiance[k];
      const auto expected = [](double t) { return planck_band_radiance(9.95, 10.05, t) / 0.1; };
      EXPECT_GT(seen, expected(kelvin - 0.3)) << w << " " << k;
      EXPECT_LT(seen, expected(kelvin + 0.3)) << w << " " << k;
      coldest = std::min(coldest, kelvin), hottest = std::max(hottest, kelvin);
    }
  EXPECT_GT(hottest - coldest, 15) << "nothing was tested";
}

TEST(Prepass, changes_pictures_through_loads_only) {
  const Ran whole = run(), given = run({}, &whole);
  EXPECT_EQ(given.report.captures, 2u);
  expect_same_pictures(given, whole);
  JobOptions few;
  few.budget.min_paths = few.budget.max_paths = 8;
  const Ran less = run(few);
  EXPECT_EQ(less.light, whole.light) << "budgets are those of pictures";
  EXPECT_EQ(less.pictures[0].paths[4], 8u);
}

class PrepassRuns : public testing::Test {
 protected:
  ~PrepassRuns() override { set_threads(0); }
};

TEST_F(PrepassRuns, the_same_with_any_number_of_threads) {
  set_threads(1);
  const Ran one = run();
  set_threads(2);
  expect_same(run(), one);
}

TEST_F(PrepassRuns, goes_on_where_it_was_interrupted) {
  set_threads(1);  // so that stop is asked once a block
  const Ran whole = run();
  const StateIdentity identity{{"scene", "plate"}};
  for (const int blocks : {0, 2, 5, 11, 12, 13}) {  // of 12 of the pre-pass and 2 of the camera
    const TempFolder folder;
    const std::string path = folder / "plate.state.h5";
    double stored = 0;
    const auto part = [&](StateUse use, int most) {
      const auto store = make_state(path, identity, {use});
      JobOptions job;
      job.store = store.get();
      job.begun = [&](const StoredWork& work) { stored = work.paths; };
      job.stop = [most, asked = 0]() mutable { return asked++ == most; };
      return run(job);
    };
    const Ran broken = part(StateUse::start, blocks);
    EXPECT_TRUE(broken.report.stopped);
    EXPECT_EQ(broken.asked, blocks < 12 ? 0 : 1) << "nothing is baked from half a pre-pass";
    expect_same(part(StateUse::resume, 1000), whole);
    EXPECT_EQ(stored, std::min(blocks, 12) * 8 * 64 + std::max(0, blocks - 12) * 5 * 16);
  }
}

TEST(Prepass, is_loaded_for) {
  std::vector<std::unique_ptr<Sensor>> before, cameras;
  before.push_back(pass());
  cameras.push_back(std::make_unique<Camera>());
  const auto windows = windows_um(cameras, before);
  ASSERT_EQ(windows.size(), 3u);
  for (const double um : {10.0, 0.55, 2.2})
    EXPECT_EQ(std::count_if(windows.begin(), windows.end(), [&](const auto& w) { return w[0] < um && um < w[1]; }), 1);
}

TEST(Prepass, refuses_what_it_cannot_run) {
  const auto made = [](std::vector<Prepass::Element> elements, TimeWindow w) {
    return message_of([&] { Prepass("p", elements, spectra(), std::span(&w, 1), {}); });
  };
  EXPECT_EQ(made(elements(), {0, 1}), "no error");
  EXPECT_THAT(made({}, {0, 1}), HasSubstr("has 0 elements"));
  EXPECT_THAT(made({{{0, 0, 0}, {0, 0, 2}}}, {0, 1}), HasSubstr("normal of length 2"));
  EXPECT_THAT(made({{{0, NAN, 0}, {0, 0, 1}}}, {0, 1}), HasSubstr("element 0 stands at"));
  EXPECT_THAT(made(elements(), {1, 0}), HasSubstr("from 1 to 0 s"));
}

// Whoever has no loads is told so, once the pre-pass has nothing to do with it.
TEST(Prepass, does_not_heat_by_itself) {
  std::vector<std::unique_ptr<Sensor>> before, cameras;
  before.push_back(pass());
  cameras.push_back(std::make_unique<Camera>());
  JobOptions job;
  job.progress = false;
  job.prepasses = before;
  EXPECT_THAT(message_of([&] { run_job(scene(), sources(), cameras, job); }),
              HasSubstr("needs the loads of its surface"));
}

}  // namespace
}  // namespace suite::test::prepass_test
