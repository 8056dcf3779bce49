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
  // Samples are dealt to the scrambles in turn, so their counts differ by one at most.
  const uint32_t n = paths_[problem];
  mean = standard_error = 0;
  if (!n) return;
  double total = 0;
  for (int s = 0; s < scrambles_; ++s) total += sums(problem, s)[band];
  if (failures_[problem] >= n) return;
  mean = total / (n - failures_[problem]);  // rejected samples are not averaged in
  double square = 0;
  int used = 0;
  for (int s = 0; s < scrambles_; ++s) {
    const uint32_t count = n / static_cast<uint32_t>(scrambles_) + (static_cast<uint32_t>(s) < n % static_cast<uint32_t>(scrambles_) ? 1 : 0);
    if (!count) continue;
    const double d = sums(problem, s)[band] / count - mean;
    square += d * d;
    ++used;
  }
  if (used > 1) standard_error = std::sqrt(square / (used - 1) / used);
  else standard_error = INFINITY;  // one scramble tells nothing about its own error
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
  return std::unique_ptr<Workspace>(new Workspace{Wave(width, options_.max_nodes, state_.size()),
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

void Pipeline::run(const Sensor& sensor, const Capture& capture, uint64_t capture_id, const Block& block, uint32_t from,
                   std::span<const uint32_t> to, Accumulators& sums, RunStatistics& statistics) const {
  const FlushDenormals flush;
  const uint64_t start = __rdtsc();
  const size_t width = size_t{block.columns} * block.rows, bands = projection_.bands();
  const int scrambles = sums.scrambles();
  std::unique_ptr<Workspace> workspace = borrow(width);
  Wave& wave = workspace->wave;
  PathGenerator& generator = workspace->generator;
  const bool single = sensor.channels().size() > 1;
  auto problem_of = [&](size_t i) {
    return (size_t{block.row} + i / block.columns) * capture.columns + block.column + i % block.columns;
  };
  uint32_t last = from;
  for (size_t i = 0; i < width; ++i) last = std::max(last, to[problem_of(i)]);

  for (uint32_t sample = from; sample < last; ++sample) {
    const uint32_t scramble = sample % static_cast<uint32_t>(scrambles), index = sample / static_cast<uint32_t>(scrambles);
    wave.active.clear();
    for (size_t i = 0; i < width; ++i) {
      const size_t problem = problem_of(i);
      if (sample >= to[problem]) continue;
      const SampleStream stream(options_.seed, capture_id, problem, scramble);
      const SensorRay ray = ask_ray(sensor, capture, problem, stream, index, {&workspace->weights[i * state_.size()], state_.size()});
      workspace->weighted[i] = ray.spectral;
      generator.start(wave, i, ray, stream, index);
    }
    generator.complete(wave, statistics);

    for (size_t i = 0; i < width; ++i) {
      const size_t problem = problem_of(i);
      if (sample >= to[problem]) continue;
      const std::span<float> radiance = wave.scratch2();
      process_path(wave, i, environment_, radiance);
      if (single) process_single(wave, i, radiance, workspace->single);
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
      const double before = target[reference_band_];
      if (const size_t bin = bin_of(capture, wave.path(i)); bin < capture.bins) {
        projection_.add(radiance, {target + bin * bands, bands});
        if (single) projection_.add(workspace->single, {target + (capture.bins + bin) * bands, bands});
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
