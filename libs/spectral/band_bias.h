// What is known of the error that the bins of a spectral state make in a band.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace suite {

// A bound: `relative` times the band's radiance or `floor`, whichever is larger, and `absolute`, which is what lights
// lack that are far darker than others and for which no bins are chosen (the air's own emission beside a lamp).
struct BandBias {
  double relative = 0;
  double floor = 0;     // W/(m2 sr um)
  bool within = true;   // what is wanted
  double absolute = 0;  // W/(m2 sr um)
  double of(double radiance) const { return relative * (radiance > floor ? radiance : floor) + absolute; }
};

// Of the bands of each state of sensors, by the sensor's name and the state's number; missing: not known.
using BandBiases = std::map<std::pair<std::string, size_t>, std::vector<BandBias>>;
// Empty where it is not known.
inline std::vector<BandBias> bias_of(const BandBiases& all, const std::string& sensor, size_t state) {
  const auto at = all.find({sensor, state});
  return at == all.end() ? std::vector<BandBias>() : at->second;
}

}  // namespace suite
