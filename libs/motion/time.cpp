#include "motion/time.h"

#include <erfa.h>

#include <cctype>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

constexpr double kDay = 86400, kTtMinusTai = 32.184;
constexpr double kMjdZero = 2400000.5;
constexpr int kFirstYear = 1972, kLastYear = 2199;
// Days from the first of 1972 to the first of 2200, modified Julian; calendars are asked within a year of them.
constexpr int64_t kFirstDay = 41317, kEndDay = 124593, kMargin = 366;

[[noreturn]] void outside() {
  throw Error("a time is outside the range of UTC here", strf("%d to %d", kFirstYear, kLastYear));
}

bool leap_year(int y) { return (y % 4 == 0 && y % 100 != 0) || y % 400 == 0; }
int days_in_month(int year, int month) {
  constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return month == 2 && leap_year(year) ? 29 : kDays[month - 1];
}

int64_t mjd_of(int year, int month, int day) {
  double zero = 0, mjd = 0;
  const int status = eraCal2jd(year, month, day, &zero, &mjd);
  SUITE_CHECK_EQ(status, 0);
  return static_cast<int64_t>(mjd);
}

// TAI - UTC at the start of a day, whole seconds from 1972 on.
double leap_seconds(int64_t mjd) {
  if (mjd < kFirstDay - kMargin || mjd > kEndDay + kMargin) outside();
  int year = 0, month = 0, day = 0;
  double fraction = 0, delta = 0;
  eraJd2cal(kMjdZero, static_cast<double>(mjd), &year, &month, &day, &fraction);
  const int status = eraDat(year, month, day, 0.0, &delta);  // status 1: beyond the table, the last value holds
  SUITE_CHECK(status == 0 || status == 1);
  return delta;
}

double length_of_utc_day(int64_t mjd) { return kDay + leap_seconds(mjd + 1) - leap_seconds(mjd); }

void check_date(const Utc& u) {
  if (u.year < kFirstYear || u.year > kLastYear)
    throw Error(strf("year %d is outside the range of UTC here", u.year), strf("give %d to %d", kFirstYear, kLastYear));
  if (u.month < 1 || u.month > 12) throw Error(strf("month %d does not exist", u.month), "months are 1 to 12");
  if (u.day < 1 || u.day > days_in_month(u.year, u.month))
    throw Error(strf("%d-%02d has no day %d", u.year, u.month, u.day));
  if (u.hour < 0 || u.hour > 23) throw Error(strf("hour %d does not exist", u.hour), "hours are 0 to 23");
  if (u.minute < 0 || u.minute > 59) throw Error(strf("minute %d does not exist", u.minute), "minutes are 0 to 59");
  if (!(u.second >= 0 && u.second < 61)) throw Error(strf("second %g does not exist", u.second), "give 0 to below 60");
}

// Reads fixed-width digits and separators from a text; every complaint names the text.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}
  bool done() const { return at_ == text_.size(); }
  char peek() const { return done() ? '\0' : text_[at_]; }
  void skip() { ++at_; }
  [[noreturn]] void fail(const char* expected) const {
    throw Error("'" + std::string(text_) + "' is not a date and time: expected " + expected +
                    strf(" at character %zu", at_ + 1),
                "write 2003-10-17T19:30:30Z, with fractions of a second and a zone such as -07:00 if needed");
  }
  int digits(int count, const char* expected) {
    int value = 0;
    for (int i = 0; i < count; ++i, ++at_) {
      if (!std::isdigit(static_cast<unsigned char>(peek()))) fail(expected);
      value = value * 10 + (peek() - '0');
    }
    return value;
  }
  void expect(char c, const char* expected) {
    if (peek() != c) fail(expected);
    skip();
  }
  double fraction() {  // the digits after the point
    double value = 0, scale = 0.1;
    if (!std::isdigit(static_cast<unsigned char>(peek()))) fail("digits after the point");
    for (; std::isdigit(static_cast<unsigned char>(peek())); skip(), scale /= 10) value += scale * (peek() - '0');
    return value;
  }

 private:
  std::string_view text_;
  size_t at_ = 0;
};

// Minutes east of UTC: "Z", "+02:00", "-0700", or nothing.
int zone_minutes(Scanner& s) {
  if (s.done()) return 0;
  if (s.peek() == 'Z' || s.peek() == 'z') return s.skip(), 0;
  if (s.peek() != '+' && s.peek() != '-') s.fail("Z or a zone such as +02:00");
  const int sign = s.peek() == '-' ? -1 : 1;
  s.skip();
  const int hours = s.digits(2, "the hours of the zone");
  int minutes = 0;
  if (s.peek() == ':') s.skip();
  if (!s.done()) minutes = s.digits(2, "the minutes of the zone");
  if (hours > 14 || minutes > 59) s.fail("a zone within 14 hours of UTC");
  return sign * (hours * 60 + minutes);
}

}  // namespace

Instant operator+(Instant instant, double seconds) {
  // Whole days first, so that fractions keep their digits however long the time.
  const double days = std::floor(seconds / kDay);
  if (!(std::fabs(days) < 1e15)) outside();
  Instant r{instant.day + static_cast<int64_t>(days), instant.seconds + (seconds - days * kDay)};
  while (r.seconds >= kDay) r = {r.day + 1, r.seconds - kDay};
  while (r.seconds < 0) r = {r.day - 1, r.seconds + kDay};
  return r;
}

double operator-(Instant a, Instant b) { return static_cast<double>(a.day - b.day) * kDay + (a.seconds - b.seconds); }

Instant instant_from_utc(const Utc& u) {
  check_date(u);
  const int64_t day = mjd_of(u.year, u.month, u.day);
  const double of_day = 3600.0 * u.hour + 60.0 * u.minute + u.second;
  if (u.second >= 60 && !(u.hour == 23 && u.minute == 59 && of_day < length_of_utc_day(day)))
    throw Error(strf("%04d-%02d-%02d %02d:%02d has no second %g", u.year, u.month, u.day, u.hour, u.minute, u.second),
                "second 60 exists only in a leap second, at the end of such a day");
  return Instant{day, 0} + (of_day + leap_seconds(day));
}

Utc utc_from_instant(Instant instant) {
  if (instant.day < kFirstDay || instant.day >= kEndDay) outside();
  // The UTC day is the TAI day or the one before (TAI is ahead by less than a day).
  int64_t day = instant.day;
  double of_day = instant.seconds - leap_seconds(day);
  if (of_day < 0) {
    --day;
    of_day = instant.seconds + kDay - leap_seconds(day);
  }
  Utc u;
  double fraction = 0;
  eraJd2cal(kMjdZero, static_cast<double>(day), &u.year, &u.month, &u.day, &fraction);
  const int minutes = static_cast<int>(std::fmin(std::floor(of_day / 60), 1439));  // a leap second stays in 23:59
  u.hour = minutes / 60;
  u.minute = minutes % 60;
  u.second = of_day - 60.0 * minutes;
  return u;
}

Utc parse_iso8601(std::string_view text) {
  Scanner s(text);
  Utc u;
  u.year = s.digits(4, "a year of four digits");
  s.expect('-', "'-' after the year");
  u.month = s.digits(2, "a month of two digits");
  s.expect('-', "'-' after the month");
  u.day = s.digits(2, "a day of two digits");
  int zone = 0;
  if (!s.done()) {
    if (s.peek() != 'T' && s.peek() != 't' && s.peek() != ' ') s.fail("T and a time");
    s.skip();
    u.hour = s.digits(2, "an hour of two digits");
    s.expect(':', "':' after the hour");
    u.minute = s.digits(2, "a minute of two digits");
    if (s.peek() == ':') {
      s.skip();
      u.second = s.digits(2, "a second of two digits");
      if (s.peek() == '.') s.skip(), u.second += s.fraction();
    }
    zone = zone_minutes(s);
    if (!s.done()) s.fail("the end");
  }
  check_date(u);
  // A zone shifts calendar minutes, not seconds, so that a leap second keeps its name.
  if (zone != 0) {
    const int minutes = u.hour * 60 + u.minute - zone;
    const int days = minutes < 0 ? -1 : minutes >= 1440 ? 1 : 0;
    double fraction = 0;
    eraJd2cal(kMjdZero, static_cast<double>(mjd_of(u.year, u.month, u.day) + days), &u.year, &u.month, &u.day,
              &fraction);
    u.hour = (minutes - 1440 * days) / 60;
    u.minute = (minutes - 1440 * days) % 60;
  }
  instant_from_utc(u);  // refuses a second 60 where there is none
  return u;
}

std::string to_iso8601(const Utc& u, int decimals) {
  SUITE_CHECK(decimals >= 0 && decimals <= 9);
  const double scale = std::pow(10.0, decimals), cut = std::floor(u.second * scale) / scale;
  return strf("%04d-%02d-%02dT%02d:%02d:%0*.*fZ", u.year, u.month, u.day, u.hour, u.minute,
              decimals > 0 ? decimals + 3 : 2, decimals, cut);
}

JulianDate julian_tt(Instant instant) {
  return {kMjdZero + static_cast<double>(instant.day), (instant.seconds + kTtMinusTai) / kDay};
}

JulianDate julian_ut1(Instant instant, double dut1) {
  // The leap seconds of the UTC day the instant lies in.
  const int64_t utc_day = instant.seconds < leap_seconds(instant.day) ? instant.day - 1 : instant.day;
  return {kMjdZero + static_cast<double>(instant.day), (instant.seconds - leap_seconds(utc_day) + dut1) / kDay};
}

}  // namespace suite
