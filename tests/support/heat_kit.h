// Loads on batches of slabs, for tests.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "heat/balance.h"
#include "heat/slab_batch.h"
#include "math/vec.h"
#include "spectral/planck.h"

namespace suite::test {

inline double black(double kelvin) { return kStefanBoltzmann * std::pow(kelvin, 4); }

// A face that sees black surroundings of one temperature.
inline FaceBalance facing(double emissivity, double kelvin) {
  return {emissivity * black(kelvin), 0, emissivity * kStefanBoltzmann};
}

inline void set_face(FaceLines& lines, size_t element, const FaceBalance& face) {
  lines.constant[element] = {face.constant, face.constant};
  lines.linear[element] = {face.linear, face.linear};
  lines.quartic[element] = face.quartic;
}

// The same at all times: the top and bottom face of every element.
inline BatchLoads steady(std::vector<std::pair<FaceBalance, FaceBalance>> faces) {
  return [faces = std::move(faces)](double, double, const SlabBatch&, FaceLines& top, FaceLines& bottom) {
    for (size_t e = 0; e < faces.size(); ++e) {
      set_face(top, e, faces[e].first);
      set_face(bottom, e, faces[e].second);
    }
  };
}

// A clear day over one element or several alike: sun, sky, air as tables a minute apart that repeat.
struct Day {
  AveragedTable constant, linear;
  double quartic;
  explicit Day(double absorptance = 0.9, double wind = 2, double emissivity = 0.9, double sky = 320)
      : Day(make(absorptance, wind, emissivity, sky), wind, emissivity) {}
  BatchLoads loads() const {
    return [*this](double begin, double end, const SlabBatch&, FaceLines& top, FaceLines&) {
      std::fill(top.constant.begin(), top.constant.end(), constant.over(begin, end));
      std::fill(top.linear.begin(), top.linear.end(), linear.over(begin, end));
      std::fill(top.quartic.begin(), top.quartic.end(), quartic);
    };
  }

 private:
  Day(std::pair<std::vector<double>, std::vector<double>> table, double wind, double emissivity)
      : constant(table.first, table.second, AveragedTable::Between::linear, true),
        linear({0, 86400}, {5.7 + 3.8 * wind, 5.7 + 3.8 * wind}, AveragedTable::Between::linear, true),
        quartic(emissivity * kStefanBoltzmann) {}
  static std::pair<std::vector<double>, std::vector<double>> make(double absorptance, double wind, double emissivity,
                                                                  double sky) {
    std::vector<double> times, values;
    for (int i = 0; i <= 1440; ++i) {
      const double c = i == 1440 ? 1 : std::cos(2 * kPi * i / 1440), sun = std::fmax(0.0, -c);
      times.push_back(60.0 * i);
      values.push_back(absorptance * 780 * sun * sun + emissivity * sky + (5.7 + 3.8 * wind) * (288 - 5 * c));
    }
    return {times, values};
  }
};

}  // namespace suite::test
