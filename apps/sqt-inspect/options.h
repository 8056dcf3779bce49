// What sqt-inspect is asked to do.
#pragma once
#include <string>

#include "base/run_app.h"

namespace suite {

struct InspectOptions {
  std::string file;
  bool json = false;
  std::string map;
  long long channel = 0;
  long long panels = 6;
  bool no_edges = false;
};
void declare_options(Cli& cli, InspectOptions& options);

}  // namespace suite
