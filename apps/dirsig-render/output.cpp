#include "output.h"

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"
#include "base/files.h"
#include "base/outputs.h"
#include "base/run_app.h"
#include "formats/envi/envi.h"
#include "located.h"
#include "math/stats.h"
#include "polarisation_picture.h"
#include "preview.h"
#include "quantities.h"
#include "truth_picture.h"

namespace suite {

namespace {

std::string stem_of(const ImageRows& rows, OutputSpec::Files files) {
  if (files == OutputSpec::Files::capture)
    return rows.captures > 1 ? rows.image + strf("_%04zu", rows.capture_number) : rows.image;
  if (files == OutputSpec::Files::task) return rows.tasks > 1 ? rows.image + "_" + rows.task : rows.image;
  return rows.image;
}

// What the name of a band in a channel ends with: of Stokes vectors I, Q, U, V.
std::string channel_suffix(const Sensor& sensor, size_t channel) {
  const auto names = sensor.channels();
  const bool stokes = std::any_of(names.begin(), names.end(), [](const auto& n) { return n.starts_with("stokes_"); });
  if (channel == 0) return stokes ? " I" : "";
  if (!names[channel].starts_with("stokes_")) return " " + names[channel];
  return {' ', static_cast<char>(std::toupper(names[channel].back()))};
}

}  // namespace

// An image while its rows come in.
struct OutputWriter::Image {
  uint32_t columns = 0, rows = 0, next = 0;
  size_t values = 0;  // of radiance, per pixel
  ImageWishes wishes;
  Display display;                       // of header and preview
  std::map<uint32_t, Delivery> waiting;  // by first row
  std::unique_ptr<EnviWriter> radiance, error, quality, truth;
  std::vector<std::unique_ptr<EnviWriter>> products;
  struct Classes {
    size_t column = 0;  // of the truth
    std::unique_ptr<EnviWriter> file;
  };
  std::vector<Classes> classes;
  std::vector<std::string> files;
  std::optional<Preview> preview;
  std::vector<TruthPicture> pictures;  // of truth
  std::optional<PolarisationPicture> polarisation;
  std::vector<float> all;          // [pixel][value], for formats that take a whole picture
  std::vector<float> all_quality;  // [pixel], likewise
  std::optional<LocatedPixels> located;
  size_t unknown = 0;               // numbers that are no quantity
  std::vector<double> correlation;  // [band][band], summed over rows
  std::optional<MapGrid> map;
  std::optional<TimeWindow> window;  // of all rows
  std::string who, description;

  std::vector<EnviWriter*> writers() const {
    std::vector<EnviWriter*> list{radiance.get(), error.get(), quality.get()};
    if (truth) list.push_back(truth.get());
    for (const Classes& c : classes) list.push_back(c.file.get());
    for (const auto& p : products) list.push_back(p.get());
    return list;
  }
};

OutputWriter::OutputWriter(std::string folder, OutputSpec spec, SceneNotes notes, const Facts& facts, BandBiases biases)
    : folder_(std::move(folder)),
      spec_(std::move(spec)),
      notes_(std::move(notes)),
      facts_(facts),
      biases_(std::move(biases)) {}
OutputWriter::~OutputWriter() = default;

OutputSpec::Files OutputWriter::files_of(const ImageRows& rows) const {
  if (spec_.files != OutputSpec::Files::natural) return spec_.files;
  return rows.lines ? OutputSpec::Files::task : OutputSpec::Files::capture;
}

// The header that all files of an image begin with; radiance and what is like it keep all of it.
EnviHeader OutputWriter::common_header(const Image& m, const Delivery& d) const {
  EnviHeader h;
  h.samples = m.columns, h.lines = m.rows, h.bands = m.values;
  h.type = spec_.type == OutputSpec::Type::float64  ? EnviType::float64
           : spec_.type == OutputSpec::Type::uint16 ? EnviType::uint16
                                                    : EnviType::float32;
  h.interleave = static_cast<Interleave>(spec_.order);
  h.data_units = text_of(m.wishes.quantity, spec_.units).unit;
  for (size_t c = 0; c < d.result.channels; ++c)
    for (size_t t = 0; t < d.result.bins; ++t)
      for (const Band& b : d.bands) {
        h.band_names.push_back(b.name + channel_suffix(d.sensor, c) + (d.result.bins > 1 ? strf(" t%zu", t) : ""));
        h.wavelength_um.push_back(b.center_um);
        h.fwhm_um.push_back(b.fwhm_um);
      }
  for (const size_t b : m.display.bands) h.default_bands.push_back(static_cast<int>(b) + 1);
  if (m.map) add_map(*m.map, notes_.origin, h);
  return h;
}

std::unique_ptr<EnviWriter> OutputWriter::open(Image& m, const std::string& base, EnviHeader header) const {
  m.files.push_back(base + ".img");
  return std::make_unique<EnviWriter>(m.files.back(), std::move(header));
}

// How far each band of the image may be off by its bins, where that is known.
void OutputWriter::add_bias(const Image& m, const Delivery& d, EnviHeader& h) const {
  const size_t state = d.sensor.tasks()[d.result.task].captures[d.result.capture].state;
  const std::vector<BandBias> bias = bias_of(biases_, d.sensor.name(), state);
  if (bias.empty()) return;
  std::string relative = "{", floor = "{", absolute = "{";
  for (size_t i = 0; i < m.values; ++i) {
    const BandBias& b = bias[i % bias.size()];
    relative += strf("%s%.3g", i ? ", " : "", b.relative), floor += strf("%s%.4g", i ? ", " : "", b.floor);
    absolute += strf("%s%.3g", i ? ", " : "", b.absolute);
  }
  h.extra.push_back({"spectral bias", relative + "}"});
  h.extra.push_back({"spectral bias units", "1, of the radiance or of spectral bias floor where that is more"});
  h.extra.push_back({"spectral bias floor", floor + "}"});
  h.extra.push_back({"spectral bias floor units", "W/(m2 sr um)"});
  h.extra.push_back({"spectral bias absolute", absolute + "}"});
  h.extra.push_back({"spectral bias absolute units", "W/(m2 sr um), besides"});
}

void OutputWriter::open_radiance(Image& m, const Delivery& d, const std::string& base, const std::string& about) const {
  const std::string name = text_of(m.wishes.quantity, spec_.units).name;
  EnviHeader h = common_header(m, d);
  h.description = name + about;
  add_bias(m, d, h);
  EnviHeader e = h;
  e.description = "standard error of the " + name + about +
                  strf("; an interval of 95 %% reaches %.3g standard errors to either side (Student, %.3g degrees)",
                       student_t_quantile(0.95, static_cast<int>(d.result.error_degrees)), d.result.error_degrees);
  const bool temperature = m.wishes.quantity == Quantity::brightness_temperature;
  if (temperature) e.ignore_value = std::nan("");
  if (spec_.type == OutputSpec::Type::uint16) {
    std::string gains = "{";
    for (size_t i = 0; i < m.values; ++i) gains += (i ? ", " : "") + strf("%.9g", spec_.scale);
    h.extra.push_back({"data gain values", gains + "}"});
    e.type = EnviType::float32;
  }
  h.ignore_value = d.outside;
  if (temperature) h.ignore_value = h.type == EnviType::uint16 ? 0 : std::nan("");
  m.radiance = open(m, base, h);
  m.error = open(m, base + "_error", e);
}

void OutputWriter::open_truth(Image& m, const Delivery& d, const std::string& base, const EnviHeader& h,
                              const std::string& about) const {
  const std::vector<std::string>& names = d.result.truth_names;
  if (names.empty()) return;
  m.pictures = TruthPicture::of(names, spec_.preview_of(d.sensor.name()), m.columns, m.rows);
  m.truth = open(m, base + "_truth", truth_header(h, names, notes_, about));
  for (const ClassSource& source :
       {ClassSource{"material", "nothing", notes_.materials}, ClassSource{"tag", "untagged", notes_.tags}})
    if (const auto at = std::find(names.begin(), names.end(), source.truth); at != names.end() && !source.names.empty())
      m.classes.push_back({static_cast<size_t>(at - names.begin()),
                           open(m, base + "_" + source.truth, class_header(h, source, about))});
}

OutputWriter::Image& OutputWriter::image_of(const Delivery& d, const std::string& stem) {
  std::unique_ptr<Image>& slot = open_[stem];
  if (slot) return *slot;
  slot = std::make_unique<Image>();
  Image& m = *slot;
  const OutputSpec::Files files = files_of(d.rows);
  m.columns = d.result.columns;
  m.rows = files == OutputSpec::Files::capture ? d.result.rows
           : files == OutputSpec::Files::task  ? d.rows.rows_of_task
                                               : d.rows.rows_of_all;
  m.values = d.result.values_per_problem();
  m.wishes = d.sensor.wishes(d.sensor.tasks()[d.result.task].captures[d.result.capture]);
  if (m.wishes.geolocation) m.located.emplace(m.columns, m.rows, m.wishes, spec_.geotiff);
  const PreviewSpec& preview = spec_.preview_of(d.sensor.name());
  m.display = display_of(d.bands, preview);
  m.preview.emplace(d.bands, m.display.bands, preview, m.columns, m.rows);
  m.map = d.map;
  if (m.map)
    if (const std::string off = map_offset(*m.map, m.columns, m.rows, notes_.origin); !off.empty())
      emit({Dr::map_offset, "sensor '" + d.sensor.name() + "': " + off});
  const std::string& lines = files == OutputSpec::Files::task ? d.lines_of_task : d.lines_of_all;
  const std::string& said = files == OutputSpec::Files::capture || lines.empty() ? d.description : lines;
  m.description = said.empty() ? "" : "; " + said;
  m.who = " of sensor '" + d.sensor.name() + "'";
  const std::string base = in_folder(folder_, stem), about = m.who + m.description + "; " + notes_.engine;
  const EnviHeader h = common_header(m, d);
  open_radiance(m, d, base, about);
  m.quality = open(m, base + "_quality", quality_header(h, about));
  open_truth(m, d, base, h, about);
  for (const Product& p : d.products) {
    EnviHeader x = h;
    x.bands = p.bands.size(), x.band_names = p.bands, x.data_units = p.unit;
    if (x.bands != x.wavelength_um.size()) x.wavelength_um.clear(), x.fwhm_um.clear(), x.default_bands.clear();
    x.type = p.whole_numbers                           ? EnviType::uint16
             : spec_.type == OutputSpec::Type::float64 ? EnviType::float64
                                                       : EnviType::float32;
    x.description = p.name + about;
    m.products.push_back(open(m, base + "_" + p.name, x));
    if (p.name == "polarisation") m.polarisation.emplace(m.columns, m.rows);
  }
  return m;
}

// When the rows were taken and where the sun stood, in the headers of all files; known once the last row is there.
void OutputWriter::add_acquisition_time(Image& m) const {
  const double begin = m.window->begin, end = m.window->end, middle = 0.5 * (begin + end);
  const bool lasts = end > begin;
  const std::string utc = facts_.utc(middle);
  std::vector<std::pair<std::string, std::string>> extra;
  if (lasts && !utc.empty())
    extra.push_back({"acquisition time range", "{" + facts_.utc(begin) + ", " + facts_.utc(end) + "}"});
  const std::optional<FarDisk> sun = facts_.sun(middle);
  if (sun && facts_.sun_moves() && lasts) {
    const auto first = azimuth_elevation_deg(facts_.sun(begin)->direction),
               last = azimuth_elevation_deg(facts_.sun(end)->direction);
    extra.push_back({"sun azimuth range", strf("{%.9g, %.9g}", first[0], last[0])});
    extra.push_back({"sun elevation range", strf("{%.9g, %.9g}", first[1], last[1])});
  }
  for (EnviWriter* w : m.writers()) {
    EnviHeader& h = w->header();
    h.acquisition_time = utc;
    if (sun) {
      const auto stands = azimuth_elevation_deg(sun->direction);
      h.sun_azimuth_deg = stands[0], h.sun_elevation_deg = stands[1];
    }
    h.extra.insert(h.extra.end(), extra.begin(), extra.end());
  }
}

// The formats that take a whole picture: radiance, and the flags in a file of their own.
void OutputWriter::write_whole(Image& m, const std::string& base) const {
  if (!spec_.geotiff && !spec_.exr) return;
  const EnviHeader& h = m.radiance->header();
  FloatRaster r;
  r.width = m.columns, r.height = m.rows;
  for (size_t b = 0; b < m.values; ++b) r.bands.push_back({h.band_names[b], h.wavelength_um[b], h.fwhm_um[b]});
  r.units = h.data_units;
  r.display = m.display.bands, r.true_colour = m.display.true_colour;
  // What these formats hold is never a count.
  r.no_data = m.wishes.quantity == Quantity::brightness_temperature ? std::optional(std::nan("")) : h.ignore_value;
  r.utc = h.acquisition_time;
  if (h.sun_azimuth_deg) r.sun_deg = {*h.sun_azimuth_deg, *h.sun_elevation_deg};
  r.comment = strf("suite %s: ", kVersion) + command_line() + m.description;
  if (m.map) {
    r.placement = RasterPlacement{m.map->origin.x, m.map->origin.y, m.map->gsd_x, m.map->gsd_y, {}};
    if (notes_.origin.given) r.placement->origin_deg = {notes_.origin.latitude_deg, notes_.origin.longitude_deg};
  }
  if (spec_.geotiff && m.located) m.located->add_control(base + ".tif", r);
  FloatRaster q = r;
  q.bands = {{"quality"}}, q.units.clear(), q.display.clear(), q.true_colour = false, q.no_data.reset();
  const auto write = [&](auto function, const std::string& ending) {
    function(base + ending, r, m.all);
    function(base + "_quality" + ending, q, m.all_quality);
    m.files.insert(m.files.end(), {base + ending, base + "_quality" + ending});
  };
  if (spec_.geotiff) {
    write(write_float_tiff, ".tif");
    const bool as_previewed = m.preview->in_kelvin()
                                  ? m.wishes.quantity == Quantity::brightness_temperature
                                  : m.wishes.quantity == Quantity::radiance && spec_.units == OutputSpec::Units::w_m2;
    const RasterStyle style = m.preview->style(m.all, m.values, as_previewed);
    write_qgis_style(base + ".qml", style);
    write_qgis_style(base + "_quality.qml", quality_style());
    m.files.insert(m.files.end(), {base + ".qml", base + "_quality.qml"});
    if (m.located) {
      const auto more = m.located->write_rasters(base, r, m.all, m.all_quality);
      m.files.insert(m.files.end(), more.begin(), more.end());
      if (m.located->mapped()) {
        write_qgis_style(base + "_map.qml", style);
        m.files.push_back(base + "_map.qml");
      }
    }
  }
  if (spec_.exr) write(write_exr, ".exr");
}

// Numbers of a capture into the files, in the order of their rows.
void OutputWriter::append(Image& m, const Delivery& d) const {
  const CaptureResult& result = d.result;
  const size_t n = result.problems();
  std::vector<double> radiance = result.radiance, error = result.standard_error;
  Conversion(d, m.wishes.quantity, spec_.units, facts_).apply(radiance, error);
  for (double& x : radiance) {
    if (spec_.geotiff || spec_.exr) m.all.push_back(static_cast<float>(x));
    if (std::isnan(x)) ++m.unknown;
    if (spec_.type != OutputSpec::Type::uint16) continue;
    x = std::isnan(x) ? 0 : std::clamp(std::round(x / spec_.scale), 0.0, 65535.0);
  }
  m.preview->append(result);
  for (TruthPicture& picture : m.pictures) picture.append(result);
  m.radiance->append(radiance);
  m.error->append(error);
  m.quality->append(std::vector<double>(result.quality.begin(), result.quality.end()));
  if (spec_.geotiff || spec_.exr)
    m.all_quality.insert(m.all_quality.end(), result.quality.begin(), result.quality.end());
  const size_t columns = result.truth_names.size();
  if (m.truth) m.truth->append(result.truth);
  for (Image::Classes& c : m.classes) {
    std::vector<double> values(n);
    for (size_t i = 0; i < n; ++i) {
      const double id = result.truth[i * columns + c.column];
      values[i] = std::isnan(id) ? 0 : id + 1;
    }
    c.file->append(values);
  }
  if (m.located) m.located->append(d, m.next);
  for (size_t p = 0; p < m.products.size(); ++p) {
    m.products[p]->append(d.products[p].values);
    if (d.products[p].name == "polarisation") m.polarisation->append(result, d.products[p]);
  }
  // Of an image in parts the correlation is the mean over its rows.
  m.correlation.resize(result.bands * result.bands);
  for (size_t i = 0; i < m.correlation.size(); ++i) m.correlation[i] += result.error_correlation[i] * result.rows;
  const TimeWindow& window = d.sensor.tasks()[result.task].captures[result.capture].window;
  if (!m.window) m.window = window;
  m.window = TimeWindow{std::min(m.window->begin, window.begin), std::max(m.window->end, window.end)};
  m.next += result.rows;
}

void OutputWriter::finish(Image& m, const std::string& base, std::span<const Band> bands) {
  add_acquisition_time(m);
  for (EnviWriter* w : m.writers()) w->commit();
  if (m.located) {
    const std::string about = m.who + m.description + "; " + notes_.engine;
    const double scale = spec_.type == OutputSpec::Type::uint16 ? spec_.scale : 1;
    const auto more = m.located->write_tables({base, m.radiance->header(), about, scale}, notes_.origin);
    m.files.insert(m.files.end(), more.begin(), more.end());
  }
  write_whole(m, base);
  std::string correlation = "# correlation of the standard errors of the bands; 1 = they err together\nband";
  for (const Band& b : bands) correlation += "," + b.name;
  for (size_t a = 0; a < bands.size(); ++a) {
    correlation += "\n" + bands[a].name;
    for (size_t b = 0; b < bands.size(); ++b)
      correlation += strf(",%.4f", m.correlation[a * bands.size() + b] / m.rows);
  }
  m.files.push_back(base + "_error_correlation.csv");
  write_file(m.files.back(), correlation + "\n");
  m.preview->write(base + ".png");
  m.files.push_back(base + ".png");
  if (m.polarisation) {
    m.files.push_back(base + "_polarisation.png");
    m.polarisation->write(m.files.back());
  }
  for (const TruthPicture& picture : m.pictures) {
    m.files.push_back(base + "_" + picture.name() + ".png");
    picture.write(m.files.back());
  }
  if (m.unknown && m.wishes.quantity == Quantity::brightness_temperature)
    emit({Dr::no_brightness_temperature,
          strf("'%s.img': %zu of %zu values have no brightness temperature between 10 and 20 000 K (their radiance is "
               "zero, say); they are the header's data ignore value",
               base.c_str(), m.unknown, size_t{m.columns} * m.rows * m.values)});
  for (const std::string& file : m.files) note("wrote " + file);
}

void OutputWriter::take(const Delivery& delivery) {
  for (const TextFile& text : delivery.texts) write_text(text);
  if (!delivery.picture) return;
  const std::string stem = stem_of(delivery.rows, files_of(delivery.rows));
  Image& m = image_of(delivery, stem);
  const OutputSpec::Files files = files_of(delivery.rows);
  const uint32_t at = files == OutputSpec::Files::capture ? 0
                      : files == OutputSpec::Files::task  ? delivery.rows.row_in_task
                                                          : delivery.rows.row_in_all;
  m.waiting.emplace(at, delivery);
  // Captures may finish in any order; rows are written in theirs.
  for (auto next = m.waiting.find(m.next); next != m.waiting.end(); next = m.waiting.find(m.next)) {
    append(m, next->second);
    m.waiting.erase(next);
  }
  if (m.next < m.rows) return;
  finish(m, in_folder(folder_, stem), delivery.bands);
  open_.erase(stem);
}

void OutputWriter::write_text(const TextFile& text) {
  const std::string path = in_folder(folder_, text.name);
  write_file(path, std::string_view(text.text));
  note("wrote " + path);
}

}  // namespace suite
