#include "rehearse.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "cluster/rehearsal.h"
#include "estimate/block.h"
#include "guard.h"
#include "start.h"

namespace suite {

namespace {

constexpr double kWriteRate = 2e8;  // bytes/s

double count_blocks(const Simulation& sim) {
  double blocks = 0;
  for (const auto& sensor : sim.sensors)
    for (const Task& task : sensor->tasks())
      for (const Capture& capture : task.captures) blocks += static_cast<double>(blocks_of(capture).size());
  return blocks;
}

// The numbers of a list with commas between them.
template <class T>
std::vector<T> numbers_of(const std::string& text, T low, T high, const std::string& wanted) {
  std::vector<T> numbers;
  for (size_t at = 0; at <= text.size();) {
    const size_t comma = std::min(text.find(',', at), text.size());
    T n{};
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + comma, n);
    if (error != std::errc() || end != text.data() + comma || !(n >= low && n <= high))
      throw UsageError(wanted + "; found '" + text + "'");
    numbers.push_back(n);
    at = comma + 1;
  }
  return numbers;
}

}  // namespace

std::vector<int> ranks_of(const Cli& cli, const RenderOptions& o) {
  if (!cli.given("--ranks")) return {};
  if (!o.dry_run)
    throw UsageError("--ranks is what --dry-run forecasts; to run on ranks: mpirun -n N dirsig-render ...");
  for (const char* option : {"--part", "--merge", "--plan", "--study", "--resume", "--more"})
    if (cli.given(option))
      throw UsageError(std::string("--ranks forecasts a whole job from its beginning: leave out ") + option);
  if (!o.time.empty()) throw UsageError("--ranks forecasts the time that paths take: leave out --time, give --paths");
  if (o.stop == "change" || o.method == "paper")
    throw UsageError("--stop change and --method paper are for one process: leave out --ranks");
  return numbers_of(o.ranks, 1, 65536, "--ranks wants whole numbers from 1 to 65536, N or N,N,...");
}

LinkCosts link_of(const Cli& cli, const RenderOptions& o) {
  if (!cli.given("--link")) return {};
  if (!cli.given("--ranks")) throw UsageError("--link belongs to --ranks");
  const std::string wanted = "--link wants four positive numbers F,M,R,T: us, us, GB/s, GB/s";
  const std::vector<double> n = numbers_of(o.link, 1e-6, 1e9, wanted);
  if (n.size() != 4) throw UsageError(wanted + "; found '" + o.link + "'");
  return {1e-6 * n[0], 1e-6 * n[1], 1e9 * n[2], 1e9 * n[3]};
}

int rehearse(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& options,
             const std::vector<int>& ranks, const LinkCosts& link, double load_seconds) {
  const double blocks = count_blocks(sim);
  const auto measured = std::make_shared<Rehearsal::Measured>(blocks);
  std::printf(
      "forecast from about %.0f of %.0f blocks of pixels, which are run here on %d threads; a rank has as many\n",
      std::ceil(blocks / static_cast<double>(measured->every())), blocks, threads());
  std::printf(
      "assumed: %g us to fetch a block, %g us and %g GB/s for a message, results taken at %g GB/s, written at "
      "%g GB/s; not counted: what threads slow each other down by\n",
      1e6 * link.fetch, 1e6 * link.message, 1e-9 * link.rate, 1e-9 * link.take, 1e-9 * kWriteRate);
  std::printf("%6s %10s %9s %9s %9s %9s %9s %9s %9s %8s %8s\n", "ranks", "blocks per", "load", "build", "prepare",
              "trace", "gather", "write", "whole", "tracing", "whole");
  std::printf("%6s %10s %9s %9s %9s %9s %9s %9s %9s %8s %8s\n", "", "thread", "s", "s", "s", "s", "s", "s", "s",
              "eff. %", "eff. %");
  const StopInGoodOrder signals;
  for (const int n : ranks) {
    Rehearsal executor(n, threads(), link, measured);
    JobOptions trial = options;
    trial.executor = &executor;
    trial.progress = false;
    trial.stop = [] { return stop_signal() != 0; };
    start_sensors(sim, trial, "");
    const JobReport r = run_job(scene, sim.sources, sim.sensors, trial);
    if (r.stopped) return 128 + stop_signal();
    const Rehearsed& f = executor.found();
    const double prepare = std::max(0.0, r.seconds - r.build_seconds - r.deliver_seconds - f.here),
                 write = r.deliver_seconds + image_bytes(sim) / kWriteRate, tracing = f.trace + f.gather,
                 whole = load_seconds + r.build_seconds + prepare + tracing + write;
    const double all_threads = static_cast<double>(n) * threads();
    std::printf("%6d %10.4g %9.3g %9.3g %9.3g %9.3g %9.3g %9.3g %9.3g %8.1f %8.1f\n", n, blocks / all_threads,
                load_seconds, r.build_seconds, prepare, f.trace, f.gather, write, whole,
                100 * f.busy / (all_threads * tracing), 100 * f.busy / (all_threads * whole));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace suite
