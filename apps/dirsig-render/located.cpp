#include "located.h"

#include <algorithm>

#include "base/diagnostics.h"
#include "base/run_app.h"

namespace suite {

LocatedPixels::LocatedPixels(uint32_t columns, uint32_t rows, const ImageWishes& wishes, bool geotiff)
    : columns_(columns), wishes_(wishes) {
  if (geotiff) sight_.emplace(columns, rows);
}

void LocatedPixels::append(const Delivery& d, uint32_t first_row) {
  const std::vector<std::string>& names = d.result.truth_names;
  const auto east = std::find(names.begin(), names.end(), "east [m]");
  SUITE_CHECK(names.end() - east >= 3);
  for (size_t i = 0; i < d.result.problems(); ++i) {
    const double* at = &d.result.truth[i * names.size() + static_cast<size_t>(east - names.begin())];
    enu_.push_back({at[0], at[1], at[2]});
  }
  if (sight_) sight_->add(d, first_row);
}

std::vector<std::string> LocatedPixels::write_tables(const LocatedImage& image, const GeodeticOrigin& origin) {
  places_.emplace(enu_, columns_, origin);
  try {
    map_ = ground_map(*places_, wishes_.epsg, wishes_.pixel);
  } catch (const Error& e) {
    emit({Dr::no_lookup_table, "'" + image.base + ".img' gets no lookup table (GLT)" +
                                   (sight_ ? " and no map: " : ": ") + e.message() +
                                   (e.hint().empty() ? "" : "; " + e.hint())});
  }
  mapped_ = sight_ && map_;
  if (mapped_ && horizon_in_view(sight_->lines(), *places_)) {
    mapped_ = false;
    emit({Dr::no_map,
          "'" + image.base +
              strf(".tif' gets no map: the horizon is in view, or ground that is seen at less than %g degrees",
                   kLeastElevation)});
  }
  return write_geolocation(image, *places_, map_ ? &*map_ : nullptr);
}

void LocatedPixels::add_control(const std::string& file, FloatRaster& raster) const {
  if (!raster.placement) add_ground_control(file, *places_, sight_->lines(), raster);
}

std::vector<std::string> LocatedPixels::write_rasters(const std::string& base, const FloatRaster& described,
                                                      std::span<const float> values,
                                                      std::span<const float> quality) const {
  using enum MappedImage::Kind;
  std::vector<std::string> files;
  std::optional<MapRasters> maps;
  if (mapped_) maps.emplace(*places_, *map_, wishes_.resampling.value_or(ImageWishes::Resampling::area));
  const auto on_map = [&](MappedImage image) {
    if (!maps) return;
    image.file = base + image.file;
    files.push_back(image.file);
    maps->write(std::move(image));
  };
  const auto raw = [&](const std::string& file, const FloatRaster& raster, const std::vector<double>& numbers) {
    const size_t row_values = size_t{raster.width} * raster.bands.size();
    files.push_back(base + file);
    write_float_tiff_rows(files.back(), raster, [&](uint32_t row, std::span<double> to) {
      std::copy_n(numbers.begin() + static_cast<long>(row * row_values), row_values, to.begin());
    });
  };
  on_map({means, "_map.tif", described, {values.begin(), values.end()}, described.no_data});
  FloatRaster error = described;
  error.display.clear(), error.true_colour = false, error.no_data = std::nan("");
  std::vector<double> numbers = EnviImage(base + "_error.img").read_all();
  raw("_error.tif", error, numbers);
  on_map({errors, "_error_map.tif", error, std::move(numbers), {}});
  FloatRaster flags = error;
  flags.bands = {{"quality"}}, flags.units.clear();
  on_map({bits, "_quality_map.tif", flags, {quality.begin(), quality.end()}, {}});
  const EnviImage known(base + "_truth.img");
  FloatRaster facts = error;
  facts.bands.clear(), facts.units.clear(), facts.doubles = true;
  for (const std::string& name : known.header().band_names) facts.bands.push_back({name});
  numbers = known.read_all();
  raw("_truth.tif", facts, numbers);
  on_map({MappedImage::Kind::truth, "_truth_map.tif", facts, std::move(numbers), {}});
  return files;
}

}  // namespace suite
