#include "detect.h"

#include "base/files.h"
#include "base/run_lock.h"
#include "detect_input.h"
#include "detect_output.h"
#include "formats/pulse/pulse.h"

namespace suite {

namespace {

void check_detect_usage(const Cli& cli, const RenderOptions& o) {
  if (o.simulation.empty())
    throw UsageError("--detect wants the text of the detectors: --detect RESPONSE.h5 detector.yaml -o FOLDER");
  for (const char* option :
       {"--paths",   "--target-error",  "--target-floor", "--target-bands", "--time",          "--stop",
        "--method",  "--cache-memory",  "--memory",       "--state",        "--resume",        "--more",
        "--part",    "--merge",         "--plan",         "--heat",         "--heat-operator", "--heat-only",
        "--study",   "--study-budgets", "--study-seeds",  "--reference",    "--view",          "--view-size",
        "--dry-run", "--ranks",         "--link",         "--air",          "--against",       "--load-all",
        "--convert", "--import-report", "--strict",       "--path"})
    if (cli.given(option))
      throw UsageError(std::string(option) + " is of renders: --detect traces nothing; it takes -o, --set and --seed");
  if (cli.given("--seed") && (o.seed < 0 || o.seed > (1LL << 53)))
    throw UsageError("--seed wants a whole number from 0 to 2^53");
}

PulseTable pulse_file(const Params& p) { return read_pulse_file(p.at("file").as_path(), p.text("column", "")); }

struct Counts {
  uint64_t returns = 0, ideal = 0, signal = 0, silent = 0;  // silent: pulses without a return
};

Json log_of(const DetectContext& c, const RenderOptions& o, const std::vector<Counts>& counts) {
  Json log = Json::object();
  log.set("arguments", command_line());
  log.set("response", o.detect);
  log.set("pulses", c.pulses), log.set("pixels", c.head.pixel_count()), log.set("seed", c.spec.seed);
  Json detectors = Json::array();
  for (size_t d = 0; d < counts.size(); ++d) {
    Json one = Json::object();
    one.set("name", c.spec.detectors[d]->name());
    one.set("returns", counts[d].returns), one.set("signal_returns", counts[d].signal);
    one.set("ideal_returns", counts[d].ideal), one.set("pulses_without_return", counts[d].silent);
    detectors.push(std::move(one));
  }
  log.set("detectors", std::move(detectors));
  return log;
}

void count(const DetectedPulse& p, Counts& to) {
  bool any = false;
  for (const PixelRecord& r : p.records) {
    to.returns += r.returns.size(), to.ideal += r.ideal_returns.size();
    for (const LidarReturn& one : r.returns) to.signal += one.signal;
    any = any || !r.returns.empty();
  }
  to.silent += !any;
}

}  // namespace

int run_detect(const Cli& cli, const RenderOptions& o) {
  check_detect_usage(cli, o);
  const Params text = Params::parse_file(o.simulation, o.settings);
  DetectionSpec spec = read_detection(text, pulse_file);
  if (o.seed >= 0) spec.seed = static_cast<uint64_t>(o.seed);
  const ResponseSource source = open_response(o.detect);
  if (source.pulses == 0) throw Error(Where{o.detect, 0, 0, {}, -1}, "has no pulses");
  const RunLock lock = RunLock::of_folder(o.output);
  make_folder(o.output);
  const DetectContext context{o.output, source.head, spec, source.pulses};
  const std::vector<std::unique_ptr<DetectOutput>> outputs = read_outputs(text, context);
  text.reject_unread();
  std::vector<Counts> counts(spec.detectors.size());
  DetectionRun run(source.head, spec, [&](DetectedPulse&& p) {
    count(p, counts[p.detector]);
    for (const auto& output : outputs) output->take(p);
  });
  try {
    source.read(run);
    run.finish();
  } catch (const Error& e) {
    // What a pulse of the response does not allow is said of the response.
    throw e.where().file.empty() ? Error(Where{o.detect, 0, 0, {}, -1}, e.message(), e.hint()) : e;
  }
  Json log = log_of(context, o, counts);
  for (const auto& output : outputs) output->finish(log);
  write_file(o.output + "/detect.json", log.text());
  for (size_t d = 0; d < counts.size(); ++d)
    note(strf("detector '%s': %llu returns of %llu pulses, %llu without any; %llu returns are not of the laser's light",
              spec.detectors[d]->name().c_str(), static_cast<unsigned long long>(counts[d].returns),
              static_cast<unsigned long long>(source.pulses), static_cast<unsigned long long>(counts[d].silent),
              static_cast<unsigned long long>(counts[d].returns - counts[d].signal)));
  return 0;
}

}  // namespace suite
