// A map: parallel rays straight down, pixels on a regular grid, north up.
#include "sensor/kinds/simple.h"

namespace suite {

namespace {

class Orthographic final : public SimpleSensor {
 public:
  Orthographic(const Params& p, const SensorContext& context) : SimpleSensor(p, context, "map") {
    wishes_ = read_wishes(p, truth_);
    channels_ = read_channels(p);
    polarimetry_ = read_polarimetry(p, channels_);
    if (polarimetry_) polarimetry_->up = {0, 1, 0};
    capture_.columns = static_cast<uint32_t>(p.integer("columns", 1, 100000));
    capture_.rows = static_cast<uint32_t>(p.integer("rows", 1, 100000));
    const double gsd = p.number_in("gsd_m", 1e-6, 1e6, "m");
    const std::vector<double> center = p.at("center_m").as_numbers();
    if (center.size() != 2) throw p.at("center_m").error("center_m is two numbers: east, north");
    height_ = p.number_in("height_m", -1e7, 1e9, "m", 20000);
    grid_ = {{center[0] - 0.5 * gsd * capture_.columns, center[1] + 0.5 * gsd * capture_.rows}, gsd, gsd};
    done();
  }
  SensorRay ray(const RayRequest& r) const override {
    const Capture::Place at = r.capture.place_of(r.problem);
    const double column = at.column + r.u[0], row = at.row + r.u[1];
    return {{{grid_.origin.x + column * grid_.gsd_x, grid_.origin.y - row * grid_.gsd_y, height_},
             {0, 0, -1},
             moment(r.u[2])}};
  }

 private:
  void finish(Delivery& d) const override { d.map = grid_; }
  MapGrid grid_;
  double height_ = 0;
};

}  // namespace

SensorRow orthographic_row() {
  return {"orthographic", "a map: parallel rays straight down, with map coordinates in its header", "",
          make_kind<Orthographic>};
}

}  // namespace suite
