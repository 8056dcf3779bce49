#include "fit.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/run_app.h"
#include "sqt/reciprocity.h"

namespace suite {

namespace {

constexpr size_t kReferencePairs = 200000;
// Heights of lobes that are asked for when the user says nothing.
constexpr double kSurfacePeak = 0.9, kPhasePeak = 0.98;

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
  if (surface && f.reciprocity_error > sqt::kNotReciprocal)
    say(strf("the data are not reciprocal: reciprocity_error %.2f %%", 100 * f.reciprocity_error),
        "fitted as they are");
}

sqt::AlignedSource::Options source_options(const SqtFitOptions& o) {
  sqt::AlignedSource::Options options;
  if (o.views) options.views = static_cast<size_t>(o.views);
  if (o.order)
    options.order_fixed = true, options.max_order = static_cast<int>(o.order),
    options.base_order = std::min(options.base_order, options.max_order);
  return options;
}

using MuellerPtr = std::shared_ptr<const sqt::MuellerTable>;

// What the frame around trees and totals takes: known once something has been packed. The figures of error are not
// known yet; digits without pattern compress as badly as theirs, and 64 bytes are left for luck.
size_t container_bytes(const SqtProvenance& provenance, const sqt::AlignedSource& source, size_t channels,
                       const MuellerPtr& mueller) {
  sqt::AlignedFit first = sqt::encode_aligned(source, 1.0);
  first.data.mueller = mueller;
  double last = 0;
  auto digits = [&last] { return last = std::fmod(last + 0.6180339887498949, 1.0); };
  std::vector<sqt::ErrorFigures> errors(channels + 1);
  for (sqt::ErrorFigures& e : errors)
    e = {digits(), digits(), digits(), digits(), digits(), digits(), digits(), digits(), digits()};
  return pack_sqt(first, provenance, errors).size() - first.sheets_bytes.size() - first.totals_bytes.size() + 64;
}

}  // namespace

double min_peak(const SqtFitOptions& o, const FitInput& input) {
  if (o.min_peak >= 0) return o.min_peak;
  return input.function->info().quantity == sqt::Quantity::phase ? kPhasePeak : kSurfacePeak;
}

sqt::PaperOptions paper_options(const SqtFitOptions& o) {
  sqt::PaperOptions options;
  if (o.views) options.views = static_cast<size_t>(o.views);
  if (o.order) options.order = static_cast<int>(o.order);
  options.threshold = o.threshold;
  return options;
}

// Promises that were not kept, and lobes that are too low or too high; errors under --strict.
void judge_fit(const SqtFitOptions& o, const FitInput& input, const Outcome& out) {
  std::string text;
  auto add = [&text](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (!out.bytes_met) add(strf("%lld bytes cannot be kept: the smallest file has %zu", o.max_bytes, out.file.size()));
  if (!out.error_met)
    add(strf("an error of %g cannot be kept: %s has %.4g", o.max_error, o.max_bytes ? "this fit" : "the best fit",
             out.errors.back().l1));
  if (!out.peak_met) {
    const std::array<double, 3> peaks = out.reference->least_peaks(*out.bundle);
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

Outcome fit_function(const SqtFitOptions& o, const FitInput& input, const std::function<void(double)>& progress) {
  const Stopwatch watch;
  auto advance = [&progress](double share) {
    return [&progress, share](double fraction) {
      if (progress) progress(share * fraction);
    };
  };
  Outcome out;
  out.reference = std::make_unique<const sqt::Reference>(*input.function, kReferencePairs, 1, advance(0.2));
  const sqt::Reference& reference = *out.reference;
  judge_input(input, reference, o.strict);
  SqtProvenance provenance = input.provenance;
  MuellerPtr mueller;
  if (input.mueller) {
    out.mueller = sqt::fit_mueller(*input.mueller, o.mueller_error);
    mueller = out.mueller->table, provenance.mueller = out.mueller->errors;
  }
  if (o.method == "aligned") {
    const sqt::FitTarget target{o.max_error, static_cast<size_t>(o.max_bytes), min_peak(o, input)};
    sqt::FitResult result = sqt::fit_to(
        *input.function, reference, source_options(o), target,
        [&](const sqt::AlignedSource& s) {
          return container_bytes(provenance, s, input.function->info().wavelength_um.size(), mueller);
        },
        advance(0.8));
    out.source = std::move(result.source);
    result.fit.data.mueller = mueller;
    out.bundle = sqt::make_bundle(result.fit.data);
    out.errors = reference.measure(*out.bundle);
    out.file = pack_sqt(result.fit, provenance, out.errors);
    out.error_met = result.error_met;
    out.peak_met = result.peak_met;
    out.bytes_met = !o.max_bytes || out.file.size() <= static_cast<size_t>(o.max_bytes);
  } else {
    sqt::PaperData data = sqt::fit_paper(*input.function, paper_options(o), advance(0.8));
    data.mueller = mueller;
    out.bundle = sqt::make_bundle(data);
    out.errors = reference.measure(*out.bundle);
    out.file = pack_sqt(data, provenance, out.errors);
  }
  out.seconds = watch.seconds();
  return out;
}

}  // namespace suite
