// Months of the Baseline Surface Radiation Network, "station-to-archive" files. Based on: G. Koenig-Langlo and others,
// "Update of the technical plan for BSRN data management", GCOS-174, 2013 (logical records 0001, 0004 and 0100).
#include "formats/weather/readers.h"

namespace suite {

namespace {

using Q = WeatherQuantity;

// Moves to the first line of a logical record.
void find_record(TextLines& lines, std::string_view number) {
  while (lines.next_raw())
    if (lines.line().size() >= 6 && lines.line()[0] == '*' && lines.line().substr(2, 4) == number) {
      lines.next_raw();
      return;
    }
  throw lines.error_at_end("has no logical record " + std::string(number), "station-to-archive files of BSRN have it");
}

// -999 and -99.9 stand where nothing was measured.
void put(WeatherRow& row, Q quantity, const TextLines& lines, size_t word, const char* name, double missing,
         double scale = 1, double offset = 0) {
  const double v = lines.number(word, name);
  if (v != missing) row.value(quantity) = scale * v + offset;
}

}  // namespace

WeatherTable parse_bsrn(std::string_view text, const std::string& file, const WeatherOptions& options) {
  WeatherTable table = table_of_means(file, options, "BSRN");
  TextLines lines(text, file);
  find_record(lines, "0001");
  LocalStamp month;
  month.month = static_cast<int>(lines.integer(1, "month", 1, 12));
  month.year = static_cast<int>(lines.integer(2, "year", 1973, 2198));
  find_record(lines, "0004");
  for (int i = 0; i < 5; ++i) lines.next_raw();
  // Counted from the south pole and from 180 west.
  table.site = {lines.number_in(0, "latitude", 0, 180) - 90, lines.number_in(1, "longitude", 0, 360) - 180,
                lines.number_in(2, "altitude", -1000, 9000)};
  find_record(lines, "0100");
  std::vector<Instant> begins;
  for (bool more = true; more && !lines.line().starts_with('*'); more = lines.next_raw()) {
    if (lines.words() == 0) continue;
    WeatherRow& row = add_row(table, lines);
    LocalStamp s = month;
    s.day = static_cast<int>(lines.integer(0, "day", 1, 31));
    check_date(s, lines, 0);
    s.seconds = 60 * static_cast<double>(lines.integer(1, "minute of the day", 0, 1439));
    begins.push_back(instant_of(s, 0));
    put(row, Q::global, lines, 2, "global", -999);
    put(row, Q::direct_normal, lines, 6, "direct", -999);
    if (!lines.next_raw()) throw lines.error_at_end("ends within a minute", "two lines stand for each");
    put(row, Q::diffuse, lines, 0, "diffuse", -999);
    put(row, Q::longwave_down, lines, 4, "downward longwave", -999);
    put(row, Q::air_temperature, lines, 8, "air temperature", -99.9, 1, kFreezing);
    put(row, Q::relative_humidity, lines, 9, "relative humidity", -99.9, 0.01);
    put(row, Q::pressure, lines, 10, "pressure", -999, 100);
  }
  set_stamps(table, begins);
  std::vector<Instant> ends;
  for (const Instant& begin : begins) ends.push_back(begin + table.step);
  set_stamps(table, ends);
  table.notes.push_back(strf("times are UTC; values are means of the %g min that begin at the stamp", table.step / 60));
  return table;
}

}  // namespace suite
