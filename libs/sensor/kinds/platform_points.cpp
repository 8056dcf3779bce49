// Far points on the focal planes of a platform's framing cameras: through distortion, point spread, motion and shutter.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "sensor/kinds/platform.h"
#include "sensor/point_images.h"

namespace suite {

namespace {

// Where the light of a point falls, drawn evenly: a Kronecker sequence (M. Roberts, "The unreasonable effectiveness of
// quasirandom sequences", 2018).
class Falls {
 public:
  Falls(const PointSpread* psf, size_t bins, size_t count) : psf_(psf), count_(count) {
    if (!psf_ || !psf_->spectral()) return;
    // What the samples hold of each bin's light is divided out, so that none is lost or won.
    one_.resize(bins);
    std::vector<double> held(bins, 0.0);
    for (size_t i = 0; i < count_; ++i) {
      psf_->weights(offset(i), one_);
      for (size_t k = 0; k < bins; ++k) held[k] += static_cast<double>(one_[k]);
    }
    for (const double h : held) normal_.push_back(static_cast<float>(h > 0 ? static_cast<double>(count_) / h : 0));
  }
  size_t count() const { return count_; }
  Vec2 offset(size_t i) const {
    if (!psf_) return {0, 0};
    constexpr double kSteps[] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    const auto number = [&](int axis) {
      const double x = 0.5 + kSteps[axis] * static_cast<double>(i + 1);
      return x - std::floor(x);
    };
    return psf_->sample(number(0), number(1), number(2));
  }
  // Of each bin at an offset; empty = 1.
  std::span<const float> weights(Vec2 offset) {
    if (normal_.empty()) return {};
    psf_->weights(offset, one_);
    for (size_t k = 0; k < one_.size(); ++k) one_[k] *= normal_[k];
    return one_;
  }

 private:
  const PointSpread* psf_;
  size_t count_;
  std::vector<float> one_, normal_;
};

// The problem of a capture whose detector holds a place of the focal plane (m).
std::optional<size_t> problem_at(const FocalArray& array, const Segment& segment, const Capture& capture, Vec2 place) {
  for (size_t i = segment.first_chip; i < segment.first_chip + segment.chips; ++i) {
    const Chip& chip = array.chips[i];
    double x = (place.x - chip.offset.x) / array.pitch.x + 0.5 * chip.columns,
           y = (place.y - chip.offset.y) / array.pitch.y + 0.5 * chip.rows;
    if (array.flip_columns) x = chip.columns - x;
    if (array.flip_rows) y = chip.rows - y;
    if (!(x >= 0 && x < chip.columns && y >= 0 && y < chip.rows)) continue;
    const size_t column = chip.first_column + static_cast<size_t>(x) - segment.first_column;
    return static_cast<size_t>(y) * capture.columns + column;
  }
  return std::nullopt;
}

// Where a direction in camera axes is imaged; nothing where the lens does not show it.
std::optional<Vec2> image_of(const Lens& lens, Dir d) {
  if (!(d.z < -1e-3)) return std::nullopt;
  const Vec2 place = lens.image_of(d);
  // Beyond its fold a distortion would show things a second time.
  if (angle_between(lens.look(place), d) > 1e-6) return std::nullopt;
  return place;
}

// sr/m2 about a place.
double solid_angle(const Lens& lens, Vec2 p, Vec2 pitch) {
  const Vec3 x = lens.look({p.x + pitch.x / 2, p.y}) - lens.look({p.x - pitch.x / 2, p.y}),
             y = lens.look({p.x, p.y + pitch.y / 2}) - lens.look({p.x, p.y - pitch.y / 2});
  return length(cross(x, y)) / (pitch.x * pitch.y);
}

}  // namespace

bool sees_points(const PlatformSpec& spec, const Capture& capture) {
  const FocalArray& array = spec.arrays[spec.segments[capture.state].array];
  const Readout& r = array.readout;
  return !array.scans() && r.stages == 1 && capture.bins == 1 && !spec.instruments[array.instrument].lens.thin() &&
         (r.kind == Readout::Kind::global || r.integration > 0);
}

void image_point(const PlatformSpec& spec, const Capture& capture, const std::function<Pose(double)>& pose,
                 const std::function<Dir(double, Vec3)>& direction_at, double brightness,
                 const std::function<void(const PointShare&)>& share) {
  const Segment& segment = spec.segments[capture.state];
  const FocalArray& array = spec.arrays[segment.array];
  const Lens& lens = spec.instruments[array.instrument].lens;
  const auto seen_at = [&](double time) {
    const Pose at = pose(time);
    return image_of(lens, at.inverse().vector(direction_at(time, at.point({0, 0, 0}))));
  };
  const TrailSteps steps(capture.window, [&](double time) -> std::optional<Vec2> {
    const auto place = seen_at(time);
    if (!place) return std::nullopt;
    return Vec2{place->x / array.pitch.x, place->y / array.pitch.y};
  });
  const bool rolling = array.readout.kind == Readout::Kind::rolling;
  const double window = capture.window.end - capture.window.begin;
  // Rows that are exposed one after the other see what stands still at times of their own.
  const double exposures = rolling ? window / array.readout.integration : 1;
  const size_t count = std::clamp(static_cast<size_t>(std::ceil(rolling ? 64 * exposures : 1)),
                                  static_cast<size_t>(steps.count), size_t{65536});
  const std::optional<Vec2> still = steps.count == 1 ? seen_at(steps.time(0)) : std::nullopt;
  if (steps.count == 1 && !still) return;
  // 4096 to V = 2, 256 from V = 6.
  const double wanted = segment.psf ? std::clamp(4096 * brightness / 0.16, 256.0, 4096.0) : 1;
  Falls falls(segment.psf.get(), spec.states[capture.state].size(),
              std::max<size_t>(1, static_cast<size_t>(wanted) / count) * count);
  for (size_t step = 0; step < count; ++step) {
    const double time = capture.window.begin + (static_cast<double>(step) + 0.5) / static_cast<double>(count) * window;
    const auto place = still ? still : seen_at(time);
    if (!place) continue;
    const double gathered = 1 / (solid_angle(lens, *place, array.pitch) * array.pitch.x * array.pitch.y);
    for (size_t i = step; i < falls.count(); i += count) {
      const Vec2 offset = falls.offset(i);
      const auto problem = problem_at(array, segment, capture, {place->x + offset.x, place->y + offset.y});
      if (!problem) continue;
      double exposing = 1;
      if (rolling) {
        const double since = time - capture.window.begin - exposed(spec, capture, *problem).delay;
        if (!(since >= 0 && since < array.readout.integration)) continue;
        exposing = exposures;
      }
      share({*problem, exposing * gathered / static_cast<double>(falls.count()), falls.weights(offset), time,
             pose(time).point({0, 0, 0})});
    }
  }
}

}  // namespace suite
