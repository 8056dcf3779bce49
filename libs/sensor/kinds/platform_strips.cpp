// Which way up strips are. Lines of a push-broom and scans of a whiskbroom follow in time from the top of the picture
// downwards, as raw strips do. A picture whose columns then ran like its detectors, from left to right as seen in
// forward flight, would be mirrored; so its columns run against them wherever that is needed for the ground to appear
// as it is seen from the sensor, turned but not mirrored: right x down = the direction of sight.
//
// Assumes: the order is that in the middle of the task, without jitter, for ground at z = 0 (for sights that do not
// reach it: at 1 km). What does not move counts as flying forward.
#include <algorithm>
#include <array>
#include <cmath>

#include "sensor/kinds/platform.h"

namespace suite {

namespace {

Pose steady_pose(const PlatformSpec& spec, const Instrument& instrument, double t) {
  Pose pose = spec.track->at(t);
  for (Attachment a : instrument.chain) {
    a.jitter = nullptr;
    pose = a.at(t, pose, nullptr);
  }
  return pose;
}

// Where a place of the focal plane looks to, at a distance.
struct Sight {
  const PlatformSpec& spec;
  const Instrument& instrument;
  double distance = 1000;

  Dir direction(Vec2 place, double t) const {
    return normalized(steady_pose(spec, instrument, t).vector(instrument.lens.look(place)));
  }
  Vec3 at(Vec2 place, double t) const {
    return steady_pose(spec, instrument, t).translation + direction(place, t) * distance;
  }
};

// How a strip lies: where its detectors' axes and its lines go, at the middle of the task.
struct Lie {
  Vec3 along_row, along_column, onward;  // one detector (or sample) on, one detector row on, one line on
  Dir sight;
};

// The places between which a step is taken stay inside what the task needs of its motion.
Lie lie_of(const PlatformSpec& spec, const FocalArray& array, size_t first_chip, TimeWindow lines) {
  const Readout& r = array.readout;
  const Instrument& instrument = spec.instruments[array.instrument];
  const Chip& chip = array.chips[first_chip];
  Sight sight{spec, instrument};
  const bool whisk = r.kind == Readout::Kind::whisk;
  const double scan = whisk ? (r.samples - 1) * r.sample_period : 0;
  // The middle of a scan (or a line) in the middle of the task.
  const double whole = std::floor((lines.end - lines.begin - scan) / r.line_period / 2);
  const double t = lines.begin + std::max(0.0, whole) * r.line_period + 0.5 * scan;
  Lie lie;
  lie.sight = sight.direction(chip.offset, t);
  const double height = steady_pose(spec, instrument, t).translation.z;
  if (height > 0 && lie.sight.z < 0) sight.distance = std::min(5e7, height / -lie.sight.z);
  auto from_to = [&](Vec2 step, double before, double after) {
    return sight.at({chip.offset.x + step.x, chip.offset.y + step.y}, std::min(after, lines.end)) -
           sight.at(chip.offset, std::max(before, lines.begin));
  };
  // From one line to the next, or from the one before.
  const double here = t + r.line_period <= lines.end ? t : t - r.line_period;
  lie.onward = from_to({0, 0}, here, here + r.line_period);
  lie.along_row =
      whisk ? from_to({0, 0}, t - 0.5 * r.sample_period, t + 0.5 * r.sample_period) : from_to({array.pitch.x, 0}, t, t);
  lie.along_column = from_to({0, array.pitch.y}, t, t);
  // What a scan does meanwhile is no advance.
  const double sample = dot(lie.along_row, lie.along_row);
  if (whisk && sample > 0) {
    lie.onward = lie.onward - lie.along_row * (dot(lie.onward, lie.along_row) / sample);
    lie.onward = lie.onward - lie.sight * dot(lie.onward, lie.sight);
  }
  // Standing still, it counts as flying forward: towards the top of the focal plane.
  if (!(length(lie.onward) > 1e-11 * sight.distance)) lie.onward = -lie.along_column;
  return lie;
}

uint8_t reversed(const Lie& lie, const FocalArray& array) {
  uint8_t turned = 0;
  if (dot(cross(lie.along_row, lie.onward), lie.sight) <= 0) turned |= kColumnsReversed;
  if (array.readout.kind == Readout::Kind::whisk && dot(lie.onward, lie.along_column) < 0) turned |= kRowsReversed;
  return turned;
}

// The captures of a task that show an array, in the order of their lines (of its first segment).
std::vector<const Capture*> captures_of(const PlatformSpec& spec, size_t task, size_t array) {
  std::vector<const Capture*> list;
  for (size_t c = 0; c < spec.parts[task].size(); ++c)
    if (spec.parts[task][c].segment == spec.arrays[array].segments[0] && spec.parts[task][c].array == array)
      list.push_back(&spec.tasks[task].captures[c]);
  return list;
}

TimeWindow lines_of(const std::vector<const Capture*>& captures) {
  return {captures.front()->window.begin, captures.back()->window.end};
}

std::string compass(Vec3 v, bool backwards) {
  if (backwards) v = -v;
  const double azimuth = std::atan2(v.x, v.y) / kDegree;
  return strf("%.1f deg", azimuth < -0.05 ? azimuth + 360 : std::fabs(azimuth));
}

}  // namespace

void turn_strips(PlatformSpec& spec) {
  for (size_t t = 0; t < spec.tasks.size(); ++t)
    for (size_t a = 0; a < spec.arrays.size(); ++a) {
      const FocalArray& array = spec.arrays[a];
      if (!array.scans()) continue;
      const std::vector<const Capture*> captures = captures_of(spec, t, a);
      if (captures.empty()) continue;
      const uint8_t turned = reversed(lie_of(spec, array, 0, lines_of(captures)), array);
      for (size_t c = 0; c < spec.parts[t].size(); ++c)
        if (spec.parts[t][c].array == a) spec.tasks[t].captures[c].reversed = turned;
    }
}

Exposed exposed(const PlatformSpec& spec, const Capture& capture, size_t problem) {
  const Segment& segment = spec.segments[capture.state];
  const FocalArray& array = spec.arrays[segment.array];
  const Readout& r = array.readout;
  auto [column, row] = capture.place_of(problem);
  if (capture.reversed & kColumnsReversed) column = capture.columns - 1 - column;
  switch (r.kind) {
    case Readout::Kind::global:
      break;
    case Readout::Kind::rolling:
      return {segment.first_column + column, row, row * r.row_time};
    case Readout::Kind::line:
      return {segment.first_column + column, 0, row * r.line_period};
    case Readout::Kind::whisk: {
      const uint32_t scan = row / array.rows, detector = row % array.rows;
      return {0, capture.reversed & kRowsReversed ? array.rows - 1 - detector : detector,
              scan * r.line_period + column * r.sample_period};
    }
  }
  return {segment.first_column + column, row, 0};
}

std::string lines_text(const PlatformSpec& spec, size_t task, size_t array_number, const SensorContext& context) {
  const FocalArray& array = spec.arrays[array_number];
  const Readout& r = array.readout;
  const std::vector<const Capture*> captures = captures_of(spec, task, array_number);
  if (captures.empty()) return {};
  uint32_t rows = 0;
  for (const Capture* c : captures) rows += c->rows;
  const double begin = captures.front()->window.begin;
  const bool whisk = r.kind == Readout::Kind::whisk;
  const uint32_t scans = whisk ? rows / array.rows : rows;
  const std::string utc = context.utc ? context.utc(begin) : std::string();
  const uint8_t turned = captures.front()->reversed;
  std::string text =
      strf("task '%s': %s n = 1 to %u from the top begins at %.9g + (n - 1) x %.9g s%s", spec.tasks[task].name.c_str(),
           whisk ? "scan" : "line", scans, begin, r.line_period, utc.empty() ? "" : (" (n = 1: " + utc + ")").c_str());
  if (whisk)
    text += strf(" and has %u lines; sample k = 1 to %u from the %s begins (k - 1) x %.9g s later", array.rows,
                 r.samples, turned & kColumnsReversed ? "right" : "left", r.sample_period);
  text += strf("; each integrates %.9g s", r.integration);
  if (r.stages > 1) text += strf(" in each of %u stages", r.stages);
  const Lie lie = lie_of(spec, array, 0, lines_of(captures));
  text += "; not mirrored: at its middle the picture's bottom is towards " + compass(lie.onward, false) +
          " and its right towards " + compass(lie.along_row, turned & kColumnsReversed) + " of the compass";
  return text;
}

}  // namespace suite
