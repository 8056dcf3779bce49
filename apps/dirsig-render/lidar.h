// Laser radars of a simulation: their pulses are traced, the responses stored, and detected in one go where the text
// has detectors.
#pragma once
#include <memory>
#include <vector>

#include "base/json.h"
#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

class LidarJobs {
 public:
  // Reads what detection says in the texts of the simulation's laser radars, and refuses unknown keys. Located Errors.
  // UsageError: options that say nothing to laser radars, or that they cannot follow.
  LidarJobs(const Cli& cli, const RenderOptions& options, Simulation& simulation, bool several_ranks);
  ~LidarJobs();
  bool any() const { return !jobs_.empty(); }
  // Refuses what the scene has not: tags and materials; and what it cannot: motions that end too early. Tells nothing
  // and writes nothing.
  void check(const std::shared_ptr<const Scene>& scene);
  // A line for each: pulses, paths, bins, bytes.
  void forecast() const;
  // Traces all of them. The folder is there. False: a signal has stopped it; laser radars that were finished stay, and
  // what was traced of the one at work. identity: of the run; empty: what was traced of that is not kept.
  bool run(const std::shared_ptr<const Scene>& scene, const std::string& identity = {});
  // All that a simulation without other sensors asks for, the forecast of --dry-run and render.json included. Returns
  // the exit code.
  int run_alone(const std::shared_ptr<const Scene>& scene, const JobOptions& options);
  // Of each that has been run, for render.json.
  Json log() const;

 private:
  struct Job;
  bool run(Job& job, const std::shared_ptr<const Scene>& scene, const std::string& identity);
  bool finished(const Job& job) const;
  const RenderOptions& options_;
  const Simulation& simulation_;
  std::vector<std::unique_ptr<Job>> jobs_;
};

// Tells what there is of a run that a signal has stopped; its exit code.
int end_by_signal(const std::string& left);

// um: what a scene has to be loaded for.
std::vector<std::array<double, 2>> lidar_windows_um(const Simulation& simulation);

}  // namespace suite
