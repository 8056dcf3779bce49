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

using namespace suite;

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
