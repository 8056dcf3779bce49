#include "radiometry/pipeline.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>

#include "radiometry/path_generator.h"
#include "radiometry/path_processor.h"
#include "radiometry/wave.h"

namespace suite {

void RunStatistics::merge(const RunStatistics& o) {
  paths += o.paths;
  nodes += o.nodes;
  failures += o.failures;
  truncated += o.truncated;
  trace.rays += o.trace.rays;
  trace.cycles += o.trace.cycles;
  cycles += o.cycles;
  sensor_cycles += o.sensor_cycles;
  path_cycles += o.path_cycles;
  shade_cycles += o.shade_cycles;
}

Accumulators::Accumulators(size_t problems, size_t bands, int scrambles, size_t truth_slots)
    : bands_(bands), scrambles_(scrambles), sums_(problems * bands * static_cast<size_t>(scrambles)), paths_(problems), failures_(problems),
      truncated_(problems), largest_(problems), truth_slots_(truth_slots), truth_(problems * truth_slots) {}

namespace {

// How n samples share out among the scrambles, and what the squared deviation of each one's mean weighs in the variance of
// the mean of all.
struct Shares {
  Shares(uint32_t n, int scrambles) {
    double sum = 0;
    bool half = false;
    for (int s = 0; s < scrambles; ++s) {
      count[s] = dealt(n, static_cast<uint32_t>(s));
      const double share = count[s] / n;
      used += count[s] > 0;
      half = half || share >= 0.5;
      weight[s] = share * share / (1 - 2 * share);
      sum += weight[s];
    }
    for (int s = 0; s < scrambles; ++s) weight[s] = half ? 1.0 / (used * std::max(1, used - 1)) : weight[s] / (1 + sum);
  }
  double count[8], weight[8];
  int used = 0;
};

}  // namespace

void Accumulators::estimate(size_t problem, size_t band, double& mean, double& standard_error) const {
  const uint32_t n = paths_[problem];
  mean = standard_error = 0;
  if (!n || failures_[problem] >= n) return;
  double total = 0;
  for (int s = 0; s < scrambles_; ++s) total += sums(problem, s)[band];
  mean = total / (n - failures_[problem]);  // rejected samples are not averaged in
  double square = 0;
  const Shares shares(n, scrambles_);
  for (int s = 0; s < scrambles_; ++s) {
    if (!(shares.count[s] > 0)) continue;
    const double d = sums(problem, s)[band] / shares.count[s] - mean;
    square += shares.weight[s] * d * d;
  }
  standard_error = shares.used < 2 ? INFINITY : std::sqrt(square);  // one scramble tells nothing about its own error
}

void Accumulators::estimate(size_t problem, std::span<double> means, std::span<double> errors) const {
  const uint32_t n = paths_[problem];
  std::fill(means.begin(), means.end(), 0.0);
  std::fill(errors.begin(), errors.end(), 0.0);
  if (!n || failures_[problem] >= n) return;
  double* __restrict const mean = means.data();
  double* __restrict const square = errors.data();
  const double accepted = n - failures_[problem];
  for (int s = 0; s < scrambles_; ++s) {
    const double* __restrict sum = sums(problem, s);
    for (size_t b = 0; b < bands_; ++b) mean[b] += sum[b];
  }
  for (size_t b = 0; b < bands_; ++b) mean[b] /= accepted;
  const Shares shares(n, scrambles_);
  for (int s = 0; s < scrambles_; ++s) {
    if (!(shares.count[s] > 0)) continue;
    const double* __restrict sum = sums(problem, s);
    const double count = shares.count[s], weight = shares.weight[s];
    for (size_t b = 0; b < bands_; ++b) {
      const double d = sum[b] / count - mean[b];
      square[b] += weight * d * d;
    }
  }
  for (size_t b = 0; b < bands_; ++b) square[b] = shares.used < 2 ? INFINITY : std::sqrt(square[b]);
}

void Accumulators::clear() {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  std::fill(paths_.begin(), paths_.end(), 0u);
  std::fill(failures_.begin(), failures_.end(), 0u);
  std::fill(truncated_.begin(), truncated_.end(), 0.0f);
  std::fill(largest_.begin(), largest_.end(), 0.0f);
  std::fill(truth_.begin(), truth_.end(), 0.0);
}

std::vector<Block> blocks_of(const Capture& capture) {
  std::vector<Block> blocks;
  for (uint32_t r = 0; r < capture.rows; r += kBlockEdge)
    for (uint32_t c = 0; c < capture.columns; c += kBlockEdge)
      blocks.push_back({c, r, std::min(kBlockEdge, capture.columns - c), std::min(kBlockEdge, capture.rows - r)});
  return blocks;
}

Pipeline::Pipeline(const Surface& surface, const Optics& optics, const Environment& environment, const SpectralState& state,
                   const BandProjection& projection, size_t reference_band, const TruthPlan& truth,
                   const PipelineOptions& options)
    : surface_(surface), optics_(optics), environment_(environment), state_(state), projection_(projection), reference_band_(reference_band), truth_(truth), options_(options) {
  if (!optics.media().empty() && environment.atmosphere)
    throw Error("layers of air and media in the scene cannot be combined", "let a clear sky stand for the air, or leave the media out");
  if (options_.max_nodes < 1 || options_.max_nodes > kMaxNodes) throw Error(strf("max nodes %d is not between 1 and %d", options_.max_nodes, kMaxNodes));
}

struct Pipeline::Workspace {
  Wave wave;
  PathGenerator generator;
  std::vector<float> weights;     // [path][bin], of rays that weigh wavelengths
  std::vector<uint8_t> weighted;  // [path]
  std::vector<float> single;      // [bin]
};

Pipeline::~Pipeline() = default;

std::unique_ptr<Pipeline::Workspace> Pipeline::borrow(size_t width) const {
  {
    const std::lock_guard lock(mutex_);
    for (auto& w : idle_)
      if (w->wave.width() >= width) {
        std::swap(w, idle_.back());
        auto found = std::move(idle_.back());
        idle_.pop_back();
        return found;
      }
  }
  return std::unique_ptr<Workspace>(new Workspace{Wave(width, options_.max_nodes, state_.size(), !optics_.media().empty()),
                                                  PathGenerator(surface_, optics_, environment_, options_),
                                                  std::vector<float>(width * state_.size()), std::vector<uint8_t>(width),
                                                  std::vector<float>(state_.size())});
}

namespace {

// The second block of numbers that a sensor may ask for; nodes take the blocks from 1 on, their lobes those from 128 on.
constexpr uint32_t kSecondSensorBlock = 250;

// Asks the sensor for the ray of a sample. weights: where it may leave spectral weights.
SensorRay ask_ray(const Sensor& sensor, const Capture& capture, size_t problem, const SampleStream& stream, uint32_t index, std::span<float> weights) {
  const size_t numbers = static_cast<size_t>(sensor.numbers());
  std::array<double, 8> u;
  const std::array<double, 4> first = stream.draw(index, 0);
  std::copy(first.begin(), first.end(), u.begin());
  if (numbers > 4) {
    const std::array<double, 4> second = stream.draw(index, kSecondSensorBlock);
    std::copy(second.begin(), second.end(), u.begin() + 4);
  }
  return sensor.ray({capture, problem, {u.data(), numbers}, weights});
}

// The bin of a capture that a path's radiance goes into, or Capture::bins when none is right.
size_t bin_of(const Capture& capture, const Path& path) {
  if (capture.bin_by == Capture::BinBy::none) return 0;
  if (capture.bin_by == Capture::BinBy::time) {
    const double span = capture.window.end - capture.window.begin;
    const double at = span > 0 ? std::floor((path.ray.time - capture.window.begin) / span * capture.bins) : 0;
    return static_cast<size_t>(std::clamp(at, 0.0, capture.bins - 1.0));
  }
  if (path.end != PathEnd::escaped || path.escape.z < 0) return capture.bins;
  const uint32_t columns = capture.bins / capture.escape_rings;
  const double turn = std::atan2(path.escape.y, path.escape.x) / (2 * kPi);
  const uint32_t ring = std::min(static_cast<uint32_t>(path.escape.z * capture.escape_rings), capture.escape_rings - 1);
  return size_t{ring} * columns + std::min(static_cast<uint32_t>((turn - std::floor(turn)) * columns), columns - 1);
}

}  // namespace

void Pipeline::run(const Sensor& sensor, const Capture& capture, uint64_t capture_id, const Block& block,
                   std::span<const uint32_t> to, Accumulators& sums, Slots slots, RunStatistics& statistics) const {
  const FlushDenormals flush;
  const uint64_t start = __rdtsc();
  const size_t width = size_t{block.columns} * block.rows, bands = projection_.bands();
  std::unique_ptr<Workspace> workspace = borrow(width);
  Wave& wave = workspace->wave;
  PathGenerator& generator = workspace->generator;
  const bool single = sensor.channels().size() > 1;
  auto problem_of = [&](size_t i) {
    return (size_t{block.row} + i / block.columns) * capture.columns + block.column + i % block.columns;
  };
  auto slot_of = [&](size_t i) { return slots == Slots::by_place ? i : problem_of(i); };
  const bool stop_on_change = options_.stop == StopRule::change;
  auto sum_of = [&](size_t slot) {
    double sum = 0;
    for (int s = 0; s < sums.scrambles(); ++s) sum += sums.sums(slot, s)[reference_band_];
    return sum;
  };
  std::vector<uint32_t> next(width), end(width);
  for (size_t i = 0; i < width; ++i) next[i] = sums.paths(slot_of(i)), end[i] = to[problem_of(i)];
  const uint32_t first = *std::min_element(next.begin(), next.end()), last = *std::max_element(end.begin(), end.end());

  for (uint32_t sample = first; sample < last; ++sample) {
    const auto [scramble, index] = deal(sample);
    const uint64_t asked = __rdtsc();
    wave.active.clear();
    for (size_t i = 0; i < width; ++i) {
      if (sample < next[i] || sample >= end[i]) continue;
      const size_t problem = problem_of(i);
      const SampleStream stream(options_.seed, capture_id, problem, scramble);
      const SensorRay ray = ask_ray(sensor, capture, problem, stream, index, {&workspace->weights[i * state_.size()], state_.size()});
      workspace->weighted[i] = ray.spectral;
      generator.start(wave, i, ray, stream, index);
    }
    const uint64_t started = __rdtsc();
    generator.complete(wave, statistics);
    const uint64_t completed = __rdtsc();
    statistics.sensor_cycles += started - asked;
    statistics.path_cycles += completed - started;

    for (size_t i = 0; i < width; ++i) {
      if (sample < next[i] || sample >= end[i]) continue;
      const size_t slot = slot_of(i);
      const std::span<float> radiance = wave.scratch2();
      process_path(wave, i, environment_, radiance);
      if (single) process_single(wave, i, environment_, radiance, workspace->single);
      const bool timed = capture.bin_by == Capture::BinBy::time;
      if (workspace->weighted[i] || timed) {
        const float* weights = workspace->weighted[i] ? &workspace->weights[i * state_.size()] : nullptr;
        for (size_t k = 0; k < radiance.size(); ++k) {
          const float factor = (weights ? weights[k] : 1.0f) * (timed ? static_cast<float>(capture.bins) : 1.0f);
          radiance[k] *= factor;
          if (single) workspace->single[k] *= factor;
        }
      }
      // One comparison rejects NaN, infinity and negative radiance alike; such a sample is counted, not averaged in.
      unsigned good = 1;
      for (const float L : radiance) good &= static_cast<unsigned>(L >= 0) & static_cast<unsigned>(L < 3e38f);
      ++statistics.paths;
      statistics.truncated += wave.path(i).truncated;
      sums.set_paths(slot, sample + 1);
      if (!good) {
        ++statistics.failures;
        ++sums.failures(slot);
        continue;
      }
      double* const target = sums.sums(slot, static_cast<int>(scramble));
      const double before = target[reference_band_], sum_before = stop_on_change ? sum_of(slot) : 0;
      if (const size_t bin = bin_of(capture, wave.path(i)); bin < capture.bins) {
        projection_.add(radiance, {target + bin * bands, bands});
        if (single) projection_.add(workspace->single, {target + (capture.bins + bin) * bands, bands});
      }
      if (stop_on_change && sample >= options_.change_after) {
        const double mean = sum_of(slot) / (sample + 1.0);
        if (std::fabs(mean - sum_before / sample) <= options_.change * mean) end[i] = 0;
      }
      sums.largest(slot) = std::max(sums.largest(slot), static_cast<float>(target[reference_band_] - before));
      sums.truncated(slot) += static_cast<float>(wave.path(i).truncated);
      truth_.add(wave, i, sums.truth(slot));
    }
    statistics.shade_cycles += __rdtsc() - completed;
  }
  statistics.cycles += __rdtsc() - start;
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(workspace));
}

}  // namespace suite
