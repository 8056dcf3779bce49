#include "run.h"

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/inputs.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "fit.h"
#include "folder.h"
#include "page/page.h"

namespace suite {

namespace {

bool is_folder(const SqtFitOptions& o) {
  std::error_code unknown;  // a loop of links, say: opening it says what is wrong
  return !o.input.empty() && std::filesystem::is_directory(o.input, unknown);
}

// What a folder's table asks of the options.
void check_folder_options(const SqtFitOptions& o) {
  if (std::filesystem::path(o.output).extension() != ".csv")
    throw UsageError("of a folder of files give -o TABLE.csv; --fits FOLDER keeps the fits themselves");
  if (!o.report.empty() || !o.curve.empty()) throw UsageError("--report and --curve are of one file, not of a folder");
}

void check_options(const SqtFitOptions& o) {
  if (o.input.empty() == o.model.empty()) throw UsageError("give one input file, a folder of them, or --model");
  if (is_folder(o))
    check_folder_options(o);
  else if (!o.fits.empty())
    throw UsageError("--fits goes with a folder of files");
  if (o.swap && o.input.empty())
    throw UsageError("--swap goes with a file: models know which direction is the light's");
  if (o.output.empty() && o.report.empty() && o.curve.empty())
    throw UsageError("give -o FILE.sqt (or --report, --curve)");
  if (std::filesystem::path(o.curve).extension() == ".html")
    throw UsageError("--curve names the table, FILE.csv; its page FILE.html stands beside it");
  if (o.method != "aligned" && o.method != "paper") throw UsageError("--method is 'aligned' or 'paper'");
  const bool paper = o.method == "paper";
  if (paper && (o.max_error != 0 || o.max_bytes != 0))
    throw UsageError("--max-error and --max-bytes need --method aligned; see --threshold and --curve");
  if (paper && o.min_peak >= 0) throw UsageError("--min-peak needs --method aligned");
  if (!(o.min_peak <= 1)) throw UsageError(strf("--min-peak %g is out of range; give 0 to 1", o.min_peak));
  if (o.order && (o.order < (paper ? 1 : 3) || o.order > (paper ? 8 : 12)))
    throw UsageError(strf("--order %lld is out of range; give %s, or 0", o.order, paper ? "1 to 8" : "3 to 12"));
  if (o.views && (o.views < 2 || o.views > 64))
    throw UsageError(strf("--views %lld is out of range; give 2 to 64, or 0", o.views));
  if (!(o.mueller_error >= 0 && o.mueller_error <= 1))
    throw UsageError(strf("--mueller-error %g is out of range; give 0 to 1", o.mueller_error));
  if (!(o.max_error >= 0) || o.max_bytes < 0 || !(o.threshold >= 0))
    throw UsageError("--max-error, --max-bytes and --threshold must not be negative");
}

// Outputs that would replace the input or each other, before any time is spent.
void check_places(const SqtFitOptions& o) {
  namespace fs = std::filesystem;
  std::vector<std::string> files{o.output, o.report, o.curve};
  if (!o.curve.empty()) files.push_back(fs::path(o.curve).replace_extension(".html").string());
  note_input(o.input);
  if (const size_t at = o.model.find("table=@"); at != std::string::npos) note_input(o.model.substr(at + 7));
  check_outputs(files);
}

Json report_json(const SqtFitOptions& o, const FitInput& input, const Outcome& out) {
  Json j = Json::object();
  j.set("input", input.provenance.input);
  j.set("method", o.method);
  j.set("bytes", out.file.size());
  j.set("leaves", out.bundle->info().leaves);
  j.set("max_order", out.bundle->info().max_order);
  j.set("frame", out.bundle->info().frame);
  j.set("seconds", out.seconds);
  j.set("error_met", out.error_met);
  j.set("bytes_met", out.bytes_met);
  j.set("peak_met", out.peak_met);
  if (o.method == "aligned") j.set("min_peak", min_peak(o, input));
  j.set("conventions", input.provenance.conventions);
  j.set("units", "value 1/sr without cosine; rmse 1/sr; other errors relative");
  if (out.mueller) {
    Json m = mueller_error_json(out.mueller->errors);
    m.set("changed", out.mueller->changed);
    j.set("mueller", std::move(m));
  }
  j.set("overall", error_json(out.errors.back()));
  Json channels = Json::array();
  for (size_t c = 0; c + 1 < out.errors.size(); ++c) {
    Json e = error_json(out.errors[c]);
    e.set("wavelength_um", input.function->info().wavelength_um[c]);
    channels.push(std::move(e));
  }
  j.set("channels", std::move(channels));
  return j;
}

void print_summary(const SqtFitOptions& o, const Outcome& out) {
  const sqt::ErrorFigures& e = out.errors.back();
  note(strf("%s: %zu bytes, %zu leaves to order %d, %.2f s", o.method.c_str(), out.file.size(),
            out.bundle->info().leaves, out.bundle->info().max_order, out.seconds));
  note(strf("  l1 %.2f %%  cos_rmse %.2f %%  rmse %.3g /sr  total_error %.2g %%  reciprocity_error %.2f %%", 100 * e.l1,
            100 * e.cos_rmse, e.rmse, 100 * e.total_error, 100 * e.reciprocity_error));
  note(strf("  peaks at 20/45/70 deg: %.3f %.3f %.3f of the data; largest sampling weight %.2f", e.peak_ratio_20,
            e.peak_ratio_45, e.peak_ratio_70, e.max_weight));
  if (!out.mueller) return;
  const sqt::MuellerFit& m = *out.mueller;
  const sqt::HalfGrid& g = m.table->data().grid;
  note(strf(
      "  matrices at %zu x %zu x %zu angles (theta_h, theta_d, phi_d): rms %.2g of m11, by light %.2g, largest %.2g",
      g.theta_h.size(), g.theta_d.size(), g.phi_d.size(), m.errors.rms, m.errors.lit, m.errors.largest));
  if (m.changed > 0)
    note(strf(
        "  %.3g %% of the matrices could not exist (Cloude) and were made possible; the largest change is %.2g rms",
        100 * m.changed, m.most_changed));
}

// Error against size and time over a range of the method's knob.
void write_curve(const SqtFitOptions& o, const FitInput& input, const Outcome& out) {
  const sqt::AlignedSource* source = out.source.get();
  std::string csv = "method,knob,bytes,leaves,seconds,l1,cos_rmse,rmse\n";
  auto row = [&](double knob, size_t bytes, const sqt::Bundle& bundle, double seconds) {
    const sqt::ErrorFigures e = out.reference->measure(bundle).back();
    csv += strf("%s,%.6g,%zu,%zu,%.4g,%.6g,%.6g,%.6g\n", o.method.c_str(), knob, bytes, bundle.info().leaves, seconds,
                e.l1, e.cos_rmse, e.rmse);
  };
  Progress progress("curve", 10, "point");
  for (int k = 0; k < 10; ++k) {
    const Stopwatch watch;
    if (source) {
      const double quality = 0.01 * std::pow(2, 0.8 * k);
      const sqt::AlignedFit fit = sqt::encode_aligned(*source, quality);
      const size_t bytes = pack_sqt(fit, input.provenance, {}).size();
      row(quality, bytes, *sqt::make_bundle(fit.data), watch.seconds());
    } else {
      sqt::PaperOptions options = paper_options(o);
      options.threshold = k ? 0.01 * std::pow(2, 0.8 * (k - 1)) : 0;
      const sqt::PaperData data = sqt::fit_paper(*input.function, options);
      const size_t bytes = pack_sqt(data, input.provenance, {}).size();
      row(options.threshold, bytes, *sqt::make_bundle(data), watch.seconds());
    }
    progress.add(1);
  }
  progress.finish();
  write_file(o.curve, csv);
  // The same as a page to look at, beside the table.
  const std::string page = std::filesystem::path(o.curve).replace_extension(".html").string();
  write_file(page,
             html_of(page_of_csv("# " + command_line() + "\n# " + input.provenance.input +
                                     ": l1 and cos_rmse are relative, rmse is in 1/sr; seconds are of one fit\n" + csv,
                                 "Error against size and seconds", {"bytes", "seconds"}, {"l1", "cos_rmse", "rmse"},
                                 "method", o.curve)));
}

}  // namespace

int run_sqt_fit(const SqtFitOptions& o) {
  check_options(o);
  if (is_folder(o)) return fit_folder(o);
  check_places(o);
  const FitInput input = load_input(o);
  make_folders_of({o.output, o.report, o.curve});
  Progress progress("fitting", 100, "%");
  const Outcome out = fit_function(o, input, [&](double share) { progress.add(100 * share); });
  progress.finish();
  print_summary(o, out);
  judge_fit(o, input, out);
  if (!o.output.empty()) write_file(o.output, out.file);
  if (!o.report.empty()) write_file(o.report, report_json(o, input, out).text());
  if (!o.curve.empty()) write_curve(o, input, out);
  return 0;
}

}  // namespace suite
