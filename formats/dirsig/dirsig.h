// DIRSIG's scenes and simulations as texts of ours. FORMAT.md says what is read, what becomes of it, and what is
// assumed where no public document tells.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "formats/dirsig/import.h"

namespace suite::dirsig {

// By the name and the first bytes of a file (4 KiB, or all of a shorter one).
bool is_scene(const std::string& path, std::string_view head);       // .scene, or a .cfg of DIRSIG3
bool is_simulation(const std::string& path, std::string_view head);  // .sim, .jsim, or a .cfg of DIRSIG3

struct SceneMade {
  MadeText text;
  Tree lamps;         // sources that the scene's geometry places: they belong to the simulation
  std::string epoch;  // UTC of second 0 of its motions; empty where they have no date
  std::optional<std::array<double, 3>> origin;  // latitude and longitude (degrees), height (m)
  bool heat = false;                            // temperatures of it follow from weather
};

// The scene as scene text (formats/scene_text/FORMAT.md). The account is complete once the ledger is closed. Error,
// located: a file is missing or is not of its grammar, a value that must be there is not.
SceneMade scene_of(Import& import, const std::string& file);

// Air as a deck of MODTRAN (tape5) asks for it.
struct DeckAir {
  std::string profile;  // as simulation texts name it
  std::string aerosol;  // model; empty = none
  std::optional<double> visibility_km;
};

// A .wth file with what it does not say.
struct WeatherAsked {
  std::string path;
  std::array<double, 3> site;  // as SceneMade::origin
  double utc_offset_h;
  std::string date;  // of the first row, local: "2009-07-26"
};

struct SimulationHelp {
  // The path of the prepared scene that was or will be made of a scene's file, whose text this is.
  std::function<std::string(const std::string& scene_file, const SceneMade& scene)> prepared;
  std::function<DeckAir(const std::string& deck_file)> deck;
  // The seconds that weather covers from its first row on. Error: it is none, or does not fit the place and the date.
  std::function<double(const WeatherAsked& asked)> weather;
};

// The simulation as simulation text (formats/sim_text/FORMAT.md). Errors as scene_of.
MadeText simulation_of(Import& import, const std::string& file, const SimulationHelp& help);

// The text of a .gdb as Wavefront OBJ. Error, located.
std::string obj_of_gdb(std::string_view text, const std::string& file);

}  // namespace suite::dirsig
