#include "base/run_app.h"
#include "options.h"
#include "run.h"

int main(int argc, char** argv) {
  suite::SqtFitOptions options;
  return suite::run_app(
      suite::sqt_fit_info(), argc, argv, [&](suite::Cli& cli) { suite::declare(cli, options); },
      [&](suite::Cli&) { return suite::run_sqt_fit(options); });
}
