// Photometric files: what they hold in every symmetry, closed forms of their lumens, faults with their place.
#include "formats/ies/ies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/error.h"
#include "math/vec.h"
#include "support/message_of.h"

namespace suite::format_ies_ies_test {
namespace {

using testing::HasSubstr;

// A file with these angles and candela (of a vertical and a horizontal angle), with factors that make 2.
std::string file_of(const std::vector<double>& v, const std::vector<double>& h,
                    const std::function<double(double, double)>& candela, const std::string& lumens = "-1") {
  std::string t = "IESNA:LM-63-2002\r\n[TEST] none\r\n[LUMINAIRE] a lamp\r\nTILT=NONE\r\n1 " + lumens + " 4 " +
                  std::to_string(v.size()) + " " + std::to_string(h.size()) + " 1 2 0.1 0.1 0\r\n0.5 1 100\r\n";
  for (const double x : v) t += std::to_string(x) + " ";
  t += "\r\n";
  for (const double x : h) t += std::to_string(x) + "\r\n";
  for (const double y : h)
    for (const double x : v) t += std::to_string(candela(x, y)) + "\r\n";
  return t;
}

std::vector<double> every(double step, double last, double first = 0) {
  std::vector<double> list;
  for (double x = first; x <= last + 1e-9; x += step) list.push_back(x);
  return list;
}

TEST(Ies, AnEvenLightBelowHasTwoPiOfItsCandela) {
  const IesLuminaire l = parse_ies(file_of({0, 90}, {0}, [](double, double) { return 50; }), "x.ies");
  EXPECT_EQ(l.name, "a lamp");
  EXPECT_DOUBLE_EQ(l.at(30, 77), 100);
  EXPECT_DOUBLE_EQ(l.at(91, 0), 0);
  EXPECT_NEAR(l.lumens(), 100 * 2 * kPi, 1e-9);
  EXPECT_EQ(l.watts, 100);
}

// A cosine (a Lambert panel) of I0 has pi I0 lumens; linear between steps of 1 deg it loses (1 deg)^2 / 12 of them.
// Cut-off luminaires: files that end at 60 degrees, where 2 pi (1 - cos 60) I of light ends.
TEST(Ies, FilesThatEndWhereTheLightDoes) {
  const IesLuminaire l = parse_ies(file_of({0, 30, 60}, {0}, [](double, double) { return 50; }), "x.ies");
  EXPECT_NEAR(l.lumens(), kPi * l.at(10, 0), 1e-9);
  EXPECT_EQ(l.at(60.1, 0), 0);
  double lost = 1;
  const IntensityTable table = intensity_table(l, lost);
  EXPECT_LT(std::fabs(lost), 0.005);  // the edge is a quarter of a degree wide
  EXPECT_EQ(table.polars, 721u);
}

TEST(Ies, ALambertPanelHasPiOfItsCandela) {
  const IesLuminaire l =
      parse_ies(file_of(every(1, 90), {0}, [](double v, double) { return std::cos(v * kDegree); }), "x.ies");
  EXPECT_NEAR(l.lumens(), 2 * kPi, 2 * kPi * 5e-5);
}

TEST(Ies, RangesOfAzimuthAreMirroredOn) {
  const auto f = [](double, double h) { return h; };
  const IesLuminaire quarter = parse_ies(file_of({0, 180}, {0, 90}, f), "q.ies"),
                     half = parse_ies(file_of({0, 180}, {0, 180}, f), "h.ies"),
                     turned = parse_ies(file_of({0, 180}, {90, 270}, f), "t.ies"),
                     whole = parse_ies(file_of({0, 180}, {0, 360}, f), "w.ies");
  EXPECT_NEAR(quarter.at(10, 100), 160, 1e-9);
  EXPECT_NEAR(quarter.at(10, 190), 20, 1e-9);
  EXPECT_NEAR(quarter.at(10, -10), 20, 1e-9);
  EXPECT_NEAR(half.at(10, 190), 340, 1e-9);
  EXPECT_NEAR(turned.at(10, 80), 200, 1e-9);
  EXPECT_NEAR(turned.at(10, 280), 520, 1e-9);
  EXPECT_NEAR(whole.at(10, 190), 380, 1e-9);
  // Means over azimuth: 90, 180, 360, 360 cd.
  EXPECT_NEAR(quarter.lumens(), 90 * 4 * kPi, 1e-6);
  EXPECT_NEAR(half.lumens(), 180 * 4 * kPi, 1e-6);
  EXPECT_NEAR(turned.lumens(), 360 * 4 * kPi, 1e-6);
  EXPECT_NEAR(whole.lumens(), 360 * 4 * kPi, 1e-6);
}

TEST(Ies, TheTableOfALampTurnsTheOtherWay) {
  const IesLuminaire l = parse_ies(
      file_of(every(5, 90), every(22.5, 360), [](double v, double h) { return 1 + v + (h < 360 ? h : 0); }), "x.ies");
  double lost = 1;
  const IntensityTable t = intensity_table(l, lost);
  EXPECT_EQ(t.polars, 721u);
  EXPECT_EQ(t.azimuths, 16u);
  EXPECT_NEAR(t.value[40 * 16 + 4], l.at(10, 270), 1e-9);  // 90 deg about the axis, which points down
  EXPECT_EQ(t.value[361 * 16], 0);                         // above the horizon
  // The table has half a step more light at the horizon, where the file ends at once.
  EXPECT_GT(lost, 0);
  EXPECT_LT(lost, 0.005);
}

TEST(Ies, AFullSphereOnTheGridLosesNothing) {
  double lost = 1;
  intensity_table(parse_ies(file_of(every(10, 180), {0}, [](double v, double) { return 200 - v; }), "x.ies"), lost);
  EXPECT_NEAR(lost, 0, 1e-12);
}

TEST(Ies, FaultsAreToldWithTheirPlace) {
  const auto even = [](double, double) { return 1.0; };
  auto message = [](const std::string& text) { return message_of([&] { parse_ies(text, "x.ies"); }); };
  EXPECT_THAT(message("IESNA:LM-63-2002\n"), HasSubstr("has no line TILT="));
  EXPECT_THAT(message("TILT=lamp.tlt\n"), HasSubstr("x.ies:1"));
  EXPECT_THAT(message("TILT=NONE\n1 -1 1 2 1 2 2 0 0 0\n"), HasSubstr("photometry of type B"));
  EXPECT_THAT(message(file_of({0, 90}, {0, 120}, even)), HasSubstr("horizontal angles reach from 0 to 120"));
  EXPECT_THAT(message(file_of({0, 90}, {90, 0}, even)), HasSubstr("do not ascend"));
  EXPECT_THAT(message(file_of({0, 90}, {0}, [](double, double) { return -1; })), HasSubstr("candela"));
  std::string cut = file_of({0, 90}, {0}, even);
  cut.resize(cut.size() - 12);
  EXPECT_THAT(message(cut), HasSubstr("the file ends before candela"));
}

// Truncated anywhere it is an Error or a whole file, never anything else.
TEST(Ies, TruncatedAnywhereIsAnError) {
  const std::string whole = file_of(every(30, 180), every(45, 180), [](double v, double h) { return v + h; });
  for (size_t n = 0; n < whole.size(); ++n) {
    try {
      parse_ies(std::string_view(whole).substr(0, n), "x.ies");
    } catch (const Error&) {
    }
  }
}

}  // namespace
}  // namespace suite::format_ies_ies_test
