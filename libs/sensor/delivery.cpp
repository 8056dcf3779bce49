#include "sensor/delivery.h"

#include <map>

namespace suite {

std::vector<std::vector<ImageRows>> lay_out(std::span<const Task> tasks,
                                            const std::vector<std::vector<ImageKey>>& key_of) {
  struct Count {
    size_t tasks = 0, captures = 0;
    uint32_t rows = 0;
    size_t last_task = SIZE_MAX;
  };
  std::map<std::string, Count> whole;
  std::map<std::pair<std::string, size_t>, uint32_t> per_task;
  std::vector<std::vector<ImageRows>> out(tasks.size());
  for (size_t t = 0; t < tasks.size(); ++t)
    for (size_t c = 0; c < tasks[t].captures.size(); ++c) {
      const Capture& capture = tasks[t].captures[c];
      const ImageKey& key = key_of[t][c];
      Count& all = whole[key.image];
      uint32_t& here = per_task[{key.image, t}];
      if (all.last_task != t) all.last_task = t, ++all.tasks;
      ImageRows r;
      r.image = key.image;
      r.lines = key.lines;
      r.task = tasks[t].name;
      r.capture = capture.name;
      r.task_number = all.tasks - 1;
      r.capture_number = all.captures++;
      r.row_in_task = here;
      r.row_in_all = all.rows;
      here += capture.rows, all.rows += capture.rows;
      out[t].push_back(std::move(r));
    }
  for (size_t t = 0; t < out.size(); ++t)
    for (ImageRows& r : out[t]) {
      const Count& all = whole[r.image];
      r.tasks = all.tasks, r.captures = all.captures, r.rows_of_all = all.rows;
      r.rows_of_task = per_task[{r.image, t}];
    }
  return out;
}

std::vector<std::vector<ImageRows>> lay_out(std::span<const Task> tasks, const std::string& image) {
  std::vector<std::vector<ImageKey>> keys;
  for (const Task& t : tasks) keys.emplace_back(t.captures.size(), ImageKey{image, false});
  return lay_out(tasks, keys);
}

}  // namespace suite
