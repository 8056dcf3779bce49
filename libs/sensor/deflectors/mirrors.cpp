// Mirrors. Based on: J. Shan, C. K. Toth (eds.), "Topographic Laser Ranging and Scanning", 2nd ed. 2018, chapter 1
// (oscillating, polygon and nutating mirrors).
#include <algorithm>
#include <cmath>

#include "sensor/deflectors/deflector.h"

namespace suite {

namespace {

constexpr double kMostHz = 1e7;

// Across the flight, positive to the right.
Dir across(double angle) { return {std::sin(angle), 0, -std::cos(angle)}; }

class Fixed : public Deflector {
 public:
  std::optional<Dir> direction(double, size_t) const override { return Dir{0, 0, -1}; }
};

// angle = A sin(2 pi f t + phase): 2 f lines a second.
class Galvo : public Deflector {
 public:
  explicit Galvo(const Params& p)
      : half_(p.number_in("half_angle_deg", 0, 90, "degrees") * kDegree),
        rate_(p.number_in("rate_hz", 0, kMostHz, "Hz")),
        phase_(p.number_in("phase_deg", -360, 360, "degrees", 0) * kDegree) {}
  std::optional<Dir> direction(double t, size_t) const override {
    return across(half_ * std::sin(2 * kPi * rate_ * t + phase_));
  }

 private:
  double half_, rate_, phase_;
};

// Even speed but for the turns, where the acceleration is constant. turn: share of the time that turns take.
class Triangle : public Deflector {
 public:
  explicit Triangle(const Params& p)
      : half_(p.number_in("half_angle_deg", 0, 90, "degrees") * kDegree),
        rate_(p.number_in("rate_hz", 0, kMostHz, "Hz")),
        turn_(p.number_in("turn_share", 0, 1, "", 0.1)),
        phase_(p.number_in("phase_deg", -360, 360, "degrees", 0) / 90) {}
  std::optional<Dir> direction(double t, size_t) const override {
    // In quarters of a period: 0 at 0, the half angle at 1, and the same backwards and to the other side.
    const double x = 4 * rate_ * t + phase_, period = x - 4 * std::floor(x / 4);
    const double sign = period < 2 ? 1 : -1, within = period < 2 ? period : period - 2;
    const double quarter = within < 1 ? within : 2 - within;
    // Even up to 1 - turn, then a parabola with its top at 1: speed v with v (1 - turn) + v turn / 2 = 1.
    const double v = 1 / (1 - turn_ / 2), left = 1 - quarter;
    const double part = left >= turn_ ? v * quarter : 1 - v * left * left / (2 * turn_);
    return across(sign * half_ * part);
  }

 private:
  double half_, rate_, turn_, phase_;  // phase in quarters
};

// One way at even speed from -half to +half, and again; the beam leaves within a part of it.
class Sweep : public Deflector {
 public:
  explicit Sweep(const Params& p)
      : half_(p.number_in("half_angle_deg", 0, 360, "degrees") * kDegree),
        rate_(p.number_in("rate_hz", 0, kMostHz, "Hz")),
        start_(p.number_in("start_deg", -360, 360, "degrees", 0) * kDegree),
        from_(p.number_in("from_deg", -360, 360, "degrees", -half_ / kDegree) * kDegree),
        to_(p.number_in("to_deg", -360, 360, "degrees", half_ / kDegree) * kDegree) {
    if (!(std::fabs(start_) <= half_)) throw p.at("start_deg").error("the sweep does not reach its start");
    if (!(from_ <= to_)) throw p.error(strf("no beam leaves from %g to %g degrees", from_ / kDegree, to_ / kDegree));
  }
  std::optional<Dir> direction(double t, size_t) const override {
    const double x = half_ > 0 ? rate_ * t + (start_ + half_) / (2 * half_) : 0;
    const double angle = -half_ + 2 * half_ * (x - std::floor(x));
    constexpr double kRounding = 1e-12;
    if (angle < from_ - kRounding || angle > to_ + kRounding) return std::nullopt;
    return across(angle);
  }

 private:
  double half_, rate_, start_, from_, to_;
};

// m facets: the beam sweeps 2 (360 / m) duty degrees, always one way, m lines a turn.
class Polygon : public Deflector {
 public:
  explicit Polygon(const Params& p)
      : facets_(static_cast<double>(p.integer("facets", 2, 1000))),
        rate_(p.number_in("rotation_hz", 0, kMostHz, "Hz")),
        duty_(p.number_in("duty", 1e-6, 1, "", 1)) {}
  std::optional<Dir> direction(double t, size_t) const override {
    const double x = facets_ * rate_ * t, facet = x - std::floor(x);  // 0..1 of a facet
    const double mirror = (facet - 0.5) * 2 * kPi / facets_;
    if (std::fabs(facet - 0.5) > duty_ / 2) return std::nullopt;
    return across(2 * mirror);
  }

 private:
  double facets_, rate_, duty_;
};

// A mirror whose normal n is tilted against the shaft that turns it: d' = d - 2 (d.n) n. The mean beam leaves along -z;
// `incidence_deg` is the angle between the beam and the shaft, in the plane of y and z.
class Palmer : public Deflector {
 public:
  explicit Palmer(const Params& p)
      : tilt_(p.number_in("mirror_tilt_deg", 0, 45, "degrees") * kDegree),
        rate_(p.number_in("rotation_hz", -kMostHz, kMostHz, "Hz")) {
    const double incidence = p.number_in("incidence_deg", 0, 80, "degrees", 0) * kDegree;
    shaft_ = {0, std::sin(incidence), -std::cos(incidence)};
    along_ = cross(shaft_, across_);
    const Dir down{0, 0, -1};
    beam_ = down - shaft_ * (2 * dot(down, shaft_));
  }
  std::optional<Dir> direction(double t, size_t) const override {
    const double turn = 2 * kPi * rate_ * t;
    const Dir n = shaft_ * std::cos(tilt_) + (across_ * std::cos(turn) + along_ * std::sin(turn)) * std::sin(tilt_);
    return normalized(beam_ - n * (2 * dot(beam_, n)));
  }

 private:
  double tilt_, rate_;
  Dir shaft_, across_{1, 0, 0}, along_, beam_;
};

template <class Kind>
std::unique_ptr<Deflector> make(const Params& p) {
  return std::make_unique<Kind>(p);
}

}  // namespace

DeflectorRow fixed_deflector_row() {
  return {"fixed", "no deflection: beams leave along -z", "", [](const Params&) { return std::make_unique<Fixed>(); }};
}
DeflectorRow galvo_row() {
  return {"galvo", "oscillating mirror: sine across the flight, 2 rate_hz lines a second", "", make<Galvo>};
}
DeflectorRow triangle_row() {
  return {"triangle", "oscillating mirror: even speed with smooth turns", "", make<Triangle>};
}
DeflectorRow sweep_row() {
  return {"sweep", "rotating mirror by its angles: rate_hz lines a second, one way, lit from one angle to another", "",
          make<Sweep>};
}
DeflectorRow polygon_row() { return {"polygon", "rotating polygon: lines one way, facets a turn", "", make<Polygon>}; }
DeflectorRow palmer_row() {
  return {"palmer", "nutating mirror: a cone, an oval at slanted incidence", "", make<Palmer>};
}

}  // namespace suite
