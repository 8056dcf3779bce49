#include <charconv>
#include <cmath>

#include "base/files.h"
#include "base/text_lines.h"
#include "formats/tape5/tape5.h"
#include "math/vec.h"

namespace suite {

namespace {

class Deck {
 public:
  Deck(std::string_view text, const std::string& file) : lines_(text, file) {}

  std::vector<Tape5Run> runs() {
    std::vector<Tape5Run> runs;
    int repeat = 1;
    do {
      Tape5Run run = runs.empty() ? Tape5Run{} : runs.back();
      if (repeat == 1) {
        run = {};
        card("card 1");
        card_1(run);
        own_cards_ = run.unread.size();
      }
      if (repeat == 1 || repeat == 3) cards_3(run);
      if (repeat == 1 || repeat == 4) card_4(run);
      runs.push_back(run);
      // A deck may end without its last card.
      repeat = lines_.next() ? integer(1, 5) : 0;
      if (repeat != 0 && repeat != 1 && repeat != 3 && repeat != 4)
        throw at(1, strf("card 5 asks for a repetition of kind %d", repeat), "0, 1, 3 or 4");
    } while (repeat != 0);
    return runs;
  }

 private:
  Where place(int column) const {
    Where w = lines_.where();
    w.column = column;
    return w;
  }
  Error at(int column, const std::string& what, const std::string& hint = {}) const {
    return Error(place(column), what, hint);
  }
  void card(const char* name) {
    name_ = name;
    if (!lines_.next_raw()) throw lines_.error_at_end(std::string("the deck ends before ") + name);
  }
  // Columns count from 1. Nothing when they are blank.
  std::optional<double> number(int first, int length) const {
    std::string_view f = lines_.line();
    f = static_cast<size_t>(first) <= f.size() ? f.substr(static_cast<size_t>(first - 1), static_cast<size_t>(length))
                                               : std::string_view{};
    f.remove_prefix(std::min(f.find_first_not_of(' '), f.size()));
    f = f.substr(0, f.find_last_not_of(' ') + 1);
    if (f.empty()) return std::nullopt;
    if (f[0] == '+') f.remove_prefix(1);
    double value = 0;
    const auto [stop, code] = std::from_chars(f.data(), f.data() + f.size(), value);
    if (code != std::errc() || stop != f.data() + f.size() || !(std::fabs(value) < 1e12))
      throw at(first, strf("columns %d to %d of %s hold no number: '", first, first + length - 1, name_) +
                          std::string(f) + "'");
    return value;
  }
  double number_in(int first, int length, double low, double high) const {
    const double v = number(first, length).value_or(0);
    if (!(v >= low && v <= high))
      throw at(first, strf("columns %d to %d of %s hold %g", first, first + length - 1, name_, v),
               strf("%g to %g", low, high));
    return v;
  }
  int integer(int first, int length) const {
    const auto v = number(first, length);
    if (v && (*v != std::floor(*v) || std::fabs(*v) > 1e6))
      throw at(first, strf("columns %d to %d of %s hold no whole number: %g", first, first + length - 1, name_, *v));
    return static_cast<int>(v.value_or(0));
  }
  int integer_in(int first, int length, int low, int high) const {
    number_in(first, length, low, high);
    return integer(first, length);
  }

  std::string text_at(int first, int length) const {
    std::string_view f = lines_.line();
    if (static_cast<size_t>(first) > f.size()) return {};
    f = f.substr(static_cast<size_t>(first - 1), static_cast<size_t>(length));
    f.remove_prefix(std::min(f.find_first_not_of(" \t\r"), f.size()));
    return std::string(f.substr(0, f.find_last_not_of(" \t\r") + 1));
  }
  // A field that asks for something which is not done here, unless it is blank, 0 or as it would be anyway.
  void note_unread(Tape5Run& r, const char* field, int first, int length, double harmless = 0) const {
    const std::string f = text_at(first, length);
    if (f.empty()) return;
    double value = NAN;
    std::from_chars(f.data() + (f[0] == '+'), f.data() + f.size(), value);
    const bool letters = std::isalpha(static_cast<unsigned char>(f[0]));
    if (!letters && (value == 0 || value == harmless)) return;
    r.unread.push_back(std::string(field) + " " + printable(f) +
                       strf(" (%s, columns %d to %d)", name_, first, first + length - 1));
  }

  // MODTRAN's begins with letters, LOWTRAN's with the number of the profile.
  void card_1(Tape5Run& r) {
    r.where = place(1);
    const bool modtran = !lines_.line().empty() && std::isalpha(static_cast<unsigned char>(lines_.line()[0]));
    const int model = modtran ? integer(4, 2) : integer(1, 5);
    if (model < 1 || model > 6)
      throw at(modtran ? 4 : 1, strf("profile %d of card 1 is the user's own, which is not read", model),
               "1 to 6; a profile of one's own as a table");
    r.model = model;
    r.path_type = integer_in(6, 5, 1, 3);
    r.mode = integer_in(11, 5, 0, 3);
    r.many_scatterings = integer(16, 5) != 0;
    constexpr const char* kOwnProfiles[] = {"M1", "M2", "M3", "M4", "M5", "M6"};
    for (int k = 0; k < 6; ++k) note_unread(r, kOwnProfiles[k], 21 + 5 * k, 5, model);
    note_unread(r, "MDEF", 51, 5, 1);
    note_unread(r, "IM", 56, 5);
    if (const double t = number_in(66, 8, 0, 1e4); t > 0) r.surface_temperature = t;
    r.surface_albedo = number_in(74, 7, -99, 1);
    if (r.surface_albedo < 0) throw at(74, "the surface is one of the program's own materials, which are not read");
    if (modtran) {
      card("card 1A");
      if (const auto co2 = number(11, 10); co2 && *co2 > 0) r.co2_ppm = *co2;
      note_unread(r, "H2OSTR", 21, 10, 1);
      note_unread(r, "O3STR", 31, 10, 1);
      constexpr int filter = 46;  // LFLTNM
      if (lines_.line().size() >= filter && (lines_.line()[filter - 1] == 'T' || lines_.line()[filter - 1] == 't'))
        throw at(filter, "a filter file on card 1A is not read");
    }
    card("card 2");
    r.haze = integer(3, 3);
    if (r.haze == 7) throw at(3, "haze 7 is the user's own, which is not read");
    note_unread(r, "ISEASN", modtran ? 7 : 6, modtran ? 4 : 5);
    note_unread(r, "IVULCN", modtran ? 14 : 11, modtran ? 2 : 5);
    if (r.haze == 3) note_unread(r, "ICSTL", 16, 5);
    for (const auto& [field, first] : {std::pair{"WSS", 41}, {"WHH", 51}, {"RAINRT", 61}})
      note_unread(r, field, first, 10);
    if (integer(21, 5) != 0) throw at(21, "clouds of card 2 (ICLD) are not read");
    if (integer(26, 5) != 0) throw at(26, "the army's vertical structure (IVSA) is not read");
    // A visibility below 0 is an optical depth to later versions, and as none to earlier ones.
    if (const double v = number_in(31, 10, -1e3, 1e3); v > 0)
      r.visibility = v * 1e3;
    else if (v < 0)
      throw at(31, strf("a visibility of %g km; above 0, or 0 for that of the haze", v));
    r.ground_height = number_in(71, 10, -1, 100) * 1e3;
  }

  void cards_3(Tape5Run& r) {
    card("card 3");
    r.observer_height = number_in(1, 10, -1, 1e6) * 1e3;
    r.end_height = number_in(11, 10, -1, 1e6) * 1e3;
    r.zenith = number_in(21, 10, 0, 180) * kDegree;
    const std::vector<std::string> of_card_1(r.unread.begin(),
                                             r.unread.begin() + static_cast<std::ptrdiff_t>(own_cards_));
    r.unread = of_card_1;
    // A horizontal path is at H1 over RANGE; nothing else of the card counts.
    if (r.path_type == 1 && r.mode != 3) {
      note_unread(r, "H2", 11, 10, r.observer_height / 1e3);
      note_unread(r, "ANGLE", 21, 10, 90);
      r.end_height = r.observer_height;
      r.zenith.reset();
    }
    if (r.mode != 3) {
      note_unread(r, "BETA", 41, 10);
      note_unread(r, "RO", 51, 10);
      note_unread(r, "LEN", 61, 5);
    }
    r.range.reset(), r.day.reset();
    r.solar_zenith.reset(), r.relative_azimuth.reset();
    r.latitude.reset(), r.longitude.reset(), r.hour.reset();
    if (r.mode == 3) {
      r.day = integer_in(31, 5, 0, 366);
      return;
    }
    if (const double range = number_in(31, 10, 0, 1e9); range > 0) r.range = range * 1e3;
    if (r.mode != 2) return;
    card("card 3A1");
    const int kind = integer(1, 5);
    if (integer(16, 5) == 1) throw at(16, "the Moon in place of the Sun (ISOURC 1) is not read");
    if (integer(6, 5) == 1) throw at(6, "phase functions of the user's own (IPH 1) are not read");
    if (const int day = integer_in(11, 5, 0, 366); day > 0) r.day = day;
    card("card 3A2");
    const double first = number_in(1, 10, -360, 360), second = number_in(11, 10, -360, 360);
    if (kind == 2 || kind == 12) {
      r.relative_azimuth = first * kDegree;
      r.solar_zenith = number_in(11, 10, 0, 180) * kDegree;
    } else {
      // Longitudes of cards count westwards.
      r.latitude = first * kDegree;
      r.longitude = -second * kDegree;
      if (kind != 0) r.hour = number_in(41, 10, -24, 48);
    }
  }

  void card_4(Tape5Run& r) {
    card("card 4");
    r.first = number_in(1, 10, 0, 1e9), r.last = number_in(11, 10, 0, 1e9);
    r.step = number_in(21, 10, 0, 1e6), r.width = number_in(31, 10, 0, 1e6);
    const char unit = lines_.line().size() >= 51 ? lines_.line()[50] : ' ';
    if (unit != ' ' && unit != 'W' && unit != 'w') to_wavenumbers(r, unit);
    if (!(r.last >= r.first) || !(r.first > 0) || !(r.step > 0))
      throw at(1, "card 4 gives no band", "from, to and step");
  }
  // Bands in microns or nanometres; steps and widths at the band's middle.
  void to_wavenumbers(Tape5Run& r, char unit) const {
    const double um = unit == 'M' || unit == 'm' ? 1 : unit == 'N' || unit == 'n' ? 1e-3 : 0;
    if (um == 0) throw at(51, std::string("the unit of card 4 is '") + unit + "'", "W, M or N");
    if (!(r.first > 0) || !(r.last > 0)) throw at(1, "card 4 gives no band", "from, to and step");
    const double low = r.first * um, high = r.last * um, middle = 0.5 * (low + high);
    r.first = 1e4 / high, r.last = 1e4 / low;
    r.step *= um * 1e4 / (middle * middle), r.width *= um * 1e4 / (middle * middle);
  }

  TextLines lines_;
  size_t own_cards_ = 0;  // what cards 1 to 2 leave unread, which cards 3 of a repetition keep
  const char* name_ = "card 5";
};

}  // namespace

std::vector<Tape5Run> parse_tape5(std::string_view text, const std::string& file_name) {
  return Deck(text, file_name).runs();
}

std::vector<Tape5Run> read_tape5(const std::string& path) {
  return parse_tape5(read_text(path, size_t{16} << 20), path);
}

}  // namespace suite
