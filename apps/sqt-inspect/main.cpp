#include "run.h"

int main(int argc, char** argv) {
  suite::InspectOptions options;
  const suite::AppInfo info{"sqt-inspect",
                            "Looks into a fitted scattering function (.sqt): header, pictures, checks, comparisons.",
                            "Examples:\n  sqt-inspect satin.sqt --map satin.png\n  sqt-inspect satin.sqt --json\n"};
  return suite::run_app(
      info, argc, argv, [&](suite::Cli& cli) { suite::declare_options(cli, options); },
      [&](suite::Cli& cli) { return suite::inspect(cli, options); });
}
