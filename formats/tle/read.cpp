#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "formats/tle/tle.h"

namespace suite {

namespace {

Where whole_file(const std::string& path) { return {path, 0, 0, {}, -1}; }

constexpr size_t kLineLength = 69;

// One of the two lines; columns are counted from 1 as in every description of the format.
struct Line {
  std::string file, text;
  int number = 0;

  Where at(int column) const { return {file, number, column, text, -1}; }
  std::string_view columns(int first, int last) const {
    return std::string_view(text).substr(static_cast<size_t>(first - 1), static_cast<size_t>(last - first + 1));
  }
  // Blanks may pad a field on the left.
  double number_in(int first, int last, const char* what, const char* prefix = "") const {
    std::string field(columns(first, last));
    const size_t begin = field.find_first_not_of(' '), end = field.find_last_not_of(' ');
    if (begin == std::string::npos)
      throw Error(at(first), std::string("no ") + what + strf(" in columns %d to %d", first, last));
    field = field.substr(begin, end - begin + 1);
    if (*prefix)
      for (char& c : field)
        if (c == ' ') c = '0';
    field = prefix + field;
    double value = 0;
    const auto [stop, status] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (status != std::errc() || stop != field.data() + field.size() || !std::isfinite(value))
      throw Error(at(first), std::string(what) + " is no number: '" + std::string(columns(first, last)) + "'",
                  strf("columns %d to %d hold it", first, last));
    return value;
  }
  double degrees(int first, int last, const char* what, double high) const {
    const double v = number_in(first, last, what);
    if (!(v >= 0 && v <= high))
      throw Error(at(first), strf("%s is outside its range: %g", what, v), strf("0 to %g degrees", high));
    return v * kDegree;
  }
  // A signed mantissa with an implied leading point and a signed exponent of one digit: " 28098-4" is 0.28098e-4.
  double exponential(int first, int last, const char* what) const {
    const std::string field(columns(first, last));
    std::string text_value = field[0] == '-' ? "-0." : "0.";
    const size_t e = field.find_last_of("+-");
    bool ok = (field[0] == ' ' || field[0] == '+' || field[0] == '-') && e != std::string::npos && e > 1 &&
              e + 2 == field.size();
    for (size_t i = 1; ok && i < field.size(); ++i) {
      if (i == e)
        text_value += field[i] == '-' ? "e-" : "e";
      else if (std::isdigit(static_cast<unsigned char>(field[i])))
        text_value += field[i];
      else
        ok = false;
    }
    double value = 0;
    if (ok) ok = std::from_chars(text_value.data(), text_value.data() + text_value.size(), value).ec == std::errc();
    if (!ok)
      throw Error(at(first), std::string(what) + " is no number: '" + field + "'",
                  "write it like ' 28098-4' for 0.28098e-4");
    return value;
  }
};

int checksum(std::string_view digits) {
  int sum = 0;
  for (const char c : digits) sum += std::isdigit(static_cast<unsigned char>(c)) ? c - '0' : c == '-' ? 1 : 0;
  return sum % 10;
}

void check_line(const Line& line, TleChecksum checksum_rule) {
  if (line.text.size() < kLineLength)
    throw Error(line.at(static_cast<int>(line.text.size()) + 1), strf("this line has %zu characters", line.text.size()),
                "a line of a two-line element set has 69");
  if (line.text.size() > kLineLength && line.text[kLineLength] != ' ')
    throw Error(line.at(70), "text goes on after column 69", "only after a blank may something follow");
  for (size_t i = 0; i < kLineLength; ++i)
    if (line.text[i] < ' ' || line.text[i] > '~')
      throw Error(line.at(static_cast<int>(i) + 1), "a character that is not printable ASCII");
  const int expected = checksum(line.columns(1, 68)), found = line.text[68] - '0';
  if (checksum_rule == TleChecksum::required && found != expected)
    throw Error(line.at(69), strf("the checksum is '%c', the line adds up to %d", line.text[68], expected),
                "a digit of this line is wrong");
}

Utc epoch_of(const Line& line) {
  const double yy = line.number_in(19, 20, "the year of the epoch"),
               day = line.number_in(21, 32, "the day of the epoch");
  Utc u;
  u.year = static_cast<int>(yy) + (yy < 57 ? 2000 : 1900);
  if (u.year < 1972) throw Error(line.at(19), strf("the epoch lies in %d", u.year), "UTC is defined from 1972 on");
  const bool leap = (u.year % 4 == 0 && u.year % 100 != 0) || u.year % 400 == 0;
  if (!(day >= 1 && day < (leap ? 367 : 366)))
    throw Error(line.at(21), strf("the day of the epoch is outside the year: %g", day));
  const int lengths[] = {31, leap ? 29 : 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  int whole = static_cast<int>(day);
  for (u.month = 1; whole > lengths[u.month - 1]; ++u.month) whole -= lengths[u.month - 1];
  u.day = whole;
  double seconds = (day - std::floor(day)) * 86400;
  u.hour = static_cast<int>(seconds / 3600);
  u.minute = static_cast<int>((seconds -= 3600.0 * u.hour) / 60);
  u.second = seconds - 60.0 * u.minute;
  return u;
}

OrbitElements elements_of(const Line& one, const Line& two, TleChecksum checksum_rule) {
  check_line(one, checksum_rule);
  check_line(two, checksum_rule);
  if (one.columns(3, 7) != two.columns(3, 7))
    throw Error(two.at(3), "line 2 is of satellite '" + std::string(two.columns(3, 7)) + "', line 1 of '" +
                               std::string(one.columns(3, 7)) + "'");
  OrbitElements o;
  const std::string_view id = one.columns(3, 7);
  o.satellite = std::string(id.substr(std::min(id.find_first_not_of(' '), id.size())));
  if (o.satellite.empty()) throw Error(one.at(3), "no catalogue number in columns 3 to 7");
  o.epoch = epoch_of(one);
  o.drag = one.exponential(54, 61, "the drag term B*");
  o.inclination = two.degrees(9, 16, "the inclination", 180);
  o.ascending_node = two.degrees(18, 25, "the ascending node", 360);
  o.eccentricity = two.number_in(27, 33, "the eccentricity", "0.");
  o.perigee_argument = two.degrees(35, 42, "the argument of perigee", 360);
  o.mean_anomaly = two.degrees(44, 51, "the mean anomaly", 360);
  const double revolutions = two.number_in(53, 63, "the mean motion");
  if (!(revolutions > 0 && revolutions < 20))
    throw Error(two.at(53), strf("the mean motion is outside its range: %g", revolutions),
                "more than 0, below 20 revolutions a day");
  o.mean_motion = revolutions * 2 * kPi / 1440;
  return o;
}

struct Pair {
  std::string title;
  Line one, two;
};

// The lines of a text, paired; what is in them is not looked at yet.
std::vector<Pair> pairs_of(std::string_view text, const std::string& file_name) {
  std::vector<Pair> pairs;
  std::string title;
  std::optional<Line> first;
  int number = 0;
  while (!text.empty()) {
    const size_t end = text.find('\n');
    Line line{file_name, std::string(text.substr(0, end)), ++number};
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    while (!line.text.empty() && (line.text.back() == '\r' || line.text.back() == ' ')) line.text.pop_back();
    const bool is_one = line.text.starts_with("1 "), is_two = line.text.starts_with("2 ");
    if (first && !is_two)
      throw Error(line.at(1), "line 2 of the element set is missing here", strf("line 1 is line %d", first->number));
    if (line.text.empty() || line.text[0] == '#') continue;
    if (is_one) {
      first = line;
    } else if (is_two) {
      if (!first) throw Error(line.at(1), "line 2 of an element set without its line 1");
      pairs.push_back({title, *first, line});
      first.reset();
      title.clear();
    } else {
      title = line.text.starts_with("0 ") ? line.text.substr(2) : line.text;
    }
  }
  if (first) throw Error(first->at(1), "line 2 of the element set is missing", "the file ends after line 1");
  if (pairs.empty())
    throw Error(whole_file(file_name), "there is no two-line element set in it", "lines starting with '1 ' and '2 '");
  return pairs;
}

std::string text_of(const std::string& path) { return read_text(path, size_t{256} << 20); }

}  // namespace

std::vector<TleEntry> parse_tle(std::string_view text, const std::string& file_name, TleChecksum checksum_rule) {
  std::vector<TleEntry> sets;
  for (const Pair& p : pairs_of(text, file_name)) sets.push_back({p.title, elements_of(p.one, p.two, checksum_rule)});
  return sets;
}

std::vector<TleEntry> read_tle(const std::string& path, TleChecksum checksum_rule) {
  return parse_tle(text_of(path), path, checksum_rule);
}

TleEntry read_tle_of(const std::string& path, const std::string& satellite) {
  std::vector<std::string> known;
  std::optional<Pair> found;
  for (const Pair& p : pairs_of(text_of(path), path)) {
    std::string number = p.one.text.substr(2, 5);
    number.erase(0, number.find_first_not_of(' '));
    known.push_back(number);
    if (number != satellite && (p.title.empty() || p.title != satellite)) continue;
    if (found)
      throw Error(p.one.at(1), "satellite '" + satellite + "' is there several times", "keep one of its element sets");
    found = p;
  }
  if (!found)
    throw Error(whole_file(path), "no element set of satellite '" + satellite + "'", name_hint(satellite, known));
  return {found->title, elements_of(found->one, found->two, TleChecksum::required)};
}

}  // namespace suite
