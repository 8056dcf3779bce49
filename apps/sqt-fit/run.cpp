#include "run.h"

#include <chrono>
#include <filesystem>
#include <functional>

#include "base/error.h"
#include "base/files.h"
#include "base/inputs.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "input.h"
#include "page/page.h"
#include "sqt_fit/fit.h"

namespace suite {

namespace {

constexpr size_t kReferencePairs = 200000;

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// What is to be written, with what is to be said about it.
struct Outcome {
  std::vector<std::byte> file;
  std::shared_ptr<const sqt::Bundle> bundle;
  std::vector<sqt::ErrorFigures> errors;
  bool error_met = true, bytes_met = true, peak_met = true;
};

// Heights of lobes that are asked for when the user says nothing.
constexpr double kSurfacePeak = 0.9, kPhasePeak = 0.98;
double min_peak(const SqtFitOptions& o, const FitInput& input) {
  if (o.min_peak >= 0) return o.min_peak;
  return input.function->info().quantity == sqt::Quantity::phase ? kPhasePeak : kSurfacePeak;
}

void check_options(const SqtFitOptions& o) {
  if (o.input.empty() == o.model.empty()) throw UsageError("give one input file or --model");
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

// Numbers about the input that no physical surface has; errors under --strict.
void judge_input(const FitInput& input, const sqt::Reference& reference, bool strict) {
  const sqt::Reference::Findings& f = reference.findings();
  auto say = [&](const std::string& text, const std::string& done) {
    if (strict) throw Error(Where{input.provenance.input, 0, 0, {}, -1}, text, "leave out --strict to have it " + done);
    warn(input.provenance.input + ": " + text + "; " + done);
  };
  const bool surface = input.function->info().quantity == sqt::Quantity::bsdf;
  if (surface && f.largest_total > 1.0005)
    say(strf("directional-hemispherical total of %.4f exceeds 1", f.largest_total), "clamped to 1");
  if (f.negative_share > 0) say(strf("%.3g %% of the values are negative", 100 * f.negative_share), "taken as 0");
  if (surface && f.reciprocity_error > 0.02)
    say(strf("not reciprocal: mean difference %.2g %%", 100 * f.reciprocity_error), "fitted as it is");
}

sqt::AlignedSource::Options source_options(const SqtFitOptions& o) {
  sqt::AlignedSource::Options options;
  if (o.views) options.views = static_cast<size_t>(o.views);
  if (o.order)
    options.order_fixed = true, options.max_order = static_cast<int>(o.order),
    options.base_order = std::min(options.base_order, options.max_order);
  return options;
}

// What the frame around trees and totals takes: known once something has been packed. The figures of error are not
// known yet; digits without pattern compress as badly as theirs, and 64 bytes are left for luck.
size_t container_bytes(const FitInput& input, const sqt::AlignedSource& source) {
  const sqt::AlignedFit first = sqt::encode_aligned(source, 1.0);
  double last = 0;
  auto digits = [&last] { return last = std::fmod(last + 0.6180339887498949, 1.0); };
  std::vector<sqt::ErrorFigures> errors(input.function->info().wavelength_um.size() + 1);
  for (sqt::ErrorFigures& e : errors)
    e = {digits(), digits(), digits(), digits(), digits(), digits(), digits(), digits(), digits()};
  return pack_sqt(first, input.provenance, errors).size() - first.sheets_bytes.size() - first.totals_bytes.size() + 64;
}

sqt::PaperOptions paper_options(const SqtFitOptions& o) {
  sqt::PaperOptions options;
  if (o.views) options.views = static_cast<size_t>(o.views);
  if (o.order) options.order = static_cast<int>(o.order);
  options.threshold = o.threshold;
  return options;
}

// Promises that were not kept, and lobes that are too low or too high; errors under --strict.
void judge_fit(const SqtFitOptions& o, const FitInput& input, const sqt::Reference& reference, const Outcome& out) {
  std::string text;
  auto add = [&text](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (!out.bytes_met) add(strf("%lld bytes cannot be kept: the smallest file has %zu", o.max_bytes, out.file.size()));
  if (!out.error_met)
    add(strf("an error of %g cannot be kept: %s has %.4g", o.max_error, o.max_bytes ? "this fit" : "the best fit",
             out.errors.back().l1));
  if (!out.peak_met) {
    const std::array<double, 3> peaks = reference.least_peaks(*out.bundle);
    const std::string low =
        strf("lobes at view angles of 20/45/70 deg reach %.3f %.3f %.3f of the data's, %g is asked for (--min-peak)",
             peaks[0], peaks[1], peaks[2], min_peak(o, input));
    if (o.min_peak >= 0)
      add(low);
    else
      warn(low);  // nobody asked for it
  }
  if (!text.empty() && o.strict)
    throw Error(Where{input.provenance.input, 0, 0, {}, -1}, text, "relax the target or leave out --strict");
  if (!text.empty()) warn(text);
  const double allowed = min_peak(o, input);
  for (size_t c = 0; c + 1 < out.errors.size() && allowed > 0; ++c) {
    const sqt::ErrorFigures& e = out.errors[c];
    if (std::max({e.peak_ratio_20, e.peak_ratio_45, e.peak_ratio_70}) * allowed <= 1) continue;
    warn(strf("lobes at view angles of 20/45/70 deg are %.3f %.3f %.3f of the data's at %g um: higher than measured",
              e.peak_ratio_20, e.peak_ratio_45, e.peak_ratio_70, input.function->info().wavelength_um[c]));
    break;
  }
}

Json report_json(const SqtFitOptions& o, const FitInput& input, const Outcome& out, double seconds) {
  Json j = Json::object();
  j.set("input", input.provenance.input);
  j.set("method", o.method);
  j.set("bytes", out.file.size());
  j.set("leaves", out.bundle->info().leaves);
  j.set("max_order", out.bundle->info().max_order);
  j.set("frame", out.bundle->info().frame);
  j.set("seconds", seconds);
  j.set("error_met", out.error_met);
  j.set("bytes_met", out.bytes_met);
  j.set("peak_met", out.peak_met);
  if (o.method == "aligned") j.set("min_peak", min_peak(o, input));
  j.set("conventions", input.provenance.conventions);
  j.set("units", "value 1/sr without cosine; rmse 1/sr; other errors relative");
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

void print_summary(const SqtFitOptions& o, const Outcome& out, double seconds) {
  const sqt::ErrorFigures& e = out.errors.back();
  note(strf("%s: %zu bytes, %zu leaves to order %d, %.2f s", o.method.c_str(), out.file.size(),
            out.bundle->info().leaves, out.bundle->info().max_order, seconds));
  note(strf("  l1 %.2f %%  cos_rmse %.2f %%  rmse %.3g /sr  total_error %.2g %%  reciprocity_error %.2g %%", 100 * e.l1,
            100 * e.cos_rmse, e.rmse, 100 * e.total_error, 100 * e.reciprocity_error));
  note(strf("  peaks at 20/45/70 deg: %.3f %.3f %.3f of the data; largest sampling weight %.2f", e.peak_ratio_20,
            e.peak_ratio_45, e.peak_ratio_70, e.max_weight));
}

// Error against size and time over a range of the method's knob.
void write_curve(const SqtFitOptions& o, const FitInput& input, const sqt::Reference& reference,
                 const sqt::AlignedSource* source) {
  std::string csv = "method,knob,bytes,leaves,seconds,l1,cos_rmse,rmse\n";
  auto row = [&](double knob, size_t bytes, const sqt::Bundle& bundle, double seconds) {
    const sqt::ErrorFigures e = reference.measure(bundle).back();
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
  check_places(o);
  const FitInput input = load_input(o);
  make_folders_of({o.output, o.report, o.curve});
  const Stopwatch watch;
  Progress progress("fitting", 100, "%");
  auto advance = [&](double share) {
    return [&progress, share](double fraction) { progress.add(100 * share * fraction); };
  };
  const sqt::Reference reference(*input.function, kReferencePairs, 1, advance(0.2));
  judge_input(input, reference, o.strict);
  Outcome out;
  std::unique_ptr<sqt::AlignedSource> source;
  if (o.method == "aligned") {
    const sqt::FitTarget target{o.max_error, static_cast<size_t>(o.max_bytes), min_peak(o, input)};
    sqt::FitResult result = sqt::fit_to(
        *input.function, reference, source_options(o), target,
        [&](const sqt::AlignedSource& s) { return container_bytes(input, s); }, advance(0.8));
    source = std::move(result.source);
    out.bundle = sqt::make_bundle(result.fit.data);
    out.errors = reference.measure(*out.bundle);
    out.file = pack_sqt(result.fit, input.provenance, out.errors);
    out.error_met = result.error_met;
    out.peak_met = result.peak_met;
    out.bytes_met = !o.max_bytes || out.file.size() <= static_cast<size_t>(o.max_bytes);
  } else {
    const sqt::PaperData data = sqt::fit_paper(*input.function, paper_options(o), advance(0.8));
    out.bundle = sqt::make_bundle(data);
    out.errors = reference.measure(*out.bundle);
    out.file = pack_sqt(data, input.provenance, out.errors);
  }
  progress.finish();
  const double seconds = watch.seconds();
  print_summary(o, out, seconds);
  judge_fit(o, input, reference, out);
  if (!o.output.empty()) write_file(o.output, out.file);
  if (!o.report.empty()) write_file(o.report, report_json(o, input, out, seconds).text());
  if (!o.curve.empty()) write_curve(o, input, reference, source.get());
  return 0;
}

}  // namespace suite
