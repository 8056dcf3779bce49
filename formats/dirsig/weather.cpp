// Weather of simulations (.wth), where temperatures of the scene follow from it. The file says neither its place nor
// its zone nor its date: the scene's, the tasks' and the tasks' are taken; of its two days the second is that of the
// tasks, so that the first is what has been.
#include <cmath>

#include "formats/dirsig/simulation_writer.h"
#include "motion/time.h"

namespace suite::dirsig {

namespace {

constexpr double kWeatherDay = 86400;
constexpr double kMostOffMean = 2.5;  // h that a zone's time may differ from the mean sun's

}  // namespace

// Hours ahead of UTC that a date ends with ("-07:00", "+0530"); none without, or with a Z.
std::optional<double> zone_of(std::string_view date) {
  const size_t time = date.find_first_of("T ");
  if (time == date.npos) return std::nullopt;
  const size_t sign = date.find_first_of("+-", time);
  if (sign == date.npos) return std::nullopt;
  std::string digits;
  for (const char c : date.substr(sign + 1))
    if (c >= '0' && c <= '9') digits += c;
  if (digits.size() != 2 && digits.size() != 4) return std::nullopt;
  const double hours = std::stod(digits.substr(0, 2)) + (digits.size() == 4 ? std::stod(digits.substr(2)) / 60 : 0);
  return date[sign] == '-' ? -hours : hours;
}

void SimulationWriter::read_weather(const Item& section) {
  if (!heat_) return section.mark_all(Fate::ignored, "no temperature of the scene follows from weather");
  const Item* data = section.find("classicdata");
  if (data) data->mark(Fate::exact);
  const Item* named = (data ? data : &section)->any({"filename", "weather_filename", "input_filename", "@filename"});
  if (!named || named->value.empty())
    return section.mark_all(Fate::unsupported, "a kind of weather that is not known here: temperatures are not found");
  use_weather(*named);
}

void SimulationWriter::use_weather(const Item& named) {
  const auto lost = [&](const std::string& why) {
    named.mark(Fate::unsupported, why + "; without weather no temperatures are found, and bands that see them fail");
  };
  if (epoch_.empty()) return lost("the tasks have no date");
  if (!origin_) return lost("the scene has no place on the Earth");
  WeatherAsked asked;
  try {
    asked.path = import_.file_of(named, folders_);
  } catch (const Error& e) {
    return lost(e.message());
  }
  const double mean_sun = std::round((*origin_)[1] / 15);
  const bool zoned = zone_h_ && std::fabs(*zone_h_ - (*origin_)[1] / 15) <= kMostOffMean;
  asked.site = *origin_;
  asked.utc_offset_h = zoned ? *zone_h_ : mean_sun;
  const Instant epoch = instant_from_utc(parse_iso8601(epoch_));
  // The clock on the wall, as if it were UTC.
  Utc local = utc_from_instant(epoch + asked.utc_offset_h * 3600);
  local.hour = local.minute = 0, local.second = 0;
  const Instant begin = instant_from_utc(local) + -asked.utc_offset_h * 3600 + -kWeatherDay;
  asked.date = to_iso8601(utc_from_instant(instant_from_utc(local) + -kWeatherDay), 0).substr(0, 10);
  double seconds = 0;
  try {
    seconds = help_.weather(asked);
  } catch (const Error& e) {
    return lost("it does not fit " + asked.date +
                strf(", UTC%+g h, in %.4g %.4g: ", asked.utc_offset_h, asked.site[0], asked.site[1]) +
                (e.where().file.empty() ? "" : to_text(e.where()) + ": ") + e.message());
  }
  Tree weather = Tree::map(named.where), heat = Tree::map(named.where);
  weather.set("file", Tree::word(import_.name_of(asked.path), named.where));
  weather.set("site", Tree::numbers({asked.site[0], asked.site[1], asked.site[2]}, named.where));
  weather.set("utc_offset_h", Tree::number(asked.utc_offset_h, named.where));
  weather.set("date", Tree::word(asked.date, named.where));
  heat.set("from", Tree::number(begin - epoch, named.where));
  heat.set("to", Tree::number(begin - epoch + seconds, named.where));
  root_.set("weather", std::move(weather)), root_.set("heat", std::move(heat));
  named.mark(Fate::approximated,
             "its first row is taken as midnight of " + asked.date +
                 strf(", UTC%+g h (%s)", asked.utc_offset_h, zoned ? "the tasks' zone" : "the mean sun's"));
}

}  // namespace suite::dirsig
