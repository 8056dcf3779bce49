#include "air/representative.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/message_of.h"

namespace suite::representative_test {
namespace {

using testing::HasSubstr;

RepresentativeTable one_band() {
  RepresentativeTable t;
  t.bands = {{900, 1000, {{0, 1.0}}}};
  t.gases = {{Gas::o3, {1e-300, 1e25}, {250, 250}, {0}, {0}, {0}, {1e-25f, 3e-25f}}};
  return t;
}

// Pressures so far apart that their ratio is no number: an index went out of the table.
TEST(Representative, PressuresFarApart) {
  const auto gases = representative_gases(one_band());
  std::vector<AirLevel> levels(2);
  levels[0] = {0, 100000, 270, {}}, levels[1] = {1000, 0, 240, {}};
  for (AirLevel& l : levels) l.share(Gas::o3) = 1e-6;
  const auto points = gases->absorbers(gases->bands(900, 1000)[0], levels);
  const double share = std::log(1e305) / std::log(10.0) / 325;
  EXPECT_NEAR(points[0].absorption[0] / (levels[0].density() * 1e-6 * 1e-25 * (1 + 2 * share)), 1, 1e-5);
  EXPECT_EQ(points[0].absorption[1], 0);
}

TEST(Representative, RefusesWhatDoesNotFit) {
  const auto message = [](auto change) {
    RepresentativeTable t = one_band();
    change(t);
    return message_of([&] { check_representative(t); });
  };
  EXPECT_EQ(message([](RepresentativeTable&) {}), "no error");
  EXPECT_THAT(message([](RepresentativeTable& t) { t.bands[0].members[0].weight = 0.5; }), HasSubstr("sum to 0.5"));
  EXPECT_THAT(message([](RepresentativeTable& t) {
                t.bands.push_back({1010, 1020, {{0, 1.0}}});
              }),
              HasSubstr("band 2 begins at 1010 cm-1, the one before ends at 1000"));
  EXPECT_THAT(message([](RepresentativeTable& t) { t.gases[0].place[0] = 1; }),
              HasSubstr("o3: a wavelength is outside"));
  EXPECT_THAT(message([](RepresentativeTable& t) { t.gases[0].cross_section.pop_back(); }),
              HasSubstr("do not fit their axes"));
  EXPECT_THAT(message([](RepresentativeTable& t) { t.bands[0].members[0].wavelength = 3; }),
              HasSubstr("wavelengths are missing"));
}

}  // namespace
}  // namespace suite::representative_test
