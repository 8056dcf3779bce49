// The choice of bins through gases: knots, cells, and bins of which some g-points are missing.
#include "scheduler/air_choice.h"

#include <gtest/gtest.h>

#include "air/column.h"
#include "support/bins_kit.h"

namespace suite::air_choice_test {
namespace {

TEST(AirChoice, CellsAreFineAndNarrowerInNarrowBands) {
  const std::vector<Band> bands{Band::rectangular("wide", 0.6, 0.1), Band::rectangular("narrow", 0.9, 0.0024),
                                Band::rectangular("thermal", 10, 1)};
  const SpectralState cells = air_cells(bands);
  double support = 0;
  for (const Bin& b : cells.bins) {
    const double width = b.high_um - b.low_um;
    support += width;
    EXPECT_LE(width, (b.low_um < 0.7 ? 0.0005 : b.low_um < 1 ? 0.0001 : 1e-4 * b.high_um * b.high_um) * 1.5);
  }
  EXPECT_NEAR(support, 1.1024, 1e-9);
}

TEST(AirChoice, KnotsAreTransparent) {
  SpectralState state = make_state(std::vector<Band>{Band::rectangular("b", 0.76, 0.02)}, 0.005, 0.76);
  const std::vector<float> depth{0.1f, 3.0f, 0.02f, 0.5f};
  place_transparent_knots(state, 1, depth);
  EXPECT_EQ(state.knots, std::vector<size_t>{2});
  // Nothing to choose between: the nearest stays.
  place_transparent_knots(state, 1, std::vector<float>(4, 0.2f));
  SpectralState plain = state;
  place_knots(plain, 1);
  EXPECT_EQ(state.knots, plain.knots);
}

// A state that has lost some g-points bakes the rest as before.
TEST(AirChoice, SomePointsOfAnIntervalBakeAsAmongAll) {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.gases = shared_builtin_gases();
  const SpectralState all =
      with_gas_points(air, make_state(std::vector<Band>{Band::rectangular("oxygen", 0.762, 0.01)}, 0.005));
  SpectralState some = all;
  some.bins.clear();
  std::vector<size_t> kept;
  for (size_t i = 1; i < all.size(); i += 2) some.bins.push_back(all.bins[i]), kept.push_back(i);
  some.knots = {0};
  ASSERT_GT(kept.size(), 2u);
  for (const ColumnParts parts : {ColumnParts::all, ColumnParts::extinction}) {
    const AirColumn whole = bake_column(air, all, parts), part = bake_column(air, some, parts);
    for (size_t l = 0; l < whole.layers(); ++l)
      for (size_t k = 0; k < kept.size(); ++k) {
        EXPECT_EQ(part.extinction[l * some.size() + k], whole.extinction[l * all.size() + kept[k]]);
        EXPECT_EQ(part.blackbody[l * some.size() + k], whole.blackbody[l * all.size() + kept[k]]);
      }
  }
}

// Light that gases have taken is held to what there was before, and no closer.
TEST(AirChoice, ErrorsOfWhatGasesHaveTakenAreRelativeToLightWithoutThem) {
  constexpr uint32_t one = SpectralProducts::kOne;
  SpectralProducts products;
  products.cells = 2;
  products.spectra = {{1e-3f, 3e-3f}, {1, 1}};
  products.products = {{0, {one, one, one}}, {1, {one, one, one}}};
  const BandCells band{0, {0.5, 0.5}};
  EXPECT_NEAR(band_means(products, band)[0].scale, 2e-3, 1e-9);
  products.unabsorbed = {{1, 1}};
  EXPECT_NEAR(band_means(products, band)[0].scale, 0.01, 1e-9);
  EXPECT_NEAR(band_means(products, band)[1].scale, 1, 1e-9);
}

// What bins may do to a band that they miss is part of its error; one within what is wanted keeps its own.
TEST(AirChoice, BiasOfBandsThatMissIsPartOfTheirErrors) {
  const std::vector<Band> bands{Band::rectangular("a", 0.55, 0.01), Band::rectangular("b", 0.65, 0.01)};
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("grey", test::lambert(0.5))});
  SourceSpecs sources = test::sun_of(Curve::constant(1000));
  const auto errors = [&](BandBiases biases) {
    std::vector<std::unique_ptr<Sensor>> sensors;
    sensors.push_back(std::make_unique<test::RaySensor>(std::vector<Ray>{{{0.1, 0.1, 5}, {0, 0, -1}, 0}}, bands, 64));
    JobOptions job;
    job.progress = false;
    for (auto& [of, bias] : biases) job.biases[{sensors[0]->name(), of.second}] = bias;
    run_job(scene, sources, sensors, job);
    const CaptureResult& r = static_cast<test::RaySensor&>(*sensors[0]).result;
    return std::array{r.standard_error[0], r.standard_error[1], r.radiance[0]};
  };
  const auto without = errors({}), with = errors({{{"", 0}, {{0.1, 0, false}, {0.1, 0, true}}}});
  EXPECT_EQ(with[2], without[2]);
  EXPECT_NEAR(with[0], std::hypot(without[0], 0.1 * without[2]), 1e-9 * without[2]);
  EXPECT_EQ(with[1], without[1]);
  const auto dark = errors({{{"", 0}, {{0.1, 10 * without[2], false}, {}}}});
  EXPECT_NEAR(dark[0], std::hypot(without[0], without[2]), 1e-9 * without[2]);
}

}  // namespace
}  // namespace suite::air_choice_test
