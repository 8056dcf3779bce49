#include "input.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "formats/measured/measured.h"
#include "optics/model_function.h"
#include "sqt_fit/narrow_lobe.h"
#include "sqt_fit/scattered.h"
#include "sqt_fit/swapped.h"

namespace suite {

namespace {

// Says how far from the normal the samples reach where they leave much of the hemisphere to the outermost ones: beyond
// 75 degrees lie 7 % of the projected solid angle.
void report_reach(const sqt::Samples& samples, const std::string& file) {
  if (samples.info.quantity != sqt::Quantity::bsdf) return;
  const size_t channels = samples.info.wavelength_um.size();
  double out = 0, in = 0;
  for (size_t i = 0; i < samples.in.size(); ++i) {
    if (!std::isfinite(samples.value[i * channels])) continue;
    out = std::max(out, std::acos(std::min(1.0, std::fabs(samples.out[i].z))));
    in = std::max(in, std::acos(std::min(1.0, std::fabs(samples.in[i].z))));
  }
  if (std::min(out, in) < 75 * kDegree)
    note(strf(
        "%s: samples reach %.0f degrees from the normal in the outgoing and %.0f in the incident direction; beyond, "
        "the nearest ones hold, and no error of it is reported",
        file.c_str(), out / kDegree, in / kDegree));
}

// Rows without a value are left out, and counted.
std::shared_ptr<const sqt::Function> interpolated(const sqt::Samples& samples, const std::string& file) {
  const size_t channels = samples.info.wavelength_um.size();
  size_t missing = 0;
  for (size_t i = 0; i < samples.in.size(); ++i)
    missing += std::any_of(&samples.value[i * channels], &samples.value[(i + 1) * channels],
                           [](double v) { return !std::isfinite(v); });
  if (missing == samples.in.size())
    throw Error(Where{file, 0, 0, {}, -1}, "no pair of directions has a value in every channel",
                "nan and inf mark missing values");
  if (missing)
    warn(strf("%s: %zu of %zu pairs of directions lack a value and are left out", file.c_str(), missing,
              samples.in.size()));
  const double longest = *std::max_element(samples.info.wavelength_um.begin(), samples.info.wavelength_um.end());
  if (longest > 100)
    warn(strf("%s: wavelengths reach %g um; are they in nm? columns and lists are in um", file.c_str(), longest));
  report_reach(samples, file);
  return sqt::interpolate(samples);
}

// What was filled in, and what cannot be.
void report_matrices(const sqt::MuellerBrdf& brdf, const SqtFitOptions& options) {
  if (options.swap) throw UsageError("--swap: matrices say themselves which direction is the light's");
  if (brdf.missing_share() > 0)
    warn(strf("%s: %.3g %% of the directions have no matrix and take the nearest one", options.input.c_str(),
              100 * brdf.missing_share()));
  if (!brdf.info().bilateral)
    note(strf("%s: m11 at phi_d and -phi_d differs by %.2g %%; both sides are kept", options.input.c_str(),
              100 * brdf.asymmetry()));
}

}  // namespace

FitInput load_input(const SqtFitOptions& options) {
  FitInput input;
  input.provenance.command = command_line();
  input.provenance.tool = std::string("sqt-fit ") + kVersion;
  if (!options.model.empty()) {
    input.provenance.input = options.model;
    // A long table comes from a file: tabulated:table=@mie.txt
    const size_t at = options.model.find("table=@");
    std::string model = options.model;
    if (at != std::string::npos) {
      const std::string file = options.model.substr(at + 7);
      model = options.model.substr(0, at + 6) + read_text(file);
      input.provenance.input_sha256 = sha256(read_bytes(file));
    }
    input.function = model_function(model);
  } else {
    Measured measured = read_measured(options.input);
    if (auto* function = std::get_if<0>(&measured))
      input.function = std::move(*function);
    else
      input.function = interpolated(std::get<1>(measured), options.input);
    input.mueller = std::dynamic_pointer_cast<const sqt::MuellerBrdf>(input.function);
    if (input.mueller) report_matrices(*input.mueller, options);
    if (options.swap) input.function = sqt::swapped(std::move(input.function));
    input.provenance.input = options.input;
    input.provenance.input_sha256 = sha256(read_bytes(options.input));
  }
  if (options.method == "aligned") {
    const sqt::NarrowLobe narrow =
        sqt::split_narrow_lobe(input.function, options.order ? static_cast<int>(options.order) : 10);
    if (narrow.rest) {
      input.function = narrow.rest;
      note(
          strf("a lobe narrower than the finest cell in the %s, up to %.3f of the total: stored as a Dirac lobe that "
               "stands for the %.2f deg (half vector) around it",
               narrow.where.c_str(), narrow.largest, narrow.core / kDegree));
    }
  }
  input.provenance.conventions = input.function->info().source;
  return input;
}

}  // namespace suite
