#include "base/run_app.h"
#include "options.h"
#include "run.h"

int main(int argc, char** argv) {
  suite::ScenePrepOptions options;
  return suite::run_app(
      suite::scene_prep_info(), argc, argv, [&](suite::Cli& cli) { suite::declare(cli, options); },
      [&](suite::Cli&) { return suite::run_scene_prep(options); });
}
