// Decks of cards that ask LOWTRAN and MODTRAN for runs: tape5, .tp5, .ltn; the grammar is in FORMAT.md. Read so that
// the same paths can be computed with the air of this suite. Based on: F. X. Kneizys and others, "Users guide to
// LOWTRAN 7", AFGL-TR-88-0177, 1988, sections 3.1 to 3.6; A. Berk and others, "MODTRAN4 user's manual", Air Force
// Research Laboratory, 1999.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace suite {

struct Tape5Run {
  // Card 1.
  int model =
      6;  // profile: 1 tropical, 2, 3 midlatitude summer, winter, 4, 5 subarctic summer, winter, 6 U.S. standard
  int path_type = 1;  // 1 horizontal, 2 between two heights, 3 to space
  int mode = 0;       // 0 transmittance, 1 thermal radiance, 2 with the Sun, 3 the Sun's irradiance
  bool many_scatterings = false;
  std::optional<double> surface_temperature;  // K; without: the air's
  double surface_albedo = 0;
  std::optional<double> co2_ppm;  // card 1A
  // Card 2.
  int haze = 0;                      // IHAZE: 0 none, 1 rural 23 km, 2 rural 5 km, ...
  std::optional<double> visibility;  // m; without: that of the haze
  double ground_height = 0;          // m
  // Card 3.
  double observer_height = 0, end_height = 0;  // H1, H2, m
  std::optional<double> zenith;                // rad, at H1; of the Sun in mode 3
  std::optional<double> range;                 // m
  std::optional<int> day;                      // of the year
  // Cards 3A.
  std::optional<double> solar_zenith, relative_azimuth;  // rad; IPARM 2
  std::optional<double> latitude, longitude, hour;       // of the observer, rad, east positive; UTC; other IPARM
  // Card 4: from, to, step and width (full at half maximum), 1/cm.
  double first = 0, last = 0, step = 0, width = 0;
  // What else the cards say that is read past: "H2OSTR 0.8 (card 1A, columns 21-30)".
  std::vector<std::string> unread = {};
  Where where;  // card 1
};

// All runs of a deck. Error, located: a card missing, a field that is no number or out of range, and what is not
// read: profiles and aerosols of the user's own, clouds, army models, user-defined phase functions, filters.
std::vector<Tape5Run> read_tape5(const std::string& path);
std::vector<Tape5Run> parse_tape5(std::string_view text, const std::string& file_name);

}  // namespace suite
