#include "run.h"

int main(int argc, char** argv) {
  suite::RenderOptions options;
  return suite::run_app(
      suite::render_info(), argc, argv, [&](suite::Cli& cli) { suite::declare_render(cli, options); },
      [&](suite::Cli& cli) { return suite::run_render(cli, options); });
}
