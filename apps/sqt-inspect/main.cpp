#include "run.h"

int main(int argc, char** argv) {
  suite::InspectOptions options;
  return suite::run_app(
      suite::inspect_info(), argc, argv, [&](suite::Cli& cli) { suite::declare_options(cli, options); },
      [&](suite::Cli& cli) { return suite::inspect(cli, options); });
}
