// What sqt-inspect is asked to do.
#pragma once
#include <string>
#include <vector>

#include "base/run_app.h"

namespace suite {

struct InspectOptions {
  std::string file;
  bool json = false, check = false, no_edges = false;
  std::string map, slice, plot, compare, compare_model, error_map, eval, sphere, export_to;
  std::string views, view;  // view: page
  double zoom = 0, export_error = 0;
  std::string out = "30,0";
  long long channel = 0, panels = 6, sample = 0, seed = 1, pairs = 400000, size = 512, export_size = 0;
};
AppInfo inspect_info();
void declare_options(Cli& cli, InspectOptions& options);
// Numbers of "a,b,c". UsageError when it is not `least` to `most` numbers.
std::vector<double> number_list(const std::string& option, const std::string& text, size_t least, size_t most);

}  // namespace suite
