// A light that the suite does not have: a far ring of even radiance. It is what adding one takes: this file, and its
// row in the table.
#pragma once
#include "light/environment.h"
#include "light/light_rows.h"
#include "math/vec.h"

namespace suite::test {

// Between two angles (rad) from a direction.
struct RingSpec {
  Dir middle{0, 0, 1};
  double inner = 0.3, outer = 0.5;
  Curve radiance;  // W/(m2 sr um)
};

class Ring final : public Light {
 public:
  Ring(const RingSpec& s, const SpectralState& state)
      : frame_(Frame::around(s.middle)),
        low_(std::cos(s.outer)),
        high_(std::cos(s.inner)),
        density_(1 / (2 * kPi * (high_ - low_))),
        spectrum_(state.sample(s.radiance)) {
    nature_.far = true;
  }
  std::optional<LightSample> sample(const LightReceiver& at, const std::array<double, 4>& u, double t) const override {
    return sample_member(0, 1, at, {0, u[0], u[1], 0}, t);
  }
  std::optional<LightSample> sample_member(size_t, double probability, const LightReceiver&,
                                           const std::array<double, 4>& u, double) const override {
    const double z = low_ + (high_ - low_) * u[1], r = std::sqrt(1 - z * z), phi = 2 * kPi * u[2];
    LightSample s;
    s.direction = frame_.to_world({r * std::cos(phi), r * std::sin(phi), z});
    s.density = density_ * probability;
    s.scale = 1;
    s.spectrum = spectrum_.data();
    return s;
  }
  std::optional<LightMet> met_outside(Dir direction, double) const override {
    const double z = dot(direction, frame_.z);
    if (z < low_ || z > high_) return std::nullopt;
    return LightMet{1, spectrum_.data(), density_};
  }

 private:
  Frame frame_;
  double low_, high_, density_;
  std::vector<float> spectrum_;
};

class RingLight final : public LightSpec {
 public:
  explicit RingLight(RingSpec spec) : spec_(std::move(spec)) {}
  std::string key() const override { return "ring"; }
  bool shines(double low_um, double high_um) const override { return shines_between(spec_.radiance, low_um, high_um); }
  void add_spectra(std::vector<LightSpectra>& to) const override { add_curve("the ring", spec_.radiance, to); }
  std::vector<std::string> hardly_met(double) const override { return {}; }
  std::shared_ptr<const Light> bake(const Tracer&, const SpectralState& state) const override {
    return std::make_shared<const Ring>(spec_, state);
  }

 private:
  const RingSpec spec_;
};

inline LightRow ring_row() {
  const auto read = [](const Params& p, const LightContext& context) -> LightSpecPtr {
    RingSpec s;
    const auto direction = p.at("direction").as_direction();
    s.middle = {direction[0], direction[1], direction[2]};
    s.inner = p.number_in("inner_deg", 0, 90, "degrees") * kDegree;
    s.outer = p.number_in("outer_deg", s.inner / kDegree, 90, "degrees") * kDegree;
    s.radiance = context.positive(p.at("radiance"), "radiance", "W/(m2 sr um)");
    return std::make_shared<const RingLight>(std::move(s));
  };
  return {{"ring", "a far ring of even radiance", "W/(m2 sr um)", read},
          false,
          "A sample of the ring at every node, with a visibility ray.",
          "ring: {direction: [0.2, 0.1, 1], inner_deg: 20, outer_deg: 35, radiance: 4}\n"};
}

}  // namespace suite::test
