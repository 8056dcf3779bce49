// The smallest executable with the suite's shell around it: does what its argument says, so that every way out of an
// executable can be tested.
#include <cstdio>
#include <new>
#include <stdexcept>

#include "base/error.h"
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
        std::printf("name=%s size=%g strict=%d given=%d threads=%d command=%s\n", name.c_str(), size, strict,
                    cli.given("--size"), threads(), command_line().c_str());
        return 0;
      });
}
