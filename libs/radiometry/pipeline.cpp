#include "radiometry/pipeline.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>

#include "radiometry/lost_light.h"
#include "radiometry/many_suns.h"
#include "radiometry/matte_kernel.h"
#include "radiometry/path_generator.h"
#include "radiometry/path_processor.h"
#include "radiometry/sensor_samples.h"
#include "radiometry/wave.h"

namespace suite {

Pipeline::Pipeline(const Surface& surface, const Optics& optics, const Environment& environment,
                   const SpectralState& state, const BandProjection& projection, size_t reference_band,
                   const TruthPlan& truth, const PipelineOptions& options)
    : surface_(surface),
      optics_(optics),
      environment_(environment),
      state_(state),
      projection_(projection),
      reference_band_(reference_band),
      truth_(truth),
      options_(options) {
  if (options_.method == Method::paper && !optics.media().empty())
    throw Error("the paper's estimator knows surfaces only", "render scenes with media by the standard method");
  if (options_.lamp_draws < 1 || options_.lamp_draws > kLampDraws)
    throw Error(strf("%d lamps a node are not between 1 and %d", options_.lamp_draws, kLampDraws));
  if (options_.max_nodes < 1 || options_.max_nodes > kMaxNodes)
    throw Error(strf("max nodes %d is not between 1 and %d", options_.max_nodes, kMaxNodes));
  matte_ = options_.specialise && MatteKernel::serves(surface, optics, environment, options_);
  loses_light_ = LostLight::possible(surface.tracer().scene(), optics, options_);
}

bool Pipeline::may_miss(const Capture& capture) const {
  const Environment& e = environment_;
  return loses_light_ && (e.sun || e.moon || e.lamps || capture.bin_by == Capture::BinBy::sun);
}

namespace {

// A path of a wave: which problem of the block it belongs to, and which of its samples it is.
struct Lane {
  uint32_t place, sample;
};
// Neighbours in a wave are samples of one problem as far as possible: their rays run so close together that a packet of
// eight costs the ray tracer little more than one.
constexpr uint32_t kTogether = 8, kWaveWidth = 64;
// Problems of a block that take their samples before the next ones do: sums of many bands then stay in the cache.
constexpr uint32_t kBeside = kWaveWidth / kTogether;

}  // namespace

struct Pipeline::Workspace {
  Wave wave;
  PathGenerator generator;
  std::vector<Lane> lanes;        // of the wave that is being filled or run
  std::vector<float> weights;     // [path][bin], of rays that weigh wavelengths
  std::vector<uint8_t> weighted;  // [path]
  std::vector<float> single;      // [bin]
  ManySuns suns;
  std::unique_ptr<MatteKernel> matte;  // null where it does not serve
  std::vector<uint8_t> is_matte;       // [path]: run by it, then: to be averaged in
  std::vector<float> seen;             // [path]: its radiance in the reference band, or else in the first bin
  std::vector<uint32_t> together;      // paths whose radiance is added up in one pass
};

Pipeline::~Pipeline() = default;

std::unique_ptr<Pipeline::Workspace> Pipeline::borrow() const {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      std::unique_ptr<Workspace> found = std::move(idle_.back());
      idle_.pop_back();
      return found;
    }
  }
  return std::unique_ptr<Workspace>(new Workspace{
      Wave(kWaveWidth, options_.max_nodes, state_.size(), !optics_.media().empty(), loses_light_),
      PathGenerator(surface_, optics_, environment_, options_),
      {},
      std::vector<float>(kWaveWidth * state_.size()),
      std::vector<uint8_t>(kWaveWidth),
      std::vector<float>(state_.size()),
      ManySuns(surface_, loses_light_ ? std::make_unique<LostLight>(surface_, optics_) : nullptr),
      matte_ ? std::make_unique<MatteKernel>(surface_, optics_, environment_, options_, truth_.wanted(), kWaveWidth)
             : nullptr,
      std::vector<uint8_t>(kWaveWidth),
      std::vector<float>(kWaveWidth),
      {}});
}

// The problems of one block while they run.
class Pipeline::BlockRun {
 public:
  BlockRun(const Pipeline& pipeline, const Sensor& sensor, const Capture& capture, uint64_t capture_id,
           const Block& block, std::span<const uint32_t> to, Accumulators& sums, Slots slots, RunStatistics& statistics,
           Workspace& workspace)
      : pipeline_(pipeline),
        sensor_(sensor),
        capture_(capture),
        block_(block),
        sums_(sums),
        slots_(slots),
        statistics_(statistics),
        workspace_(workspace),
        single_(sensor.channels().size() > 1),
        matte_(pipeline.matte_ && !single_ && capture.bin_by == Capture::BinBy::none) {
    const size_t width = size_t{block.columns} * block.rows;
    for (uint32_t i = 0; i < width; ++i) {
      next_.push_back(sums.next(slot_of(i), block.scrambles));
      end_.push_back(to[problem_of(i)]);
      keys_.push_back(SampleStream::problem_key(pipeline.options_.seed, capture_id, problem_of(i)));
    }
  }

  // Every problem takes its samples in order; a few of one problem run together, those of the next beside them.
  void run() {
    const auto width = static_cast<uint32_t>(next_.size());
    const uint32_t first = *std::min_element(next_.begin(), next_.end()),
                   last = *std::max_element(end_.begin(), end_.end());
    // A rule that looks at every sample must not be given many at a time.
    const bool watched = pipeline_.options_.stop == StopRule::change;
    const uint32_t together = watched ? 1 : std::max(kTogether, kWaveWidth / width), beside = watched ? width : kBeside;
    for (uint32_t begin = 0; begin < width; begin += beside)
      for (uint32_t group = first; group < last; group += together)
        for (uint32_t i = begin; i < std::min(begin + beside, width); ++i)
          for (uint32_t sample = std::max(group, next_[i]); sample < std::min(group + together, end_[i]); ++sample) {
            if (!wants(i, sample)) continue;
            workspace_.lanes.push_back({i, sample});
            if (workspace_.lanes.size() == kWaveWidth) run_wave();
          }
    if (!workspace_.lanes.empty()) run_wave();
  }

 private:
  size_t problem_of(size_t i) const { return problem_at(capture_, block_, i); }
  // Of the block's scrambles, and not taken yet.
  bool wants(size_t i, uint32_t sample) const {
    const Deal d = deal(sample);
    return (block_.scrambles >> d.scramble & 1) && d.index >= sums_.taken(slot_of(i), static_cast<int>(d.scramble));
  }
  size_t slot_of(size_t i) const { return slots_ == Slots::by_place ? i : problem_of(i); }
  double reference_sum(size_t slot) const {
    double sum = 0;
    for (int s = 0; s < sums_.scrambles(); ++s) sum += sums_.sums(slot, s)[pipeline_.reference_band_];
    return sum;
  }

  void run_wave() {
    Wave& wave = workspace_.wave;
    const size_t bins = pipeline_.state_.size();
    const uint64_t asked = __rdtsc();
    wave.active.clear();
    for (size_t p = 0; p < workspace_.lanes.size(); ++p) {
      const auto [place, sample] = workspace_.lanes[p];
      const auto [scramble, index] = deal(sample);
      // Independent numbers: every sample is the first of a sequence of its own.
      const bool independent = pipeline_.options_.method == Method::paper;
      const SampleStream stream =
          independent ? SampleStream(hash_of(keys_[place], sample), 0) : SampleStream(keys_[place], scramble);
      const uint32_t number = independent ? 0 : index;
      const SensorRay ray =
          ask_ray(sensor_, capture_, problem_of(place), stream, number, {&workspace_.weights[p * bins], bins});
      workspace_.weighted[p] = ray.spectral;
      workspace_.is_matte[p] = matte_ && !ray.spectral && ray.receiver == SensorRay::Receiver::none;
      if (workspace_.is_matte[p])
        workspace_.matte->start(wave, p, ray, stream, number);
      else
        workspace_.generator.start(wave, p, ray, stream, number);
    }
    const uint64_t started = __rdtsc();
    if (matte_) workspace_.matte->complete(wave, statistics_);
    workspace_.generator.complete(wave, statistics_);
    const uint64_t completed = __rdtsc();
    statistics_.sensor_cycles += started - asked;
    statistics_.path_cycles += completed - started;
    for (size_t p = 0; p < workspace_.lanes.size();) {
      const auto [place, sample] = workspace_.lanes[p];
      if (workspace_.is_matte[p]) {
        p = accumulate_matte(p);
        continue;
      }
      if (sample < end_[place]) {
        if (capture_.bin_by == Capture::BinBy::sun)
          accumulate_suns(p, place, sample);
        else
          accumulate(p, place, sample);
      }
      ++p;
    }
    statistics_.shade_cycles += __rdtsc() - completed;
    workspace_.lanes.clear();
  }

  // The radiance of path p, in the wave's second scratch spectrum, and of single scattering where that is asked for.
  std::span<float> radiance_of(size_t p) {
    Wave& wave = workspace_.wave;
    const std::span<float> radiance = wave.scratch2();
    process_path(wave, p, pipeline_.environment_, radiance);
    if (single_) process_single(wave, p, pipeline_.environment_, radiance, workspace_.single);
    weigh(p, radiance);
    if (single_) weigh(p, workspace_.single);
    return radiance;
  }

  // By the sensor's weights and the number of the bins of time.
  void weigh(size_t p, std::span<float> radiance) const {
    const bool timed = capture_.bin_by == Capture::BinBy::time;
    if (!workspace_.weighted[p] && !timed) return;
    const float* weights = workspace_.weighted[p] ? &workspace_.weights[p * radiance.size()] : nullptr;
    for (size_t k = 0; k < radiance.size(); ++k)
      radiance[k] *= (weights ? weights[k] : 1.0f) * (timed ? static_cast<float>(capture_.bins) : 1.0f);
  }

  // One comparison rejects NaN, infinity and negative radiance alike; such a sample is counted, not averaged in.
  static bool acceptable(std::span<const float> radiance) {
    unsigned good = 1;
    for (const float L : radiance) good &= static_cast<unsigned>(L >= 0) & static_cast<unsigned>(L < 3e38f);
    return good;
  }

  void accumulate_suns(size_t p, size_t place, uint32_t sample) {
    const size_t slot = slot_of(place);
    const int scramble = static_cast<int>(deal(sample).scramble);
    const Path& path = workspace_.wave.path(p);
    double* const target = sums_.sums(slot, scramble);
    std::span<double> missing;
    if (sums_.keeps_missing()) missing = {sums_.missing(slot, scramble).light, sums_.bands()};
    const bool good = workspace_.suns.add(workspace_.wave, p, capture_.suns, pipeline_.projection_, single_,
                                          {target, sums_.bands()}, missing, statistics_.trace);
    ++statistics_.paths;
    statistics_.truncated += path.truncated;
    sums_.take(slot, scramble);
    if (!good) return reject(slot, scramble);
    if (path.missed() && !missing.empty())
      *sums_.missing(slot, scramble).square = INFINITY;  // nothing but asking finds a collimated sun
    note(p, slot, scramble, path.truncated);
  }

  // A sample that is not averaged in.
  void reject(size_t slot, int scramble) {
    ++statistics_.failures;
    ++sums_.failures(slot, scramble);
  }
  // What is known of a sample beside its radiance.
  void note(size_t p, size_t slot, int scramble, double truncated) {
    sums_.truncated(slot, scramble) += static_cast<float>(truncated);
    if (pipeline_.truth_.wanted()) pipeline_.truth_.add(workspace_.wave, p, sums_.truth(slot, scramble));
  }

  // Adds what path p is known to have missed.
  void add_missing(size_t p, size_t slot, int scramble, size_t bin) {
    const Path& path = workspace_.wave.path(p);
    const size_t bands = pipeline_.projection_.bands();
    const Accumulators::Missing missing = sums_.missing(slot, scramble);
    const std::span<float> light = workspace_.wave.scratch2();
    for (const bool single : {false, true}) {
      if (single && !single_) break;
      process_missed(workspace_.wave, p, pipeline_.environment_, single, light);
      weigh(p, light);
      if (!acceptable(light)) return;
      double* const sum = missing.light + (single ? capture_.bins + bin : bin) * bands;
      const double before = sum[pipeline_.reference_band_];
      pipeline_.projection_.add(light, {sum, bands});
      const double seen = sum[pipeline_.reference_band_] - before;
      if (single) break;
      *missing.reference += seen;
      *missing.square += path.missed_chance > 0 ? seen * (seen / path.missed_chance) : INFINITY;
    }
  }

  void accumulate(size_t p, size_t place, uint32_t sample) {
    const size_t slot = slot_of(place), bands = pipeline_.projection_.bands(), reference = pipeline_.reference_band_;
    const int scramble = static_cast<int>(deal(sample).scramble);
    const Path& path = workspace_.wave.path(p);
    const std::span<float> radiance = radiance_of(p);
    ++statistics_.paths;
    statistics_.truncated += path.truncated;
    sums_.take(slot, scramble);
    if (!acceptable(radiance)) return reject(slot, scramble);
    double* const target = sums_.sums(slot, scramble);
    const bool watched = pipeline_.options_.stop == StopRule::change;
    const double before = target[reference], sum_before = watched ? reference_sum(slot) : 0;
    const size_t bin = bin_of(capture_, path);
    if (bin < capture_.bins) {
      pipeline_.projection_.add(radiance, {target + bin * bands, bands});
      if (single_) pipeline_.projection_.add(workspace_.single, {target + (capture_.bins + bin) * bands, bands});
    }
    if (watched && sample >= pipeline_.options_.change_after) {
      const double accepted = sums_.accepted(slot), mean = reference_sum(slot) / accepted;
      if (std::fabs(mean - sum_before / (accepted - 1)) <= pipeline_.options_.change * mean) end_[place] = 0;
    }
    sums_.note_sample(slot, scramble, target[reference] - before);
    note(p, slot, scramble, path.truncated);
    if (path.missed() && sums_.keeps_missing() && bin < capture_.bins) add_missing(p, slot, scramble, bin);
  }

  // The samples of one problem that the matte kernel ran, from lane p on. Those of one scramble are added together.
  // Returns the lane behind them.
  size_t accumulate_matte(size_t p) {
    const uint32_t place = workspace_.lanes[p].place;
    size_t end = p;
    while (end < workspace_.lanes.size() && workspace_.lanes[end].place == place && workspace_.is_matte[end]) ++end;
    const size_t slot = slot_of(place);
    for (size_t i = p; i < end; ++i) workspace_.is_matte[i] = take_matte(i, slot);
    for (int scramble = 0; scramble < sums_.scrambles(); ++scramble) {
      workspace_.together.clear();
      for (size_t i = p; i < end; ++i)
        if (workspace_.is_matte[i] && scramble_of(i) == scramble)
          workspace_.together.push_back(static_cast<uint32_t>(i));
      if (!workspace_.together.empty()) add_matte(sums_.sums(slot, scramble));
    }
    // In the order of the samples, so that the sums do not depend on how these were cut into waves.
    for (size_t i = p; i < end; ++i)
      if (workspace_.is_matte[i]) sums_.note_sample(slot, scramble_of(i), static_cast<double>(workspace_.seen[i]));
    return end;
  }

  int scramble_of(size_t lane) const { return static_cast<int>(deal(workspace_.lanes[lane].sample).scramble); }

  // Counts a sample of the matte kernel. False when it must not be averaged in.
  bool take_matte(size_t p, size_t slot) {
    const double truncated = workspace_.matte->truncated(p);
    const int scramble = scramble_of(p);
    ++statistics_.paths;
    sums_.take(slot, scramble);
    statistics_.truncated += truncated;
    const bool direct = pipeline_.projection_.identity();  // bands are bins
    const float radiance = workspace_.matte->radiance(p, direct ? pipeline_.reference_band_ : 0);
    if (std::isnan(radiance)) {
      reject(slot, scramble);
      return false;
    }
    workspace_.seen[p] = radiance;
    note(p, slot, scramble, truncated);
    return true;
  }

  void add_matte(double* target) {
    const BandProjection& projection = pipeline_.projection_;
    if (projection.identity() && projection.bands() == 1) {
      for (const uint32_t p : workspace_.together) target[0] += static_cast<double>(workspace_.seen[p]);
      return;
    }
    if (projection.identity()) return workspace_.matte->add(workspace_.together, target);
    const std::span<float> radiance = workspace_.wave.scratch2();
    for (const uint32_t p : workspace_.together) {
      const double before = target[pipeline_.reference_band_];
      workspace_.matte->spectrum(p, radiance);
      projection.add(radiance, {target, projection.bands()});
      workspace_.seen[p] = static_cast<float>(target[pipeline_.reference_band_] - before);
    }
  }

  const Pipeline& pipeline_;
  const Sensor& sensor_;
  const Capture& capture_;
  const Block block_;
  Accumulators& sums_;
  const Slots slots_;
  RunStatistics& statistics_;
  Workspace& workspace_;
  const bool single_;
  const bool matte_;                  // rays are given to the matte kernel
  std::vector<uint32_t> next_, end_;  // samples of each problem
  std::vector<uint64_t> keys_;        // of its sample streams
};

void Pipeline::run(const Sensor& sensor, const Capture& capture, uint64_t capture_id, const Block& block,
                   std::span<const uint32_t> to, Accumulators& sums, Slots slots, RunStatistics& statistics) const {
  const FlushDenormals flush;
  const uint64_t start = __rdtsc();
  std::unique_ptr<Workspace> workspace = borrow();
  BlockRun(*this, sensor, capture, capture_id, block, to, sums, slots, statistics, *workspace).run();
  statistics.cycles += __rdtsc() - start;
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(workspace));
}

}  // namespace suite
