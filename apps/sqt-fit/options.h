// The options of sqt-fit.
#pragma once
#include <string>

#include "base/run_app.h"

namespace suite {

struct SqtFitOptions {
  std::string input, model, output, report, curve, fits;
  std::string method = "aligned";
  long long order = 0, views = 0, max_bytes = 0;
  double threshold = 0.1, mueller_error = 0.01, max_error = 0, min_peak = -1;  // min_peak < 0: not given
  bool swap = false, strict = false;
};

AppInfo sqt_fit_info();
void declare(Cli& cli, SqtFitOptions& options);

}  // namespace suite
