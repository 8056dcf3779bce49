// Days and the year of Denver against sums that another program makes of the same text.
//
// Sums of the columns, and the mean of (infrared / sigma)^(1/4), printed by mawk 1.3.4 (HEAD: header lines, 5 or 8):
//   awk -F, 'FNR>HEAD {n++; g+=$14; b+=$15; d+=$16; i+=$13; t+=$7; s+=($13/5.670374419e-8)^0.25}
//            END {printf "%.10g %.10g %.10g %.12g %.12g %.12g\n", g, b, d, i/n, t/n, s/n}' FILE
// Four days are tests/data/weather/denver_four_days.epw. The whole year, USA_CO_Denver.Intl.AP.725650_TMY3.epw (where
// it is from: the README there), is read where SUITE_WEATHER_DATA names its folder.
#include <cstdlib>

#include "base/files.h"
#include "formats/weather/weather.h"
#include "spectral/planck.h"
#include "support/weather_kit.h"

namespace suite::format_weather_denver_test {
namespace {

struct Sums {
  double global, direct, diffuse;        // Wh/m2
  double infrared, celsius, sky_kelvin;  // means
};

void expect_sums(const Weather& w, const Sums& expected) {
  const TimeSpan span = w.span();
  const double hours = (span.end - span.begin) / 3600;
  EXPECT_NEAR(w.mean(Q::global, span.begin, span.end) * hours, expected.global, 1e-9 * expected.global);
  EXPECT_NEAR(w.mean(Q::direct_normal, span.begin, span.end) * hours, expected.direct, 1e-9 * expected.direct);
  EXPECT_NEAR(w.mean(Q::diffuse, span.begin, span.end) * hours, expected.diffuse, 1e-9 * expected.diffuse);
  EXPECT_NEAR(w.mean(Q::longwave_down, span.begin, span.end), expected.infrared, 1e-9 * expected.infrared);
  double celsius = 0, sky = 0;
  for (double t = span.begin; t < span.end - 1; t += 3600) {
    celsius += w.at(Q::air_temperature, t + 3600) - 273.15;
    sky += std::pow(w.mean(Q::longwave_down, t, t + 3600) / kStefanBoltzmann, 0.25);
  }
  EXPECT_NEAR(celsius / hours, expected.celsius, 1e-8);
  EXPECT_NEAR(sky / hours, expected.sky_kelvin, 1e-6);
}

// What a sum of the means over other intervals must be, too: nothing is counted twice or left out.
void expect_additive(const Weather& w, const Sums& expected) {
  const TimeSpan span = w.span();
  const int parts = 1013;
  double sum = 0;
  for (int i = 0; i < parts; ++i) {
    const double a = span.begin + (span.end - span.begin) * i / parts,
                 b = span.begin + (span.end - span.begin) * (i + 1) / parts;
    sum += w.mean(Q::global, a, b) * (b - a) / 3600;
  }
  EXPECT_NEAR(sum, expected.global, 1e-7 * expected.global);
}

// The infrared that is left out is modelled as NREL's converter modelled it (Clark & Allen), which rounds to 1 W/m2.
double worst_modelled_infrared(const std::string& text, const Weather& given) {
  std::string without;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    if (line.starts_with("1") || line.starts_with("2")) {
      size_t comma = 0;
      for (int i = 0; i < 12; ++i) comma = line.find(',', comma) + 1;
      line.replace(comma, line.find(',', comma) - comma, "9999");
    }
    without += line + "\n";
    at = end + 1;
  }
  const Weather modelled = parse_weather(without, "denver.epw", {.year = 2001, .longwave = LongwaveModel::clark_allen});
  EXPECT_THAT(modelled.notes(), Contains(HasSubstr("longwave_down is modelled")));
  double worst = 0;
  for (size_t i = 0; i < given.table().rows.size(); ++i)
    worst = std::max(worst, std::abs(modelled.table().rows[i].value(Q::longwave_down) -
                                     given.table().rows[i].value(Q::longwave_down)));
  return worst;
}

TEST(Denver, FourDaysToTheirSums) {
  const std::string file = SUITE_TEST_DATA "/weather/denver_four_days.epw";
  const Weather w = read_weather(file);
  const Sums expected{12265, 8881, 7111, 289.21875, 4.35625, 267.096631093};
  expect_sums(w, expected);
  expect_additive(w, expected);
  EXPECT_LT(worst_modelled_infrared(read_text(file), w), 1);
}

TEST(Denver, TheYearToItsSums) {
  const char* folder = std::getenv("SUITE_WEATHER_DATA");
  if (!folder) GTEST_SKIP() << "SUITE_WEATHER_DATA does not name the folder of the whole year";
  const std::string file = std::string(folder) + "/USA_CO_Denver.Intl.AP.725650_TMY3.epw";
  // A year without a leap second.
  const Weather w = read_weather(file, {.year = 2001});
  for (const std::string& note : w.notes()) std::printf("%s\n", note.c_str());
  EXPECT_NEAR((w.span().end - w.span().begin) / 3600, 8760, 1e-3);
  const Sums expected{1670220, 1977576, 556451, 310.026369863, 10.8753424658, 271.119614809};
  expect_sums(w, expected);
  expect_additive(w, expected);
  EXPECT_THAT(w.notes(), Not(Contains(HasSubstr("centred"))));
  std::printf("infrared as modelled, at worst %.2f W/m2 off\n", worst_modelled_infrared(read_text(file), w));
}

}  // namespace
}  // namespace suite::format_weather_denver_test
