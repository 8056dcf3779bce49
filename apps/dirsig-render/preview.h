// The quick look at a radiance cube.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "formats/picture/picture.h"
#include "formats/raster/raster_style.h"
#include "formats/sim_text/sim_text.h"
#include "headers.h"

namespace suite {

// Collects what an image's preview needs while its rows come in, and draws it. Of three bands: red, green and blue,
// linear from the 1st percentile of each pixel's darkest band to the 99th of its brightest, then sRGB; a pixel a
// detector. Of one band: grey with a bar of radiance, or, when its light is thermal (beyond 3 um), colours with a bar
// of brightness temperature, grey where the truth says that nothing was hit; small pictures are enlarged. The file's
// comment says what was done. Pictures wider or higher than 15000 show every n-th pixel.
class Preview {
 public:
  // chosen: three of the bands or one, as display_of tells.
  Preview(std::span<const Band> bands, std::span<const size_t> chosen, PreviewSpec spec, uint32_t columns,
          uint32_t rows);
  void append(const CaptureResult& next_rows);
  // How other programs should show the picture's numbers, `all`: [pixel][value], `values` a pixel, in whatever unit;
  // the same bands between the same percentiles, or the range that was asked for when the unit is that of the preview.
  // When all rows are there.
  RasterStyle style(std::span<const float> all, size_t values, bool same_unit) const;
  bool in_kelvin() const { return kelvin_; }
  void write(const std::string& path);  // once, when all rows are there

 private:
  void to_kelvin();  // values_ from radiance; NaN where there is nothing
  double gamma(double t) const;
  Rgb color(double t) const;  // of one band, from 0 to 1
  const char* unit() const { return kelvin_ ? "K" : "W/(m2 sr um)"; }

  PreviewSpec spec_;
  std::vector<Band> bands_;  // chosen ones
  std::vector<size_t> chosen_;
  uint32_t columns_, rows_, stride_;
  bool kelvin_;
  std::vector<float> values_;  // [pixel][chosen], W/(m2 sr um)
  std::vector<bool> nothing_;  // [pixel], no sample met anything
};

// Refuses, before rendering, a preview that names bands a sensor does not have.
void check_preview(const Sensor& sensor, const PreviewSpec& spec);

}  // namespace suite
