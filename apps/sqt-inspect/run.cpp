#include "run.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/inputs.h"
#include "base/outputs.h"
#include "check.h"
#include "compare.h"
#include "export.h"
#include "formats/measured/measured.h"
#include "formats/sqt/sqt.h"
#include "header.h"
#include "map.h"
#include "optics/model_function.h"
#include "slice.h"
#include "view.h"

namespace suite {

namespace {

void require(const std::string& option, long long value, long long low, long long high) {
  if (value < low || value > high) throw UsageError(strf("%s takes %lld to %lld", option.c_str(), low, high));
}

std::vector<double> view_angles(const InspectOptions& o) {
  const std::vector<double> views = number_list("--views", o.views.empty() ? "0,20,45,70" : o.views, 1, 6);
  for (const double v : views)
    if (!(v >= 0 && v < 90)) throw UsageError("--views are 0 to below 90 deg");
  return views;
}

void check_usage(const InspectOptions& o, const sqt::Bundle& bundle) {
  if (o.channel < 0 || o.channel >= static_cast<long long>(bundle.channels()))
    throw UsageError(strf("--channel %lld: the file has channels 0 to %zu", o.channel, bundle.channels() - 1));
  require("--panels", o.panels, 1, 24);
  require("--pairs", o.pairs, 1000, 100000000);
  require("--sample", o.sample, 0, 100000000);
  require("--size", o.size, 16, 4096);
  if (!(o.zoom >= 0 && o.zoom <= 90)) throw UsageError("--zoom takes 0 to 90 deg");
  if (!o.views.empty()) view_angles(o);
  if (!o.compare.empty() && !o.compare_model.empty())
    throw UsageError("--compare and --compare-model exclude each other");
  if (!o.error_map.empty() && o.compare.empty() && o.compare_model.empty())
    throw UsageError("--error-map needs --compare or --compare-model");
  const int printing = !o.eval.empty() + (o.sample > 0) + o.check + (!o.compare.empty() || !o.compare_model.empty());
  if (printing > 1)
    throw UsageError("--check, --compare, --sample and --eval print their own results: ask one at a time");
}

// What the comparison is with, if it is asked for.
std::optional<Measured> read_data(const InspectOptions& o) {
  if (!o.compare_model.empty()) return Measured(model_function(o.compare_model));
  if (!o.compare.empty()) return read_measured(o.compare);
  return std::nullopt;
}

// Null for scattered samples, which have no value at every direction.
const sqt::Function* function_of(const Measured& data) {
  const auto* function = std::get_if<std::shared_ptr<const sqt::Function>>(&data);
  return function ? function->get() : nullptr;
}

void write_picture(const std::string& path, const Canvas& canvas) {
  write_png(path, canvas, command_line());
  note("wrote " + path);
}

void draw_pictures(const InspectOptions& o, const sqt::Bundle& bundle, const std::optional<Measured>& data) {
  const size_t channel = static_cast<size_t>(o.channel);
  const std::string& name = bundle.info().function.name;
  if (!o.map.empty()) {
    MapOptions m;
    m.channel = channel;
    m.panels = static_cast<size_t>(o.panels);
    if (!o.views.empty()) m.view_deg = view_angles(o);
    m.zoom_deg = o.zoom;
    m.panel_size = static_cast<int>(o.size);
    m.edges = !o.no_edges;
    write_picture(o.map, draw_map(bundle, name, m));
  }
  if (!o.slice.empty()) {
    write_file(o.slice, "# " + command_line() + "\n" + slice_csv(bundle, view_angles(o)));
    note("wrote " + o.slice);
  }
  if (!o.plot.empty())
    write_picture(o.plot, slice_plot(bundle, view_angles(o), channel, name, data ? function_of(*data) : nullptr));
  if (!o.sphere.empty()) write_picture(o.sphere, draw_sphere(bundle, static_cast<int>(o.size)));
}

int run_check(const InspectOptions& o, const sqt::Bundle& bundle) {
  const Report report = check_bundle(bundle, o.file, 100000);
  std::fputs((o.json ? report.json() : report.text()).c_str(), stdout);
  return report.ok() ? 0 : 1;
}

void run_compare(const InspectOptions& o, const sqt::Bundle& bundle, const Measured& data) {
  const sqt::Function* function = function_of(data);
  const Comparison result = function ? compare(bundle, *function, static_cast<size_t>(o.pairs))
                                     : compare(bundle, std::get<sqt::Samples>(data));
  std::fputs((o.json ? result.json().text() : result.text()).c_str(), stdout);
  if (o.error_map.empty()) return;
  write_picture(o.error_map, draw_errors(bundle, *function, static_cast<size_t>(o.channel),
                                         bundle.info().function.name + ": (fit - data) / (fit + data)"));
}

Dir direction(double theta_deg, double phi_deg) {
  if (!(theta_deg >= 0 && theta_deg <= 180)) throw UsageError("zenith angles are 0 to 180 deg");
  return dir_from_angles(theta_deg * kDegree, phi_deg * kDegree);
}

void run_eval(const InspectOptions& o, const sqt::Bundle& bundle) {
  const std::vector<double> a = number_list("--eval", o.eval, 5, 5);
  const std::vector<double>& um = bundle.info().function.wavelength_um;
  const auto [low, high] = std::ranges::minmax(um);  // channels of colours descend
  if (a[4] < low || a[4] > high)
    warn(strf("the fit stands for %g to %g um: at %g um the value at its nearer end is printed", low, high, a[4]));
  const Answer r = answer(bundle, direction(a[0], a[1]), direction(a[2], a[3]), a[4]);
  std::printf("f_per_sr %.9g\nw_per_sr %.9g\npdf_per_sr %.9g\ntotal %.9g\n", r.f, r.w, r.pdf, r.total);
}

void run_sample(const InspectOptions& o, const sqt::Bundle& bundle) {
  const std::vector<double> a = number_list("--out", o.out, 2, 2);
  std::fputs(sample_csv(bundle, direction(a[0], a[1]), static_cast<size_t>(o.channel), static_cast<size_t>(o.sample),
                        static_cast<uint64_t>(o.seed))
                 .c_str(),
             stdout);
}

}  // namespace

int inspect(const Cli&, const InspectOptions& o) {
  for (const std::string& input : {o.file, o.compare}) note_input(input);
  check_outputs({o.map, o.slice, o.plot, o.sphere, o.error_map, o.view, o.export_to});
  check_export(o);
  const SqtFile file = read_sqt(o.file);
  const sqt::Bundle& bundle = *file.bundle;
  check_usage(o, bundle);
  const std::optional<Measured> data = read_data(o);
  if (data)
    require_same_channels(bundle, function_of(*data) ? function_of(*data)->info() : std::get<sqt::Samples>(*data).info);
  if (data && !function_of(*data) && (!o.error_map.empty() || !o.plot.empty()))
    throw Error(Where{o.compare, 0, 0, {}, -1}, "scattered samples have no value at every direction",
                "--error-map and --plot compare with MERL, RGL and models only");
  make_folders_of({o.map, o.slice, o.plot, o.sphere, o.error_map, o.view, o.export_to});
  draw_pictures(o, bundle, data);
  if (!o.view.empty()) write_lobe_view(bundle, o.view);
  if (!o.export_to.empty()) export_bundle(o, file);
  if (o.check) return run_check(o, bundle);
  if (data)
    run_compare(o, bundle, *data);
  else if (!o.eval.empty())
    run_eval(o, bundle);
  else if (o.sample > 0)
    run_sample(o, bundle);
  else if (o.json || (o.map + o.slice + o.plot + o.sphere + o.view + o.export_to).empty())
    std::fputs((o.json ? header_json(file, o.file).text() : printable_lines(header_text(file, o.file))).c_str(),
               stdout);
  return 0;
}

}  // namespace suite
