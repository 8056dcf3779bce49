// Where the sun stood when sunlight was found, so that days with the sun in nearly the same places need no new rays:
// the same day of other years, days soon before and after, and those as long on the other side of a solstice.
#pragma once
#include "heat/sunlight.h"

namespace suite {

// A course of the sun by its moments alone: what can be kept.
struct SunPath {
  std::vector<double> moments;           // s
  std::vector<Dir> towards;              // scene ENU, by moment
  double angular_radius = 0;             // rad
  std::vector<std::vector<float>> beam;  // by moment; sums to 1
  std::vector<float> sky;                // sums to 1
};
SunPath path_of(const SunCourse& course);

// Another day beside the one for which sunlight was found.
struct SunNear {
  double off = 0;          // rad, the farthest that its sun, when up, is from the path of the other
  double late = 0;         // s, the most that it is there earlier or later
  std::vector<double> at;  // by moment: where on the other's path, in its moments
  bool fits = false;
};
// Off the path by no more than the sun's radius, by which shadows are blurred anyway: what is found for one then holds
// for the other. Both must have the same steps, spectra that agree to 5 %, and be in place within a step; without that
// `off` is infinite.
inline constexpr double kNearSun = 0.00465;  // rad
SunNear near_path(const SunPath& found, const SunPath& wanted);

// Sunlight that was found for one path, in place for one that is near: the beam straight between its moments. Errors by
// blocks and hours of sun stay those of the day that was traced.
void move_along(Sunlight& sun, const SunNear& near);

}  // namespace suite
