#include "budget_options.h"

#include <charconv>
#include <cmath>

#include "base/run_app.h"

namespace suite {

namespace {

constexpr uint32_t kMostPaths = 1u << 30;

// The number at the front of a text; `rest` is what follows it.
double leading_number(const std::string& text, const std::string& option, std::string& rest) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) throw UsageError(option + " wants a number, found '" + text + "'");
  rest.assign(end, text.data() + text.size());
  return value;
}

uint32_t paths_of(const std::string& text) {
  std::string rest;
  const double n = leading_number(text, "--paths", rest);
  if (rest.empty() && n == 0)
    throw UsageError("--paths 0: a budget of nothing gives nothing; whole numbers from 1 to 2^30");
  if (!rest.empty() || n < 1 || n > kMostPaths || n != std::floor(n))
    throw UsageError("--paths wants whole numbers from 1 to 2^30, N or MIN,MAX; found '" + text + "'");
  return static_cast<uint32_t>(n);
}

double fraction_of(const std::string& text) {
  std::string rest;
  double value = leading_number(text, "--target-error", rest);
  if (rest == "%")
    value /= 100;
  else if (!rest.empty())
    throw UsageError("--target-error wants a fraction or per cent, 0.01 or 1%; found '" + text + "'");
  if (!(value > 0 && value < 1))
    throw UsageError("--target-error wants more than 0 and less than 100 %; found '" + text + "'");
  return value;
}

double seconds_of(const std::string& text) {
  std::string unit;
  const double value = leading_number(text, "--time", unit);
  const double scale = unit == "s" ? 1 : unit == "min" ? 60 : unit == "h" ? 3600 : 0;
  if (scale == 0) throw UsageError("--time wants a unit, s, min or h, as in 90s or 10min; found '" + text + "'");
  if (value == 0) throw UsageError("--time " + text + ": a budget of nothing gives nothing; as in 90s or 10min");
  if (!(value > 0)) throw UsageError("--time wants more than nothing; found '" + text + "'");
  return value * scale;
}

size_t bytes_of(const std::string& text, const std::string& option) {
  std::string unit;
  const double value = leading_number(text, option, unit);
  const double scale = unit == "KiB" ? 0x1p10 : unit == "MiB" ? 0x1p20 : unit == "GiB" ? 0x1p30 : 0;
  if (scale == 0) throw UsageError(option + " wants a unit, KiB, MiB or GiB, as in 512MiB; found '" + text + "'");
  if (!(value >= 0 && value * scale < 0x1p62)) throw UsageError(option + ": '" + text + "' cannot be");
  return static_cast<size_t>(value * scale);
}

}  // namespace

Budget budget_of(const RenderOptions& o) {
  Budget b;
  if (!o.paths.empty()) {
    const size_t comma = o.paths.find(',');
    b.min_paths = paths_of(o.paths.substr(0, comma));
    b.max_paths = comma == std::string::npos ? *b.min_paths : paths_of(o.paths.substr(comma + 1));
    if (*b.max_paths < *b.min_paths) throw UsageError("--paths MIN,MAX: the maximum is less than the minimum");
  }
  if (!o.target_error.empty()) b.relative_error = fraction_of(o.target_error);
  // A fixed number of paths leaves nothing for a target to decide.
  if (b.relative_error && b.min_paths && *b.min_paths == *b.max_paths)
    throw UsageError("--target-error needs room between a minimum and a maximum: --paths MIN,MAX");
  if (o.target_floor >= 0) b.absolute_floor = o.target_floor;
  if (o.target_bands == "all")
    b.all_bands = true;
  else if (o.target_bands != "reference")
    throw UsageError("--target-bands is 'reference' or 'all', found '" + o.target_bands + "'");
  if (!o.time.empty()) b.seconds = seconds_of(o.time);
  return b;
}

size_t kit_bytes_of(const RenderOptions& o) {
  return o.kit_memory.empty() ? kDefaultKitBytes : bytes_of(o.kit_memory, "--cache-memory");
}

size_t view_bytes_of(const RenderOptions& o) { return bytes_of(o.view_size, "--view-size"); }

size_t tile_bytes_of(const RenderOptions& o) {
  if (o.memory.empty()) return 0;
  const size_t bytes = bytes_of(o.memory, "--memory");
  if (bytes == 0) throw UsageError("--memory: '" + o.memory + "' holds nothing");
  return bytes;
}

StopRule stop_rule_of(const RenderOptions& o) {
  // The paper's estimator comes with the paper's rule, unless another is asked for.
  if (o.stop.empty()) return method_of(o) == Method::paper ? StopRule::change : StopRule::plan;
  if (o.stop == "plan") return StopRule::plan;
  if (o.stop == "change") return StopRule::change;
  throw UsageError("--stop is 'plan' or 'change', found '" + o.stop + "'");
}

Method method_of(const RenderOptions& o) {
  if (o.method == "standard") return Method::standard;
  if (o.method == "paper") return Method::paper;
  throw UsageError("--method is 'standard' or 'paper', found '" + o.method + "'");
}

}  // namespace suite
