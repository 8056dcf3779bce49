// The parts of the translation of simulations. Not for users of the format.
#pragma once
#include <array>
#include <optional>
#include <set>

#include "formats/dirsig/dirsig.h"
#include "formats/dirsig/motion.h"

namespace suite::dirsig {

// What stands beside one instrument in our text: names, times, motion.
struct PlatformParts {
  const Item* platform = nullptr;
  const Item* motion = nullptr;
  const Item* tasks = nullptr;
  std::string prefix;  // of the names of images
};

// Hours ahead of UTC that a date ends with ("-07:00", "+0530"); none without, or with a Z.
std::optional<double> zone_of(std::string_view date);

class SimulationWriter {
 public:
  SimulationWriter(Import& import, std::string file, const SimulationHelp& help);
  MadeText run();

 private:
  // simulation.cpp
  void read_sim(const Item& sim);
  void read_jsim(const Item& jsim);
  void read_job(const Item& job);
  void read_plugin(const Item& plugin);
  void read_platform_plugin(const Item& inputs);
  void read_ephemeris(const Item& inputs);
  void add_scene(const Item& named, const std::string& path, const std::array<double, 3>& offset);
  const Item& part_of(const Item& sim, const char* name, const char* kind);
  Tree tasks_of(const Item& tasks);
  void find_epoch(const Item& tasks);
  void finish();
  // weather.cpp
  void read_weather(const Item& section);
  void use_weather(const Item& named);
  // atmosphere.cpp
  void read_atmosphere(const Item& atm);
  void read_uniform(const Item& uniform);
  void read_deck(const Item& named);
  void read_new_atmosphere(const Item& inputs);
  void set_air(const DeckAir& air, const Where& where);
  void add_sun(const Where& where);
  // platform.cpp
  void read_platform(const PlatformParts& parts);
  void read_attachment(const Item& attachment, Tree& to);
  void read_mount(const Item& mount, Tree& to);
  void read_tabulated_mount(const Item& from, double unit, const std::string& order, Tree& to);
  void read_instrument(const Item& instrument, Tree& to);
  void read_lens(const Item& properties, Tree& to);
  // focal_plane.cpp
  void read_focal_plane(const Item& plane, const Tree& lens, const std::string& instrument, Tree& to);
  void read_array(const Item& array, Tree& instrument, Tree& made);
  void read_clock(const Item& clock, Tree& instrument);
  void read_capture(const Item& method, Tree& made);
  void read_image_file(const Item& image, const Item* detector_model);
  void read_truth(const Item& plane);
  bool read_detector(const Item& method, Tree& made);
  // response.cpp
  Tree band_of(const Item& channel, double low, double high, bool counted, double factor);
  Tree bands_of(const Item& response, bool counted, double factor);

  Import& import_;
  std::string file_;
  const SimulationHelp& help_;
  Where where_;
  Folders folders_;
  Tree root_, sun_, lamps_;
  std::string epoch_;
  std::optional<double> zone_h_;                 // of the tasks' date
  std::optional<std::array<double, 3>> origin_;  // of the first scene that has one
  bool heat_ = false;                            // of a scene that waits for weather
  bool fixed_sun_ = false, air_ = false, no_sun_ = false;
  std::vector<PlatformParts> platforms_;
  // Of the platform that is being written.
  std::string image_;
  std::set<std::string> truth_, names_;
  size_t planes_ = 0;
  double fill_ = 1;       // share of the pitch's area that a detector takes
  bool counted_ = false;  // the array counts photons or electrons
  double light_ = 1;      // DIRSIG's image over ours, before the channel's own factor
};

}  // namespace suite::dirsig
