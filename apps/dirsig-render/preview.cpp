#include "preview.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bar_picture.h"
#include "base/run_app.h"
#include "spectral/thermometer.h"

namespace suite {

namespace {

constexpr double kGammaOfScreens = 2.2;  // near sRGB

// The truth column that tells where nothing was hit, and how.
struct Emptiness {
  size_t column = SIZE_MAX;
  bool zero = false;  // 0 says so, else NaN
  bool at(double truth) const { return zero ? truth == 0 : std::isnan(truth); }
};
Emptiness emptiness_of(const std::vector<std::string>& names) {
  for (const char* wanted : {"hits", "material", "range", "instance", "east", "latitude", "ecef", "view"})
    for (size_t i = 0; i < names.size(); ++i)
      if (names[i].substr(0, names[i].find(' ')) == wanted) return {i, wanted == std::string("hits")};
  return {};
}

}  // namespace

Preview::Preview(std::span<const Band> bands, std::span<const size_t> chosen, PreviewSpec spec, uint32_t columns,
                 uint32_t rows)
    : spec_(std::move(spec)),
      chosen_(chosen.begin(), chosen.end()),
      columns_(columns),
      rows_(rows),
      stride_(picture_stride(columns, rows)) {
  for (const size_t b : chosen_) bands_.push_back(bands[b]);
  kelvin_ = chosen_.size() == 1 && spec_.show != PreviewSpec::Show::radiance &&
            (spec_.show == PreviewSpec::Show::kelvin || bands_[0].center_um > kThermalFrom);
}

void Preview::append(const CaptureResult& rows) {
  const Emptiness empty = emptiness_of(rows.truth_names);
  const size_t truths = rows.truth_names.size(), per_pixel = rows.values_per_problem();
  for (size_t i = 0; i < rows.problems(); ++i) {
    for (const size_t b : chosen_) values_.push_back(static_cast<float>(rows.radiance[i * per_pixel + b]));
    nothing_.push_back(empty.column < truths && empty.at(rows.truth[i * truths + empty.column]));
  }
}

void Preview::to_kelvin() {
  // A picture of the sky alone is one of the sky's light.
  const bool any = std::find(nothing_.begin(), nothing_.end(), false) != nothing_.end();
  const BandThermometer kelvin(bands_[0]);
  for (size_t i = 0; i < values_.size(); ++i)
    values_[i] = any && nothing_[i] ? std::nanf("") : static_cast<float>(kelvin.read(double{values_[i]}).kelvin);
}

RasterStyle Preview::style(std::span<const float> all, size_t values, bool same_unit) const {
  PreviewSpec spec = spec_;
  if (!same_unit) spec.range.reset();
  std::vector<float> shown;
  for (size_t i = 0; i < nothing_.size(); ++i)
    for (const size_t b : chosen_) {
      const float v = all[i * values + b];
      shown.push_back(kelvin_ && !(v > 0) ? std::nanf("") : v);  // what sends no heat does not count, as in the picture
    }
  RasterStyle style;
  style.display = chosen_;
  style.ends = picture_ends(shown, nothing_, spec, 0);
  if (!kelvin_) style.gamma = spec_.gamma > 0 ? spec_.gamma : kGammaOfScreens;
  constexpr int kSteps = 16;
  for (int i = 0; kelvin_ && i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps, value = style.ends[0] + t * (style.ends[1] - style.ends[0]);
    const Rgb c = inferno(t);
    style.ramp.push_back({value, strf("%.6g", value), {c.r, c.g, c.b}});
  }
  return style;
}

double Preview::gamma(double t) const {
  return spec_.gamma > 0 ? std::pow(std::clamp(t, 0.0, 1.0), 1 / spec_.gamma) : srgb(t) / 255.0;
}

Rgb Preview::color(double t) const {
  if (kelvin_) return inferno(t);
  if (std::isnan(t)) return kGrey;
  const auto shade = static_cast<uint8_t>(std::lround(255 * gamma(t)));
  return {shade, shade, shade};
}

void Preview::write(const std::string& path) {
  if (kelvin_) to_kelvin();
  const std::array<double, 2> ends = picture_ends(values_, nothing_, spec_, kelvin_ ? 0.5 : 0);
  const bool bar = spec_.bar && chosen_.size() == 1;
  const int columns = static_cast<int>((columns_ + stride_ - 1) / stride_),
            rows = static_cast<int>((rows_ + stride_ - 1) / stride_);
  const BarLayout at(columns, rows, bar);
  Canvas canvas(at.width, at.height, bar ? kWhite : kBlack);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const size_t pixel = size_t{static_cast<uint32_t>(r)} * stride_ * columns_ + static_cast<uint32_t>(c) * stride_;
      const auto t = [&](size_t k) { return (values_[pixel * chosen_.size() + k] - ends[0]) / (ends[1] - ends[0]); };
      const Rgb shade = chosen_.size() == 1 ? color(t(0)) : Rgb{color(t(0)).r, color(t(1)).g, color(t(2)).b};
      canvas.fill(c * at.enlarged, at.top + r * at.enlarged, at.enlarged, at.enlarged, shade);
    }
  if (bar) {
    const bool empty = kelvin_ && std::any_of(values_.begin(), values_.end(), [](float v) { return std::isnan(v); });
    const std::string what = kelvin_ ? "brightness temperature, " : "radiance, ";
    draw_legend(canvas, at,
                {{bands_[0].name + ": " + what + unit(), what + unit(), std::string(unit())},
                 ends,
                 [&](double t) { return color(t); },
                 empty});
  }
  write_png(path, canvas,
            command_line() + strf("; linear from %g to %g %s (", ends[0], ends[1], unit()) +
                (spec_.range ? "as asked" : strf("%g and %g %% of the pixels", spec_.low_percent, spec_.high_percent)) +
                (kelvin_           ? "), inferno"
                 : spec_.gamma > 0 ? strf("), gamma %g", spec_.gamma)
                                   : "), sRGB"));
}

void check_preview(const Sensor& sensor, const PreviewSpec& spec) {
  for (size_t s = 0; s < sensor.states().size(); ++s) display_of(sensor.bands(s), spec);
}

}  // namespace suite
