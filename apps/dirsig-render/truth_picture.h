// Pictures of truth about warmth (temperature and its error, hours of sun, absorbed sun, longwave received), in colours
// with a bar.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "formats/sim_text/sim_text.h"
#include "sensor/sensor.h"

namespace suite {

// Of an image while its rows come in.
class TruthPicture {
 public:
  // Those that an image's truth has; names: its columns.
  static std::vector<TruthPicture> of(const std::vector<std::string>& names, const PreviewSpec& spec, uint32_t columns,
                                      uint32_t rows);
  // As NAME_sun_hours.png has it.
  const char* name() const { return name_; }
  void append(const CaptureResult& next_rows);
  void write(const std::string& path) const;  // when all rows are there

 private:
  TruthPicture(const char* name, std::string title, size_t column, PreviewSpec spec, uint32_t columns, uint32_t rows);
  const char* name_;
  std::string title_, unit_;
  size_t column_;  // of the truth
  PreviewSpec spec_;
  uint32_t columns_, rows_;
  std::vector<float> values_;  // [pixel]; NaN where nothing is known
};

// What their names may end with: names of sensors may not.
std::vector<std::string> truth_picture_names();

}  // namespace suite
