#include "parts.h"

#include <charconv>

#include "base/interrupt.h"
#include "base/progress.h"
#include "start.h"

namespace suite {

namespace {

constexpr uint32_t kMostParts = 100000;

Share parse_part(const std::string& text) {
  uint32_t part = 0, parts = 0;
  const char* const end = text.data() + text.size();
  const auto k = std::from_chars(text.data(), end, part);
  const bool slash = k.ec == std::errc() && k.ptr != end && *k.ptr == '/';
  const auto n = slash ? std::from_chars(k.ptr + 1, end, parts) : k;
  if (!slash || n.ec != std::errc() || n.ptr != end || part < 1 || part > parts || parts > kMostParts)
    throw UsageError(strf("--part wants K/N with K from 1 to N and N up to %u, as in 2/8; found '", kMostParts) + text +
                     "'");
  return {part - 1, parts};
}

}  // namespace

void check_parts_usage(const Cli& cli, const RenderOptions& o) {
  const bool merge = cli.given("--merge"), plan = cli.given("--plan"), part = cli.given("--part");
  if (!part && !merge && !plan) return;
  if (!o.study.empty()) throw UsageError("--study runs whole: leave out --part, --plan and --merge");
  if (part && merge) throw UsageError("--part runs a part, --merge joins parts: give one of them");
  if (plan && !part) throw UsageError("--plan is for parts: --part K/N --state --plan FOLDER");
  if (plan && o.resume)
    throw UsageError("--resume goes on with the part as it was begun, its plan is in its state: leave out --plan");
  if (part && o.more >= 0 && !plan)
    throw UsageError("--more adds to what is merged: with --part it wants --plan FOLDER, the folder of that");
  if (part && !o.state && !o.resume && !o.dry_run)
    throw UsageError("--part keeps what it runs in a state, for --merge: add --state");
  if (merge && (o.state || o.resume || o.more >= 0))
    throw UsageError("--merge makes a state of its own: leave out --state and --resume, and give --more afterwards");
  if ((merge || plan) && !o.time.empty()) throw UsageError("--time is measured before the parts are run: leave it out");
  if ((merge || plan) && o.dry_run) throw UsageError("--dry-run looks at no state: leave out --merge and --plan");
}

std::optional<Share> share_of(const RenderOptions& o) {
  if (!o.merge.empty()) return Share{0, 0};
  if (!o.part.empty()) return parse_part(o.part);
  return std::nullopt;
}

void refuse_time(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& options) {
  const uint32_t parts = options.share->parts;
  uint32_t worth = 0;
  JobOptions trial = options;
  trial.share.reset();
  trial.budget.seconds *= parts;
  trial.time_worth = [&](uint32_t paths) { worth = paths; };
  const StopInGoodOrder signals;
  trial.stop = [&] { return worth > 0 || stop_signal() != 0; };
  start_sensors(sim, trial, "");
  run_job(scene, sim.sources, sim.sensors, trial);
  if (stop_signal()) throw Stopped{};
  const std::string refused = "--time with --part: parts would find different numbers of paths for it; ";
  if (!worth) throw UsageError(refused + "give --paths");
  const uint32_t least = options.budget.min_paths.value_or(kDefaultPilot);
  const bool range = options.budget.relative_error && least < worth;
  throw UsageError(
      refused + strf("%u parts of %s each are worth --paths ", parts, human_seconds(options.budget.seconds).c_str()) +
      (range ? strf("%u,%u", least, worth) : strf("%u", worth)) + " at the speed of this machine");
}

void report_share(const JobReport& r, const Share& share, const std::string& folder) {
  const auto captures = [](size_t n) { return strf("%zu capture%s", n, n == 1 ? "" : "s"); };
  if (!share.runs())
    return note(
        strf("%zu of %s %s for %s paths. Second round: run every part again with --plan %s, then join the parts "
             "again; or one run with --resume in place of --merge does it all",
             r.captures_waiting, captures(r.captures_asked).c_str(),
             r.captures_waiting == 1 ? "is planned and waits" : "are planned and wait",
             human_count(r.paths_waiting).c_str(), folder.c_str()));
  note(share.text() + " has run " + human_count(static_cast<double>(r.statistics.paths) - r.paths_kept) +
       " paths, which are in " + folder);
  note(r.pilots_waiting
           ? "the plan for the targets of " + captures(r.pilots_waiting) +
                 " follows from the pilots of all parts: when all have come so far, --merge joins them and "
                 "states the second round"
           : "when all parts have, --merge joins them");
}

}  // namespace suite
