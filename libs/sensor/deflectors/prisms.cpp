// Rotating wedge prisms (Risley). Based on: G. F. Marshall, "Risley prism scan patterns", SPIE 3787, 1999; refraction
// at each face by the vector form of Snell's law.
#include <cmath>

#include "sensor/deflectors/deflector.h"

namespace suite {

std::optional<Dir> refract(Dir d, Dir n, double ratio) {
  if (dot(d, n) > 0) n = -n;
  const double in = -dot(d, n), rest = 1 - ratio * ratio * (1 - in * in);
  if (rest < 0) return std::nullopt;
  return normalized(d * ratio + n * (ratio * in - std::sqrt(rest)));
}

namespace {

// Prisms one behind the other along -z; each with one face square to the axis and the other one, by default the second,
// tilted by the wedge. Thin wedges: sum of (index - 1) wedge (cos, sin)(2 pi rate t + phase).
class Risley : public Deflector {
 public:
  explicit Risley(const Params& params) {
    for (const Params& p : params.at("prisms").items())
      prisms_.push_back({p.number_in("wedge_deg", 0, 60, "degrees") * kDegree, p.number_in("index", 1, 5, ""),
                         p.number_in("rotation_hz", -1e7, 1e7, "Hz"),
                         p.number_in("phase_deg", -360, 360, "degrees", 0) * kDegree,
                         p.has("tilted") && p.at("tilted").as_choice({"first", "second"}) == 0});
    if (const auto incident = params.find("incident")) {
      const auto [x, y, z] = incident->as_direction();
      if (!(z < 0)) throw incident->error("the beam does not go into the prisms", "[x, y, z] with z below 0");
      incident_ = {x, y, z};
    }
    if (prisms_.empty() || prisms_.size() > 8)
      throw params.at("prisms").error(strf("%zu prisms", prisms_.size()), "1 to 8");
    // What a single wedge reflects totally on the axis is no prism.
    for (const Prism& p : prisms_)
      if (p.index * std::sin(p.wedge) >= 1)
        throw params.at("prisms").error(strf("a wedge of %g degrees reflects the beam totally", p.wedge / kDegree),
                                        "index x sin(wedge) below 1");
  }
  std::optional<Dir> direction(double t, size_t) const override {
    std::optional<Dir> d = incident_;
    for (const Prism& p : prisms_) {
      // The thick side lies where the beam is turned to.
      const double turn = 2 * kPi * p.rate * t + p.phase, s = std::sin(p.wedge), c = std::cos(p.wedge);
      const Dir square{0, 0, 1}, tilted{-s * std::cos(turn), -s * std::sin(turn), p.first ? c : -c};
      d = refract(*d, p.first ? tilted : square, 1 / p.index);
      if (d) d = refract(*d, p.first ? square : tilted, p.index);
      if (!d) return std::nullopt;
    }
    return d;
  }

 private:
  struct Prism {
    double wedge, index, rate, phase;
    bool first;  // its first face is the tilted one
  };
  Dir incident_{0, 0, -1};
  std::vector<Prism> prisms_;
};

}  // namespace

DeflectorRow risley_row() {
  return {"risley", "rotating wedge prisms, refracted face by face: rosettes", "",
          [](const Params& p) { return std::make_unique<Risley>(p); }};
}

}  // namespace suite
