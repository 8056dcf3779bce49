// Simulations of DIRSIG rendered directly: the uniform atmosphere's closed form, conversion, strictness, messages.
#include <cmath>
#include <filesystem>
#include <functional>

#include "base/params.h"
#include "formats/envi/envi.h"
#include "motion/ephemeris.h"
#include "motion/time.h"
#include "spectral/planck.h"
#include "support/programs_kit.h"

namespace suite::dirsig_test {

namespace {

class Dirsig : public ProgramsTest<Dirsig> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    std::filesystem::copy(SUITE_TEST_DATA "/dirsig", folder_->path(), std::filesystem::copy_options::recursive);
  }
  static std::vector<double> image(const std::string& name) { return EnviImage(*folder_ / name).read_all(); }
  // Electrons of one of the camera's detectors under radiance that is the same at all wavelengths: G# = (1 + 4 N^2) /
  // (tau pi), N = 2, tau = 0.8, 10 ms, 10 x 10 um.
  static double electrons(double radiance, const std::function<double(double)>& response) {
    double sum = 0;
    constexpr double step = 1e-5;
    for (double x = 0.4 + step / 2; x < 1.0; x += step) sum += response(x) * x * 1e-6 * step;
    return 0.01 * 1e-10 * radiance / (17 / (0.8 * kPi)) * sum / (kPlanckConstant * kSpeedOfLight);
  }
  static void expect_closed_form(const std::string& name, double cos_zenith) {
    const double radiance = 0.5 * 2000 * cos_zenith / kPi;
    for (const double v : image(name + ".img")) ASSERT_NEAR(v / radiance, 1, 1e-4);
    const std::function<double(double)> responses[] = {
        [](double x) { return std::fabs(x - 0.55) <= 0.05 ? 1.0 : 0.0; },
        [](double x) { return std::exp(-0.5 * std::pow((x - 0.7) / 0.03, 2)) / std::sqrt(2 * kPi); },
        [](double x) {
          return x < 0.6 || x > 0.9 ? 0 : x < 0.7 ? 0.4 * (x - 0.6) / 0.1 : 0.4 - 0.3 * (x - 0.7) / 0.2;
        }};
    const std::vector<double> counted = image(name + "_electrons.img");
    EXPECT_FALSE(file_exists(*folder_ / (name + "_dn.img"))) << "nothing says what a count is";
    for (size_t i = 0; i < counted.size(); ++i)
      ASSERT_NEAR(counted[i] / electrons(radiance, responses[i % 3]), 1, 1e-4) << i;
  }
};

TEST_F(Dirsig, UniformAtmosphereHasItsClosedForm) {
  const CommandResult r = run("dirsig-render plane.jsim -o fixed -q");
  ASSERT_EQ(r.code, 0) << r.err;
  expect_closed_form("fixed/fixed_plane", 0.5);
}

TEST_F(Dirsig, UniformAtmosphereHasItsClosedFormUnderTheSunOfTheDate) {
  const CommandResult r = run("dirsig-render plane.sim -o dated -q");
  ASSERT_EQ(r.code, 0) << r.err;
  const SceneFrame frame({39, -120, 0});
  const Instant instant = instant_from_utc(parse_iso8601("2009-07-27T19:29:32Z"));
  expect_closed_form("dated/plane", sun_at(frame, {}, instant).direction.z);
}

TEST_F(Dirsig, ConvertedItGivesTheSameBytes) {
  ASSERT_EQ(run("dirsig-render plane.sim -o direct -q").code, 0);
  const CommandResult converted = run("dirsig-render plane.sim --convert ours -q");
  ASSERT_EQ(converted.code, 0) << converted.err;
  const CommandResult prepared = run("scene-prep ours/plane.yaml -o ours/plane.h5 -q");
  ASSERT_EQ(prepared.code, 0) << prepared.err;
  ASSERT_EQ(run("dirsig-render ours/simulation.yaml -o again -q").code, 0);
  for (const char* name : {"plane.img", "plane_electrons.img", "plane_truth.img"})
    EXPECT_EQ(read_text(*folder_ / (std::string("direct/") + name)),
              read_text(*folder_ / (std::string("again/") + name)))
        << name;
  EXPECT_NE(read_text(*folder_ / "ours/simulation_import.txt").find("; 0 unread"), std::string::npos);
}

TEST_F(Dirsig, ConvertKeepsTextsThatWereEdited) {
  const CommandResult first = run("dirsig-render plane.sim --convert mine");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.err.find("scene-prep mine/plane.yaml -o mine/plane.h5\n"), std::string::npos) << first.err;
  EXPECT_EQ(run("dirsig-render plane.sim --convert mine -q").code, 0) << "the same texts";
  for (const char* name : {"mine/plane.yaml", "mine/simulation.yaml"}) {
    const std::string written = read_text(*folder_ / name), edited = written + "# mine\n";
    write_file(*folder_ / name, std::string_view(edited));
    const CommandResult again = run("dirsig-render plane.sim --convert mine -q");
    EXPECT_EQ(again.code, 1);
    EXPECT_NE(again.err.find(std::string(name) + ": error: is there with other content"), std::string::npos)
        << again.err;
    EXPECT_NE(again.err.find("remove it, or name another folder"), std::string::npos) << again.err;
    EXPECT_EQ(read_text(*folder_ / name), edited);
    write_file(*folder_ / name, std::string_view(written));
  }
}

TEST_F(Dirsig, ConvertKeepsTextsOfScenesThatWereEdited) {
  ASSERT_EQ(run("scene-prep plane.scene --convert scene -q").code, 0);
  EXPECT_EQ(run("scene-prep plane.scene --convert scene -q").code, 0) << "the same texts";
  write_file(*folder_ / "scene/plane.yaml", std::string_view("scene: 1\n"));
  const CommandResult again = run("scene-prep plane.scene --convert scene -q");
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.err.find("scene/plane.yaml: error: is there with other content"), std::string::npos) << again.err;
  EXPECT_EQ(read_text(*folder_ / "scene/plane.yaml"), "scene: 1\n");
}

TEST_F(Dirsig, ThermFollowsFromTheWeatherOfTheSimulation) {
  const CommandResult r = run("dirsig-render warm.sim -o warm --set heat.elements=200 --set heat.paths=32");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.err.find("direct insolation is taken as that on a level plane"), std::string::npos) << r.err;
  // The radiance is that of a body of emissivity
  // 0.5, besides half of what the sky sends down.
  const EnviImage truth(*folder_ / "warm/warm_truth.img");
  const std::vector<double> all = truth.read_all();
  const auto band = std::find(truth.header().band_names.begin(), truth.header().band_names.end(), "temperature [K]");
  ASSERT_NE(band, truth.header().band_names.end());
  const size_t bands = truth.header().band_names.size();
  const double kelvin = all[static_cast<size_t>(band - truth.header().band_names.begin())];
  EXPECT_GT(kelvin, 291);  // soil that absorbs half of July's noon, under air of 288 K
  EXPECT_LT(kelvin, 310);
  ASSERT_EQ(all.size() % bands, 0u);
  const double body =
      0.5 * (planck_radiance(8, kelvin) + 4 * planck_radiance(10, kelvin) + planck_radiance(12, kelvin)) / 6;
  for (const double v : image("warm/warm.img")) EXPECT_NEAR(v / body, 1, 0.03);
  // Without it the visible goes on and the thermal is refused.
  write_file(*folder_ / "cold.atm",
             std::string_view(std::string(read_text(*folder_ / "warm.atm"))
                                  .replace(read_text(*folder_ / "warm.atm").find("july"), 4, "gone")));
  write_file(*folder_ / "cold.sim",
             std::string_view(std::string(read_text(*folder_ / "warm.sim"))
                                  .replace(read_text(*folder_ / "warm.sim").find("warm.atm"), 8, "cold.atm")));
  const CommandResult cold = run("dirsig-render cold.sim -o cold");
  EXPECT_EQ(cold.code, 1);
  EXPECT_NE(cold.err.find("cold.atm:3:"), std::string::npos) << cold.err;
  EXPECT_NE(cold.err.find("follows from weather, which is not given"), std::string::npos) << cold.err;
}

TEST_F(Dirsig, TheAccountIsComplete) {
  ASSERT_EQ(run("dirsig-render plane.jsim -o counted --import-report account.json -q").code, 0);
  const Params account = Params::parse_file(*folder_ / "account.json");
  const Params counts = account.at("counts");
  double sum = 0;
  for (const char* fate : {"exact", "converted", "approximated", "ignored-harmless", "unsupported"})
    sum += counts.number(fate);
  EXPECT_EQ(sum, account.number("items"));
  EXPECT_EQ(counts.number("unread"), 0);
  EXPECT_EQ(account.at("entries").size(), static_cast<size_t>(sum));
}

TEST_F(Dirsig, StrictLeavesNothingOut) {
  const CommandResult r = run("dirsig-render plane.sim -o strict --strict");
  EXPECT_EQ(r.code, 1);
  EXPECT_NE(r.err.find("a strict import leaves nothing out"), std::string::npos) << r.err;
  const CommandResult scene = run("scene-prep range.scene --strict -o strict.h5");
  EXPECT_EQ(scene.code, 1);
  EXPECT_NE(scene.err.find("SP704"), std::string::npos) << scene.err;
  EXPECT_FALSE(file_exists(*folder_ / "strict.h5"));
}

TEST_F(Dirsig, AFaultIsToldWhereItStands) {
  std::string text = read_text(*folder_ / "noon.tasks");
  write_file(*folder_ / "noon.tasks", std::string_view(std::string(text).replace(text.find("-07:00"), 6, "-7 hrs")));
  const CommandResult r = run("dirsig-render plane.sim -o never");
  write_file(*folder_ / "noon.tasks", std::string_view(text));
  EXPECT_EQ(r.code, 1);
  EXPECT_EQ(r.err.find("noon.tasks:2:15: error: "), 0u) << r.err;
  EXPECT_EQ(run("dirsig-render ours/simulation.yaml --convert x").code, 2);
}

TEST_F(Dirsig, AScenesReportPointsIntoItsFiles) {
  const CommandResult r = run("scene-prep range.scene -o range.h5 --import-report range.json");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("materials/range.mat:5:5: mat/MATERIAL_ENTRY/DOUBLE_SIDED = FALSE"), std::string::npos) << r.out;
  const Params account = Params::parse_file(*folder_ / "range.json");
  bool found = false;
  for (const Params& e : account.at("entries").items())
    found = found || (e.text("path") == "odb/CURVED_FRUSTUM/RAMP" && e.text("file") == "geometry/range.odb" &&
                      e.number("line") == 46 && e.text("fate") == "unsupported");
  EXPECT_TRUE(found);
  const CommandResult again = run("scene-prep range.scene -o range.h5");
  EXPECT_NE((again.out + again.err).find("up to date"), std::string::npos) << again.out << again.err;
}

}  // namespace

}  // namespace suite::dirsig_test
