// A pose as named numbers, wherever they were written (a YAML map or a row of a table). Internal to formats/motion.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "formats/motion/motion.h"

namespace suite {

// Reads one place and orientation from names such as "east_m", "latitude_deg", "heading_deg", "qw".
struct PoseFields {
  std::function<bool(const char* name)> has;
  std::function<double(const char* name)> number;                  // of a name that is there
  std::function<std::string(const char* name)> text;               // of a name that is there
  std::function<Error(std::string what, std::string hint)> error;  // located at the whole

  // Error: no position, an incomplete one, names of two frames, or one absurdly far away; a frame that needs an origin
  // the scene lacks.
  Vec3 position(const MotionContext& context) const;
  // Also: an incomplete or doubled orientation, a quaternion of length 0.
  Pose pose(const MotionContext& context) const;

 private:
  PoseColumns columns(const MotionContext& context) const;
  Vec3 position_in(PoseColumns kind, const MotionContext& context) const;
  UtmPoint utm() const;
  Geodetic geodetic() const;
  Quat orientation() const;
};

// The numbers of a table: a header of names, rows of as many cells; comma-separated when the header has a comma, by
// blanks otherwise; # starts a comment line. visit is called per row.
struct TableRow {
  const std::vector<std::string>* names = nullptr;
  std::vector<std::string_view> cells;
  Where where;               // of the row
  std::vector<int> columns;  // where each cell starts
  std::optional<size_t> find(const char* name) const;
  double number(size_t column) const;  // Error, located, when it is none
  // Seconds of simulation time, from the column time_s or utc. Error unless there is one of them.
  double time(const MotionContext& context) const;
};
// A finite number, written with or without a sign; nothing when the text is none.
std::optional<double> finite_number(std::string_view text);
void for_each_row(std::string_view text, const std::string& file_name, std::span<const char* const> known_names,
                  const std::function<void(const TableRow&)>& visit);

// The path of a file that a node names. Error when there is none.
std::string motion_file(const Params& file, const MotionContext& context);

}  // namespace suite
