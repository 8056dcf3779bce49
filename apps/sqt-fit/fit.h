// One fit as the options ask for it, and what is to be said about it; for one input and for folders of them.
#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "input.h"
#include "options.h"
#include "sqt_fit/errors.h"
#include "sqt_fit/fit.h"
#include "sqt_fit/mueller_fit.h"

namespace suite {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct Outcome {
  std::vector<std::byte> file;  // the .sqt
  std::shared_ptr<const sqt::Bundle> bundle;
  std::vector<sqt::ErrorFigures> errors;   // per channel, and overall
  std::optional<sqt::MuellerFit> mueller;  // where the input has matrices
  bool error_met = true, bytes_met = true, peak_met = true;
  double seconds = 0;                                // of surveying, fitting and measuring
  std::unique_ptr<const sqt::Reference> reference;   // what the errors were measured against
  std::unique_ptr<const sqt::AlignedSource> source;  // aligned method only
};

// Progress is told as shares of the whole. Warns about unphysical input; Error under --strict.
Outcome fit_function(const SqtFitOptions& options, const FitInput& input,
                     const std::function<void(double)>& progress = {});

// Heights of lobes that are asked for, of the data's: --min-peak, or what stands for it when the user says nothing.
double min_peak(const SqtFitOptions& options, const FitInput& input);

// Warns of promises that were not kept and of lobes that are too low or too high; Error under --strict.
void judge_fit(const SqtFitOptions& options, const FitInput& input, const Outcome& out);

sqt::PaperOptions paper_options(const SqtFitOptions& options);

}  // namespace suite
