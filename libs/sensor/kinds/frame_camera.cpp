// A framing camera: a two-dimensional array of square detectors behind a pinhole, all integrating at once.
// Image coordinates: columns to the right, rows downwards as seen along the view direction.
// Based on: Goodenough & Brown, section III-B (2-D framing arrays; samples over the pixel area and the integration
// time).
#include <cmath>

#include "math/vec.h"
#include "sensor/degree_target.h"
#include "sensor/kinds/rows.h"
#include "sensor/point_images.h"
#include "sensor/polarimetry.h"

namespace suite {

namespace {

class FrameCamera final : public Sensor, public SeesPoints, public HasDegreeTarget {
 public:
  FrameCamera(const Params& p, const SensorContext& context)
      : deliver_(context.deliver), name_(p.name("name", "camera")) {
    bands_ = read_bands(p.at("bands"), context);
    state_ = read_state(p, bands_);
    truth_ = read_truth(p);
    wishes_ = read_wishes(p, truth_);
    channels_ = read_channels(p);
    polarimetry_ = read_polarimetry(p, channels_);

    Capture capture;
    capture.columns = static_cast<uint32_t>(p.integer("columns", 1, 100000));
    capture.rows = static_cast<uint32_t>(p.integer("rows", 1, 100000));
    pitch_ = p.number_in("pitch_um", 1e-3, 1e6, "um") * 1e-6;
    focal_ = p.number_in("focal_length_mm", 1e-3, 1e6, "mm") * 1e-3;
    const auto [x, y, z] = p.at("position_m").as_vec3();
    position_ = {x, y, z};
    const auto [tx, ty, tz] = p.at("look_at_m").as_vec3();
    const Vec3 to = Vec3{tx, ty, tz} - position_;
    if (!(length(to) > 0))
      throw p.at("look_at_m").error("look_at_m is the position of the camera", "give another point");
    forward_ = normalized(to);
    Vec3 up{0, 0, 1};
    if (const auto u = p.find("up")) {
      const auto [ux, uy, uz] = u->as_vec3();
      up = {ux, uy, uz};
    } else if (std::fabs(forward_.z) > 1 - 1e-9) {
      up = {0, 1, 0};  // straight down or up: rows run north to south
    }
    right_ = cross(forward_, up);
    if (!(length(right_) > 1e-9 * length(up))) throw p.error("`up` runs along the view direction", "give another `up`");
    right_ = normalized(right_);
    down_ = cross(forward_, right_);
    if (polarimetry_) polarimetry_->up = -down_;
    capture.name = name_;
    capture.window = read_window(p);
    capture.convergence = read_convergence(p);
    capture.band_targets = read_band_targets(p, bands_, capture.convergence);
    degree_target_ = read_degree_target(p, bands_, capture.convergence, capture.band_targets);
    check_degree_target(degree_target_, channels_, capture.bins);
    tasks_.push_back({name_, capture.window, {capture}});
  }

  std::string name() const override { return name_; }
  std::span<const SpectralState> states() const override { return {&state_, 1}; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  void take_state(size_t, SpectralState with_bins) override { state_ = std::move(with_bins); }
  std::span<const Task> tasks() const override { return tasks_; }

  SensorRay ray(const RayRequest& request) const override {
    const auto& [capture, problem, u, spectral] = request;
    const Capture::Place at = capture.place_of(problem);
    const double column = at.column + u[0], row = at.row + u[1];
    const double x = (column - 0.5 * capture.columns) * pitch_, y = (row - 0.5 * capture.rows) * pitch_;
    SensorRay r;
    r.ray.origin = position_;
    r.ray.direction = normalized(forward_ * focal_ + right_ * x + down_ * y);
    r.ray.time = capture.window.begin + u[2] * (capture.window.end - capture.window.begin);
    r.points_apart = true;
    return r;
  }

  bool sees_points(const Capture&) const override { return true; }
  void image_point(const Capture& capture, const std::function<Dir(double, Vec3)>& direction_at, double,
                   const std::function<void(const PointShare&)>& share) const override {
    const auto place_at = [&](double time) -> std::optional<Vec2> {  // pixels
      const Dir d = direction_at(time, position_);
      const double ahead = dot(d, forward_);
      if (!(ahead > 0)) return std::nullopt;
      const double scale = focal_ / (ahead * pitch_);
      return Vec2{dot(d, right_) * scale + 0.5 * capture.columns, dot(d, down_) * scale + 0.5 * capture.rows};
    };
    const TrailSteps steps(capture.window, place_at);
    for (int i = 0; i < steps.count; ++i) {
      const double time = steps.time(i);
      const auto at = place_at(time);
      if (!at || !(at->x >= 0 && at->x < capture.columns && at->y >= 0 && at->y < capture.rows)) continue;
      // A pixel sees evenly over its area, which is cos^3 / f^2 of solid angle a square metre.
      const double ahead = dot(direction_at(time, position_), forward_), f = focal_ / pitch_;
      const size_t problem = static_cast<size_t>(at->y) * capture.columns + static_cast<size_t>(at->x);
      share({problem, f * f / (ahead * ahead * ahead * steps.count), {}, time, position_});
    }
  }
  void take_points(const Capture&, std::vector<SeenPoint> points) override { points_ = std::move(points); }

  void accept(CaptureResult&& result) override {
    Delivery d{*this, lay_out(tasks_, name_)[result.task][result.capture], std::move(result), bands_, {}, {}, {}, {}};
    if (points_) d.texts.push_back({name_ + "_stars.csv", points_table(*points_, bands_)});
    if (polarimetry_) {
      add_polarisation(d);
      d.description = text_of(*polarimetry_);
    }
    deliver_(d);
  }
  std::span<const std::string> truth() const override { return truth_; }
  std::span<const std::string> channels() const override { return channels_; }
  const Polarimetry* polarimetry() const override { return polarimetry_ ? &*polarimetry_ : nullptr; }
  ImageWishes wishes(const Capture&) const override { return wishes_; }
  double degree_target(const Capture&) const override { return degree_target_.error; }

 private:
  std::function<void(const Delivery&)> deliver_;
  std::string name_;
  std::vector<Band> bands_;
  std::vector<std::string> truth_, channels_;
  ImageWishes wishes_;
  std::optional<Polarimetry> polarimetry_;
  DegreeTarget degree_target_;
  SpectralState state_;
  std::vector<Task> tasks_;
  Vec3 position_, forward_, right_, down_;
  double pitch_ = 0, focal_ = 0;
  std::optional<std::vector<SeenPoint>> points_;  // where something that has some shines
};

}  // namespace

SensorRow frame_camera_row() {
  return {"frame_camera", "2-D framing array behind a pinhole, global shutter", "", make_kind<FrameCamera>};
}

}  // namespace suite
