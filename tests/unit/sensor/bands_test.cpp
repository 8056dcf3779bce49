// Bands of a sensor's text: one by one, in bulk, and from a table of responses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/params.h"
#include "sensor/sensors.h"
#include "support/message_of.h"

namespace suite::bands_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::vector<Band> bands(const std::string& text) {
  SensorContext context;
  context.responses = [](const Params&) {
    return std::vector<NamedResponse>{{"B1", Curve({0.44, 0.45}, {0.5, 1}, Outside::zero)},
                                      {"B8A", Curve({0.85, 0.86, 0.87}, {0, 1, 0}, Outside::zero)}};
  };
  return read_bands(Params::parse_text("bands: " + text, "s.yaml").at("bands"), context);
}
std::string message(const std::string& text) {
  return message_of([&] { bands(text); });
}

TEST(Bands, InBulkHaveEvenCentres) {
  const std::vector<Band> all = bands("{from_um: 0.4, to_um: 2.5, count: 211, fwhm_um: 0.012}");
  ASSERT_EQ(all.size(), 211u);
  for (size_t i = 0; i < all.size(); ++i) {
    EXPECT_NEAR(all[i].center_um, 0.4 + 0.01 * static_cast<double>(i), 1e-9);
    EXPECT_EQ(all[i].fwhm_um, 0.012);
  }
  EXPECT_EQ(all[0].name, "400 nm");
  EXPECT_EQ(all[33].name, "730 nm");
  // Without a width they touch; a shape goes to all.
  const std::vector<Band> touching = bands("[{from_um: 8, to_um: 12, count: 5, shape: rectangular}]");
  EXPECT_EQ(touching[1].fwhm_um, 1);
  EXPECT_EQ(touching[1].low_um(), 8.5);
  EXPECT_EQ(touching[4].high_um(), 12.5);
}

TEST(Bands, OfAllKindsStandInOneList) {
  const std::vector<Band> all =
      bands("[{name: red, center_um: 0.65, fwhm_um: 0.03}, {from_um: 1, to_um: 1.1, count: 2}, {responses: f.csv}]");
  std::string names;
  for (const Band& b : all) names += b.name + ";";
  EXPECT_EQ(names, "red;1000 nm;1100 nm;B1;B8A;");
  EXPECT_EQ(bands("{responses: f.csv, names: [B8A]}").at(0).name, "B8A");
}

TEST(Bands, FaultsHaveTheirPlace) {
  EXPECT_THAT(message("{from_um: 2, to_um: 1, count: 3}"),
              AllOf(HasSubstr("s.yaml:1:"), HasSubstr("not beyond the first")));
  EXPECT_THAT(message("{from_um: 1, to_um: 2, count: 1}"), HasSubstr("s.yaml:1:"));
  EXPECT_THAT(message("{from_um: 1, to_um: 2, count: 1000000000}"), HasSubstr("s.yaml:1:"));
  EXPECT_THAT(message("{from_um: 1, to_um: 2}"), HasSubstr("count"));
  EXPECT_THAT(message("[{from_um: 1, to_um: 2, count: 2}, {from_um: 2, to_um: 3, count: 2}]"),
              HasSubstr("two bands are named '2000 nm'"));
  EXPECT_THAT(message("{from_nm: 400, to_nm: 700, count: 4}"),
              AllOf(HasSubstr("s.yaml:1:"), HasSubstr("a band has no key 'from_nm'"), HasSubstr("micrometres")));
  EXPECT_THAT(message("{name: b, center_nm: 550, fwhm_um: 0.01}"), HasSubstr("a band has no key 'center_nm'"));
  EXPECT_THAT(message("{name: b, fwhm_um: 0.01}"), HasSubstr("the band has no wavelengths; give name, center_um"));
  EXPECT_THAT(message("{responses: f.csv, names: [B8]}"), HasSubstr("the file has no band 'B8'; did you mean"));
}

}  // namespace
}  // namespace suite::bands_test
