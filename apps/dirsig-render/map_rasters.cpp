#include "map_rasters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/run_app.h"
#include "sensor/footprints.h"

namespace suite {

namespace {

constexpr size_t kControlEdge = 15;  // ground control points along an edge of a picture

RasterRpc in_tag_order(const Rpc& r, double metres) {
  RasterRpc tag{-1, metres};
  size_t at = 2;
  const auto scales = {r.line, r.sample, r.latitude_deg, r.longitude_deg, r.height_m};
  for (const Rpc::Scale& s : scales) tag[at++] = s.offset;
  for (const Rpc::Scale& s : scales) tag[at++] = s.scale;
  for (const Rpc::Terms* t : {&r.line_numerator, &r.line_denominator, &r.sample_numerator, &r.sample_denominator})
    for (const double x : *t) tag[at++] = x;
  return tag;
}

std::vector<GroundControl> control_points(const GroundPlaces& places) {
  std::vector<GroundControl> points;
  const size_t columns = places.columns(), rows = places.size() / columns;
  const size_t step_x = std::max<size_t>(1, (columns + kControlEdge - 1) / kControlEdge),
               step_y = std::max<size_t>(1, (rows + kControlEdge - 1) / kControlEdge);
  // Of each block the first known pixel from its middle on, so that edges of what is seen have some, too.
  for (size_t y = 0; y < rows; y += step_y)
    for (size_t x = 0; x < columns; x += step_x) {
      const size_t wide = std::min(step_x, columns - x), tall = std::min(step_y, rows - y), n = wide * tall;
      const size_t middle = tall / 2 * wide + wide / 2;
      for (size_t k = 0; k < n; ++k) {
        const size_t j = (middle + k) % n, c = x + j % wide, r = y + j / wide, i = r * columns + c;
        if (!places.known(i)) continue;
        const auto [px, py, pz] = places.triple(i);
        points.push_back({static_cast<double>(c) + 0.5, static_cast<double>(r) + 0.5, px, py, pz});
        break;
      }
    }
  return points;
}

bool is_name(const std::string& band) {
  return band == "material" || band == "instance" || band == "tag" || band == "state";
}

// What the pixels of a cell make together.
class Cell {
 public:
  Cell(const MappedImage& image, std::span<const Footprints::Share> shares, size_t band)
      : image_(image), shares_(shares), band_(band) {}
  double value() const {
    switch (image_.kind) {
      case MappedImage::Kind::errors:
        return error();
      case MappedImage::Kind::bits:
        return bits();
      case MappedImage::Kind::truth:
        if (is_name(image_.raster.bands[band_].name)) return most_frequent();
        [[fallthrough]];
      case MappedImage::Kind::means:
        return mean();
    }
    return NAN;
  }

 private:
  double at(const Footprints::Share& s) const {
    const double x = image_.values[s.pixel * image_.raster.bands.size() + band_];
    return image_.ignored && x == *image_.ignored ? NAN : x;
  }
  double mean() const {
    double sum = 0, area = 0;
    for (const auto& s : shares_)
      if (const double x = at(s); !std::isnan(x)) sum += s.area * x, area += s.area;
    return area > 0 ? sum / area : NAN;
  }
  double error() const {
    double sum = 0, area = 0;
    for (const auto& s : shares_)
      if (const double x = at(s) * s.area; !std::isnan(x)) sum += x * x, area += s.area;
    return area > 0 ? std::sqrt(sum) / area : NAN;
  }
  double bits() const {
    unsigned sum = 0;
    for (const auto& s : shares_) sum |= static_cast<unsigned>(at(s));
    return shares_.empty() ? NAN : sum;
  }
  double most_frequent() const {
    double best = NAN, most = 0;
    for (const auto& s : shares_) {
      const double x = at(s);
      double area = 0;
      for (const auto& other : shares_)
        if (at(other) == x) area += other.area;
      if (area > most) best = x, most = area;
    }
    return best;
  }

  const MappedImage& image_;
  std::span<const Footprints::Share> shares_;
  size_t band_;
};

}  // namespace

void add_ground_control(const std::string& file, const GroundPlaces& places, const std::vector<SightLine>& lines,
                        FloatRaster& raster) {
  const auto fit = rpc_of(lines, places);
  if (fit && fit->rms <= kWorstRpc) {
    const std::string residual = strf("%.2g pixels rms, %.2g at most", fit->rms, fit->largest);
    note("'" + file + "': RPCs (RPC00B) follow the places of its pixels within " + residual);
    std::vector<Vec2> east_north;
    for (size_t i = 0; i < places.size(); ++i) east_north.push_back({places.enu(i).x, places.enu(i).y});
    raster.rpc = in_tag_order(fit->rpc, fit->rms * spacing_of(east_north, places.columns()).pixel());
    raster.remarks.push_back({"rpc_residual", residual});
    return;
  }
  raster.control = control_points(places);
  raster.on_plane = !places.on_earth();
  if (raster.control.empty()) return;
  const std::string why = !places.on_earth() ? "the scene has no origin on the Earth"
                          : fit              ? strf("RPCs leave %.2g pixels rms", fit->rms)
                                             : "no RPCs follow its lines of sight";
  note("'" + file + strf("' gets %zu ground control points: ", raster.control.size()) + why);
}

struct MapRasters::Cells {
  std::optional<Footprints> areas;
  std::vector<Footprints::Share> nearest;  // one a cell; no area = none
  std::span<const Footprints::Share> at(size_t i) const {
    if (areas) return areas->cell(i);
    return std::span(nearest).subspan(i, nearest[i].area > 0 ? 1 : 0);
  }
};

MapRasters::MapRasters(const GroundPlaces& places, const GroundMap& map, ImageWishes::Resampling how)
    : map_(map), cells_(std::make_unique<Cells>()) {
  if (how == ImageWishes::Resampling::area) {
    std::vector<double> heights(places.size(), NAN);
    for (size_t i = 0; i < heights.size(); ++i)
      if (places.known(i)) heights[i] = places.height_m(i);
    cells_->areas.emplace(map.places, heights, places.columns(), map.grid, map.unit_m);
    return;
  }
  for (size_t i = 0; i < map.grid.sample.size(); ++i) {
    const int32_t sample = std::abs(map.grid.sample[i]), line = std::abs(map.grid.line[i]);
    const auto pixel =
        sample ? static_cast<uint32_t>(line - 1) * places.columns() + static_cast<uint32_t>(sample - 1) : 0;
    cells_->nearest.push_back({pixel, sample ? 1.f : 0.f});
  }
}
MapRasters::~MapRasters() = default;

void MapRasters::write(MappedImage image) const {
  const GroundGrid& g = map_.grid;
  FloatRaster& r = image.raster;
  r.width = g.columns, r.height = g.rows;
  r.no_data = std::nan("");
  r.placement = RasterPlacement{g.west, g.north, g.cell, g.cell, {}, map_.epsg, map_.geographic};
  r.control.clear(), r.rpc.reset(), r.remarks.clear();
  r.remarks.push_back({"resampling", cells_->areas ? "area" : "nearest"});
  const size_t bands = r.bands.size();
  write_float_tiff_rows(image.file, r, [&](uint32_t row, std::span<double> to) {
    for (size_t c = 0; c < g.columns; ++c) {
      const auto shares = cells_->at(size_t{row} * g.columns + c);
      for (size_t b = 0; b < bands; ++b) to[c * bands + b] = Cell(image, shares, b).value();
    }
  });
}

}  // namespace suite
