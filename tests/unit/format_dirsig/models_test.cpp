// Reflectances, temperatures and weather of DIRSIG in terms of ours: parameters of facets, THERM, .wth.
#include <cmath>

#include "base/files.h"
#include "formats/scene_text/scene_text.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "support/dirsig_kit.h"
#include "support/temp_folder.h"

namespace suite::format_dirsig_models_test {

namespace {

class DirsigModels : public testing::Test {
 protected:
  DirsigModels() { std::filesystem::copy(kDirsigData, folder_.path(), std::filesystem::copy_options::recursive); }
  void change(const std::string& name, const std::string& from, const std::string& to) {
    std::string text = read_text(folder_ / name);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_file(folder_ / name, std::string_view(text.replace(at, from.size(), to)));
  }
  Params materials() {
    import_ = std::make_unique<dirsig::Import>(std::vector<std::string>{}, folder_.path());
    file_ = folder_ / "models.scene";
    made_ = dirsig::scene_of(*import_, file_);
    expect_accounted(import_->ledger());
    return params_of(made_.text, file_).at("materials");
  }
  Params simulation(const std::string& name) {
    import_ = std::make_unique<dirsig::Import>(std::vector<std::string>{}, folder_.path());
    const dirsig::SimulationHelp help = dirsig_help();
    const dirsig::MadeText made = dirsig::simulation_of(*import_, folder_ / name, help);
    expect_accounted(import_->ledger());
    return params_of(made, folder_ / name);
  }
  std::string fate(const std::string& end) const { return fate_of(import_->ledger(), end); }
  TempFolder folder_;
  std::unique_ptr<dirsig::Import> import_;
  dirsig::SceneMade made_;
  std::string file_;
};

TEST_F(DirsigModels, FitsBecomeFacets) {
  const Params target = materials().at("target");
  EXPECT_EQ(target.text("model"), "shell");
  EXPECT_EQ(target.number("sigma"), 0.15);
  EXPECT_EQ(target.number("tau_deg"), 12);
  // Blocks by their wavelengths.
  EXPECT_EQ(target.at("index").at("wavelength_um").as_numbers(), (std::vector<double>{0.45, 0.65}));
  EXPECT_EQ(target.at("index").at("value").as_numbers(), (std::vector<double>{1.5, 1.4}));
  // DHR = bias F + pi rho_d + 4 pi (1 - ln 2) rho_v at the first wavelength, of the sorted blocks.
  const double pi = std::acos(-1.0), volume = 4 * pi * (1 - std::log(2.0)) * 0.01;
  const auto mirrored = [](double n, double k) { return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k); };
  const double bias = target.number("bias");
  EXPECT_NEAR(bias * mirrored(1.5, 0.1) + pi * 0.01 + volume, 0.16, 1e-9);
  // What the emissivity of 0.5 leaves is the body's.
  const std::vector<double> diffuse = target.at("diffuse").at("value").as_numbers();
  EXPECT_NEAR(diffuse.front() + bias * mirrored(1.5, 0.1) + volume, 0.5, 1e-9);
  EXPECT_EQ(fate("REFLECTANCE_PROP/EMISSIVITY_FILE"), "approximated");
  EXPECT_EQ(fate("FIT_PARAMS/LAMBDA"), "exact");
  bool other_shape = false;
  for (const dirsig::Entry& e : import_->ledger().entries())
    other_shape =
        other_shape || (e.path.ends_with("/OMEGA") && e.value == "45" && e.note.find("first") != std::string::npos);
  EXPECT_TRUE(other_shape);
}

TEST_F(DirsigModels, ParametersMayStandInTheEntry) {
  const Params all = materials();
  EXPECT_EQ(all.at("background").text("model"), "shell");
  EXPECT_NEAR(all.at("background").number("diffuse"), std::acos(-1.0) * 0.05, 1e-12);
  EXPECT_EQ(all.at("germer").text("model"), "priest_germer");
  EXPECT_EQ(all.at("germer").number("diffuse"), 0);
  EXPECT_EQ(all.at("germer").number("temperature_k"), 301.5);
  EXPECT_EQ(all.at("kernels").text("model"), "ross_li");
  EXPECT_EQ(all.at("kernels").number("isotropic"), 0.2);
  EXPECT_EQ(all.at("kernels").at("volume").at("value").as_numbers(), (std::vector<double>{0.8, 0.8}));
  // 0.7 and 0.5 are more than all light.
  EXPECT_NEAR(all.at("copper").number("diffuse"), 0.7 / 1.2, 1e-12);
  EXPECT_EQ(all.at("copper").number("roughness_y"), 0.2);
  EXPECT_EQ(fate("REFLECTANCE_PROP/DS_WEIGHTS"), "approximated");
}

TEST_F(DirsigModels, WhatCannotBeReadIsToldAndGrey) {
  const Params nef = materials().at("nef");
  EXPECT_EQ(nef.number("reflectance"), 0.18);
  EXPECT_EQ(fate("REFLECTANCE_PROP/NEF_MAT_FILE"), "unsupported");
  EXPECT_EQ(fate("TEMP_SOLVER/IMAGE_FILENAME"), "unsupported");  // Balfour's coefficients
  EXPECT_EQ(fate("UV_PROJECTOR/FLIPX"), "unsupported");
  write_file(folder_ / "materials/0693UUUASP.nmf", std::string_view("1 2 3\nasphalt\n"));
  EXPECT_EQ(materials().at("nef").number("reflectance"), 0.18);
  write_file(folder_ / "materials/0693UUUASP.nmf",
             std::string_view("N = 1.6\nK = 0.2\nSIGMA = 0.2\nBIAS = 0.05\nTAU = 20\nOMEGA = 40\nRHO_D = 0.02\n"));
  EXPECT_EQ(materials().at("nef").text("model"), "beard_maxwell");
  EXPECT_EQ(fate("fit/BIAS"), "exact");
}

TEST_F(DirsigModels, ThermBecomesABalanceOfHeat) {
  const Params all = materials();
  EXPECT_TRUE(made_.heat);
  const Params soil = all.at("soil").at("temperature");
  EXPECT_EQ(soil.text("model"), "heat");
  EXPECT_NEAR(soil.number("specific_heat_j_kg_k"), 836.8, 1e-9);
  EXPECT_NEAR(soil.number("density_kg_m3"), 1600, 1e-9);
  EXPECT_NEAR(soil.number("conductivity_w_m_k"), 8.6 * 0.116222, 1e-4);
  EXPECT_NEAR(soil.number("thickness_m"), 0.1, 1e-12);
  EXPECT_EQ(soil.number("absorptance"), 0.7);
  EXPECT_FALSE(soil.has("emissivity"));  // its curve reaches 20 um
  EXPECT_FALSE(soil.has("back"));
  // A curve that ends at 2.5 um says nothing of the infrared; without a thickness it is as deep as a day.
  const Params lawn = all.at("lawn").at("temperature");
  EXPECT_EQ(lawn.number("emissivity"), 0.94);
  const double diffusivity = 8.6 * 0.116222222 / (1600 * 836.8);
  EXPECT_NEAR(lawn.number("thickness_m"), 3 * std::sqrt(diffusivity * 86400 / std::acos(-1.0)), 1e-6);
  // Nothing is stored without conduction; more than half is open on both sides.
  const Params copper = all.at("copper").at("temperature");
  EXPECT_FALSE(copper.has("density_kg_m3"));
  EXPECT_EQ(copper.text("back"), "open");
  EXPECT_EQ(fate("TEMP_SOLVER/EXPOSED_AREA"), "approximated");
  EXPECT_EQ(fate("TEMP_SOLVER/SPECULARITY"), "approximated");
}

TEST_F(DirsigModels, AllOfItIsAScene) {
  const Params root = (materials(), params_of(made_.text, file_));
  Report report(scene_issues());
  TrackedInputs inputs(file_, {});
  Draft draft = read_scene_tree(root, inputs, report);
  EXPECT_TRUE(report.ok()) << report.text();
  EXPECT_EQ(draft.materials.size(), 8u);
}

TEST_F(DirsigModels, WeatherHasThePlaceAndTheDateOfTheSimulation) {
  for (const char* name : {"warm.sim", "warm.jsim"}) {
    const Params root = simulation(name);
    const Params weather = root.at("weather");
    EXPECT_EQ(weather.text("date"), "2009-07-26");  // the second day is that of the tasks
    EXPECT_EQ(weather.number("utc_offset_h"), -7);
    EXPECT_NEAR(weather.at("site").as_numbers()[0], 39, 1e-9);
    EXPECT_NEAR(weather.at("site").as_numbers()[1], -120, 1e-9);
    // Midnight of the day before 12:29:32.
    EXPECT_NEAR(root.at("heat").number("from"), -(12 * 3600 + 29 * 60 + 32 + 86400), 1e-6);
    EXPECT_NEAR(root.at("heat").number("to") - root.at("heat").number("from"), 172800, 1e-6);
  }
  EXPECT_EQ(fate("inputs/filename"), "approximated");
  // A zone that the place cannot have is not believed.
  change("noon.tasks", "-07:00", "+02:00");
  EXPECT_EQ(simulation("warm.sim").at("weather").number("utc_offset_h"), -8);
  change("noon.tasks", "+02:00", "Z");
  EXPECT_EQ(simulation("warm.sim").at("weather").number("utc_offset_h"), -8);
}

TEST_F(DirsigModels, WeatherThatIsMissingOrDoesNotFitIsTold) {
  change("warm.atm", "july.wth", "gone.wth");
  EXPECT_FALSE(simulation("warm.sim").has("weather"));
  EXPECT_EQ(fate("classicdata/filename"), "unsupported");
  std::filesystem::copy(folder_ / "july.wth", folder_ / "winter.wth");
  change("warm.atm", "gone.wth", "winter.wth");
  EXPECT_FALSE(simulation("warm.sim").has("heat"));
  EXPECT_EQ(fate("classicdata/filename"), "unsupported");
  // Where no temperature waits for it, it has no effect.
  EXPECT_FALSE(simulation("plane.sim").has("weather"));
  EXPECT_EQ(fate("classicdata/filename"), "ignored-harmless");
}

}  // namespace

}  // namespace suite::format_dirsig_models_test
