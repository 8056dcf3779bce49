#include "motion/sgp4_deep.h"

#include <cmath>

#include "math/vec.h"

namespace suite::sgp4 {

namespace {

constexpr double kTwoPi = 2 * kPi;
constexpr double kEarthRate = 4.37526908801129966e-3;                  // rad/min
constexpr double kSunMotion = 1.19459e-5, kMoonMotion = 1.5835218e-4;  // rad/min
constexpr double kSunEccentricity = 0.01675, kMoonEccentricity = 0.05490;
constexpr double kSunStrength = 2.9864797e-6, kMoonStrength = 4.7968065e-7;  // perturbation coefficients, rad/min

double cube(double x) { return x * x * x; }

// One term of the 12 h resonance: amplitude index and phase of sin(p perigee + l longitude - phase).
struct HalfDayTerm {
  int perigee, longitude;
  double phase;
};
constexpr double kG22 = 5.7686396, kG32 = 0.95240898, kG44 = 1.8014998, kG52 = 1.0508330, kG54 = 4.4108898;
constexpr HalfDayTerm kHalfDayTerms[10] = {{2, 1, kG22}, {0, 1, kG22}, {1, 1, kG32},  {-1, 1, kG32}, {2, 2, kG44},
                                           {0, 2, kG44}, {1, 1, kG52}, {-1, 1, kG52}, {1, 2, kG54},  {-1, 2, kG54}};
constexpr double kDayPhase[3] = {0.13130908, 2.8843198, 0.37448087};

}  // namespace

// Coefficients of the doubly averaged attraction of one body on the orbit (Hoots & Roehrich, the s, x and z terms).
struct DeepSpace::Geometry {
  double s1, s2, s3, s4, s5, s6, s7;
  double z1, z2, z3, z11, z12, z13, z21, z22, z23, z31, z32, z33;

  // g, i, h: cosines and sines of the body's argument of perigee, inclination and node relative to the orbit's node.
  Geometry(const Mean& m, double cos_g, double sin_g, double cos_i, double sin_i, double cos_h, double sin_h,
           double strength) {
    const double e2 = m.eccentricity * m.eccentricity, beta2 = 1 - e2, beta = std::sqrt(beta2);
    const double ci = std::cos(m.inclination), si = std::sin(m.inclination);
    const double cw = std::cos(m.perigee), sw = std::sin(m.perigee);
    const double a1 = cos_g * cos_h + sin_g * cos_i * sin_h, a3 = -sin_g * cos_h + cos_g * cos_i * sin_h;
    const double a7 = -cos_g * sin_h + sin_g * cos_i * cos_h, a8 = sin_g * sin_i;
    const double a9 = sin_g * sin_h + cos_g * cos_i * cos_h, a10 = cos_g * sin_i;
    const double a2 = ci * a7 + si * a8, a4 = ci * a9 + si * a10;
    const double a5 = -si * a7 + ci * a8, a6 = -si * a9 + ci * a10;
    const double x1 = a1 * cw + a2 * sw, x2 = a3 * cw + a4 * sw, x3 = -a1 * sw + a2 * cw, x4 = -a3 * sw + a4 * cw;
    const double x5 = a5 * sw, x6 = a6 * sw, x7 = a5 * cw, x8 = a6 * cw;
    z31 = 12 * x1 * x1 - 3 * x3 * x3;
    z32 = 24 * x1 * x2 - 6 * x3 * x4;
    z33 = 12 * x2 * x2 - 3 * x4 * x4;
    z1 = 6 * (a1 * a1 + a2 * a2) + (1 + e2) * z31;
    z2 = 12 * (a1 * a3 + a2 * a4) + (1 + e2) * z32;
    z3 = 6 * (a3 * a3 + a4 * a4) + (1 + e2) * z33;
    z11 = -6 * a1 * a5 + e2 * (-24 * x1 * x7 - 6 * x3 * x5);
    z12 = -6 * (a1 * a6 + a3 * a5) + e2 * (-24 * (x2 * x7 + x1 * x8) - 6 * (x3 * x6 + x4 * x5));
    z13 = -6 * a3 * a6 + e2 * (-24 * x2 * x8 - 6 * x4 * x6);
    z21 = 6 * a2 * a5 + e2 * (24 * x1 * x5 - 6 * x3 * x7);
    z22 = 6 * (a4 * a5 + a2 * a6) + e2 * (24 * (x2 * x5 + x1 * x6) - 6 * (x4 * x7 + x3 * x8));
    z23 = 6 * a4 * a6 + e2 * (24 * x2 * x6 - 6 * x4 * x8);
    s3 = strength / m.motion;
    s2 = -0.5 * s3 / beta;
    s4 = s3 * beta;
    s1 = -15 * m.eccentricity * s4;
    s5 = x1 * x3 + x2 * x4;
    s6 = x2 * x3 + x1 * x4;
    s7 = x2 * x4 - x1 * x3;
  }

  // Amplitudes of the long-period terms of a body on an orbit of eccentricity `body_e`.
  Periodic periodic(double orbit_e, double body_e) const {
    Periodic p{};
    p.e2 = 2 * s1 * s6;
    p.e3 = 2 * s1 * s7;
    p.i2 = 2 * s2 * z12;
    p.i3 = 2 * s2 * (z13 - z11);
    p.l2 = -2 * s3 * z2;
    p.l3 = -2 * s3 * (z3 - z1);
    p.l4 = -2 * s3 * (-21 - 9 * orbit_e * orbit_e) * body_e;
    p.gh2 = 2 * s4 * z32;
    p.gh3 = 2 * s4 * (z33 - z31);
    p.gh4 = -18 * s4 * body_e;
    p.h2 = -2 * s2 * z22;
    p.h3 = -2 * s2 * (z23 - z21);
    return p;
  }
};

DeepSpace::DeepSpace(const Mean& epoch, const SecularRates& rates, double days, double sidereal, double xke)
    : epoch_(epoch), rates_(rates), sidereal_(sidereal) {
  // The Moon's orbit at epoch, days counted from 1899 December 31.5.
  const double day = days + 18261.5;
  const double moon_node = std::fmod(4.5236020 - 9.2422029e-4 * day, kTwoPi);
  const double cos_i = 0.91375164 - 0.03568096 * std::cos(moon_node), sin_i = std::sqrt(1 - cos_i * cos_i);
  const double sin_h = 0.089683511 * std::sin(moon_node) / sin_i, cos_h = std::sqrt(1 - sin_h * sin_h);
  const double longitude = 5.8351514 + 0.0019443680 * day;
  const double shift = std::atan2(0.39785416 * std::sin(moon_node) / sin_i,
                                  cos_h * std::cos(moon_node) + 0.91744867 * sin_h * std::sin(moon_node));
  const double g = longitude + shift - moon_node;

  const double cn = std::cos(epoch.node), sn = std::sin(epoch.node);
  const Geometry sun(epoch, 0.1945905, -0.98088458, 0.91744867, 0.39785416, cn, sn, kSunStrength);
  const Geometry moon(epoch, std::cos(g), std::sin(g), cos_i, sin_i, cos_h * cn + sin_h * sn, sn * cos_h - cn * sin_h,
                      kMoonStrength);
  sun_ = sun.periodic(epoch.eccentricity, kSunEccentricity);
  moon_ = moon.periodic(epoch.eccentricity, kMoonEccentricity);
  sun_.anomaly_at_epoch = std::fmod(6.2565837 + 0.017201977 * day, kTwoPi);
  moon_.anomaly_at_epoch = std::fmod(4.7199672 + 0.22997150 * day - longitude, kTwoPi);
  set_secular(sun, moon);

  // Choose the resonance by the mean motion.
  const double n = epoch.motion;
  const double semi_major_power = std::pow(n / xke, 2.0 / 3.0);  // 1 / semi-major axis
  if (n > 0.0034906585 && n < 0.0052359877) {
    resonance_ = Resonance::day;
    set_day_resonance(semi_major_power);
  } else if (n >= 8.26e-3 && n <= 9.24e-3 && epoch.eccentricity >= 0.5) {
    resonance_ = Resonance::half_day;
    set_half_day_resonance(semi_major_power);
  }
}

void DeepSpace::set_secular(const Geometry& sun, const Geometry& moon) {
  const double e2 = epoch_.eccentricity * epoch_.eccentricity;
  const double si = std::sin(epoch_.inclination), ci = std::cos(epoch_.inclination);
  // Nearly equatorial orbits have no node to drive (below 3 degrees).
  const bool has_node = epoch_.inclination >= 5.2359877e-2 && epoch_.inclination <= kPi - 5.2359877e-2;
  auto node = [&](const Geometry& b, double motion) { return has_node ? -motion * b.s2 * (b.z21 + b.z23) : 0; };
  auto perigee = [](const Geometry& b, double motion) { return b.s4 * motion * (b.z31 + b.z33 - 6); };
  auto anomaly = [&](const Geometry& b, double motion) { return -motion * b.s3 * (b.z1 + b.z3 - 14 - 6 * e2); };
  const double node_sun = si != 0 ? node(sun, kSunMotion) / si : 0;
  const double node_moon = si != 0 ? node(moon, kMoonMotion) / si : 0;
  drift_.eccentricity = sun.s1 * kSunMotion * sun.s5 + moon.s1 * kMoonMotion * moon.s5;
  drift_.inclination = sun.s2 * kSunMotion * (sun.z11 + sun.z13) + moon.s2 * kMoonMotion * (moon.z11 + moon.z13);
  drift_.anomaly = anomaly(sun, kSunMotion) + anomaly(moon, kMoonMotion);
  drift_.perigee = perigee(sun, kSunMotion) - ci * node_sun + perigee(moon, kMoonMotion) - ci * node_moon;
  drift_.node = node_sun + node_moon;
}

void DeepSpace::set_day_resonance(double a_inverse) {
  const double e2 = epoch_.eccentricity * epoch_.eccentricity, n = epoch_.motion;
  const double ci = std::cos(epoch_.inclination), si = std::sin(epoch_.inclination);
  const double g200 = 1 + e2 * (-2.5 + 0.8125 * e2), g310 = 1 + 2 * e2, g300 = 1 + e2 * (-6 + 6.60937 * e2);
  const double f220 = 0.75 * (1 + ci) * (1 + ci), f311 = 0.9375 * si * si * (1 + 3 * ci) - 0.75 * (1 + ci);
  const double f330 = 1.875 * cube(1 + ci);
  const double base = 3 * n * n * a_inverse * a_inverse;
  day_[0] = base * f311 * g310 * 2.1460748e-6 * a_inverse;
  day_[1] = 2 * base * f220 * g200 * 1.7891679e-6;
  day_[2] = 3 * base * f330 * g300 * 2.2123015e-7 * a_inverse;
  start_longitude_ = std::fmod(epoch_.anomaly + epoch_.node + epoch_.perigee - sidereal_, kTwoPi);
  longitude_rate_ =
      rates_.anomaly + (rates_.perigee + rates_.node) - kEarthRate + drift_.anomaly + drift_.perigee + drift_.node - n;
}

void DeepSpace::set_half_day_resonance(double a_inverse) {
  const double e = epoch_.eccentricity, n = epoch_.motion;
  // Eccentricity functions: cubic fits in ranges of e (Hoots & Roehrich; the last digits are Vallado et al.'s).
  auto fit = [e](double c0, double c1, double c2, double c3) {
    return c0 + c1 * e + c2 * (e * e) + c3 * (e * (e * e));
  };
  const double g201 = -0.306 - (e - 0.64) * 0.440;
  const bool low = e <= 0.65, middle = e < 0.7;
  const double g211 = low ? fit(3.616, -13.2470, 16.2900, 0) : fit(-72.099, 331.819, -508.738, 266.724);
  const double g310 = low ? fit(-19.302, 117.3900, -228.4190, 156.5910) : fit(-346.844, 1582.851, -2415.925, 1246.113);
  const double g322 = low ? fit(-18.9068, 109.7927, -214.6334, 146.5816) : fit(-342.585, 1554.908, -2366.899, 1215.972);
  const double g410 = low ? fit(-41.122, 242.6940, -471.0940, 313.9530) : fit(-1052.797, 4758.686, -7193.992, 3651.957);
  const double g422 =
      low ? fit(-146.407, 841.8800, -1629.014, 1083.4350) : fit(-3581.690, 16178.110, -24462.770, 12422.520);
  const double g520 = low         ? fit(-532.114, 3017.977, -5740.032, 3708.2760)
                      : e > 0.715 ? fit(-5149.66, 29936.92, -54087.36, 31324.56)
                                  : fit(1464.74, -4664.75, 3763.64, 0);
  const double g533 =
      middle ? fit(-919.22770, 4988.6100, -9064.7700, 5542.21) : fit(-37995.780, 161616.52, -229838.20, 109377.94);
  const double g521 =
      middle ? fit(-822.71072, 4568.6173, -8491.4146, 5337.524) : fit(-51752.104, 218913.95, -309468.16, 146349.42);
  const double g532 =
      middle ? fit(-853.66600, 4690.2500, -8624.7700, 5341.4) : fit(-40023.880, 170470.89, -242699.48, 115605.82);

  // Inclination functions.
  const double c = std::cos(epoch_.inclination), s = std::sin(epoch_.inclination), c2 = c * c, s2 = s * s;
  const double f220 = 0.75 * (1 + 2 * c + c2), f221 = 1.5 * s2;
  const double f321 = 1.875 * s * (1 - 2 * c - 3 * c2), f322 = -1.875 * s * (1 + 2 * c - 3 * c2);
  const double f441 = 35 * s2 * f220, f442 = 39.3750 * s2 * s2;
  const double f522 = 9.84375 * s * (s2 * (1 - 2 * c - 5 * c2) + 0.33333333 * (-2 + 4 * c + 6 * c2));
  const double f523 = s * (4.92187512 * s2 * (-2 - 4 * c + 10 * c2) + 6.56250012 * (1 + 2 * c - 3 * c2));
  const double f542 = 29.53125 * s * (2 - 8 * c + c2 * (-12 + 8 * c + 10 * c2));
  const double f543 = 29.53125 * s * (-2 - 8 * c + c2 * (12 + 8 * c - 10 * c2));

  // Each order in the Earth's field brings one more power of the inverse semi-major axis.
  const double order2 = 3 * n * n * a_inverse * a_inverse, order3 = order2 * a_inverse, order4 = order3 * a_inverse,
               order5 = order4 * a_inverse;
  constexpr double k22 = 1.7891679e-6, k32 = 3.7393792e-7, k44 = 7.3636953e-9, k52 = 1.1428639e-7, k54 = 2.1765803e-9;
  const double amplitudes[10] = {order2 * k22 * f220 * g201,     order2 * k22 * f221 * g211,
                                 order3 * k32 * f321 * g310,     order3 * k32 * f322 * g322,
                                 2 * order4 * k44 * f441 * g410, 2 * order4 * k44 * f442 * g422,
                                 order5 * k52 * f522 * g520,     order5 * k52 * f523 * g532,
                                 2 * order5 * k54 * f542 * g521, 2 * order5 * k54 * f543 * g533};
  for (int i = 0; i < 10; ++i) half_day_[i] = amplitudes[i];
  start_longitude_ = std::fmod(epoch_.anomaly + epoch_.node + epoch_.node - sidereal_ - sidereal_, kTwoPi);
  longitude_rate_ = rates_.anomaly + drift_.anomaly + 2 * (rates_.node + drift_.node - kEarthRate) - n;
}

// First and second derivative of the mean motion, and the rate of the resonance angle.
void DeepSpace::resonance_rates(double longitude, double time, double motion, double& acceleration, double& jerk,
                                double& drift) const {
  acceleration = jerk = 0;
  if (resonance_ == Resonance::day) {
    for (int k = 0; k < 3; ++k) {
      const double phase = (k + 1) * (longitude - kDayPhase[k]);
      acceleration += day_[k] * std::sin(phase);
      jerk += (k + 1) * day_[k] * std::cos(phase);
    }
  } else {
    const double perigee = epoch_.perigee + rates_.perigee * time;
    for (int k = 0; k < 10; ++k) {
      const HalfDayTerm& t = kHalfDayTerms[k];
      const double phase = t.perigee * perigee + t.longitude * longitude - t.phase;
      acceleration += half_day_[k] * std::sin(phase);
      jerk += t.longitude * half_day_[k] * std::cos(phase);
    }
  }
  drift = motion + longitude_rate_;
  jerk *= drift;
}

void DeepSpace::secular(double minutes, Mean& m) const {
  m.eccentricity += drift_.eccentricity * minutes;
  m.inclination += drift_.inclination * minutes;
  m.perigee += drift_.perigee * minutes;
  m.node += drift_.node * minutes;
  m.anomaly += drift_.anomaly * minutes;
  if (resonance_ == Resonance::none) return;

  // Integrate the resonance from the epoch in the theory's own steps of half a day (second-order Taylor).
  constexpr double kStep = 720;
  const double step = minutes > 0 ? kStep : -kStep;
  double time = 0, longitude = start_longitude_, motion = epoch_.motion, acceleration, jerk, drift;
  resonance_rates(longitude, time, motion, acceleration, jerk, drift);
  while (std::fabs(minutes - time) >= kStep) {
    longitude += drift * step + acceleration * (step * step / 2);
    motion += acceleration * step + jerk * (step * step / 2);
    time += step;
    resonance_rates(longitude, time, motion, acceleration, jerk, drift);
  }
  const double rest = minutes - time;
  m.motion = motion + acceleration * rest + jerk * rest * rest * 0.5;
  const double angle = longitude + drift * rest + acceleration * rest * rest * 0.5;
  const double sidereal = std::fmod(sidereal_ + minutes * kEarthRate, kTwoPi);
  m.anomaly = resonance_ == Resonance::day ? angle - m.node - m.perigee + sidereal : angle - 2 * m.node + 2 * sidereal;
}

void DeepSpace::periodic(double minutes, Mean& m) const {
  double de = 0, di = 0, dl = 0, dgh = 0, dh = 0;
  auto add = [&](const Periodic& p, double motion, double eccentricity) {
    const double mean = p.anomaly_at_epoch + motion * minutes;
    const double f = mean + 2 * eccentricity * std::sin(mean), sf = std::sin(f);
    const double f2 = 0.5 * sf * sf - 0.25, f3 = -0.5 * sf * std::cos(f);
    de += p.e2 * f2 + p.e3 * f3;
    di += p.i2 * f2 + p.i3 * f3;
    dl += p.l2 * f2 + p.l3 * f3 + p.l4 * sf;
    dgh += p.gh2 * f2 + p.gh3 * f3 + p.gh4 * sf;
    dh += p.h2 * f2 + p.h3 * f3;
  };
  add(sun_, kSunMotion, kSunEccentricity);
  add(moon_, kMoonMotion, kMoonEccentricity);

  m.inclination += di;
  m.eccentricity += de;
  const double si = std::sin(m.inclination), ci = std::cos(m.inclination);
  if (m.inclination >= 0.2) {
    dh /= si;
    m.perigee += dgh - ci * dh;
    m.node += dh;
    m.anomaly += dl;
    return;
  }
  // Lyddane's modification near the equator, where node and perigee lose their meaning: vary the node's vector.
  const double sn = std::sin(m.node), cn = std::cos(m.node);
  const double alpha = si * sn + dh * cn + di * ci * sn, beta = si * cn - dh * sn + di * ci * cn;
  double node_before = std::fmod(m.node, kTwoPi);
  if (node_before < 0) node_before += kTwoPi;
  const double longitude = m.anomaly + m.perigee + ci * node_before + dl + dgh - di * node_before * si;
  m.node = std::atan2(alpha, beta);
  if (m.node < 0) m.node += kTwoPi;
  if (std::fabs(node_before - m.node) > kPi) m.node += m.node < node_before ? kTwoPi : -kTwoPi;
  m.anomaly += dl;
  m.perigee = longitude - m.anomaly - ci * m.node;
}

}  // namespace suite::sgp4
