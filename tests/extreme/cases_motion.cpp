// Rotations from 1e-9 rad to full turns, screws in large coordinates, exposures from 1 ns to a day.
#include <cmath>

#include "extreme/case.h"
#include "math/dualquat.h"
#include "motion/jitter.h"
#include "support/screw.h"

namespace suite::extreme {

namespace {

using test::apart, test::Screw;

double screw_error(double angle) {
  double worst = 0;
  for (int t = 0; t < 10; ++t) {
    const Dir axis = normalized(Vec3{1, 0.3 * t, 2 - t * 0.2});
    const Screw screw{axis, {30, -40.0 * t, 20}, angle, 10};
    const Pose start{quat_about(normalized(Vec3{2, 1, 0.1 * t}), 0.6 * t), {5, 6, 7}};
    for (const double s : {0.1, 0.5, 0.9})
      worst = std::fmax(worst, apart(screw.at(s) * start, sclerp(start, screw.at(1) * start, s)));
  }
  return worst;
}
// The same motion written in a frame whose origin is `far` away and turned: brought back, it is the same pose.
double framed_error(double far) {
  const Screw screw{normalized(Vec3{1, 2, 0.5}), {300, -200, 100}, 1.1, 40};
  const Pose a{quat_about({0, 0, 1}, 0.4), {100, 50, 20}}, b = screw.at(1) * a;
  const Pose frame{quat_about(normalized(Vec3{1, -1, 2}), 2.1), normalized(Vec3{0.5, 0.1, 0.8}) * far};
  double worst = 0;
  for (const double s : {0.25, 0.5, 0.75})
    worst = std::fmax(worst, apart(frame.inverse() * sclerp(frame * a, frame * b, s), sclerp(a, b, s)));
  return worst;
}

const Psd kBand{{1, 100}, {2e-9, 2e-9}, Psd::Between::linear};

}  // namespace

static void add_rotations(std::vector<Case>& c) {
  c.push_back({"rotation",
               "screw by 1e-9 rad",
               "closed form",
               "m",
               1e-9,
               [](const Numerics&, double x) { return screw_error(x); },
               {"angle", "rad", 1e-9, 1e-16, 10},
               {}});
  c.push_back({"rotation",
               "screw by half a turn less 1e-9 rad",
               "closed form",
               "m",
               1e-9,
               [](const Numerics&, double x) { return screw_error(kPi - x); },
               {"short of half a turn", "rad", 1e-9, 1e-11, 10},
               {}});
  c.push_back({"rotation",
               "exactly 180 deg: one of the two shortest ways",
               "closed form",
               "m",
               1e-9,
               [](const Numerics&, double) {
                 const Screw one{{0, 0, 1}, {10, 20, 0}, kPi, 5}, other{{0, 0, 1}, {10, 20, 0}, -kPi, 5};
                 const Pose a{quat_about({1, 0, 0}, 0.4), {1, 2, 3}}, middle = sclerp(a, one.at(1) * a, 0.5);
                 return std::fmin(apart(middle, one.at(0.5) * a), apart(middle, other.at(0.5) * a));
               },
               {},
               {}});
  c.push_back({"rotation",
               "360 deg is no turn",
               "closed form",
               "m",
               1e-9,
               [](const Numerics&, double) {
                 const Screw full{{0, 0, 1}, {10, 20, 0}, 2 * kPi, 5};
                 const Pose a{quat_about({1, 0, 0}, 0.4), {1, 2, 3}}, middle = sclerp(a, full.at(1) * a, 0.5);
                 return apart(middle, {a.rotation, a.translation + Vec3{0, 0, 2.5}});
               },
               {},
               {}});
  c.push_back({"rotation",
               "matrix of 1e-9 rad keeps 1 - cos",
               "closed form",
               "1",
               1e-15,
               [](const Numerics&, double x) {
                 const Affine3 r = rotation(normalized(Vec3{1, 1, 1}), x);
                 const double s = std::sin(x / 2), exact = 2 * s * s / 3;
                 return std::fabs((r.a[1] + r.a[3]) / 2 - exact) / x;
               },
               {"angle", "rad", 1e-9, 1e-15, 10},
               {}});
}

static void add_frames(std::vector<Case>& c) {
  c.push_back({"frames",
               "screw in ECEF against ENU",
               "one pose",
               "m",
               1e-8,
               [](const Numerics&, double x) { return framed_error(x); },
               {"distance of the frame", "m", 6.378e6, 1e12, 2},
               {}});
  c.push_back({"frames",
               "screw in the camera's frame against ENU",
               "one pose",
               "m",
               1e-8,
               [](const Numerics&, double) { return framed_error(700); },
               {},
               {}});
}

static void add_exposures(std::vector<Case>& c) {
  c.push_back({"exposure",
               "jitter over 1 ns: nothing moves within it",
               "closed form (pi T)^2 / 3 integral of S f^2",
               "1",
               1e-6,
               [](const Numerics&, double T) {
                 const double exact = kPi * kPi * T * T / 3 * 2e-9 * (1e6 - 1) / 3;
                 return std::fabs(in_frame_variance(kBand, T) / exact - 1);
               },
               {"exposure", "s", 1e-9, 1e-3, 10},
               {}});
  c.push_back({"exposure",
               "jitter over a day: all within it",
               "closed form: the whole variance",
               "1",
               1e-4,
               [](const Numerics&, double T) { return std::fabs(in_frame_variance(kBand, T) / (2e-9 * 99) - 1); },
               {"exposure", "s", 86400, 1e7, 10},
               {}});
  c.push_back(
      {"exposure",
       "jitter's two shares make the whole, 1 ns to a day",
       "identity",
       "1",
       1e-9,
       [](const Numerics&, double T) {
         double worst = 0;
         for (double t = 1e-9; t <= T * 1.01; t *= 10)
           worst = std::fmax(
               worst,
               std::fabs((in_frame_variance(kBand, t) + frame_to_frame_variance(kBand, t)) / kBand.variance() - 1));
         return worst;
       },
       {"exposure", "s", 86400, 864000, 10},
       {}});
}

std::vector<Case> motion_cases() {
  std::vector<Case> c;
  add_rotations(c);
  add_frames(c);
  add_exposures(c);
  return c;
}

}  // namespace suite::extreme
