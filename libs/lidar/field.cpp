#include "lidar/field.h"

#include <cmath>

#include "math/warps.h"

namespace suite {

ReceiverField::ReceiverField(const LidarReceiver& r) {
  const double passes = (1 - r.obscuration) * r.throughput;
  if (r.columns == 0) {
    half_ = r.field_of_view / 2;
    height_ = one_minus_cos(half_);
    importance_ = kPi * r.aperture * r.aperture / 4 * passes;
    return;
  }
  columns_ = r.columns, rows_ = r.rows;
  pitch_ = r.pitch / r.focal;
  const double F = r.focal / r.aperture;
  importance_ = kPi * passes / (1 + 4 * F * F) * r.focal * r.focal;
}

Dir ReceiverField::middle(size_t pixel) const {
  if (stop()) return {0, 0, -1};
  return sample(pixel, {0.5, 0.5});
}

double ReceiverField::solid_angle() const { return stop() ? 2 * kPi * height_ : pitch_ * pitch_; }

auto ReceiverField::at(Dir local) const -> std::optional<Seen> {
  const double cosine = -local.z;
  if (!(cosine > 0)) return std::nullopt;
  // The angle by its tangent: a cosine cannot tell narrow fields.
  if (stop())
    return std::atan2(std::hypot(local.x, local.y), cosine) < half_ ? std::optional(Seen{0, importance_})
                                                                    : std::nullopt;
  const double c = local.x / cosine / pitch_ + 0.5 * columns_, r = 0.5 * rows_ - local.y / cosine / pitch_;
  if (!(c >= 0 && c < columns_ && r >= 0 && r < rows_)) return std::nullopt;
  return Seen{static_cast<uint32_t>(r) * columns_ + static_cast<uint32_t>(c), importance_ / (cosine * cosine * cosine)};
}

Dir ReceiverField::sample(size_t pixel, Vec2 u) const {
  if (stop()) {
    const Dir d = uniform_cone(u, height_);
    return {d.x, d.y, -d.z};
  }
  const auto column = static_cast<double>(pixel % columns_), row = static_cast<double>(pixel / columns_);
  return normalized(Vec3{(column + u.x - 0.5 * columns_) * pitch_, (0.5 * rows_ - row - u.y) * pitch_, -1});
}

double ReceiverField::density(Dir local) const {
  if (stop()) return 1 / (2 * kPi * height_);
  const double cosine = -local.z;
  return 1 / (pitch_ * pitch_ * cosine * cosine * cosine);
}

}  // namespace suite
