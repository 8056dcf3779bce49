#include "polarisation_picture.h"

#include <algorithm>
#include <cmath>

#include "bar_picture.h"
#include "base/run_app.h"
#include "math/warps.h"

namespace suite {

Rgb polarisation_color(double angle_deg, double degree, double light) {
  const double gone = std::clamp(degree, 0.0, 1.0), sixth = std::fmod(angle_deg / 30, 6.0);
  const auto part = [&](double centre) {  // of a hue whose middle lies so many sixths around
    double away = std::fabs(sixth - centre);
    away = std::min(away, 6 - away);
    const double full = std::clamp(2 - away, 0.0, 1.0);
    return static_cast<uint8_t>(std::lround(255 * std::clamp(light, 0.0, 1.0) * (1 - gone + gone * full)));
  };
  return {part(0), part(2), part(4)};
}

// The degree that is shown by full colours: 99 % of the pixels have less.
static double full_saturation(std::vector<float> degrees) {
  if (degrees.empty()) return 1;
  const auto at = degrees.begin() + static_cast<long>(0.99 * static_cast<double>(degrees.size() - 1));
  std::nth_element(degrees.begin(), at, degrees.end());
  for (const double full : {0.02, 0.05, 0.1, 0.2, 0.5})
    if (double{*at} <= full) return full;
  return 1;
}

void PolarisationPicture::append(const CaptureResult& rows, const Product& polarisation) {
  const size_t per_pixel = polarisation.bands.size(), each = per_pixel / rows.bands, band = (rows.bands - 1) / 2;
  const auto column = [&](const std::string& ending) {
    for (size_t i = band * each; i < (band + 1) * each; ++i)
      if (polarisation.bands[i].ends_with(ending)) return i;
    return size_t{0};
  };
  const size_t angle = column(" aolp"), degree = column(" dolp_debiased"), undefined = column(" aolp_undefined");
  band_ = polarisation.bands[band * each].substr(0, polarisation.bands[band * each].rfind(' '));
  for (size_t i = 0; i < rows.problems(); ++i) {
    const double* const of = &polarisation.values[i * per_pixel];
    const bool grey = of[undefined] != 0 || !std::isfinite(of[angle]);
    values_.insert(values_.end(),
                   {grey ? 0.0f : static_cast<float>(of[angle]), grey ? 0.0f : static_cast<float>(of[degree]),
                    static_cast<float>(rows.radiance[i * rows.values_per_problem() + band])});
  }
}

void PolarisationPicture::write(const std::string& path) const {
  const uint32_t stride = picture_stride(columns_, rows_);
  const int columns = static_cast<int>((columns_ + stride - 1) / stride),
            rows = static_cast<int>((rows_ + stride - 1) / stride);
  std::vector<float> light;
  for (size_t i = 2; i < values_.size(); i += 3) light.push_back(values_[i]);
  const std::array<double, 2> ends = picture_ends(light, std::vector<bool>(light.size(), false), PreviewSpec{}, 0);
  std::vector<float> degrees;
  for (size_t i = 1; i < values_.size(); i += 3) degrees.push_back(values_[i]);
  const double full = full_saturation(std::move(degrees));
  const BarLayout at(columns, rows, false);
  Canvas canvas(at.width, at.height, kBlack);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const size_t pixel = size_t{static_cast<uint32_t>(r)} * stride * columns_ + static_cast<uint32_t>(c) * stride;
      const float* const of = &values_[3 * pixel];
      const double t = std::clamp(double{of[2]} / ends[1], 0.0, 1.0);
      canvas.fill(c * at.enlarged, r * at.enlarged, at.enlarged, at.enlarged,
                  polarisation_color(double{of[0]}, double{of[1]} / full, std::pow(t, 1 / 2.2)));
    }
  write_png(path, canvas,
            command_line() +
                strf("; band %s: hue the angle of linear polarisation (red 0, green 60, blue 120 degrees), saturation "
                     "the debiased degree up to %g, brightness the intensity up to %g W/(m2 sr um), gamma 2.2",
                     band_.c_str(), full, ends[1]));
}

}  // namespace suite
