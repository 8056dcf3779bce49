// Surfaces of water with waves, as a mesh.
#include <cmath>

#include "base/parallel.h"
#include "formats/scene_text/reader.h"
#include "water/waves.h"

namespace suite::scene_text {

namespace {

constexpr size_t kMostPoints = size_t{1} << 24;
constexpr double kMostTerms = 1e11;  // minutes of a core
constexpr double kPointsAWave = 4;   // of the shortest wave that the grid carries

SeaState sea_of(const Params& p) {
  SeaState s;
  constexpr WaveSpectrum kinds[] = {WaveSpectrum::pierson_moskowitz, WaveSpectrum::jonswap, WaveSpectrum::elfouhaily};
  if (const auto kind = p.find("spectrum"))
    s.spectrum = kinds[kind->as_choice({"pierson_moskowitz", "jonswap", "elfouhaily"})];
  s.wind_m_s = p.number("wind_m_s");
  s.fetch_m = p.number("fetch_m", s.fetch_m);
  s.depth_m = p.number("depth_m", s.depth_m);
  s.toward = azimuth_from_compass_deg(p.number_in("toward_deg", -360, 360, "degrees", 90));
  check_sea_state(s, p.where());
  return s;
}

}  // namespace

void Reader::read_waves(const Params& object, DraftGeometry& g) {
  const Params p = object.at("waves");
  g.kind = DraftGeometry::Kind::terrain;
  if (!g.material.given()) throw object.error("waves '" + g.name + "' need a 'material'");
  g.tile_m = object.number_in("tile_m", 1, 1e6, "m", 4000);
  const SeaState sea = sea_of(p);
  const std::vector<double> size = p.at("size_m").as_numbers();
  const double step = p.number_in("step_m", 1e-3, 1e4, "m"), time = p.number("time_s", 0);
  if (size.size() != 2 || !(size[0] >= step) || !(size[1] >= step))
    throw p.at("size_m").error("a size is [along x, along y] in metres, at least a step each");
  const double columns = std::floor(size[0] / step) + 1, rows = std::floor(size[1] / step) + 1;
  if (columns * rows > double(kMostPoints))
    throw p.at("step_m").error(strf("%.0f x %.0f points", columns, rows), strf("at most %zu", kMostPoints));
  const double shortest = std::min(kShortestWave, 2 * kPi / (kPointsAWave * step)), peak = peak_wave_number(sea);
  if (!(shortest > 0.5 * peak))
    throw p.at("step_m").error(strf("steps of %g m carry no wave: the highest are %.3g m long", step, 2 * kPi / peak),
                               strf("at most %.3g m", kPi / (kPointsAWave * peak)));
  const auto count = static_cast<size_t>(p.integer("components", 16, 100000, 600));
  if (columns * rows * double(count) > kMostTerms)
    throw p.error(strf("%.3g points of %zu waves each", columns * rows, count),
                  strf("at most %.2g together: a smaller field, a larger 'step_m' or fewer 'components'", kMostTerms));
  const Waves waves(sea, shortest, count, static_cast<uint64_t>(p.integer("seed", 0, 1LL << 52, 1)));
  g.terrain.width = static_cast<uint32_t>(columns), g.terrain.height = static_cast<uint32_t>(rows);
  g.terrain.heights.resize(static_cast<size_t>(g.terrain.width) * g.terrain.height);
  // The middle of the field is the origin; rows go south.
  const double west = -0.5 * step * (columns - 1), north = 0.5 * step * (rows - 1);
  g.terrain.place = [=](double c, double r, double z) { return Vec3{west + c * step, north - r * step, z}; };
  parallel_for(0, g.terrain.height, 1, [&](size_t begin, size_t end) {
    for (size_t r = begin; r < end; ++r)
      waves.row(west, north - double(r) * step, step, time,
                std::span(g.terrain.heights).subspan(r * g.terrain.width, g.terrain.width));
  });
  const double left_out = slope_variance(sea, shortest, kShortestWave);
  report_.add("SP609", draft_.file,
              {p.where(), sea.wind_m_s == 0
                              ? strf("waves '%s': no wind, flat water", g.name.c_str())
                              : strf("waves '%s': %.3g m high (significant); those shorter than %.3g m are left out, a "
                                     "mean square slope of "
                                     "%.3g of %.3g in all, as rough as a ggx_dielectric of roughness %.2g",
                                     g.name.c_str(), 4 * std::sqrt(waves.variance()), 2 * kPi / shortest, left_out,
                                     slope_variance(sea, 0.1 * peak, kShortestWave), std::sqrt(left_out))});
}

}  // namespace suite::scene_text
