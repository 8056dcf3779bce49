// Days of the Surface Radiation Budget Network of NOAA. Based on: README_SURFRAD.txt of the network's archive; J.
// Augustine, J. DeLuisi & C. Long, "SURFRAD - a national surface radiation budget network for atmospheric research",
// Bull. Amer. Meteor. Soc. 81, 2000.
#include <algorithm>
#include <array>
#include <cmath>

#include "formats/weather/readers.h"

namespace suite {

namespace {

using Q = WeatherQuantity;

constexpr double kSurfradNone = -9999;  // this and less
constexpr size_t kWords = 48, kZenith = 7;

struct SurfradColumn {
  Q quantity;
  size_t word;  // its flag follows
  const char* name;
  double scale, offset;
};
constexpr SurfradColumn kSurfradColumns[] = {{Q::global, 8, "downwelling solar", 1, 0},
                                             {Q::shortwave_up, 10, "upwelling solar", 1, 0},
                                             {Q::direct_normal, 12, "direct normal solar", 1, 0},
                                             {Q::diffuse, 14, "diffuse solar", 1, 0},
                                             {Q::longwave_down, 16, "downwelling infrared", 1, 0},
                                             {Q::longwave_up, 22, "upwelling infrared", 1, 0},
                                             {Q::air_temperature, 38, "air temperature", 1, kFreezing},
                                             {Q::relative_humidity, 40, "relative humidity", 0.01, 0},
                                             {Q::wind_speed, 42, "wind speed", 1, 0},
                                             {Q::pressure, 46, "pressure", 100, 0}};
constexpr size_t kSurfradWindDirection = 44;

// Whether the value of a word is to be used; what its flag says is counted.
struct Flags {
  size_t bad = 0, flagged = 0;
  bool use(const TextLines& lines, size_t word, double value) {
    const long long flag = lines.integer(word + 1, "quality flag", 0, 99);
    if (value <= kSurfradNone) return false;
    if (flag == 1) ++bad;
    if (flag > 1) ++flagged;
    return flag != 1;
  }
};

struct Zenith {
  Instant instant;
  double angle = 0;  // rad
};

// Longitudes stand without a sign though they are western: the zenith angles of the rows decide.
void settle_longitude(WeatherTable& table, const std::vector<Zenith>& zeniths) {
  constexpr size_t kAsked = 8;
  const size_t every = std::max<size_t>(1, zeniths.size() / kAsked);
  double best = 1e9;
  const double written = table.site.longitude_deg;
  for (const double longitude : {-written, written}) {
    const SceneFrame frame({table.site.latitude_deg, longitude, table.site.height_m});
    double worst = 0;
    for (size_t i = 0; i < zeniths.size(); i += every)
      worst = std::max(worst, std::abs(kPi / 2 - sun_at(frame, {}, zeniths[i].instant).elevation - zeniths[i].angle));
    if (worst < best) best = worst, table.site.longitude_deg = longitude;
  }
  // Zenith angles may be those of refracted light, half a degree at the horizon.
  if (best > 1.5 * kDegree)
    throw Error(table.where(0),
                strf("the zenith angles of the sun in the file are up to %.1f degrees off those over its place",
                     best / kDegree),
                "wrong date, place or time zone?");
  if (table.site.longitude_deg != written)
    table.notes.push_back(strf("longitude %g is west, as the zenith angles of the file have it", written));
}

}  // namespace

WeatherTable parse_surfrad(std::string_view text, const std::string& file, const WeatherOptions& options) {
  WeatherTable table = table_of_means(file, options, "SURFRAD");
  TextLines lines(text, file);
  lines.next_raw();
  lines.next();
  table.site = {lines.number_in(0, "latitude", -90, 90), lines.number_in(1, "longitude", -180, 180),
                lines.number_in(2, "elevation", -1000, 9000)};
  std::vector<Instant> ends;
  std::vector<Zenith> zeniths;
  Flags flags;
  while (lines.next()) {
    if (lines.words() != kWords)
      throw lines.error(0, strf("a row of %zu values", lines.words()), strf("%zu stand in one of SURFRAD", kWords));
    LocalStamp s;
    s.year = static_cast<int>(lines.integer(0, "year", 1973, 2198));
    s.month = static_cast<int>(lines.integer(2, "month", 1, 12));
    s.day = static_cast<int>(lines.integer(3, "day", 1, 31));
    check_date(s, lines, 3);
    s.seconds = 3600 * lines.number_in(4, "hour", 0, 24) + 60 * lines.number_in(5, "minute", 0, 59);
    WeatherRow& row = add_row(table, lines);
    ends.push_back(instant_of(s, 0));
    zeniths.push_back({ends.back(), kDegree * lines.number_in(kZenith, "zenith angle", 0, 180)});
    for (const SurfradColumn& c : kSurfradColumns) {
      const double v = lines.number(c.word, c.name);
      if (flags.use(lines, c.word, v)) row.value(c.quantity) = c.scale * v + c.offset;
    }
    const double from = lines.number(kSurfradWindDirection, "wind direction");
    if (flags.use(lines, kSurfradWindDirection, from))
      row.value(Q::wind_from) =
          azimuth_from_compass_deg(lines.number_in(kSurfradWindDirection, "wind direction", 0, 360));
  }
  set_stamps(table, ends);
  table.notes.push_back(strf("times are UTC; values are means of the %g min that end at the stamp", table.step / 60));
  if (flags.bad) table.notes.push_back(strf("%zu values flagged as impossible (1) are taken as missing", flags.bad));
  if (flags.flagged) table.notes.push_back(strf("%zu values flagged as uncertain (above 1) are used", flags.flagged));
  settle_longitude(table, zeniths);
  return table;
}

}  // namespace suite
