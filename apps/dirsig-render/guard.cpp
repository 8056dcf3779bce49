#include "guard.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>

#include "base/files.h"
#include "base/inputs.h"
#include "base/outputs.h"
#include "base/placed.h"
#include "base/progress.h"
#include "base/run_app.h"
#include "truth_picture.h"

namespace suite {

namespace {

// Names that the files of a sensor can have; what is said too often only forbids an input of that name.
bool may_be_result(const std::string& file, const std::string& sensor) {
  if (!file.starts_with(sensor)) return false;
  const std::string rest = file.substr(sensor.size());
  if (!rest.starts_with(".") && !rest.starts_with("_")) return false;
  for (const char* ending : {".img", ".img.hdr", ".png", ".tif", ".exr", ".vrt", ".qml", ".csv", ".rawbh"})
    if (rest.ends_with(ending)) return true;
  return false;
}

// Names of a run's own, whatever its sensors are called.
bool may_be_of_run(const std::string& file, bool finds_heat) {
  for (const char* name : {"render.json", "run.lock", "result.state.h5", "result.state.h5.joined"})
    if (file == name) return true;
  for (const char* name : {"heat.h5", "heat.csv", "heat.html", "heat_probes.csv", "heat_audit.csv"})
    if (finds_heat && file == name) return true;
  return file.ends_with(".mes");  // of sensors of kind `rami`
}

// Two sensors whose files would be the same ones: 'cam' writes cam_error.img, and so would a sensor 'cam_error'.
void check_names(const Simulation& sim) {
  for (const auto& one : sim.sensors)
    for (size_t i = 0; i < sim.sensors.size(); ++i) {
      const std::string& other = sim.sensors[i]->name();
      if (!other.starts_with(one->name() + "_")) continue;
      std::vector<std::string> endings = truth_picture_names();
      for (const char* ending : {"error", "quality", "truth", "material", "tag", "igm", "glt", "geo", "electrons", "dn",
                                 "counts", "polarisation", "covariance", "mosaic", "apparent_temperature", "stars"})
        endings.emplace_back(ending);
      for (const std::string& ending : endings)
        if (other == one->name() + "_" + ending)
          throw Error(sim.sensor_where[i],
                      "the files of sensor '" + other + "' and of sensor '" + one->name() + "' have the same names",
                      "give one of them another `name`");
    }
}

struct Room {
  double whole = 0, largest = 0;  // bytes: of all images, of the largest file
};

// What radiance, error, quality, truth and the places of pixels take; products of the sensors come on top.
Room room_for(const Simulation& sim) {
  Room room;
  const double value = sim.output.type == OutputSpec::Type::float64  ? 8
                       : sim.output.type == OutputSpec::Type::uint16 ? 2
                                                                     : 4;
  for (const auto& sensor : sim.sensors) {
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures) {
        if (c.bin_by == Capture::BinBy::escape) continue;  // becomes a table
        const double values = static_cast<double>(c.problems()) * static_cast<double>(sensor->bands(c.state).size()) *
                              static_cast<double>(sensor->channels().size()) * c.bins;
        constexpr double kPlaces = 32;  // bytes a pixel: longitude, latitude, height, and a cell of the lookup table
        const double truth = 8.0 * static_cast<double>(c.problems()) * static_cast<double>(sensor->truth().size());
        room.whole += values * (value + std::max(value, 4.0)) + truth + static_cast<double>(c.problems());
        if (sensor->wishes(c).geolocation) room.whole += kPlaces * static_cast<double>(c.problems());
        room.largest = std::max({room.largest, values * value, truth});
      }
  }
  return room;
}

void check_room(const std::string& folder, const Simulation& sim) {
  const Room room = room_for(sim);
  const auto there = static_cast<double>(free_bytes(folder));
  if (room.whole > there)
    throw Error(
        Where{folder, 0, 0, {}, -1},
        strf("the images take %s, and %s are free here", human_bytes(room.whole).c_str(), human_bytes(there).c_str()),
        "make room, or give another folder with -o");
  struct rlimit limit {};
  if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      room.largest > static_cast<double>(limit.rlim_cur))
    throw Error(Where{folder, 0, 0, {}, -1},
                strf("an image takes %s, and files may have %s (ulimit -f)", human_bytes(room.largest).c_str(),
                     human_bytes(static_cast<double>(limit.rlim_cur)).c_str()),
                "raise the limit");
}

}  // namespace

namespace {

void check_inputs(const RenderOptions& o, const Simulation& sim) {
  const auto result = [&](const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    return may_be_of_run(name, sim.heat && o.heat.empty()) ||
           std::ranges::any_of(sim.sensors, [&](const auto& s) { return may_be_result(name, s->name()); }) ||
           std::ranges::any_of(sim.lidars, [&](const auto& l) { return name == l.instrument.name + "_response.h5"; });
  };
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(o.output, none))
    if (result(entry.path())) check_outputs({entry.path().string()});
  check_outputs({o.view, o.account});
  const auto place = [&](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, none), none);
  };
  const std::filesystem::path folder = place(in_folder(o.output, "x")).parent_path();
  for (const std::string& named : {o.view, o.account}) {
    const std::filesystem::path at = place(named);
    if (!named.empty() && at.parent_path() == folder && result(at))
      throw UsageError("'" + named + "' has the name of a result of this run; give it another name");
  }
}

}  // namespace

RunLock lock_place(const RenderOptions& o, const Simulation& sim) {
  if (o.study.empty()) check_inputs(o, sim);
  return RunLock::of_folder(o.study.empty() ? o.output : o.study);
}

void check_folder(const std::string& folder, const Simulation& sim, bool pictures) {
  check_names(sim);
  if (pictures) check_room(folder, sim);
}

namespace {

// The folder, or that of its parents which is there and in which it would be made.
std::string nearest_folder(const std::string& folder) {
  std::error_code none;
  std::filesystem::path at = std::filesystem::absolute(in_folder(folder, "x"), none).parent_path();
  while (!std::filesystem::exists(at, none) && at.has_relative_path()) at = at.parent_path();
  return at.string();
}

// Only a try tells of permissions, read-only disks and quotas alike. It leaves nothing.
void check_writable(const std::string& folder) {
  const std::string there = nearest_folder(folder);
  if (!std::filesystem::is_directory(there))
    throw Error(Where{folder, 0, 0, {}, -1}, "folder cannot be made: '" + there + "' is a file",
                "name a writable place");
  std::string trial = in_folder(there, ".suite-XXXXXX");
  if (::mkdtemp(trial.data()) == nullptr)
    throw Error(Where{folder, 0, 0, {}, -1}, "folder is not writable: '" + there + "': " + std::strerror(errno),
                "name a writable place");
  ::rmdir(trial.c_str());
}

}  // namespace

void check_place(const RenderOptions& o, const Simulation& sim, bool pictures) {
  check_inputs(o, sim);
  check_names(sim);
  check_writable(o.output);
  if (pictures) check_room(nearest_folder(o.output), sim);
}

void check_memory(const Simulation& sim, const JobOptions& options) {
  const double there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  for (size_t s = 0; s < sim.sensors.size(); ++s) {
    const double needed = forecast_bytes(Sensors(&sim.sensors[s], 1), options);
    if (needed > there)
      throw Error(sim.sensor_where[s],
                  strf("the largest capture of sensor '%s' takes %s, and this machine has %s",
                       sim.sensors[s]->name().c_str(), human_bytes(needed).c_str(), human_bytes(there).c_str()),
                  "fewer columns or rows, or fewer lines_per_capture");
  }
}

double image_bytes(const Simulation& sim) { return room_for(sim).whole; }

std::string what_is_left(const std::string& folder, size_t finished, size_t captures, const JobOptions& options) {
  const bool part = options.share && options.share->runs();
  std::string text =
      part ? options.share->text() + " is not finished" : strf("%zu of %zu captures are complete", finished, captures);
  if (finished) text += " in " + folder;
  if (!options.store) return text + "; without --state the rest is lost";
  const std::string state = in_folder(folder, "result.state.h5");
  if (!file_exists(state)) return text + "; no state could be kept";
  return text + "; " + state +
         " holds the finished captures and blocks of 8 x 8 pixels: the same command with --resume in place of --state "
         "and its budget continues from there";
}

namespace {

// Sensor and bands, for faults without a place.
std::string sensor_and_bands(const Sensor& sensor) {
  double low = INFINITY, high = -INFINITY;
  std::string bands;
  for (size_t state = 0; state < sensor.states().size(); ++state)
    for (const Band& b : sensor.bands(state)) {
      low = std::fmin(low, b.low_um()), high = std::fmax(high, b.high_um());
      if (bands.size() < 80) bands += (bands.empty() ? "'" : ", '") + b.name + "'";
    }
  return strf("sensor '%s', %.4g to %.4g um (%s): ", sensor.name().c_str(), low, high, bands.c_str());
}

// Libraries that refuse to repeat a scene all call it so.
bool of_periodic(const Error& fault, const Simulation& sim) {
  return sim.periodic && fault.message().find("periodic scene") != std::string::npos;
}

}  // namespace

Error located(const Error& fault, const Scene& scene, const Simulation& sim, std::optional<size_t> sensor) {
  if (!fault.where().file.empty()) return fault;
  if (of_periodic(fault, sim)) return placed(fault, sim.periodic_where);
  std::map<std::string, Curve> curves;  // of what the fault is about
  const auto meant = [&](const std::string& whose) { return fault.message().starts_with(whose + ":"); };
  for (const Material& m : scene.materials)
    if (meant("material '" + m.id + "'")) curves = m.surface.curves;
  for (const Medium& m : scene.media)
    if (meant("medium '" + m.id + "'"))
      curves = {{"absorption", m.absorption}, {"scattering", m.scattering}, {"index", m.index}};
  for (size_t s = 0; s < sim.sensors.size(); ++s)
    for (size_t state = 0; state < sim.sensors[s]->states().size(); ++state)
      for (const Band& b : sim.sensors[s]->bands(state))
        for (const auto& [name, curve] : curves)
          if (!curve.covers(b.low_um(), b.high_um()))
            return Error(sim.sensor_where[s],
                         "band '" + b.name + "' of sensor '" + sim.sensors[s]->name() +
                             strf("' reaches from %.4g to %.4g um; ", b.low_um(), b.high_um()) +
                             fault.message().substr(0, fault.message().find(':')) + " has its " + name + " from " +
                             curve.range_text(),
                         "in the scene's text give a longer curve, or declare 'outside: hold' or 'zero'");
  if (!sensor) return placed(fault, Where{sim.path, 0, 0, {}, -1});
  const Sensor& of = *sim.sensors[*sensor];
  const bool named = fault.message().find("sensor '" + of.name() + "'") != std::string::npos;
  return placed(fault, sim.sensor_where[*sensor], named ? "" : sensor_and_bands(of));
}

}  // namespace suite
