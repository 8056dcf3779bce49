#include "preview.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/run_app.h"
#include "spectral/thermometer.h"

namespace suite {

namespace {

constexpr double kGammaOfScreens = 2.2;  // near sRGB
constexpr uint32_t kMost = 15000;        // pixels, which leaves room for a bar on a canvas

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

float percentile(std::vector<float>& values, double percent) {
  const auto at = values.begin() + std::lround(percent / 100 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Black: a percentile of each pixel's darkest band, so that no more pixels lose a colour there; white: of its
// brightest. Pixels that are not finite do not count, nor those where nothing is and nothing shines. The two are apart
// in any case.
std::array<double, 2> ends_of(std::span<const float> values, const std::vector<bool>& nothing, const PreviewSpec& spec,
                              double least_apart) {
  if (spec.range) return *spec.range;
  const size_t bands = values.size() / std::max(size_t{1}, nothing.size());
  std::vector<float> darkest, brightest;
  for (size_t i = 0; i < nothing.size(); ++i) {
    const float* v = &values[i * bands];
    const auto [low, high] = std::minmax_element(v, v + bands);
    if (!std::isfinite(*low) || !std::isfinite(*high) || (nothing[i] && *low == 0 && *high == 0)) continue;
    darkest.push_back(*low), brightest.push_back(*high);
  }
  if (darkest.empty()) return {0, 1};
  const double low = percentile(darkest, spec.low_percent), high = percentile(brightest, spec.high_percent);
  if (high - low >= least_apart && high > low) return {low, high};
  if (least_apart > 0) return {(low + high - least_apart) / 2, (low + high + least_apart) / 2};
  return high > 0 ? std::array<double, 2>{0, high} : std::array<double, 2>{0, 1};
}

}  // namespace

// Where things are in a picture: without a bar nothing but the picture; with one a title above and the bar at the
// right, and what is small is enlarged so that both are legible.
struct Preview::Layout {
  Layout(int columns, int rows, bool bar) {
    enlarged = bar ? std::max(1, std::min((kLegible + rows - 1) / rows, 2 * kLegible / columns)) : 1;
    picture_width = width = columns * enlarged, height = rows * enlarged;
    if (!bar) return;
    scale = std::clamp((std::min(width, height) + 140) / 280, 1, 5);
    top = 2 * Canvas::text_height(scale);
    height = top + std::max(height, 100 * scale);
    width += 16 * scale + bar_labels_width(scale);
  }
  static constexpr int kLegible = 400;
  int enlarged, picture_width, width, height, scale = 1, top = 0;
};

Preview::Preview(std::span<const Band> bands, std::span<const size_t> chosen, PreviewSpec spec, uint32_t columns,
                 uint32_t rows)
    : spec_(std::move(spec)),
      chosen_(chosen.begin(), chosen.end()),
      columns_(columns),
      rows_(rows),
      stride_(std::max({1u, (columns + kMost - 1) / kMost, (rows + kMost - 1) / kMost})) {
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
  style.ends = ends_of(shown, nothing_, spec, 0);
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
  const std::array<double, 2> ends = ends_of(values_, nothing_, spec_, kelvin_ ? 0.5 : 0);
  const bool bar = spec_.bar && chosen_.size() == 1;
  const int columns = static_cast<int>((columns_ + stride_ - 1) / stride_),
            rows = static_cast<int>((rows_ + stride_ - 1) / stride_);
  const Layout at(columns, rows, bar);
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
    draw_legend(canvas, at, ends, empty);
  }
  write_png(path, canvas,
            command_line() + strf("; linear from %g to %g %s (", ends[0], ends[1], unit()) +
                (spec_.range ? "as asked" : strf("%g and %g %% of the pixels", spec_.low_percent, spec_.high_percent)) +
                (kelvin_           ? "), inferno"
                 : spec_.gamma > 0 ? strf("), gamma %g", spec_.gamma)
                                   : "), sRGB"));
}

void Preview::draw_legend(Canvas& canvas, const Layout& at, std::array<double, 2> ends, bool empty) const {
  const int s = at.scale, line = Canvas::text_height(s), x = at.picture_width + 6 * s;
  const std::string what = kelvin_ ? "brightness temperature, " : "radiance, ";
  for (const std::string& title : {bands_[0].name + ": " + what + unit(), what + unit(), std::string(unit())})
    if (Canvas::text_width(title, s) <= at.width) {
      canvas.text(2 * s, (at.top - line) / 2, title, kBlack, s);
      break;
    }
  const int bottom = std::min(at.height - (empty ? 3 * line : line / 2), at.top + 60 * line);
  draw_bar(
      canvas, x, at.top + line / 2, 10 * s, bottom - at.top - line / 2, ends[0], ends[1],
      [&](double t) { return color(t); }, s);
  if (!empty) return;
  canvas.fill(x, bottom + line, 10 * s, line, kGrey);
  canvas.frame(x, bottom + line, 10 * s, line, kBlack);
  canvas.text(x + 17 * s, bottom + line, "nothing", kBlack, s);
}

void check_preview(const Sensor& sensor, const PreviewSpec& spec) {
  for (size_t s = 0; s < sensor.states().size(); ++s) display_of(sensor.bands(s), spec);
}

}  // namespace suite
