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

Accumulators::Accumulators(size_t problems, size_t bands, int scrambles)
    : bands_(bands), scrambles_(scrambles), sums_(problems * bands * static_cast<size_t>(scrambles)), paths_(problems), failures_(problems),
      truncated_(problems), largest_(problems), truth_(problems) {}

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
                   const BandProjection& projection, size_t reference_band, const PipelineOptions& options)
    : surface_(surface), optics_(optics), environment_(environment), state_(state), projection_(projection), reference_band_(reference_band), options_(options) {
  if (options_.max_nodes < 1 || options_.max_nodes > kMaxNodes) throw Error(strf("max nodes %d is not between 1 and %d", options_.max_nodes, kMaxNodes));
}

struct Pipeline::Workspace {
  Wave wave;
  PathGenerator generator;
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
                                                  PathGenerator(surface_, optics_, environment_, options_)});
}

namespace {

void vote(std::array<ProblemTruth::Vote, 4>& votes, uint32_t id) {
  // Misra & Gries 1982: any id seen in more than a fifth of the samples survives, which includes every majority.
  for (auto& v : votes)
    if (v.count && v.id == id) {
      ++v.count;
      return;
    }
  for (auto& v : votes)
    if (!v.count) {
      v = {id, 1};
      return;
    }
  for (auto& v : votes) --v.count;
}

void collect_truth(Wave& wave, size_t p, const Tracer& tracer, ProblemTruth& truth) {
  if (wave.path(p).size == 0) return;
  const Node& first = wave.node(p, 0);
  ++truth.hits;
  truth.range += first.optical_length;
  truth.position += first.at.position;
  vote(truth.material, first.at.material);
  if (first.hit.hit()) vote(truth.instance, tracer.objects()[first.hit.object].instance);  // the Earth has none
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
      const std::array<double, 4> u = stream.draw(index, 0);
      generator.start(wave, i, sensor.ray(capture, problem, u), stream, index);
    }
    generator.complete(wave, statistics);

    for (size_t i = 0; i < width; ++i) {
      if (sample < next[i] || sample >= end[i]) continue;
      const size_t problem = problem_of(i);
      const std::span<float> radiance = wave.scratch2();
      process_path(wave, i, environment_, radiance);
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
      double* target = sums.sums(problem, static_cast<int>(scramble));
      const double before = target[reference_band_], sum_before = stop_on_change ? sum_of(problem) : 0;
      projection_.add(radiance, {target, bands});
      if (stop_on_change && sample >= options_.change_after) {
        const double mean = sum_of(problem) / (sample + 1.0);
        if (std::fabs(mean - sum_before / sample) <= options_.change * mean) end[i] = 0;
      }
      sums.largest(problem) = std::max(sums.largest(problem), static_cast<float>(target[reference_band_] - before));
      sums.truncated(problem) += static_cast<float>(wave.path(i).truncated);
      collect_truth(wave, i, surface_.tracer(), sums.truth(problem));
    }
  }
  statistics.cycles += __rdtsc() - start;
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(workspace));
}

}  // namespace suite
