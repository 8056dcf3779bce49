// A spherical collector: radiance from all directions around a vertical axis in one round picture, the angle from the
// axis growing linearly with the distance from the middle (equidistant projection). North is up; looking up, east is to
// the left, as one sees it lying on one's back.
#include <cmath>

#include "sensor/kinds/simple.h"

namespace suite {

namespace {

class Fisheye final : public SimpleSensor {
 public:
  Fisheye(const Params& p, const SensorContext& context) : SimpleSensor(p, context, "fisheye") {
    wishes_ = read_wishes(p, truth_);
    channels_ = read_channels(p);
    polarimetry_ = read_polarimetry(p, channels_);
    if (polarimetry_) polarimetry_->up = {0, 1, 0};
    capture_.columns = capture_.rows = static_cast<uint32_t>(p.integer("size", 1, 100000));
    const auto [x, y, z] = p.at("position_m").as_vec3();
    position_ = {x, y, z};
    const auto look = p.find("look");
    up_ = !look || look->as_choice({"up", "down"}) == 0;
    if (polarimetry_) polarimetry_->axis = {0, 0, up_ ? 1.0 : -1.0};
    reach_ = p.number_in("max_angle_deg", 1, 180, "degrees", 90) * kDegree;
    done();
  }
  SensorRay ray(const RayRequest& r) const override {
    const double edge = r.capture.columns;
    const Capture::Place at = r.capture.place_of(r.problem);
    const double x = 2 * (at.column + r.u[0]) / edge - 1;
    const double y = 1 - 2 * (at.row + r.u[1]) / edge;
    const double radius = std::hypot(x, y), theta = std::min(radius, 1.0) * reach_;
    const double s = radius > 0 ? std::sin(theta) / radius : 0, c = std::cos(theta);
    SensorRay out{{position_, normalized(Vec3{(up_ ? -x : x) * s, y * s, up_ ? c : -c}), moment(r.u[2])}};
    out.weight = radius <= 1 ? 1 : 0;  // outside the circle there is nothing
    return out;
  }

 private:
  void finish(Delivery& d) const override { d.outside = 0; }
  Vec3 position_;
  bool up_ = true;
  double reach_ = 0;
};

}  // namespace

SensorRow fisheye_row() {
  return {"fisheye", "radiance from a hemisphere or more around the vertical, in one round picture", "",
          make_kind<Fisheye>};
}

}  // namespace suite
