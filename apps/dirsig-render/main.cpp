#include "run.h"
#include "together.h"

int main(int argc, char** argv) {
  suite::RenderOptions options;
  suite::Together together;
  return together.conclude(suite::run_app(
      suite::render_info(), argc, argv, [&](suite::Cli& cli) { suite::declare_render(cli, options); },
      [&](suite::Cli& cli) {
        return together.run([&] { return suite::run_render(cli, options, together.ranks()); });
      }));
}
