// What a sensor hands to the application when a capture is finished: results, products of its own, texts, and where in
// which image they belong.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sensor/sensor.h"

namespace suite {

// A product beside radiance, made by the sensor itself: digital counts, electrons.
struct Product {
  std::string name, unit;      // "dn", "DN"
  bool whole_numbers = false;  // all values are integers in 0..65535
  std::vector<std::string> bands;
  std::vector<double> values;  // [problem][band]
};

// How an image lies on the ground: its outer north-west corner (m, scene ENU) and the size of its pixels; rows go
// south.
struct MapGrid {
  Vec2 origin;
  double gsd_x = 0, gsd_y = 0;  // m
};

// Where the rows of a capture stand among those of the same image.
struct ImageRows {
  std::string image;                  // name, the stem of its files
  std::string task, capture;          // names
  size_t task_number = 0, tasks = 1;  // that show this image
  size_t capture_number = 0, captures = 1;
  uint32_t row_in_task = 0, rows_of_task = 0;
  uint32_t row_in_all = 0, rows_of_all = 0;
  bool lines = false;  // captures are lines of one picture rather than pictures
};

// Columns of an image that see with responses of their own.
struct ColumnBands {
  uint32_t columns = 0;
  std::vector<Band> bands;
};

struct Delivery {
  const Sensor& sensor;
  ImageRows rows;
  CaptureResult result;
  std::vector<Band> bands;  // of the result
  std::vector<Product> products;
  std::vector<TextFile> texts;
  std::optional<MapGrid> map;
  std::string description;                // one sentence for the header
  std::vector<ColumnBands> columns = {};  // from the left; empty: all columns see with `bands`
  std::optional<double> outside = {};     // radiance of pixels that see nothing by design, when there are such
  // Of strips: when the lines of the task were taken and how the picture lies, and the same of all tasks in turn.
  std::string lines_of_task = {}, lines_of_all = {};
  bool picture = true;  // false: products and texts are the result, its values make no image
};

// Places of all captures of a sensor, [task][capture]. image_of: the name of the image that a capture belongs to;
// captures of one image have the same number of columns. lines: whether an image's captures are lines of one picture.
struct ImageKey {
  std::string image;
  bool lines = false;
};
std::vector<std::vector<ImageRows>> lay_out(std::span<const Task> tasks,
                                            const std::vector<std::vector<ImageKey>>& key_of);
// The same for a sensor whose captures all belong to one image.
std::vector<std::vector<ImageRows>> lay_out(std::span<const Task> tasks, const std::string& image);

}  // namespace suite
