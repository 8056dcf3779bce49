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
}

Accumulators::Accumulators(size_t problems, size_t bands, int scrambles, size_t truth_slots)
    : bands_(bands), scrambles_(scrambles), sums_(problems * bands * static_cast<size_t>(scrambles)), paths_(problems), failures_(problems),
      truncated_(problems), largest_(problems), truth_slots_(truth_slots), truth_(problems * truth_slots) {}

void Accumulators::estimate(size_t problem, size_t band, double& mean, double& standard_error) const {
  const uint32_t n = paths_[problem];
  mean = standard_error = 0;
  if (!n || failures_[problem] >= n) return;
  double total = 0;
  for (int s = 0; s < scrambles_; ++s) total += sums(problem, s)[band];
  mean = total / (n - failures_[problem]);  // rejected samples are not averaged in
  double shares = 0, square = 0, plain = 0;
  int used = 0;
  bool half = false;
  for (int s = 0; s < scrambles_; ++s) {
    const uint32_t count = dealt(n, static_cast<uint32_t>(s));
    if (!count) continue;
    const double share = static_cast<double>(count) / n, d = sums(problem, s)[band] / count - mean;
    if (share < 0.5) shares += share * share / (1 - 2 * share), square += share * share / (1 - 2 * share) * d * d;
    else half = true;
    plain += d * d;
    ++used;
  }
  if (used < 2) standard_error = INFINITY;  // one scramble tells nothing about its own error
  else standard_error = std::sqrt(half ? plain / (used - 1) / used : square / (1 + shares));
}

std::vector<Block> blocks_of(const Capture& capture) {
  constexpr uint32_t edge = 8;
  std::vector<Block> blocks;
  for (uint32_t r = 0; r < capture.rows; r += edge)
    for (uint32_t c = 0; c < capture.columns; c += edge)
      blocks.push_back({c, r, std::min(edge, capture.columns - c), std::min(edge, capture.rows - r)});
  return blocks;
}

Pipeline::Pipeline(const Surface& surface, const Optics& optics, const Environment& environment, const SpectralState& state,
                   const BandProjection& projection, size_t reference_band, const TruthPlan& truth,
                   const PipelineOptions& options)
    : surface_(surface), optics_(optics), environment_(environment), state_(state), projection_(projection), reference_band_(reference_band), truth_(truth), options_(options) {
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

// The time bin of a capture that a moment falls into.
size_t time_bin(const Capture& capture, double time) {
  const double span = capture.window.end - capture.window.begin;
  if (capture.time_bins < 2 || !(span > 0)) return 0;
  const double at = std::floor((time - capture.window.begin) / span * capture.time_bins);
  return static_cast<size_t>(std::clamp(at, 0.0, capture.time_bins - 1.0));
}

}  // namespace

void Pipeline::run(const Sensor& sensor, const Capture& capture, uint64_t capture_id, const Block& block,
                   std::span<const uint32_t> to, Accumulators& sums, RunStatistics& statistics) const {
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
  const bool stop_on_change = options_.stop == StopRule::change;
  auto sum_of = [&](size_t problem) {
    double sum = 0;
    for (int s = 0; s < sums.scrambles(); ++s) sum += sums.sums(problem, s)[reference_band_];
    return sum;
  };
  std::vector<uint32_t> next(width), end(width);
  for (size_t i = 0; i < width; ++i) next[i] = sums.paths(problem_of(i)), end[i] = to[problem_of(i)];
  const uint32_t first = *std::min_element(next.begin(), next.end()), last = *std::max_element(end.begin(), end.end());

  for (uint32_t sample = first; sample < last; ++sample) {
    const auto [scramble, index] = deal(sample);
    wave.active.clear();
    for (size_t i = 0; i < width; ++i) {
      if (sample < next[i] || sample >= end[i]) continue;
      const size_t problem = problem_of(i);
      const SampleStream stream(options_.seed, capture_id, problem, scramble);
      const SensorRay ray = ask_ray(sensor, capture, problem, stream, index, {&workspace->weights[i * state_.size()], state_.size()});
      workspace->weighted[i] = ray.spectral;
      generator.start(wave, i, ray, stream, index);
    }
    generator.complete(wave, statistics);

    for (size_t i = 0; i < width; ++i) {
      if (sample < next[i] || sample >= end[i]) continue;
      const size_t problem = problem_of(i);
      const std::span<float> radiance = wave.scratch2();
      process_path(wave, i, environment_, radiance);
      if (single) process_single(wave, i, radiance, workspace->single);
      if (workspace->weighted[i] || capture.time_bins > 1) {
        const float* weights = workspace->weighted[i] ? &workspace->weights[i * state_.size()] : nullptr;
        for (size_t k = 0; k < radiance.size(); ++k) {
          const float factor = (weights ? weights[k] : 1.0f) * static_cast<float>(capture.time_bins);
          radiance[k] *= factor;
          if (single) workspace->single[k] *= factor;
        }
      }
      // One comparison rejects NaN, infinity and negative radiance alike; such a sample is counted, not averaged in.
      unsigned bad = 0;
      for (const float L : radiance) bad |= static_cast<unsigned>(!(L >= 0 && L < 3e38f));
      ++statistics.paths;
      statistics.truncated += wave.path(i).truncated;
      sums.set_paths(problem, sample + 1);
      if (bad) {
        ++statistics.failures;
        ++sums.failures(problem);
        continue;
      }
      double* const target = sums.sums(problem, static_cast<int>(scramble));
      const double before = target[reference_band_], sum_before = stop_on_change ? sum_of(problem) : 0;
      double* const cell = target + time_bin(capture, wave.path(i).ray.time) * bands;
      projection_.add(radiance, {cell, bands});
      if (single) projection_.add(workspace->single, {cell + capture.time_bins * bands, bands});
      if (stop_on_change && sample >= options_.change_after) {
        const double mean = sum_of(problem) / (sample + 1.0);
        if (std::fabs(mean - sum_before / sample) <= options_.change * mean) end[i] = 0;
      }
      sums.largest(problem) = std::max(sums.largest(problem), static_cast<float>(target[reference_band_] - before));
      sums.truncated(problem) += static_cast<float>(wave.path(i).truncated);
      truth_.add(wave, i, sums.truth(problem));
    }
  }
  statistics.cycles += __rdtsc() - start;
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(workspace));
}

}  // namespace suite
