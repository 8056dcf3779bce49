// The table of a study: one row a run and series, as CSV that a later study reads back and goes on from.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "study/compare.h"

namespace suite {

struct StudyRow {
  bool by_time = false;  // the budget is in seconds, else in paths a problem
  double budget = 0;
  uint64_t seed = 0;
  double seconds = 0;        // rendering, without building and files
  double build_seconds = 0;  // acceleration structures
  double file_seconds = 0;   // handing over results
  double paths = 0, rays = 0, nodes = 0;
  double paths_per_problem = 0;
  // Of the CPU time of the pipeline: the ray tracer; the rest of building paths (surfaces, sources, directions);
  // turning them into radiance and truth; asking the sensor for rays.
  double share_in_embree = 0, share_sample = 0, share_shade = 0, share_sensor = 0;
  double peak_bytes = 0;  // of the process so far
  Comparison figures;
  std::string ended;  // what ended the run
  double efficiency() const { return 1 / (figures.relative_rmse * figures.relative_rmse * seconds); }
};

std::string rows_to_csv(const std::vector<StudyRow>& rows, const std::string& identity);
// Rows of an earlier study. Error at `file` when it is no such table or belongs to another `identity`.
std::vector<StudyRow> rows_from_csv(std::string_view text, const std::string& identity, const std::string& file);

}  // namespace suite
