// Tracks as plain data, for files: a tree of kinds and numbers from which the same track is made again, bit for bit.
#pragma once
#include <string>
#include <vector>

#include "motion/track.h"

namespace suite {

struct TrackRecord {
  enum class Kind : uint8_t {
    fixed,
    keyframes,
    straight,
    circle,
    spin,
    composed,
    orbit,
    pointed,
    ending,
    interpolated,
    hermite
  };
  Kind kind = Kind::fixed;
  std::vector<double> numbers;  // SI; track_record.cpp says which
  std::string text;             // orbit: the satellite
  std::vector<TrackRecord>
      parts;  // composed: outer, inner; pointed: the place, then the target if there is one; ending: what ends
};

// The track that a record describes. Error: too few or too many numbers or parts, more than 64 levels, or what the
// track itself refuses.
TrackPtr track_of(const TrackRecord& record);

namespace record {
// Numbers of a pose: quaternion w x y z, translation x y z.
void put(std::vector<double>& numbers, const Pose& pose);
// Of a frame: latitude and longitude in degrees, height.
void put(std::vector<double>& numbers, const SceneFrame& frame);
// Of a date: year, month, day, hour, minute, second.
void put(std::vector<double>& numbers, const Utc& utc);
}  // namespace record

}  // namespace suite
