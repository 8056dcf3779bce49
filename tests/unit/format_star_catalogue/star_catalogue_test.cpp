// Star catalogues of the user: columns, proper motion against a star measured at two epochs, faults with their place.
#include "formats/star_catalogue/star_catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "support/message_of.h"

namespace suite::format_star_catalogue_star_catalogue_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::vector<CatalogueStar> parse(const std::string& text) { return parse_star_catalogue(text, "stars.csv"); }

TEST(StarCatalogue, ColumnsInAnyOrder) {
  const auto stars = parse(
      "# mine\n v_mag , dec_deg,ra_deg,b_v,name,type,temperature_k\r\n\n0.03,38.7837,279.2347,0.0,Vega,,\n# more\n"
      "5,-90,-30,,,G2V,\n6,0,0,1.5,hot,M9,30000\n");
  ASSERT_EQ(stars.size(), 3u);
  EXPECT_EQ(stars[0].name, "Vega");
  EXPECT_EQ(stars[0].v, 0.03);
  EXPECT_EQ(stars[0].kelvin, star_temperature(0));
  EXPECT_NEAR(std::remainder(stars[0].place.right_ascension / kDegree - 279.2347, 360), 0, 1e-9);
  EXPECT_NEAR(stars[0].place.declination / kDegree, 38.7837, 1e-9);
  EXPECT_EQ(stars[0].place.motion_declination, 0);
  EXPECT_EQ(stars[1].name, "2");
  EXPECT_NEAR(stars[1].kelvin, 5800, 100);  // G2V
  EXPECT_EQ(stars[2].kelvin, 30000);        // the temperature counts first
}

// Barnard's star, fastest of all: Gaia DR3 gives (269.448502525 deg, 4.739420051 deg) at 2016.0 and (-801.551,
// 10362.394) mas a year; Hipparcos at 1991.25 (269.45402305, 4.66828815) of ICRS. Taken from 2016 to 1991.25 the two
// meet, but for the perspective acceleration that the star's approach makes: 1.25 mas a year and year (J. Choi et al.,
// Astrophys. J. 764, 2013), 0.383 arc seconds along its way, which is north.
TEST(StarCatalogue, ProperMotionTakesBarnardsStarBack) {
  const auto stars = parse(
      "ra_deg,dec_deg,epoch,pm_ra_mas,pm_dec_mas,v_mag,type\n269.448502525,4.739420051,2016,-801.551,10362.394,9.51,"
      "M4\n");
  const CatalogPlace& p = stars[0].place;
  const double years = 1991.25 - 2000, ra = (p.right_ascension + years * p.motion_right_ascension) / kDegree,
               dec = (p.declination + years * p.motion_declination) / kDegree;
  EXPECT_NEAR(std::remainder(ra - 269.45402305, 360) * 3600, 0, 0.15);
  EXPECT_NEAR((dec - 4.66828815) * 3600, -0.383, 0.05);
  // Negative control: without its epoch the place is 4 minutes off.
  const auto unmoved = parse("ra_deg,dec_deg,v_mag,type\n269.448502525,4.739420051,9.51,M4\n");
  EXPECT_GT(std::fabs(unmoved[0].place.declination / kDegree - 4.66828815) * 3600, 200);
}

// Near the pole right ascension turns fast: the motion stays one along a great circle.
TEST(StarCatalogue, MovesAcrossThePole) {
  const auto stars = parse("ra_deg,dec_deg,epoch,pm_dec_mas,v_mag,b_v\n30,89.9,1900,720000,1,0\n");
  // 720 arc seconds a year are 20 degrees in 100 years.
  EXPECT_NEAR(stars[0].place.declination / kDegree, 70.1, 1e-6);
  EXPECT_NEAR(std::remainder(stars[0].place.right_ascension / kDegree - 210, 360), 0, 1e-6);
  EXPECT_NEAR(stars[0].place.motion_declination / kDegree * 3600, -720, 1e-3);
}

TEST(StarCatalogue, SpectralTypes) {
  EXPECT_NEAR(*colour_of_type("A0"), -0.02, 1e-12);
  EXPECT_NEAR(*colour_of_type("K2.5III"), 0.98, 1e-9);
  EXPECT_EQ(colour_of_type("M"), 1.64);
  EXPECT_EQ(colour_of_type("O2"), -0.33);
  for (const char* wrong : {"", "X3", "g2", "G10", "DA2", "C5", "G2.3.4"}) EXPECT_FALSE(colour_of_type(wrong)) << wrong;
}

TEST(StarCatalogue, SaysWhereItIsWrong) {
  const std::string head = "ra_deg,dec_deg,v_mag,b_v,type\n";
  const std::pair<std::string, std::string> faults[] = {
      {"", "is empty"},
      {head, "has no stars"},
      {"ra_deg,dec_deg,v_mag\n", "stars.csv:1"},
      {"ra_deg,v_mag,b_v\n", "'dec_deg' is missing"},
      {"ra_deg,dec_dg,v_mag,b_v\n", "dec_deg"},
      {"ra_deg,ra_deg,v_mag,b_v\n", "given twice"},
      {head + "1,2,3,0.5\n", "stars.csv:2"},
      {head + "1,2,3,0.5,,\n", "6 cells"},
      {head + "1,91,3,0.5,\n", "stars.csv:2:3"},
      {head + "1,2,three,0.5,\n", "three"},
      {head + "1,2,,0.5,\n", "'v_mag' is empty"},
      {head + "1,2,3,,\n", "coloured"},
      {head + "1,2,3,,Q5\n", "'Q5'"},
      {head + "1,2,nan,0.5,\n", "stars.csv:2"},
  };
  for (const auto& [text, expected] : faults)
    EXPECT_THAT(message_of([&] { parse(text); }), AllOf(HasSubstr("stars.csv"), HasSubstr(expected))) << text;
}

}  // namespace
}  // namespace suite::format_star_catalogue_star_catalogue_test
