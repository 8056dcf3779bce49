#include "continued.h"

#include <algorithm>
#include <filesystem>

#include "base/files.h"
#include "base/outputs.h"
#include "base/run_app.h"
#include "sensor/degree_target.h"
#include "trace/tracer.h"

namespace suite {

namespace {

std::string hash_of_file(const std::string& path) { return sha256(read_bytes(path, size_t{1} << 40)); }

// Curves, profiles, images, tracks and whatever else the simulation names; scenes have a hash of their own.
std::string hash_of_named(const Simulation& sim) {
  std::string all;
  for (const std::string& file : sim.files) {
    const bool scene =
        std::any_of(sim.scenes.begin(), sim.scenes.end(), [&](const SimulationScene& s) { return s.path == file; });
    std::error_code unknown;
    if (!scene && std::filesystem::is_regular_file(file, unknown)) all += hash_of_file(file);
  }
  return sha256(all);
}

}  // namespace

std::string hash_of_scenes(const Simulation& sim) {
  std::string scenes;
  for (const SimulationScene& s : sim.scenes) scenes += hash_of_file(s.path);
  return sim.scenes.size() == 1 ? scenes : sha256(scenes);
}

StateIdentity identity_of(const Simulation& sim, const JobOptions& options) {
  // The program itself is the build: another compiler or another line of code gives other last bits.
  return {{"scene", hash_of_scenes(sim)},
          {"simulation", hash_of_text(sim)},
          {"files named", hash_of_named(sim)},
          {"seed", strf("%llu", static_cast<unsigned long long>(options.pipeline.seed))},
          {"build", hash_of_file("/proc/self/exe")},
          {"engine", Tracer::engine()}};
}

std::string hash_of_text(const Simulation& sim) {
  std::string hash = hash_of_file(sim.path);
  for (const std::string& setting : sim.settings) hash = sha256(hash + setting);
  return hash;
}

namespace {

constexpr const char* kState = "result.state.h5";

[[noreturn]] void refuse(const std::string& path, const std::string& what, const std::string& hint) {
  throw Error(Where{path, 0, 0, {}, -1}, what, hint);
}

std::string state_in(const std::string& folder, const std::string& wanted) {
  const std::string path = in_folder(folder, kState);
  if (!file_exists(path)) refuse(path, "there is no state " + wanted, "run with --state first");
  return path;
}

// Stored work goes on with its own budget; what the options ask for must be the same, where they ask.
void check_budget(const Budget& asked, Budget stored, const std::string& path) {
  stored.more = 0;
  if (!(asked == Budget{}) && !(asked == stored))
    throw UsageError(path +
                     " is of a run with another budget, which is finished as it was begun: leave out --paths, --time, "
                     "--target-error and what belongs to it, or give the same");
}

// A stored pilot tells what its own kind of target needs.
void check_kind_of_target(const Simulation& sim, const Budget& asked, const Budget& stored) {
  if (!asked.relative_error || asked.relative_error == stored.relative_error) return;
  for (const auto& sensor : sim.sensors)
    for (const Task& task : sensor->tasks())
      for (const Capture& capture : task.captures) {
        const bool noise = !capture.detector_noise.empty() && !stored.relative_error;
        if (!noise && !(degree_target_of(*sensor, capture) > 0)) continue;
        throw UsageError("sensor '" + sensor->name() + "' was planned by " +
                         (noise ? "its detector's noise" : "the error of its degree of polarisation") +
                         ", and its pilot does not hold what --target-error needs: leave it out, or start a new run");
      }
}

Budget with_more(const RenderOptions& o, const Simulation& sim, const JobOptions& options, Budget budget) {
  check_kind_of_target(sim, options.budget, budget);
  budget.more += static_cast<uint32_t>(o.more);
  if (options.budget.relative_error) budget.relative_error = options.budget.relative_error;
  return budget;
}

std::string whose(const StateHead& head) { return head.part ? head.part->share.text() : "the whole of a run"; }

// A part may replace what it ran itself, and states of other runs.
void check_replaced(const std::string& path, const StateIdentity& identity, const Share& share) {
  if (!file_exists(path)) return;
  StateHead head;
  try {
    head = read_state_head(path, identity);
  } catch (const Error&) {
    return;
  }
  if (!head.part || (head.part->share.parts == share.parts && head.part->share.part != share.part))
    refuse(path, "is the state of " + whose(head) + ", which " + share.text() + " would replace",
           "give each part a folder of its own with -o");
}

StateSetup begin(const RenderOptions& o, const Simulation& sim, const std::string& here, const StateIdentity& identity,
                 const JobOptions& options) {
  StateSetup setup{StateUse::start, options.budget};
  if (options.share) {
    setup.part = StatePart{*options.share, !o.plan.empty()};
    check_replaced(here, identity, *options.share);
  }
  if (o.plan.empty()) return setup;
  const std::string path = state_in(o.plan, "with a plan");
  const StateHead head = read_state_head(path, identity);
  if (head.part)
    refuse(path, "is itself the state of " + head.part->share.text(), "--plan wants the folder of --merge");
  if (head.budget.seconds > 0 && !head.cap)
    refuse(path, "has a budget of time that is not yet turned into paths", "finish it with --resume");
  setup.from = {path};
  setup.budget = o.more >= 0 ? with_more(o, sim, options, head.budget) : head.budget;
  if (o.more < 0) check_budget(options.budget, head.budget, path);
  return setup;
}

StateSetup join(const RenderOptions& o, const std::string& path, const StateIdentity& identity,
                const JobOptions& options) {
  StateSetup setup;
  for (const std::string& folder : o.merge) {
    setup.from.push_back(state_in(folder, "of a part"));
    std::error_code none;
    if (std::filesystem::equivalent(setup.from.back(), path, none))
      throw UsageError("--merge into the folder of a part would replace it: give another folder with -o");
  }
  setup.budget = check_parts(setup.from, identity);
  check_budget(options.budget, setup.budget, setup.from.front());
  return setup;
}

// Goes on with the state that is there, as it was begun or with more paths.
StateSetup go_on(const RenderOptions& o, const Simulation& sim, const std::string& folder,
                 const StateIdentity& identity, JobOptions& options) {
  const bool more = o.more >= 0;
  const std::string path = state_in(folder, "to continue");
  const StateHead head = read_state_head(path, identity);
  if (o.resume) check_budget(options.budget, head.budget, path);
  if (more && (!o.paths.empty() || !o.time.empty()))
    throw UsageError("--more continues with the paths of the run before; leave out --paths and --time");
  if (head.part && more)
    refuse(path, "is the state of " + head.part->share.text(), "join the parts with --merge first");
  if (options.share && whose(head) != options.share->text())
    refuse(path, "is the state of " + whose(head) + ", not of " + options.share->text(),
           "leave out --part, the state knows it");
  if (head.part) options.share = head.part->share;
  return {more ? StateUse::extend : StateUse::resume, more ? with_more(o, sim, options, head.budget) : head.budget};
}

}  // namespace

std::unique_ptr<StateStore> open_store(const RenderOptions& o, const std::string& folder, const Simulation& sim,
                                       JobOptions& options) {
  const bool more = o.more >= 0;
  if (!o.state && !o.resume && !more && o.merge.empty()) return nullptr;
  if (o.resume && more)
    throw UsageError("--resume finishes a run as it was begun; --more adds to it: give one of them");
  if (options.pipeline.stop == StopRule::change)
    throw UsageError("--stop change looks at its own samples and cannot be continued");
  if (options.pipeline.method == Method::paper)
    throw UsageError("--method paper is for comparisons and cannot be continued");
  const std::string path = in_folder(folder, kState);
  const StateIdentity identity = identity_of(sim, options);
  StateSetup setup = !o.merge.empty()                       ? join(o, path, identity, options)
                     : o.resume || (more && o.plan.empty()) ? go_on(o, sim, folder, identity, options)
                                                            : begin(o, sim, path, identity, options);
  options.budget = setup.budget;
  return make_state(path, identity, std::move(setup));
}

}  // namespace suite
