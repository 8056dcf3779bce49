// The smallest executable with the suite's shell around it: does what its argument says, so that every way out of an
// executable can be tested.
#include <chrono>
#include <cstdio>
#include <new>
#include <optional>
#include <stdexcept>
#include <thread>

#include "base/error.h"
#include "base/files.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/run_app.h"
#include "base/run_lock.h"

using namespace suite;

namespace {

int hold_lock(const std::string& folder, double seconds) {
  const RunLock lock = RunLock::of_folder(folder);
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  return 0;
}

// Many, of many threads, until a signal comes.
int write_files(const std::string& folder) {
  on_threads(4, [&] {
    for (int i = 0; i < 1000000; ++i) write_file(folder + "/x", "short");
  });
  return 0;
}

int loop_for_ever(const std::string& file) {
  const StopInGoodOrder order;
  AtomicFile whole(file);
  whole.write(std::string_view("all of it"));
  try {
    parallel_for(0, size_t{1} << 40, 1,
                 [](size_t, size_t) { parallel_for(0, 1000, 1, [](size_t, size_t) { std::this_thread::yield(); }); });
  } catch (const Stopped&) {
    const FinishFirst finish;
    parallel_for(0, 10, 1, [&](size_t, size_t) { stop_point(); });
    whole.commit();
    throw;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::string what, name = "unnamed";
  double size = 1.5;
  bool strict = false;
  return run_app(
      {"toy", "Does what it is told.", "Example: toy fine"}, argc, argv,
      [&](Cli& cli) {
        cli.positional("what", what, "what to do");
        cli.option("--name", name, "a name");
        cli.option("-s,--size", size, "a size, m");
        cli.flag("--strict", strict, "be strict");
      },
      [&](Cli& cli) {
        note("a note");
        warn("a warning");
        if (what == "error") throw Error({"f.yaml", 3, 1, "x: y", -1}, "wrong", "do right");
        if (what == "bug") SUITE_CHECK_EQ(argc, -1);
        if (what == "standard") throw std::runtime_error("unforeseen");
        if (what == "memory") throw std::bad_alloc();
        if (what == "usage") throw UsageError("--name and --strict contradict each other");
        if (what == "refuse") return 1;
        if (what == "echo") throw Error(name);
        if (what == "lock") return hold_lock(name, size);
        if (what == "files") return write_files(name);
        if (what == "loop") return loop_for_ever(name);
        if (what == "write" || what == "stop") {
          AtomicFile file(name);
          file.write(std::string_view("half of it"));
          std::optional<StopInGoodOrder> order;
          if (what == "stop") order.emplace();
          for (int i = 0; i < 3000 && !stop_signal(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
          file.commit();
          return stop_signal() ? 128 + stop_signal() : 0;
        }
        std::printf("name=%s size=%g strict=%d given=%d threads=%d command=%s\n", name.c_str(), size, strict,
                    cli.given("--size"), threads(), command_line().c_str());
        return 0;
      });
}
