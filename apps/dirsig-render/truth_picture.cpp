#include "truth_picture.h"

#include <algorithm>
#include <cmath>

#include "bar_picture.h"
#include "base/run_app.h"

namespace suite {

namespace {

// Names as truth is asked for, and the columns that come of it (transport/truth/warmth.cpp).
constexpr const char* kPictures[][2] = {{"temperature", "temperature [K]"},
                                        {"temperature_error", "temperature error [K]"},
                                        {"sun_hours", "sun hours [h]"},
                                        {"absorbed_sun", "absorbed sunlight [W/m2]"},
                                        {"longwave_received", "longwave received [W/m2]"}};
constexpr double kLeastApart = 1e-3;  // of the ends of a bar

}  // namespace

TruthPicture::TruthPicture(const char* name, std::string title, size_t column, PreviewSpec spec, uint32_t columns,
                           uint32_t rows)
    : name_(name), column_(column), spec_(std::move(spec)), columns_(columns), rows_(rows) {
  const size_t bracket = title.find(" [");
  unit_ = title.substr(bracket + 2, title.size() - bracket - 3);
  title_ = title.substr(0, bracket);
  spec_.range.reset();  // is one of radiance
}

std::vector<TruthPicture> TruthPicture::of(const std::vector<std::string>& names, const PreviewSpec& spec,
                                           uint32_t columns, uint32_t rows) {
  std::vector<TruthPicture> out;
  for (const auto& [name, column] : kPictures)
    if (const auto at = std::ranges::find(names, column); at != names.end())
      out.push_back({name, column, static_cast<size_t>(at - names.begin()), spec, columns, rows});
  return out;
}

void TruthPicture::append(const CaptureResult& rows) {
  const size_t truths = rows.truth_names.size();
  for (size_t i = 0; i < rows.problems(); ++i) values_.push_back(static_cast<float>(rows.truth[i * truths + column_]));
}

void TruthPicture::write(const std::string& path) const {
  const uint32_t stride = picture_stride(columns_, rows_);
  const int columns = static_cast<int>((columns_ + stride - 1) / stride),
            rows = static_cast<int>((rows_ + stride - 1) / stride);
  std::vector<bool> nothing;
  for (const float v : values_) nothing.push_back(std::isnan(v));
  const std::array<double, 2> ends = picture_ends(values_, nothing, spec_, kLeastApart);
  const BarLayout at(columns, rows, spec_.bar);
  Canvas canvas(at.width, at.height, spec_.bar ? kWhite : kBlack);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const size_t pixel = size_t{static_cast<uint32_t>(r)} * stride * columns_ + static_cast<uint32_t>(c) * stride;
      canvas.fill(c * at.enlarged, at.top + r * at.enlarged, at.enlarged, at.enlarged,
                  inferno((double{values_[pixel]} - ends[0]) / (ends[1] - ends[0])));
    }
  if (spec_.bar)
    draw_legend(canvas, at,
                {{title_ + ", " + unit_, unit_}, ends, inferno, std::ranges::find(nothing, true) != nothing.end()});
  write_png(path, canvas,
            command_line() + strf("; %s, linear from %g to %g %s (%g and %g %% of the pixels), inferno", title_.c_str(),
                                  ends[0], ends[1], unit_.c_str(), spec_.low_percent, spec_.high_percent));
}

std::vector<std::string> truth_picture_names() {
  std::vector<std::string> out;
  for (const auto& [name, column] : kPictures) out.push_back(name);
  return out;
}

}  // namespace suite
