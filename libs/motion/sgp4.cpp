#include "motion/sgp4.h"

#include <erfa.h>

#include <cmath>
#include <optional>

#include "base/error.h"
#include "motion/sgp4_deep.h"

namespace suite {

namespace {

using sgp4::DeepSpace;
using sgp4::Mean;

// WGS-72, in Earth radii and minutes.
constexpr double kRadiusKm = 6378.135, kMu = 398600.8;
constexpr double kJ2 = 0.001082616, kJ3 = -0.00000253881, kJ4 = -0.00000165597, kJ3OverJ2 = kJ3 / kJ2;
const double kXke = 60 / std::sqrt(kRadiusKm * kRadiusKm * kRadiusKm / kMu);
constexpr double kTwoPi = 2 * kPi;

double fourth(double x) { return x * x * x * x; }

// Mean motion and semi-major axis of Brouwer's theory from the Kozai mean motion of an element set.
double brouwer_motion(double kozai, double e, double cos_i) {
  const double beta2 = 1 - e * e;
  const double a1 = std::pow(kXke / kozai, 2.0 / 3.0);
  const double d1 = 0.75 * kJ2 * (3 * cos_i * cos_i - 1) / (std::sqrt(beta2) * beta2);
  double delta = d1 / (a1 * a1);
  const double a0 = a1 * (1 - delta * delta - delta * (1.0 / 3 + 134 * delta * delta / 81));
  delta = d1 / (a0 * a0);
  return kozai / (1 + delta);
}

// Days since 1950 January 0.0 UTC of an epoch. The theory's implementations keep epochs as one Julian date in double,
// rounded to 40 microseconds; the Moon's place at perigee of the most eccentric verification orbit shows it (5e-6 km),
// so the same rounding is made here.
double days_since_1950(const Utc& u) {
  double zero = 0, mjd = 0;
  eraCal2jd(u.year, u.month, u.day, &zero, &mjd);
  const double julian = (mjd + zero) + ((u.second / 60 + u.minute) / 60 + u.hour) / 24;
  return julian - 2433281.5;
}

// Greenwich sidereal angle of the original theory (Hoots & Roehrich, THETAG), rad.
double sidereal_angle(double days) {
  const double since_1970 = days - 7305, whole = std::floor(since_1970 + 1e-8), part = since_1970 - whole;
  const double rate = 1.72027916940703639e-2;
  const double angle = std::fmod(
      1.7321343856509374 + rate * whole + (rate + kTwoPi) * part + since_1970 * since_1970 * 5.07551419432269442e-15,
      kTwoPi);
  return angle < 0 ? angle + kTwoPi : angle;
}

// Constants of the long-period terms by J3, which deep-space orbits recompute with their perturbed inclination.
struct LongPeriod {
  double longitude, aynl;
  explicit LongPeriod(double inclination) {
    const double c = std::cos(inclination), s = std::sin(inclination);
    const double divisor = std::fabs(c + 1) > 1.5e-12 ? 1 + c : 1.5e-12;
    longitude = -0.25 * kJ3OverJ2 * s * (3 + 5 * c) / divisor;
    aynl = -0.5 * kJ3OverJ2 * s;
  }
};

}  // namespace

struct Sgp4::Model {
  Mean epoch;
  double drag;                                    // B*
  double c1, c4, c5 = 0, d2 = 0, d3 = 0, d4 = 0;  // atmospheric drag
  double t2, t3 = 0, t4 = 0, t5 = 0;              // of the mean longitude
  double eta, anomaly_drag = 0, perigee_drag = 0, node_drag;
  double anomaly_cubed = 0;  // (1 + eta cos M)^3 at epoch
  bool simple;               // low perigee or deep space: drag to second order only
  sgp4::SecularRates rates;
  std::optional<DeepSpace> deep;

  Model(const OrbitElements& o);
  void set_higher_drag(double a, double tsi, double s);
  Mean secular(double t, double& shrink, const std::string& name) const;
};

Sgp4::Model::Model(const OrbitElements& o) : drag(o.drag) {
  const double e = o.eccentricity, ci = std::cos(o.inclination), si = std::sin(o.inclination);
  const double n = brouwer_motion(o.mean_motion, e, ci), a = std::pow(kXke / n, 2.0 / 3.0);
  epoch = {n, e, o.inclination, o.ascending_node, o.perigee_argument, o.mean_anomaly};
  const double c2 = ci * ci, c4i = c2 * c2, beta2 = 1 - e * e, beta = std::sqrt(beta2);
  const double con41 = 3 * c2 - 1, con42 = 1 - 5 * c2, x1mth2 = 1 - c2;
  const double perigee_radius = a * (1 - e);
  simple = perigee_radius < 220 / kRadiusKm + 1;

  // The density reference moves down with low perigees.
  double s = 78 / kRadiusKm + 1, q0ms4 = fourth((120 - 78) / kRadiusKm);
  if (const double perigee_km = (perigee_radius - 1) * kRadiusKm; perigee_km < 156) {
    const double s_km = perigee_km < 98 ? 20 : perigee_km - 78;
    q0ms4 = fourth((120 - s_km) / kRadiusKm);
    s = s_km / kRadiusKm + 1;
  }
  const double p_inverse2 = 1 / (a * beta2 * a * beta2), tsi = 1 / (a - s);
  eta = a * e * tsi;
  const double eta2 = eta * eta, e_eta = e * eta, psi2 = std::fabs(1 - eta2);
  const double coef = q0ms4 * fourth(tsi), coef1 = coef / std::pow(psi2, 3.5);
  const double cc2 =
      coef1 * n *
      (a * (1 + 1.5 * eta2 + e_eta * (4 + eta2)) + 0.375 * kJ2 * tsi / psi2 * con41 * (8 + 3 * eta2 * (8 + eta2)));
  c1 = drag * cc2;
  const double cc3 = e > 1e-4 ? -2 * coef * tsi * kJ3OverJ2 * n * si / e : 0;
  c4 = 2 * n * coef1 * a * beta2 *
       (eta * (2 + 0.5 * eta2) + e * (0.5 + 2 * eta2) -
        kJ2 * tsi / (a * psi2) *
            (-3 * con41 * (1 - 2 * e_eta + eta2 * (1.5 - 0.5 * e_eta)) +
             0.75 * x1mth2 * (2 * eta2 - e_eta * (1 + eta2)) * std::cos(2 * o.perigee_argument)));
  c5 = 2 * coef1 * a * beta2 * (1 + 2.75 * (eta2 + e_eta) + e_eta * eta2);

  // Secular rates by J2, J2^2 and J4.
  const double k1 = 1.5 * kJ2 * p_inverse2 * n, k2 = 0.5 * k1 * kJ2 * p_inverse2;
  const double k3 = -0.46875 * kJ4 * p_inverse2 * p_inverse2 * n;
  rates.anomaly = n + 0.5 * k1 * beta * con41 + 0.0625 * k2 * beta * (13 - 78 * c2 + 137 * c4i);
  rates.perigee = -0.5 * k1 * con42 + 0.0625 * k2 * (7 - 114 * c2 + 395 * c4i) + k3 * (3 - 36 * c2 + 49 * c4i);
  const double node_j2 = -k1 * ci;
  rates.node = node_j2 + (0.5 * k2 * (4 - 19 * c2) + 2 * k3 * (3 - 7 * c2)) * ci;
  perigee_drag = drag * cc3 * std::cos(o.perigee_argument);
  anomaly_drag = e > 1e-4 ? -2.0 / 3.0 * coef * drag / e_eta : 0;
  node_drag = 3.5 * beta2 * node_j2 * c1;
  t2 = 1.5 * c1;
  const double base = 1 + eta * std::cos(o.mean_anomaly);
  anomaly_cubed = base * base * base;

  if (kTwoPi / n >= 225) {
    simple = true;
    const double days = days_since_1950(o.epoch);
    deep.emplace(epoch, rates, days, sidereal_angle(days), kXke);
  }
  if (!simple) set_higher_drag(a, tsi, s);
}

void Sgp4::Model::set_higher_drag(double a, double tsi, double s) {
  const double c1sq = c1 * c1;
  d2 = 4 * a * tsi * c1sq;
  const double k = d2 * tsi * c1 / 3;
  d3 = (17 * a + s) * k;
  d4 = 0.5 * k * a * tsi * (221 * a + 31 * s) * c1;
  t3 = d2 + 2 * c1sq;
  t4 = 0.25 * (3 * d3 + c1 * (12 * d2 + 10 * c1sq));
  t5 = 0.2 * (3 * d4 + 12 * c1 * d3 + 6 * d2 * d2 + 15 * c1sq * (2 * d2 + c1sq));
}

// Mean elements at t minutes: gravity, drag, and for deep space Sun, Moon and resonance. `shrink` receives the
// semi-major axis.
Mean Sgp4::Model::secular(double t, double& semi_major, const std::string& name) const {
  Mean m = epoch;
  m.anomaly += rates.anomaly * t;
  m.perigee += rates.perigee * t;
  m.node += rates.node * t + node_drag * t * t;
  double shrink = 1 - c1 * t, rounder = drag * c4 * t, ahead = t2 * t * t;
  if (!simple) {
    const double base = 1 + eta * std::cos(m.anomaly);
    const double swap = perigee_drag * t + anomaly_drag * (base * base * base - anomaly_cubed);
    m.anomaly += swap;
    m.perigee -= swap;
    const double tt = t * t, ttt = tt * t, tttt = tt * tt;
    shrink -= d2 * tt + d3 * ttt + d4 * tttt;
    rounder += drag * c5 * (std::sin(m.anomaly) - std::sin(epoch.anomaly));
    ahead += t3 * ttt + tttt * (t4 + t * t5);
  }
  if (deep) deep->secular(t, m);
  if (!(m.motion > 0)) throw Error("satellite " + name + strf(": the mean motion is not positive at %g min", t));
  semi_major = std::pow(kXke / m.motion, 2.0 / 3.0) * shrink * shrink;
  m.motion = kXke / std::pow(semi_major, 1.5);
  m.eccentricity -= rounder;
  if (!(m.eccentricity < 1 && m.eccentricity >= -0.001))
    throw Error("satellite " + name + strf(": the mean eccentricity %g has left 0 to 1 at %g min", m.eccentricity, t));
  m.eccentricity = std::fmax(m.eccentricity, 1e-6);
  m.anomaly += epoch.motion * ahead;
  const double longitude = std::fmod(m.anomaly + m.perigee + m.node, kTwoPi);
  m.node = std::fmod(m.node, kTwoPi);
  m.perigee = std::fmod(m.perigee, kTwoPi);
  m.anomaly = std::fmod(longitude - m.perigee - m.node, kTwoPi);
  return m;
}

Sgp4::Sgp4(const OrbitElements& o) : elements_(o), epoch_(instant_from_utc(o.epoch)) {
  auto need = [&](bool ok, const char* what, double value, const char* range) {
    if (!ok) throw Error("satellite " + o.satellite + strf(": %s %g is outside its range", what, value), range);
  };
  need(o.eccentricity >= 0 && o.eccentricity < 1, "eccentricity", o.eccentricity, "0 <= e < 1");
  need(o.mean_motion > 0 && o.mean_motion < 20 * kTwoPi / 1440, "mean motion (rad/min)", o.mean_motion,
       "more than 0, below 20 revolutions a day");
  need(o.inclination >= 0 && o.inclination <= kPi, "inclination (rad)", o.inclination, "0 to pi");
  for (const double x : {o.ascending_node, o.perigee_argument, o.mean_anomaly, o.drag})
    need(std::isfinite(x), "an element", x, "finite numbers");
  model_ = std::make_unique<const Model>(o);
  at_minutes(0);  // an orbit that is under ground at its own epoch is refused here
}
Sgp4::~Sgp4() = default;
Sgp4::Sgp4(Sgp4&&) noexcept = default;

bool Sgp4::deep_space() const { return model_->deep.has_value(); }

OrbitState Sgp4::at_minutes(double t) const {
  const std::string& name = elements_.satellite;
  if (!(std::fabs(t) <= 1e8))
    throw Error("satellite " + name + strf(": asked for %g min after its epoch", t), "at most 1e8 min (190 years)");
  double a = 0;
  Mean m = model_->secular(t, a, name);
  if (model_->deep) {
    model_->deep->periodic(t, m);
    if (m.inclination < 0) {
      m.inclination = -m.inclination;
      m.node += kPi;
      m.perigee -= kPi;
    }
    if (!(m.eccentricity >= 0 && m.eccentricity <= 1))
      throw Error("satellite " + name +
                  strf(": the perturbed eccentricity %g has left 0 to 1 at %g min", m.eccentricity, t));
  }

  // Long-period terms, then Kepler's equation in (argument of latitude, e cos w, e sin w).
  const double ci = std::cos(m.inclination), si = std::sin(m.inclination);
  const LongPeriod long_period(m.inclination);
  const double axn = m.eccentricity * std::cos(m.perigee);
  const double j3_scale = 1 / (a * (1 - m.eccentricity * m.eccentricity));
  const double ayn = m.eccentricity * std::sin(m.perigee) + j3_scale * long_period.aynl;
  const double u = std::fmod(m.anomaly + m.perigee + j3_scale * long_period.longitude * axn, kTwoPi);
  double E = u;
  for (int i = 0; i < 10; ++i) {
    const double slope = 1 - std::cos(E) * axn - std::sin(E) * ayn;
    const double step = (u - ayn * std::cos(E) + axn * std::sin(E) - E) / slope;
    E += std::fmax(-0.95, std::fmin(0.95, step));
    if (std::fabs(step) < 1e-12) break;
  }
  const double ce = std::cos(E), se = std::sin(E);
  const double e_cos = axn * ce + ayn * se, e_sin = axn * se - ayn * ce, el2 = axn * axn + ayn * ayn,
               pl = a * (1 - el2);
  if (!(pl >= 0)) throw Error("satellite " + name + strf(": the semi-latus rectum is negative at %g min", t));

  // Short-period terms by J2 on radius, argument of latitude, node, inclination.
  const double r = a * (1 - e_cos), r_dot = std::sqrt(a) * e_sin / r, rv_dot = std::sqrt(pl) / r;
  const double beta = std::sqrt(1 - el2), k = e_sin / (1 + beta);
  const double sin_u = a / r * (se - ayn - axn * k), cos_u = a / r * (ce - axn + ayn * k);
  const double sin_2u = 2 * cos_u * sin_u, cos_2u = 1 - 2 * sin_u * sin_u;
  const double j1 = 0.5 * kJ2 / pl, j2 = j1 / pl, c2 = ci * ci, con41 = 3 * c2 - 1, x1mth2 = 1 - c2,
               x7thm1 = 7 * c2 - 1;
  const double radius = r * (1 - 1.5 * j2 * beta * con41) + 0.5 * j1 * x1mth2 * cos_2u;
  const double latitude = std::atan2(sin_u, cos_u) - 0.25 * j2 * x7thm1 * sin_2u;
  const double node = m.node + 1.5 * j2 * ci * sin_2u, incl = m.inclination + 1.5 * j2 * ci * si * cos_2u;
  const double radial = r_dot - m.motion * j1 * x1mth2 * sin_2u / kXke;
  const double across = rv_dot + m.motion * j1 * (x1mth2 * cos_2u + 1.5 * con41) / kXke;
  if (!(radius >= 1)) throw Error("satellite " + name + strf(": it has decayed at %g min (below the ground)", t));

  const double su = std::sin(latitude), cu = std::cos(latitude), sn = std::sin(node), cn = std::cos(node);
  const double sin_i = std::sin(incl), cos_i = std::cos(incl);
  const Vec3 outward{-sn * cos_i * su + cn * cu, cn * cos_i * su + sn * cu, sin_i * su};
  const Vec3 forward{-sn * cos_i * cu - cn * su, cn * cos_i * cu - sn * su, sin_i * cu};
  const double metres = 1000 * kRadiusKm, metres_per_second = metres * kXke / 60;
  return {outward * (radius * metres), (outward * radial + forward * across) * metres_per_second};
}

OrbitState earth_fixed_from_teme(const OrbitState& s, Instant instant, double dut1) {
  const JulianDate ut1 = julian_ut1(instant, dut1);
  const double angle = eraGmst82(ut1.day, ut1.fraction), c = std::cos(angle), d = std::sin(angle);
  auto turn = [c, d](Vec3 v) { return Vec3{c * v.x + d * v.y, -d * v.x + c * v.y, v.z}; };
  constexpr double kEarthRate = 7.29211514670698e-5;  // rad/s, of the mean sidereal angle
  OrbitState r{turn(s.position), turn(s.velocity)};
  r.velocity -= Vec3{-r.position.y, r.position.x, 0} * kEarthRate;
  return r;
}

}  // namespace suite
