#include "output.h"

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/run_app.h"
#include "formats/envi/envi.h"
#include "formats/raster/raster_write.h"
#include "preview.h"
#include "sensor/quality.h"
#include "spectral/planck.h"

namespace suite {

namespace {

const char* const kUnits[] = {"W/(m2 sr um)", "W/(cm2 sr um)", "photons/(s m2 sr um)"};

// What radiance in W/(m2 sr um) is multiplied by. Photons are counted at the energy of the band's centre.
double unit_factor(OutputSpec::Units units, const Band& band) {
  if (units == OutputSpec::Units::w_cm2) return 1e-4;
  if (units == OutputSpec::Units::photons) return band.center_um * 1e-6 / (kPlanckConstant * kSpeedOfLight);
  return 1;
}

// The tangent plane at the scene's origin as a coordinate system that other programs know.
std::string tangent_wkt(const GeodeticOrigin& o) {
  return strf(
      "PROJCS[\"scene ENU\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
      "84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
      "UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Orthographic\"],PARAMETER[\"latitude_of_origin\",%.12g],"
      "PARAMETER[\"central_meridian\",%.12g],PARAMETER[\"false_easting\",0],PARAMETER[\"false_northing\",0],UNIT["
      "\"metre\",1]]",
      o.latitude_deg, o.longitude_deg);
}

std::string stem_of(const ImageRows& rows, OutputSpec::Files files) {
  if (files == OutputSpec::Files::natural) files = rows.lines ? OutputSpec::Files::task : OutputSpec::Files::capture;
  if (files == OutputSpec::Files::capture)
    return rows.captures > 1 ? rows.image + strf("_%04zu", rows.capture_number) : rows.image;
  if (files == OutputSpec::Files::task) return rows.tasks > 1 ? rows.image + "_" + rows.task : rows.image;
  return rows.image;
}

// The header of the flags beside an image: one byte a pixel, the sum of the bits that the header names.
EnviHeader quality_header(EnviHeader h, const std::string& about) {
  h.extra.clear(), h.wavelength_um.clear(), h.fwhm_um.clear(), h.data_units.clear();
  h.type = EnviType::uint8;
  h.bands = 1;
  h.band_names = {"quality"};
  h.description = "quality" + about + "; a pixel is the sum of the bits that hold, 0 = none:";
  std::string bits = "{";
  for (const QualityBit& b : quality_bits()) {
    h.description += strf("\n%d = %s: %s", b.bit, b.name.c_str(), b.meaning.c_str());
    bits += strf("%s%d %s", bits.size() > 1 ? ", " : "", b.bit, b.name.c_str());
  }
  h.extra.push_back({"quality bits", bits + "}"});
  return h;
}

}  // namespace

// An image while its rows come in.
struct OutputWriter::Image {
  uint32_t columns = 0, rows = 0, next = 0;
  size_t values = 0;                     // of radiance, per pixel
  std::vector<double> factor;            // of each value
  std::map<uint32_t, Delivery> waiting;  // by first row
  std::unique_ptr<EnviWriter> radiance, error, quality, truth;
  std::vector<std::unique_ptr<EnviWriter>> products;
  std::vector<std::string> files;
  std::optional<Preview> preview;
  std::vector<std::string> names;
  std::vector<float> all;           // [pixel][value], for formats that take a whole picture
  std::vector<float> all_quality;   // [pixel], likewise
  std::vector<double> correlation;  // [band][band], summed over rows
  std::optional<MapGrid> map;
  std::string description;
};

OutputWriter::OutputWriter(std::string folder, OutputSpec spec, SceneNotes notes)
    : folder_(std::move(folder)), spec_(std::move(spec)), notes_(std::move(notes)) {}
OutputWriter::~OutputWriter() = default;

OutputWriter::Image& OutputWriter::image_of(const Delivery& d, const std::string& stem) {
  std::unique_ptr<Image>& slot = open_[stem];
  if (slot) return *slot;
  slot = std::make_unique<Image>();
  Image& m = *slot;
  OutputSpec::Files files = spec_.files;
  if (files == OutputSpec::Files::natural) files = d.rows.lines ? OutputSpec::Files::task : OutputSpec::Files::capture;
  m.columns = d.result.columns;
  m.rows = files == OutputSpec::Files::capture ? d.result.rows
           : files == OutputSpec::Files::task  ? d.rows.rows_of_task
                                               : d.rows.rows_of_all;
  m.values = d.result.values_per_problem();
  m.preview.emplace(d.bands, spec_.preview_of(d.sensor.name()), m.columns, m.rows);
  m.map = d.map;
  const std::string& lines = files == OutputSpec::Files::task ? d.lines_of_task : d.lines_of_all;
  const std::string& said = files == OutputSpec::Files::capture || lines.empty() ? d.description : lines;
  m.description = said.empty() ? "" : "; " + said;
  const std::string base = folder_ + "/" + stem, tail = m.description + "; " + notes_.engine;

  EnviHeader h;
  h.samples = m.columns, h.lines = m.rows, h.bands = m.values;
  h.type = spec_.type == OutputSpec::Type::float64  ? EnviType::float64
           : spec_.type == OutputSpec::Type::uint16 ? EnviType::uint16
                                                    : EnviType::float32;
  h.interleave = static_cast<Interleave>(spec_.order);
  h.data_units = kUnits[static_cast<size_t>(spec_.units)];
  for (size_t c = 0; c < d.result.channels; ++c)
    for (size_t t = 0; t < d.result.bins; ++t)
      for (const Band& b : d.bands) {
        h.band_names.push_back(b.name + (c ? " single" : "") + (d.result.bins > 1 ? strf(" t%zu", t) : ""));
        h.wavelength_um.push_back(b.center_um);
        h.fwhm_um.push_back(b.fwhm_um);
        m.factor.push_back(unit_factor(spec_.units, b));
      }
  m.names = h.band_names;
  if (d.map) {
    h.map_info = {notes_.origin.given ? "Orthographic" : "Arbitrary",
                  "1",
                  "1",
                  strf("%.10g", d.map->origin.x),
                  strf("%.10g", d.map->origin.y),
                  strf("%.10g", d.map->gsd_x),
                  strf("%.10g", d.map->gsd_y),
                  notes_.origin.given ? "WGS-84" : "0",
                  "units=Meters"};
    if (notes_.origin.given) h.coordinate_system = tangent_wkt(notes_.origin);
  }
  const std::string who = " of sensor '" + d.sensor.name() + "'";
  auto open = [&](const std::string& suffix, EnviHeader header) {
    m.files.push_back(base + suffix + ".img");
    return std::make_unique<EnviWriter>(m.files.back(), std::move(header));
  };
  h.description = "spectral radiance" + who + tail;
  EnviHeader e = h;
  e.description = "standard error of the spectral radiance" + who + tail;
  if (spec_.type == OutputSpec::Type::uint16) {
    std::string gains = "{";
    for (size_t i = 0; i < m.values; ++i) gains += (i ? ", " : "") + strf("%.9g", spec_.scale);
    h.extra.push_back({"data gain values", gains + "}"});
    e.type = EnviType::float32;
  }
  m.radiance = open("", h);
  m.error = open("_error", e);
  m.quality = open("_quality", quality_header(h, who + tail));
  EnviHeader t = h;
  t.extra.clear(), t.wavelength_um.clear(), t.fwhm_um.clear(), t.data_units.clear();
  t.type = EnviType::float64;  // positions and indices keep every digit
  t.bands = d.result.truth_names.size();
  t.band_names = d.result.truth_names;
  t.ignore_value = std::nan("");
  t.description = "truth" + who + tail + "; materials:";
  for (size_t i = 0; i < notes_.materials.size(); ++i) t.description += strf(" %zu=%s", i, notes_.materials[i].c_str());
  if (!notes_.tags.empty()) t.description += "; tags:";
  for (size_t i = 0; i < notes_.tags.size(); ++i) t.description += strf(" %zu=%s", i, notes_.tags[i].c_str());
  if (t.bands) m.truth = open("_truth", t);
  for (const Product& p : d.products) {
    EnviHeader x = h;
    x.extra.clear();
    x.bands = p.bands.size(), x.band_names = p.bands, x.data_units = p.unit;
    if (x.bands != x.wavelength_um.size()) x.wavelength_um.clear(), x.fwhm_um.clear();
    x.type = p.whole_numbers                           ? EnviType::uint16
             : spec_.type == OutputSpec::Type::float64 ? EnviType::float64
                                                       : EnviType::float32;
    x.description = p.name + who + tail;
    m.products.push_back(open("_" + p.name, x));
  }
  return m;
}

// The formats that take a whole picture: radiance, and the flags in a file of their own.
void OutputWriter::write_whole(Image& m, const std::string& base) {
  const std::string comment = strf("suite %s: ", kVersion) + command_line() + m.description;
  std::optional<RasterPlacement> place;
  if (m.map) {
    place = RasterPlacement{m.map->origin.x, m.map->origin.y, m.map->gsd_x, m.map->gsd_y, {}};
    if (notes_.origin.given) place->origin_deg = {notes_.origin.latitude_deg, notes_.origin.longitude_deg};
  }
  if (spec_.geotiff) {
    write_float_tiff(base + ".tif", m.columns, m.rows, m.names, m.all, comment, place);
    write_float_tiff(base + "_quality.tif", m.columns, m.rows, {"quality"}, m.all_quality, comment, place);
    m.files.insert(m.files.end(), {base + ".tif", base + "_quality.tif"});
  }
  if (spec_.exr) {
    write_exr(base + ".exr", m.columns, m.rows, m.names, m.all, comment);
    write_exr(base + "_quality.exr", m.columns, m.rows, {"quality"}, m.all_quality, comment);
    m.files.insert(m.files.end(), {base + ".exr", base + "_quality.exr"});
  }
}

void OutputWriter::take(const Delivery& delivery) {
  for (const TextFile& text : delivery.texts) write_text(text);
  if (!delivery.result.columns) return;
  const std::string stem = stem_of(delivery.rows, spec_.files);
  Image& m = image_of(delivery, stem);
  OutputSpec::Files files = spec_.files;
  if (files == OutputSpec::Files::natural)
    files = delivery.rows.lines ? OutputSpec::Files::task : OutputSpec::Files::capture;
  const uint32_t at = files == OutputSpec::Files::capture ? 0
                      : files == OutputSpec::Files::task  ? delivery.rows.row_in_task
                                                          : delivery.rows.row_in_all;
  m.waiting.emplace(at, delivery);
  // Captures may finish in any order; rows are written in theirs.
  for (auto next = m.waiting.find(m.next); next != m.waiting.end(); next = m.waiting.find(m.next)) {
    const Delivery& d = next->second;
    const size_t n = d.result.problems();
    std::vector<double> radiance = d.result.radiance, error = d.result.standard_error;
    for (size_t i = 0; i < n; ++i)
      for (size_t v = 0; v < m.values; ++v) {
        double& x = radiance[i * m.values + v];
        x *= m.factor[v], error[i * m.values + v] *= m.factor[v];
        if (spec_.geotiff || spec_.exr) m.all.push_back(static_cast<float>(x));
        if (spec_.type == OutputSpec::Type::uint16) x = std::clamp(std::round(x / spec_.scale), 0.0, 65535.0);
      }
    m.preview->append(d.result);
    m.radiance->append(radiance);
    m.error->append(error);
    m.quality->append(std::vector<double>(d.result.quality.begin(), d.result.quality.end()));
    if (spec_.geotiff || spec_.exr)
      m.all_quality.insert(m.all_quality.end(), d.result.quality.begin(), d.result.quality.end());
    if (m.truth) m.truth->append(d.result.truth);
    for (size_t p = 0; p < m.products.size(); ++p) m.products[p]->append(d.products[p].values);
    // Of an image in parts the correlation is the mean over its rows.
    m.correlation.resize(d.result.bands * d.result.bands);
    for (size_t i = 0; i < m.correlation.size(); ++i) m.correlation[i] += d.result.error_correlation[i] * d.result.rows;
    m.next += d.result.rows;
    m.waiting.erase(next);
  }
  if (m.next < m.rows) return;
  for (EnviWriter* w : {m.radiance.get(), m.error.get(), m.quality.get(), m.truth.get()})
    if (w) w->commit();
  for (auto& w : m.products) w->commit();
  const std::string base = folder_ + "/" + stem;
  write_whole(m, base);
  std::string correlation = "# correlation of the standard errors of the bands; 1 = they err together\nband";
  const size_t bands = delivery.bands.size();
  for (const Band& b : delivery.bands) correlation += "," + b.name;
  for (size_t a = 0; a < bands; ++a) {
    correlation += "\n" + delivery.bands[a].name;
    for (size_t b = 0; b < bands; ++b) correlation += strf(",%.4f", m.correlation[a * bands + b] / m.rows);
  }
  m.files.push_back(base + "_error_correlation.csv");
  write_file(m.files.back(), correlation + "\n");
  m.preview->write(base + ".png");
  m.files.push_back(base + ".png");
  for (const std::string& file : m.files) note("wrote " + file);
  open_.erase(stem);
}

void OutputWriter::write_text(const TextFile& text) {
  write_file(folder_ + "/" + text.name, std::string_view(text.text));
  note("wrote " + folder_ + "/" + text.name);
}

}  // namespace suite
