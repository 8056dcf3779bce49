// What paths found, in files: there and back, other weather without a new ray, a search that was ended and goes on, and
// what does not fit.
#include "formats/heat_hdf/operator_hdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/files.h"
#include "support/message_of.h"
#include "support/searched_scene.h"
#include "support/temp_folder.h"

namespace suite::format_heat_hdf_operator_test {
namespace {

using namespace test;
using testing::AllOf;
using testing::HasSubstr;

void expect_same(const HeatOperator& a, const HeatOperator& b) {
  EXPECT_EQ(a.exchange.ends, b.exchange.ends);
  EXPECT_EQ(a.exchange.weights, b.exchange.weights);
  EXPECT_EQ(a.exchange.emissivity, b.exchange.emissivity);
  EXPECT_EQ(a.exchange.rays(), b.exchange.rays());
  EXPECT_EQ(a.exchange.unfinished(), b.exchange.unfinished());
  EXPECT_EQ(a.sun.beam.floats(), b.sun.beam.floats());
  EXPECT_EQ(a.sun.sky.floats(), b.sun.sky.floats());
  EXPECT_EQ(a.sun.below, b.sun.below);
  EXPECT_EQ(a.sun.beam_of_block.floats(), b.sun.beam_of_block.floats());
  EXPECT_EQ(a.sun.beam_spread.floats(), b.sun.beam_spread.floats());
  EXPECT_EQ(a.sun.sky_of_block.floats(), b.sun.sky_of_block.floats());
  EXPECT_EQ(a.sun.below_of_block, b.sun.below_of_block);
  EXPECT_EQ(a.sun.sun_hours, b.sun.sun_hours);
  EXPECT_EQ(a.sun.absorptance, b.sun.absorptance);
  EXPECT_EQ(a.sun.rays(), b.sun.rays());
}

size_t files_in(const std::string& folder) {
  size_t n = 0;
  std::error_code none;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder, none)) ++n;
  return n;
}

void other_weather(bool moving) {
  const TempFolder folder;
  const SearchedScene s(600, moving);
  const std::string path = folder / "heat_operator.h5";
  write_operator(path, s.found(), s.identity(), "a test");
  expect_same(s.found(), s.stored(path, s.identity()));
  const WeatherLoads cloudy = s.loads({.direct = 50, .diffuse = 200, .longwave = 380, .air_kelvin = 285}),
                     clear = s.loads({.direct = 800, .diffuse = 90, .longwave = 290, .air_kelvin = 300});
  const HeatResult anew = s.kit.solve(cloudy, s.spec), again = s.solved(s.stored(path, s.identity()), cloudy),
                   other = s.solved(s.stored(path, s.identity()), clear);
  ASSERT_EQ(anew.kelvin.size(), again.kelvin.size());
  double worst = 0, differs = 0;
  for (size_t k = 0; k < anew.kelvin.size(); ++k) {
    worst = std::fmax(worst, std::fabs(double{anew.kelvin[k]} - double{again.kelvin[k]}));
    differs = std::fmax(differs, std::fabs(double{anew.kelvin[k]} - double{other.kelvin[k]}));
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_EQ(anew.path_error, again.path_error);
  EXPECT_GT(differs, 5);  // negative control
}

TEST(HeatOperatorHdf, OtherWeatherNeedsNoNewRay) { other_weather(false); }
TEST(HeatOperatorHdf, NeitherDoesItWhereThingsMove) { other_weather(true); }

// Ends a search as a signal would: nothing after it is run.
struct Ended {};

void ended_search(bool moving) {
  const TempFolder folder;
  const SearchedScene s(600, moving);
  const HeatOperator whole = s.found();
  const size_t faces = s.kit.faces->size();
  const std::string pieces_folder = folder / "pieces";
  size_t had = 0;
  for (const size_t after :
       {size_t{1}, faces / 2, faces + 1, faces + faces / 2, 2 * faces + 1, 2 * faces + faces / 2}) {
    const auto pieces = pieces_in(pieces_folder, s.identity(), 0);
    size_t told = 0;
    EXPECT_THROW(s.found(pieces.get(),
                         [&](size_t more) {
                           if ((told += more) > after) throw Ended{};
                         }),
                 Ended);
    const size_t has = files_in(pieces_folder);
    EXPECT_GE(has, had);
    had = has;
  }
  EXPECT_GT(had, 4u);
  const auto pieces = pieces_in(pieces_folder, s.identity(), 0);
  size_t told = 0;
  const HeatOperator after = s.found(pieces.get(), [&](size_t more) { told += more; });
  EXPECT_EQ(told, 3 * faces);  // of sunlight twice
  expect_same(whole, after);
  // All is there now: another one traces nothing, and is the same.
  expect_same(whole, s.found(pieces_in(pieces_folder, s.identity(), 0).get()));
  write_file(pieces_folder + "/note.txt", std::string_view("somebody's"));
  remove_pieces(pieces_folder);
  EXPECT_EQ(files_in(pieces_folder), 1u);
  remove_pieces(folder / "none");
}

TEST(HeatOperatorHdf, AnEndedSearchGoesOn) { ended_search(false); }
TEST(HeatOperatorHdf, SoItDoesWhereThingsMove) {
  const SearchedScene s(600, true);
  const HeatOperator found = s.found();
  EXPECT_GT(found.exchange.rows.size(), found.exchange.faces());  // some faces see it
  EXPECT_LT(found.exchange.rows.size(), 2 * found.exchange.faces());
  ended_search(true);
}

TEST(HeatOperatorHdf, Messages) {
  const TempFolder folder;
  const SearchedScene s(300);
  const std::string path = folder / "heat_operator.h5";
  write_operator(path, s.found(), s.identity(), "a test");
  OperatorIdentity other = s.identity();
  other.scene[1].second = "32";
  EXPECT_THAT(message_of([&] { s.stored(path, other); }),
              AllOf(HasSubstr("heat_operator.h5"), HasSubstr("another number of paths (16, here 32)")));
  EXPECT_THAT(message_of([&] { s.stored(folder / "none.h5", s.identity()); }), HasSubstr("none.h5"));
  EXPECT_FALSE(StoredOperator(path, s.identity("of another day")).same_sun());
  EXPECT_EQ(operator_cut(path), s.identity().cut);
  const SunPath sun = StoredOperator(path, s.identity("of another day")).sun_path();
  EXPECT_EQ(sun.moments, s.identity().path.moments);
  EXPECT_EQ(sun.towards, s.identity().path.towards);
  EXPECT_EQ(sun.beam, s.identity().path.beam);
  EXPECT_EQ(sun.sky, s.identity().path.sky);
  EXPECT_THAT(message_of([&] { operator_cut(folder / "none.h5"); }), HasSubstr("none.h5"));
  const SearchedScene more(900);
  EXPECT_THAT(message_of([&] { more.stored(path, more.identity()); }), HasSubstr("heat_operator.h5"));
  // Pieces of another search, and ones that overlap.
  const std::string pieces = folder / "pieces";
  s.found(pieces_in(pieces, s.identity(), 0).get());
  EXPECT_THAT(message_of([&] { s.found(pieces_in(pieces, other, 0).get()); }), HasSubstr("infrared_0000000000.h5"));
  std::filesystem::copy_file(pieces + "/infrared_0000000000.h5", pieces + "/infrared_0000000001.h5");
  EXPECT_THAT(message_of([&] { s.found(pieces_in(pieces, s.identity(), 0).get()); }),
              HasSubstr("that another piece has, too"));
  HeatOperator bad = s.found();
  bad.exchange.ends[7] = 1u << 30;
  write_operator(path, bad, s.identity(), "a test");
  EXPECT_THAT(message_of([&] { s.stored(path, s.identity()); }), HasSubstr("/infrared/end holds"));
}

}  // namespace
}  // namespace suite::format_heat_hdf_operator_test
