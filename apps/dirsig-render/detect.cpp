#include "detect.h"

#include "base/files.h"
#include "base/run_lock.h"
#include "detect_input.h"
#include "detect_job.h"
#include "formats/preset/preset.h"

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

}  // namespace

int run_detect(const Cli& cli, const RenderOptions& o) {
  check_detect_usage(cli, o);
  const Params text = parse_simulation(o.simulation, o.settings);
  DetectionSpec spec = read_detection(text, text, pulse_of_file);
  if (o.seed >= 0) spec.seed = static_cast<uint64_t>(o.seed);
  const ResponseSource source = open_response(o.detect);
  if (source.pulses == 0) throw Error(Where{o.detect, 0, 0, {}, -1}, "has no pulses");
  const RunLock lock = RunLock::of_folder(o.output);
  make_folder(o.output);
  DetectJob job(text, std::move(spec), source.head, {o.output, o.detect, source.pulses});
  text.reject_unread();
  try {
    source.read(job);
    job.end_pulses();
  } catch (const Error& e) {
    // What a pulse of the response does not allow is said of the response.
    throw e.where().file.empty() ? Error(Where{o.detect, 0, 0, {}, -1}, e.message(), e.hint()) : e;
  }
  job.finish();
  return 0;
}

}  // namespace suite
