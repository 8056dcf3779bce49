// What the detectors of an image share: light on an array, readings, one interface for all kinds.
//
// Every random number is drawn from a generator whose key is the seed, the detector and the read-out, so readings do
// not depend on the order or the number of threads.
#pragma once
#include <memory>

#include "math/sampling.h"
#include "sensor/detector.h"

namespace suite {

// Detectors that read a scene.
struct DetectorSite {
  uint64_t number = 0;  // the same in every read-out: what the detector always is follows from it
  uint32_t column = 0;  // in the array
  uint32_t chip = 0;
  bool dead = false;
};

// Read-outs that light may be left over from.
inline constexpr uint32_t kMostBefore = 16;

// One read-out of the detectors of one band, row-major.
struct ArrayLight {
  uint32_t columns = 0, rows = 0;
  std::vector<double> electrons;    // mean signal of each, >= 0, before what detectors differ in
  std::vector<DetectorSite> sites;  // of each
  double exposure = 0;              // s
  uint64_t array = 0;               // number of the array's band
  uint64_t read_out = 0;            // number; read-outs that follow each other differ by 1
  double more = 0;                  // electrons, standard deviation of noise beside that of the detector
  bool lines = false;               // rows are moments of one line of detectors
  Vec2 pitch;                       // m
  uint32_t before = 0;              // read-outs right before this one, kMostBefore at most
  double period = 0;                // s from one of them to the next
  size_t size() const { return electrons.size(); }
  // Key of the noise of one detector in this read-out, or in the one `ago` before it.
  uint64_t key(size_t i, uint64_t ago = 0) const { return hash_of(sites[i].number, read_out - ago, i); }
};

struct ArrayReading {
  std::vector<double> dn;      // digital counts; empty: this kind has none
  std::vector<double> counts;  // photons or electrons that were counted; likewise
  std::vector<uint8_t> clipped;
};

// Variance of one reading in signal electrons squared: constant + linear * mean signal electrons.
struct DetectorNoise {
  double constant = 0, linear = 0;
};

class ArrayDetector {
 public:
  virtual ~ArrayDetector() = default;
  virtual ArrayReading read(const ArrayLight& light) const = 0;
  // Shot noise, read noise and what belongs to them; not what detectors differ in. exposure: s; area: m2, of the pitch.
  virtual DetectorNoise noise(double exposure, double area) const = 0;
  // Reads whole frames of one chip: light goes from pixel to pixel.
  virtual bool whole_frames() const { return false; }
  // What is wrong with it for pixels of this pitch (m), in words; empty = nothing.
  virtual std::string fault_of(Vec2) const { return {}; }
};

// What a detector always is.
struct Character {
  double response = 1, dark = 1;  // factors
  bool dead = false, hot = false;
};
Character character_of(const DetectorSpec& spec, const DetectorSite& site);
// Mean electrons that a detector collects, dark ones included. exposure: s.
double collected(const DetectorSpec& spec, const Character& of, double signal, double exposure);

// Full scale of the converter, counts.
double most_counts(const DetectorSpec& spec);
// Counts of a charge; clipped: beyond an end of the converter.
struct Converted {
  double counts = 0;
  bool clipped = false;
};
Converted convert(const DetectorSpec& spec, double charge);
// A reading of dn, clipped or counts of so many detectors, all 0.
ArrayReading empty_reading(size_t detectors, bool dn, bool counts);

inline constexpr uint64_t kNoiseStream = 0x6e6f697365ull;
// Counts that the bias of low-light detectors has unless told, so that noise about no light is not cut at 0.
inline constexpr double kDarkBias = 100;

}  // namespace suite
