// Skies before they are baked: from a text, and as others need to know them.
#include <algorithm>
#include <cmath>

#include "light/kinds/rows.h"
#include "light/kinds/sky.h"

namespace suite {

namespace {

using Rows = std::vector<std::vector<float>>;

// One table a wavelength: some directions of the table.
LightSpectra spectra_of_tables(const SkySpec& sky) {
  constexpr size_t kDirections = 12;
  const size_t directions = sky.zeniths * sky.azimuths, step = std::max<size_t>(1, directions / kDirections);
  LightSpectra seen;
  std::vector<Curve> shapes;
  for (size_t d = 0; d < directions; d += step) {
    std::vector<double> value;
    for (size_t c = 0; c < sky.wavelength_um.size(); ++c) value.push_back(sky.table.at(c * directions + d));
    if (*std::max_element(value.begin(), value.end()) <= 0) continue;
    seen.names.push_back(strf("the sky, direction %zu of its table", d));
    shapes.emplace_back(sky.wavelength_um, std::move(value), Outside::hold);
  }
  seen.over = [&sky, shapes](const SpectralState& s) {
    const std::vector<float> radiance = s.sample(sky.radiance);
    Rows rows;
    for (const Curve& shape : shapes) {
      rows.push_back(s.sample(shape));
      for (size_t i = 0; i < radiance.size(); ++i) rows.back()[i] *= radiance[i];
    }
    return rows;
  };
  return seen;
}

// A thermal sky at some zenith angles.
LightSpectra spectra_of_layers(const SkySpec& sky) {
  constexpr size_t kZeniths = 6;  // the last at the horizon
  LightSpectra seen;
  for (size_t i = 0; i < kZeniths; ++i) seen.names.push_back(strf("the sky at zenith angle %zu", 18 * i));
  seen.over = [&sky](const SpectralState& s) {
    SkySpec few = sky;
    few.zeniths = kZeniths;
    const Sky baked(few, s);
    Rows rows;
    for (size_t i = 0; i < kZeniths; ++i) {
      rows.emplace_back(s.size(), 0.0f);
      baked.add(dir_from_angles(std::min(kPi / 2 - 1e-9, 18 * static_cast<double>(i) * kDegree), 0), 0, 1, rows.back());
    }
    return rows;
  };
  return seen;
}

class SkyLight final : public LightSpec {
 public:
  explicit SkyLight(SkySpec spec) : spec_(std::move(spec)) {}
  std::string key() const override { return "sky"; }
  bool shines(double low_um, double high_um) const override {
    return !spec_.layers.empty() || shines_between(spec_.radiance, low_um, high_um);
  }
  void add_spectra(std::vector<LightSpectra>& to) const override {
    if (!spec_.layers.empty())
      to.push_back(spectra_of_layers(spec_));
    else if (spec_.table.empty() || spec_.wavelength_um.empty())
      add_curve("the sky", spec_.radiance, to);
    else
      to.push_back(spectra_of_tables(spec_));
  }
  bool in_scene() const override { return false; }
  std::vector<std::string> hardly_met(double) const override { return {}; }
  std::shared_ptr<const Light> bake(const Tracer&, const SpectralState& state) const override {
    return std::make_shared<const Sky>(spec_, state);
  }

 private:
  const SkySpec spec_;
};

// Cells from the pixels of a panorama: rows from the zenith down, columns clockwise from a compass azimuth (degrees).
void fill_cells(SkySpec& sky, const LightImage& image, double left, const Params& file) {
  sky.cells = true;
  sky.zeniths = image.height, sky.azimuths = image.width;
  sky.table.resize(size_t{image.width} * image.height * image.channels);
  const double n = image.width;
  for (uint32_t j = 0; j < image.width; ++j) {
    // The pixel whose middle lies nearest to the middle of cell j.
    const double compass = 90 - (j + 0.5) / n * 360, turns = (compass - left) / 360;
    const auto column = std::min(image.width - 1, static_cast<uint32_t>((turns - std::floor(turns)) * n));
    for (uint32_t r = 0; r < image.height; ++r)
      for (uint32_t c = 0; c < image.channels; ++c) {
        const double v = static_cast<double>(image.values[(size_t{r} * image.width + column) * image.channels + c]);
        if (!(v >= 0) || !std::isfinite(v))
          throw file.error(strf("pixel (%u, %u) is negative or not finite", column, r));
        sky.table[(size_t{c} * image.height + r) * image.width + j] = v;
      }
  }
}

LightSpecPtr read_image(const Params& p, const LightContext& context) {
  SkySpec sky;
  const auto scale = p.find("radiance");
  sky.radiance = scale ? context.positive(*scale, "radiance", "W/(m2 sr um)") : Curve::constant(1);
  const Params file = p.at("file");
  const LightImage image = context.image(file.as_path());
  if (size_t{image.width} * image.height * image.channels > size_t{1} << 27)
    throw file.error(
        strf("%u x %u pixels of %u channels are too many for a sky", image.width, image.height, image.channels));
  if (const auto w = p.find("wavelength_um")) sky.wavelength_um = w->as_numbers();
  if (sky.wavelength_um.size() != (image.channels == 1 ? 0 : image.channels))
    throw p.error(strf("the image has %u channels and %zu wavelengths", image.channels, sky.wavelength_um.size()),
                  "give `wavelength_um`, ascending, one per channel of several");
  for (size_t i = 0; i < sky.wavelength_um.size(); ++i)
    if (!(sky.wavelength_um[i] > (i ? sky.wavelength_um[i - 1] : 0)))
      throw p.at("wavelength_um").error("the wavelengths are not positive and ascending");
  sky.full_sphere = true;
  if (const auto covers = p.find("covers")) sky.full_sphere = covers->as_choice({"sphere", "hemisphere"}) == 0;
  fill_cells(sky, image, p.number_in("left_azimuth_deg", -360, 360, "degrees clockwise from north", 0), file);
  return make_light(std::move(sky));
}

LightSpecPtr read_thermal(const Params& p, const LightContext& context) {
  SkySpec sky;
  sky.zeniths = static_cast<size_t>(p.integer("zeniths", 2, 1000, 181));
  for (const Params& layer : p.at("layers").items())
    sky.layers.push_back({layer.number_in("temperature_k", 1e-3, 1e5, "K"),
                          context.positive(layer.at("optical_depth"), "optical depth", "vertical, of absorption")});
  if (sky.layers.empty()) throw p.at("layers").error("a thermal sky needs at least one layer");
  return make_light(std::move(sky));
}

std::optional<SkyStokes> read_sky_stokes(const Params& p) {
  const auto stokes = p.find("stokes");
  if (!stokes) return std::nullopt;
  SkyStokes s;
  size_t rows = 0, columns = 0;
  read_rows(stokes->at("q"), s.zeniths, s.azimuths, s.q, "a table of q", TableSigns::any);
  read_rows(stokes->at("u"), rows, columns, s.u, "a table of u", TableSigns::any);
  if (rows != s.zeniths || columns != s.azimuths) throw stokes->error("the tables of q and u differ in size");
  if (rows < 2)
    throw stokes->error("tables of q and u need at least two rows",
                        "the first is the zenith, the last the horizon (the nadir with full_sphere)");
  for (size_t i = 0; i < s.q.size(); ++i)
    if (!(std::hypot(s.q[i], s.u[i]) <= 1 + 1e-9))
      throw stokes->error(strf("a degree of polarisation of %g", std::hypot(s.q[i], s.u[i])),
                          "q and u are over I: hypot(q, u) is 0 to 1");
  return s;
}

LightSpecPtr read_tabulated(const Params& p, const LightContext& context) {
  SkySpec sky;
  sky.radiance = context.positive(p.at("radiance"), "radiance", "W/(m2 sr um)");
  sky.full_sphere = p.boolean("full_sphere", false);
  sky.stokes = read_sky_stokes(p);
  const auto table = p.find("table");
  const auto tables = p.find("tables");
  if (table && tables) throw tables->error("`table` and `tables` exclude each other");
  const auto check_rows = [](const Params& at, size_t rows) {
    if (rows < 2)
      throw at.error("a sky table needs at least two rows",
                     "the first is the zenith, the last the horizon (the nadir with full_sphere)");
  };
  if (table) {
    read_rows(*table, sky.zeniths, sky.azimuths, sky.table, "a sky table");
    check_rows(*table, sky.zeniths);
  }
  if (!tables) return make_light(std::move(sky));
  // One table per wavelength, all of one size.
  for (const Params& one : tables->items()) {
    sky.wavelength_um.push_back(one.number_in("wavelength_um", 1e-3, 1e4, "um"));
    if (sky.wavelength_um.size() > 1 && !(sky.wavelength_um.back() > sky.wavelength_um[sky.wavelength_um.size() - 2]))
      throw one.error("the wavelengths of the tables are not ascending");
    size_t rows = 0, columns = 0;
    read_rows(one.at("table"), rows, columns, sky.table, "a sky table");
    check_rows(one, rows);
    if (sky.wavelength_um.size() > 1 && (rows != sky.zeniths || columns != sky.azimuths))
      throw one.error("the tables differ in size");
    sky.zeniths = rows, sky.azimuths = columns;
  }
  if (sky.wavelength_um.empty()) throw tables->error("no table is given");
  return make_light(std::move(sky));
}

}  // namespace

LightSpecPtr make_light(SkySpec spec) { return std::make_shared<const SkyLight>(std::move(spec)); }

LightRow sky_table_row() {
  return {{"sky table", "uniform, one table of relative radiance, or one table per wavelength", "W/(m2 sr um)",
           read_tabulated},
          false,
          "Light from everywhere else. A uniform sky is met by chance alone; others are also sampled at every node.",
          "sky:\n  radiance: 3\n  tables:\n    - {wavelength_um: 0.5, table: [[1, 1, 1], [4, 2, 0.5], [0, 1, 0]]}\n"
          "    - {wavelength_um: 0.6, table: [[0, 0, 0], [0.1, 2, 7], [1, 1, 1]]}\n"};
}

LightRow sky_image_row() {
  return {{"sky image", "a panorama (latitude-longitude raster), radiance per channel or a luminance times a spectrum",
           "W/(m2 sr um)", read_image},
          false,
          {},
          "sky: {kind: image, file: sky.png, radiance: 0.01}\n"};
}

LightRow sky_thermal_row() {
  return {{"sky thermal", "emission of absorbing layers, radiance per wavelength and zenith angle", "", read_thermal},
          false,
          {},
          "sky: {kind: thermal, zeniths: 31, layers: [{temperature_k: 2500, optical_depth: 0.3}, {temperature_k: 2200, "
          "optical_depth: 0.5}]}\n"};
}

}  // namespace suite
