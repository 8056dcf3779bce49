#include "view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>

#include "base/diagnostics.h"
#include "base/files.h"
#include "base/inputs.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "base/run_app.h"
#include "budget_options.h"
#include "formats/envi/envi.h"
#include "headers.h"
#include "page/live_page.h"
#include "page/packed.h"
#include "sensor/quality.h"

namespace suite {

namespace {

// One image of the folder, with what lies beside it.
struct Viewed {
  std::string name, base;  // base: folder and name
  EnviHeader values, errors;
  std::optional<EnviHeader> truth;                          // nothing: the sensor has none
  std::vector<std::pair<std::string, EnviHeader>> classes;  // "material", "tag": their names
};

std::string description(const EnviHeader& h, bool command) {
  const size_t end = h.description.rfind('\n');
  if (end == std::string::npos) return command ? "" : h.description;
  return command ? h.description.substr(end + 1) : h.description.substr(0, end);
}

// The names of the images, in the order of the alphabet.
std::vector<std::string> images_of(const std::string& folder) {
  std::error_code fault;
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, fault)) files.insert(entry.path().filename());
  if (fault) throw Error(Where{folder, 0, 0, {}, -1}, "is no folder of results that can be read: " + fault.message());
  std::vector<std::string> names;
  for (const std::string& file : files) {
    if (!file.ends_with(".img")) continue;
    const std::string name = file.substr(0, file.size() - 4);
    if (files.contains(name + "_error.img") && files.contains(name + "_quality.img")) names.push_back(name);
  }
  if (names.empty())
    throw Error(Where{folder, 0, 0, {}, -1}, "there is no image here with its errors and flags beside it",
                "-o names the folder of a finished run");
  return names;
}

// What lies beside an image must be of its size and run.
bool belongs(const EnviHeader& main, const EnviHeader& beside) {
  return main.samples == beside.samples && main.lines == beside.lines &&
         description(main, true) == description(beside, true);
}

Viewed open_viewed(const std::string& folder, const std::string& name) {
  const std::string base = in_folder(folder, name);
  Viewed v{name, base, read_envi_header(base + ".img"), read_envi_header(base + "_error.img"), {}, {}};
  const EnviHeader &main = v.values, flags = read_envi_header(base + "_quality.img");
  if (!belongs(main, v.errors) || !belongs(main, flags) || v.errors.bands != main.bands || flags.bands != 1)
    throw Error(Where{base + ".img", 0, 0, {}, -1}, "its errors or flags are those of another run or size",
                "render again into an empty folder");
  const auto there = [&](const std::string& product) {
    const std::string path = base + "_" + product + ".img";
    if (!file_exists(path)) return false;
    if (belongs(main, read_envi_header(path))) return true;
    emit({Dr::page_of_other_run, path + " is left out: it is of another run than " + name + ".img"});
    return false;
  };
  if (there("truth")) v.truth = read_envi_header(base + "_truth.img");
  for (const char* product : {"material", "tag"})
    if (there(product)) v.classes.push_back({product, read_envi_header(base + "_" + product + ".img")});
  return v;
}

const std::vector<std::string> kScripts{"cube_data.js",    "cube_spectra.js", "cube_places.js",
                                        "cube_regions.js", "cube_play.js",    "cube.js"};

// Characters of the file that an image takes at most when every n-th column and row is kept: steps of 16 and 9 bits for
// values and errors, and the heads of their blocks (page/steps.h).
double size_of(const Viewed& v, size_t step) {
  const auto kept = [&](size_t n) { return static_cast<double>((n + step - 1) / step); };
  const double truth = v.truth ? 4.0 * static_cast<double>(v.truth->bands) : 0;
  // Steps stand in whole blocks of 64 pixels.
  const double pixels = kept(v.values.samples) * kept(v.values.lines), filled = 64 * std::ceil(pixels / 64);
  const double blocks = 2 * static_cast<double>(v.values.bands) + 1 + truth / 4;
  return (206.0 / 64 * static_cast<double>(v.values.bands) * filled + (1 + truth) * pixels) * 4 / 3 +
         kLiveBlock * blocks;
}

// Numbers [band][pixel] of every `step`-th column and row. scale: what a stored number counts.
std::vector<float> read_kept(const std::string& path, size_t step, double scale = 1) {
  const EnviImage image(path);
  const EnviHeader& h = image.header();
  const size_t columns = (h.samples + step - 1) / step, rows = (h.lines + step - 1) / step, pixels = columns * rows;
  std::vector<float> all(h.bands * pixels);
  const size_t most = std::max<size_t>(1, (size_t{16} << 20) / (h.samples * h.bands));
  const size_t at_once = step > 1 ? 1 : most;
  for (size_t row = 0; row < rows; row += at_once) {
    const size_t n = std::min(at_once, rows - row);
    const std::vector<double> lines = image.read_lines(row * step, n);
    for (size_t r = 0; r < n; ++r)
      for (size_t c = 0; c < columns; ++c) {
        const double* from = &lines[(r * h.samples + c * step) * h.bands];
        for (size_t b = 0; b < h.bands; ++b)
          all[b * pixels + (row + r) * columns + c] = static_cast<float>(from[b] * scale);
      }
  }
  return all;
}

// What counts stand for, and NaN where the header says that there is no measurement.
std::vector<float> radiance_of(const Viewed& v, size_t step) {
  const EnviHeader& h = v.values;
  double scale = 1;
  for (const auto& [key, text] : h.extra)
    if (key == "data gain values") scale = std::strtod(text.c_str() + text.find_first_not_of("{ "), nullptr);
  std::vector<float> all = read_kept(v.base + ".img", step, scale);
  if (h.ignore_value && !std::isnan(*h.ignore_value)) {
    const float none = static_cast<float>(*h.ignore_value * scale);
    // A number that is none in one band is none in all: a pixel outside of a fisheye's circle, not a dark band.
    const size_t pixels = all.size() / h.bands;
    for (size_t p = 0; p < pixels; ++p) {
      bool nowhere = true;
      for (size_t b = 0; b < h.bands && nowhere; ++b) nowhere = all[b * pixels + p] == none;
      for (size_t b = 0; b < h.bands && nowhere; ++b) all[b * pixels + p] = NAN;
    }
  }
  return all;
}

// "range [m]" is a name and a unit.
Json truth_of(const std::string& column, const Viewed& v) {
  const size_t unit = column.rfind(" [");
  const bool has = unit != std::string::npos && column.ends_with("]");
  Json j = Json::object();
  const std::string name = has ? column.substr(0, unit) : column;
  j.set("name", name);
  j.set("unit", has ? column.substr(unit + 2, column.size() - unit - 3) : "");
  for (const auto& [product, header] : v.classes) {
    if (product != name) continue;
    Json classes = Json::array();
    for (size_t i = 1; i < header.classes.size(); ++i) {  // 0 = none, which the truth has as NaN
      const EnviClass& c = header.classes[i];
      Json one = Json::object();
      one.set("name", c.name);
      one.set("colour", strf("#%02x%02x%02x", c.rgb[0], c.rgb[1], c.rgb[2]));
      classes.push(std::move(one));
    }
    j.set("classes", std::move(classes));
  }
  return j;
}

double reach_of_95_percent(const EnviHeader& errors) {
  static constexpr std::string_view kBefore = "reaches ";
  const size_t at = errors.description.find(kBefore);
  return at == std::string::npos ? 0 : std::strtod(errors.description.c_str() + at + kBefore.size(), nullptr);
}

// Where the picture is: as a map, and where scene ENU is on the Earth.
void set_place(const Viewed& v, Json& j) {
  const std::vector<std::string>& m = v.values.map_info;
  if (m.size() >= 7 && (m[0] == "Orthographic" || m[0] == "Arbitrary")) {
    Json map = Json::object();
    map.set("west", std::strtod(m[3].c_str(), nullptr));
    map.set("north", std::strtod(m[4].c_str(), nullptr));
    map.set("dx", std::strtod(m[5].c_str(), nullptr));
    map.set("dy", std::strtod(m[6].c_str(), nullptr));
    j.set("map", std::move(map));
  }
  for (const auto& [key, text] : v.truth ? v.truth->extra : decltype(v.truth->extra){}) {
    double at[3];
    if (key != kSceneOrigin || std::sscanf(text.c_str(), " {%lf , %lf , %lf", at, at + 1, at + 2) != 3) continue;
    Json origin = Json::array();
    for (const double x : at) origin.push(x);
    j.set("origin", std::move(origin));
  }
}

Json about_image(const Viewed& v, size_t step) {
  const EnviHeader& h = v.values;
  Json j = Json::object();
  j.set("name", v.name);
  j.set("columns", (h.samples + step - 1) / step);
  j.set("rows", (h.lines + step - 1) / step);
  j.set("fullColumns", h.samples);
  j.set("fullRows", h.lines);
  j.set("step", step);
  j.set("unit", h.data_units);
  j.set("about", description(h, false));
  j.set("command", description(h, true));
  j.set("time", h.acquisition_time);
  j.set("quantity", h.description.substr(0, h.description.find(" of sensor")));
  j.set("reach", reach_of_95_percent(v.errors));
  Json bands = Json::array(), shown = Json::array(), truth = Json::array();
  for (size_t b = 0; b < h.bands; ++b) {
    Json band = Json::object();
    band.set("name", b < h.band_names.size() ? h.band_names[b] : strf("band %zu", b + 1));
    if (b < h.wavelength_um.size()) band.set("um", h.wavelength_um[b]);
    if (b < h.fwhm_um.size()) band.set("fwhm", h.fwhm_um[b]);
    bands.push(std::move(band));
  }
  for (const int b : h.default_bands) shown.push(b - 1);
  if (v.truth)
    for (const std::string& column : v.truth->band_names) truth.push(truth_of(column, v));
  set_place(v, j);
  j.set("bands", std::move(bands));
  j.set("shown", std::move(shown));
  j.set("truth", std::move(truth));
  return j;
}

Json about_flags() {
  Json flags = Json::array();
  for (const QualityBit& b : quality_bits()) {
    Json one = Json::object();
    one.set("bit", static_cast<int>(b.bit));
    one.set("name", b.name);
    one.set("meaning", b.meaning);
    flags.push(std::move(one));
  }
  return flags;
}

// Bands that are written one after the other, each as steps from the last one; but a browser that wants one band must
// read those that it is told from, so that every eighth stands by itself.
class Bands {
 public:
  Bands(LivePage& page, LiveKind kind) : page_(page), kind_(kind) {}
  void put(const std::string& id, Packed packed) {
    const bool alone = count_++ % 8 == 0;
    page_.steps(id, kind_, packed, alone ? std::nullopt : std::optional(LivePage::Base{id_, last_.codes}));
    id_ = id;
    last_ = std::move(packed);
  }

 private:
  LivePage& page_;
  LiveKind kind_;
  size_t count_ = 0;
  std::string id_;
  Packed last_;
};

// The blocks of an image, the bands of its picture first; begins the page when it is the first image. Returns what
// packing lost.
Json put_blocks(LivePage& page, const Viewed& v, size_t number, size_t step) {
  const size_t bands = v.values.bands;
  const std::string prefix = strf("i%zu.", number);
  const std::vector<float> values = radiance_of(v, step);
  const size_t pixels = values.size() / bands;
  double lost_values = 0, lost_errors = 0;
  std::vector<size_t> order;
  const auto once = [&](size_t b) {
    if (std::find(order.begin(), order.end(), b) == order.end()) order.push_back(b);
  };
  for (const int b : v.values.default_bands) once(static_cast<size_t>(b) - 1);
  if (order.empty()) once(0);  // what a page shows first
  const size_t first = order.size();
  for (size_t b = 0; b < bands; ++b) once(b);
  Bands value_bands(page, LiveKind::half), error_bands(page, LiveKind::log8);
  for (size_t i = 0; i < bands; ++i) {
    if (number == 0 && i == first) page.begin();
    Packed p = packed_half(std::span(values).subspan(order[i] * pixels, pixels));
    lost_values = std::max(lost_values, p.loss);
    value_bands.put(prefix + strf("v%zu", order[i]), std::move(p));
  }
  if (number == 0 && first == bands) page.begin();
  const std::vector<float> flags = read_kept(v.base + "_quality.img", step);
  std::vector<std::byte> bits(flags.size());
  std::transform(flags.begin(), flags.end(), bits.begin(), [](float f) { return static_cast<std::byte>(f); });
  page.data(prefix + "q", LiveKind::u8, bits);
  const std::vector<float> errors = read_kept(v.base + "_error.img", step);
  for (size_t b = 0; b < bands; ++b) {
    Packed p = packed_log8(std::span(errors).subspan(b * pixels, pixels));
    lost_errors = std::max(lost_errors, p.loss);
    error_bands.put(prefix + strf("e%zu", b), std::move(p));
  }
  if (v.truth) {
    const std::vector<float> truth = read_kept(v.base + "_truth.img", step);
    for (size_t t = 0; t < v.truth->bands; ++t)
      page.data(prefix + strf("t%zu", t), LiveKind::f32, std::as_bytes(std::span(truth).subspan(t * pixels, pixels)));
  }
  Json lost = Json::object();
  lost.set("values", lost_values);
  lost.set("errors", lost_errors);
  return lost;
}

Json about_page(const std::vector<Viewed>& images, size_t step) {
  Json about = Json::object(), list = Json::array();
  for (const Viewed& v : images) list.push(about_image(v, step));
  about.set("images", std::move(list));
  about.set("flags", about_flags());
  about.set("made", strf("suite %s: ", kVersion) + command_line());
  return about;
}

// The least step with which all images fit.
size_t step_for(const std::vector<Viewed>& images, double bytes) {
  size_t most = 1;
  for (const Viewed& v : images) most = std::max({most, v.values.samples, v.values.lines});
  const auto around = static_cast<double>(live_page_size(kScripts, about_page(images, most)));
  for (size_t step = 1;; ++step) {
    double all = around;
    for (const Viewed& v : images) all += size_of(v, step);
    if (all <= bytes) return step;
    if (step >= most)
      throw Error(
          strf("a page of these %zu images takes %s with one pixel of each", images.size(), human_bytes(all).c_str()),
          "give it more room with --view-size");
  }
}

// What does not go with --view.
void check_view_usage(const Cli& cli, const RenderOptions& o) {
  if (o.view.empty()) {
    if (cli.given("--view-size")) throw UsageError("--view-size belongs to --view");
    return;
  }
  const auto refuse = [&](const std::string& why, std::initializer_list<const char*> options) {
    for (const char* option : options)
      if (cli.given(option)) throw UsageError("--view " + why + ": leave out " + option);
  };
  refuse("shows finished pictures, of which there are none then",
         {"--part", "--study", "--dry-run", "--ranks", "--heat-only", "--convert", "--air"});
  if (o.simulation.empty())
    refuse("without a simulation shows what is in the folder of -o",
           {"--set", "--paths", "--target-error", "--time", "--seed", "--state", "--resume", "--more", "--merge",
            "--plan", "--heat", "--import-report", "--strict", "--plugin"});
}

}  // namespace

void write_view(const std::string& folder, const std::string& path, size_t room) {
  const double bytes = static_cast<double>(room);
  std::vector<Viewed> images;
  for (const std::string& name : images_of(folder)) images.push_back(open_viewed(folder, name));
  const size_t step = step_for(images, bytes);
  if (step > 1)
    emit({Dr::page_thinned, strf("%s keeps one in %zu columns and rows of the images alone, to stay within %s",
                                 path.c_str(), step, human_bytes(bytes).c_str())});
  make_folders_of({path});
  const std::string name = std::filesystem::path(in_folder(folder, "x")).parent_path().filename();
  LivePage page(path, "Results in " + name, kScripts, about_page(images, step));
  Json lost = Json::array();
  for (size_t i = 0; i < images.size(); ++i) lost.push(put_blocks(page, images[i], i, step));
  page.json("lost", lost);
  page.commit();
  note(strf("%s: %zu image%s, %s", path.c_str(), images.size(), images.size() == 1 ? "" : "s",
            human_bytes(static_cast<double>(file_size(path))).c_str()));
}

bool show_finished(const Cli& cli, const RenderOptions& o) {
  check_view_usage(cli, o);
  if (!o.simulation.empty()) return false;
  if (o.view.empty()) throw UsageError("a simulation text is required");
  write_view(o.output, o.view, view_bytes_of(o));
  return true;
}

int show_own(const RenderOptions& o) {
  const OwnResults own;
  if (!o.view.empty()) write_view(o.output, o.view, view_bytes_of(o));
  return 0;
}

}  // namespace suite
