// Files of SURFRAD and BSRN, written here after their grammars.
#include "formats/weather/weather.h"
#include "support/weather_kit.h"

namespace suite::format_weather_networks_test {
namespace {

constexpr Geodetic kAlamosa{37.70, -105.92, 2317};

// Minutes of SURFRAD from 2016-01-01 19:00 UTC on, with the sun's zenith angle as seen from a longitude.
struct Surfrad {
  double written = 105.92, zenith_longitude = -105.92;
  int rows = 5;
  std::string global = "   601.5 0", temperature = "    -7.6 0";  // with its flag, in the third row

  std::string text() const {
    std::string all = strf(" Alamosa\n   37.70  %g 2317 m version 1\n", written);
    const SceneFrame frame({37.70, zenith_longitude, 2317});
    for (int i = 0; i < rows; ++i) {
      const Instant now = instant_from_utc(parse_iso8601("2016-01-01T19:00:00Z")) + 60.0 * i;
      const double zenith = 90 - sun_at(frame, {}, now).elevation / kDegree;
      all += strf(" 2016   1  1  1 19 %2d %6.3f %6.2f", i, 19 + i / 60.0, zenith) + (i == 2 ? global : "   601.5 0") +
             "    65.0 0   980.0 0   100.2 0   186.3 0    -5.7 0    -6.2 0   276.0 0    -6.3 0    -6.4 0 -9999.9 1 "
             "-9999.9 1"
             "    -1.0 0   -89.7 0   -90.7 0" +
             (i == 2 ? temperature : "    -7.6 0") + "    52.7 0     3.1 0   304.7 0   773.5 0\n";
    }
    return all;
  }
  Weather read() const { return parse_weather(text(), "slv.dat"); }
};

TEST(SurfradDay, MinutesOfUtcThatEndAtTheStamp) {
  const Weather w = Surfrad().read();
  EXPECT_EQ(to_iso8601(w.clock().utc(0), 0), "2016-01-01T18:59:00Z");
  EXPECT_NEAR(w.table().step, 60, 1e-6);
  EXPECT_NEAR(w.mean(Q::global, 0, 60), 601.5, 1e-9);
  EXPECT_NEAR(w.mean(Q::shortwave_up, 0, 300), 65, 1e-9);
  EXPECT_NEAR(w.mean(Q::direct_normal, 0, 300), 980, 1e-9);
  EXPECT_NEAR(w.mean(Q::diffuse, 0, 300), 100.2, 1e-9);
  EXPECT_NEAR(w.mean(Q::longwave_down, 0, 300), 186.3, 1e-9);
  EXPECT_NEAR(w.mean(Q::longwave_up, 0, 300), 276, 1e-9);
  EXPECT_NEAR(w.at(Q::air_temperature, 100), 273.15 - 7.6, 1e-9);
  EXPECT_NEAR(w.at(Q::relative_humidity, 100), 0.527, 1e-9);
  EXPECT_NEAR(w.at(Q::wind_speed, 100), 3.1, 1e-9);
  EXPECT_NEAR(w.at(Q::wind_from, 100), std::remainder((90 - 304.7) * kDegree, 2 * kPi), 1e-9);
  EXPECT_NEAR(w.at(Q::pressure, 100), 77350, 1e-6);
  EXPECT_THAT(w.notes(), Contains("times are UTC; values are means of the 1 min that end at the stamp"));
}

TEST(SurfradDay, TheZenithAnglesTellWestFromEast) {
  const Weather west = Surfrad().read();
  EXPECT_NEAR(west.site().longitude_deg, kAlamosa.longitude_deg, 1e-12);
  EXPECT_THAT(west.notes(), Contains("longitude 105.92 is west, as the zenith angles of the file have it"));
  const Weather written = Surfrad{.written = -105.92}.read();
  EXPECT_NEAR(written.site().longitude_deg, -105.92, 1e-12);
  EXPECT_THAT(written.notes(), Not(Contains(HasSubstr("is west"))));
  EXPECT_THAT(message_of([] { Surfrad{.zenith_longitude = -75}.read(); }),
              HasSubstr("slv.dat:3: error: the zenith angles of the sun in the file are up to"));
}

TEST(SurfradDay, MissingAndFlags) {
  const Weather none = Surfrad{.global = " -9999.9 1"}.read();
  EXPECT_THAT(none.notes(), Contains("global is missing: 1 of 5 rows, first in line 5"));
  EXPECT_THAT(none.notes(), Contains("global from direct_normal and diffuse: 1 of 5 rows, first in line 5"));
  const Weather impossible = Surfrad{.temperature = "   -70.0 1"}.read();
  EXPECT_THAT(impossible.notes(), Contains("1 values flagged as impossible (1) are taken as missing"));
  EXPECT_TRUE(std::isnan(impossible.at(Q::air_temperature, 150)));
  const Weather flagged = Surfrad{.temperature = "    -8.6 2"}.read();
  EXPECT_THAT(flagged.notes(), Contains("1 values flagged as uncertain (above 1) are used"));
  EXPECT_NEAR(flagged.mean(Q::air_temperature, 120, 180), 273.15 - 8.6, 1e-9);
}

TEST(SurfradDay, RefusesWithThePlace) {
  EXPECT_THAT(message_of([] { parse_weather(Surfrad().text() + " 2016 1 1\n", "s"); }),
              HasSubstr("s:8:2: error: a row of 3 values"));
  EXPECT_THAT(message_of([] { Surfrad{.global = "  4000.0 0"}.read(); }),
              HasSubstr("slv.dat:5: error: global = 4000 W/m2 is out of range"));
}

// Two minutes of a month at Payerne (46.815 N, 6.944 E): latitudes count from the south pole, longitudes from 180 W.
std::string bsrn(const std::string& minute =
                     "  1   720    -999 -99.9 -999 -999     702   0.1  702  702\n"
                     "             95   0.1   95   95     291   0.2  291  291     18.5  61.5   957\n") {
  return "*C0001\n 21  6 2016  1\n  1   2   3\n*C0003\nXXX\n*C0004\n 1  1 2010\n  5  7\nKirche 1, Payerne\n+41 26      "
         "      +41 26\n"
         "XXX             someone@example.org\n 136.815 186.944  491 06610\n 1  1 2010\n  0  1  5  1 -1 -1\n*U0100\n" +
         minute +
         "  1   721     810   0.5  809  812     703   0.1  702  704\n"
         "             96   0.1   95   96     292   0.2  291  293    -99.9 -99.9  -999\n*C0300\n  1  720  150  0.1 150 "
         "150\n";
}

TEST(BsrnMonth, MinutesOfUtcThatBeginAtTheStamp) {
  const Weather w = parse_weather(bsrn(), "pay0616.dat");
  EXPECT_EQ(to_iso8601(w.clock().utc(0), 0), "2016-06-01T12:00:00Z");
  EXPECT_NEAR(w.site().latitude_deg, 46.815, 1e-9);
  EXPECT_NEAR(w.site().longitude_deg, 6.944, 1e-9);
  EXPECT_EQ(w.site().height_m, 491);
  EXPECT_NEAR(w.mean(Q::direct_normal, 0, 60), 702, 1e-9);
  EXPECT_NEAR(w.mean(Q::diffuse, 0, 60), 95, 1e-9);
  EXPECT_NEAR(w.mean(Q::longwave_down, 60, 120), 292, 1e-9);
  EXPECT_NEAR(w.mean(Q::global, 60, 120), 810, 1e-9);
  EXPECT_NEAR(w.mean(Q::air_temperature, 0, 60), 273.15 + 18.5, 1e-9);
  EXPECT_NEAR(w.mean(Q::pressure, 0, 60), 95700, 1e-6);
  EXPECT_TRUE(std::isnan(w.at(Q::air_temperature, 90)));
  EXPECT_THAT(w.notes(), Contains("global is missing: 1 of 2 rows, first in line 16"));
  EXPECT_THAT(w.notes(), Contains("global from direct_normal and diffuse: 1 of 2 rows, first in line 16"));
  EXPECT_THAT(w.notes(), Contains("times are UTC; values are means of the 1 min that begin at the stamp"));
}

TEST(BsrnMonth, RefusesWithThePlace) {
  EXPECT_THAT(message_of([] { parse_weather("*C0001\n 21  6 2016  1\n", "b"); }),
              HasSubstr("has no logical record 0004"));
  EXPECT_THAT(message_of([] { parse_weather(bsrn("  31   1 1 1 1 1 1 1 1 1\n1 1 1 1 1 1 1 1 1 1 1\n"), "b"); }),
              HasSubstr("b:16:3: error: there is no 2016-06-31"));
  EXPECT_THAT(message_of([] { parse_weather(bsrn("  1   1440 1 1 1 1 1 1 1 1\n1 1 1 1 1 1 1 1 1 1 1\n"), "b"); }),
              HasSubstr("minute of the day = 1440 is out of range"));
}

}  // namespace
}  // namespace suite::format_weather_networks_test
