#include "continued.h"

#include "base/files.h"
#include "base/outputs.h"
#include "base/run_app.h"
#include "trace/tracer.h"

namespace suite {

namespace {

std::string hash_of_file(const std::string& path) { return sha256(read_bytes(path, size_t{1} << 40)); }

// Bins follow from the curves that the simulation names, which may have changed.
std::string hash_of_bins(const Simulation& sim) {
  std::string all;
  for (const auto& sensor : sim.sensors)
    for (const SpectralState& s : sensor->states()) {
      for (const Bin& b : s.bins) all += strf("%a %a ", b.low_um, b.high_um);
      for (const double share : s.shares) all += strf("%a ", share);
    }
  return sha256(all);
}

StateIdentity identity_of(const Simulation& sim, const JobOptions& options) {
  // The program itself is the build: another compiler or another line of code gives other last bits.
  std::string scenes;
  for (const SimulationScene& s : sim.scenes) scenes += hash_of_file(s.path);
  return {{"scene", sim.scenes.size() == 1 ? scenes : sha256(scenes)},
          {"simulation", hash_of_text(sim)},
          {"spectral bins", hash_of_bins(sim)},
          {"seed", strf("%llu", static_cast<unsigned long long>(options.pipeline.seed))},
          {"build", hash_of_file("/proc/self/exe")},
          {"engine", Tracer::engine()}};
}

}  // namespace

std::string hash_of_text(const Simulation& sim) {
  std::string hash = hash_of_file(sim.path);
  for (const std::string& setting : sim.settings) hash = sha256(hash + setting);
  return hash;
}

std::unique_ptr<StateStore> open_store(const RenderOptions& o, const std::string& folder, const Simulation& sim,
                                       JobOptions& options) {
  const bool more = o.more >= 0;
  if (!o.state && !o.resume && !more) return nullptr;
  if (o.resume && more)
    throw UsageError("--resume finishes a run as it was begun; --more adds to it: give one of them");
  if (options.pipeline.stop == StopRule::change)
    throw UsageError("--stop change looks at its own samples and cannot be continued");
  if (options.pipeline.method == Method::paper)
    throw UsageError("--method paper is for comparisons and cannot be continued");
  const std::string path = in_folder(folder, "result.state.h5");
  const StateIdentity identity = identity_of(sim, options);
  if (o.resume || more) {
    if (!file_exists(path))
      throw Error(Where{path, 0, 0, {}, -1}, "there is no state to continue", "run with --state first");
    Budget budget = read_state_budget(path, identity);
    if (o.resume && (!o.paths.empty() || !o.target_error.empty() || !o.time.empty()))
      throw UsageError("--resume finishes a run as it was begun; leave out --paths, --target-error and --time");
    if (more) {
      if (!o.paths.empty() || !o.time.empty())
        throw UsageError("--more continues with the paths of the run before; leave out --paths and --time");
      budget.more += static_cast<uint32_t>(o.more);
      if (options.budget.relative_error) budget.relative_error = options.budget.relative_error;
    }
    options.budget = budget;
    return make_state(path, more ? StateUse::extend : StateUse::resume, identity, budget);
  }
  return make_state(path, StateUse::start, identity, options.budget);
}

}  // namespace suite
