#include "transport/block_run.h"

#include <immintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/interrupt.h"
#include "transport/dimensions.h"
#include "transport/sensor_samples.h"
#include "transport/serve.h"
#include "transport/workspace.h"

namespace suite {

BlockRun::BlockRun(const Pipeline& pipeline, const Sensor& sensor, const Capture& capture, uint64_t capture_id,
                   const Block& block, std::span<const uint32_t> to, Accumulators& sums, Slots slots,
                   RunStatistics& statistics, Pipeline::Workspace& workspace)
    : pipeline_(pipeline),
      sensor_(sensor),
      capture_(capture),
      block_(block),
      sums_(sums),
      slots_(slots),
      statistics_(statistics),
      workspace_(workspace),
      watched_(pipeline.options_.stop == StopRule::change),
      plain_(workspace.sink.targets() == 1 && capture.bin_by == Capture::BinBy::none),
      scale_(capture.bin_by == Capture::BinBy::time ? static_cast<float>(capture.bins) : 1.0f) {
  on_surface_.assign(block.problems(), -1);
  if (const Environment& e = pipeline.environment_; e.sun != kNoLight) sun_ = e.lights[e.sun]->beam()->direction;
  for (uint32_t i = 0; i < block.problems(); ++i) {
    problems_.push_back(problem_at(capture, block, i));
    next_.push_back(sums.next(slot_of(i), block.scrambles));
    end_.push_back(to[problems_[i]]);
    const uint64_t key = SampleStream::problem_key(pipeline.options_.seed, capture_id, problems_[i]);
    keys_.push_back(key);
    whole_.push_back(block.scrambles == kAllScrambles);
    for (uint32_t s = 0; s < kMostScrambles; ++s) {
      streams_.emplace_back(key, s);
      if (static_cast<int>(s) < sums.scrambles())
        whole_[i] &= sums.taken(slot_of(i), static_cast<int>(s)) == dealt(next_[i], s);
    }
  }
}

bool BlockRun::wants(size_t i, uint32_t sample) const {
  if (whole_[i]) return true;
  const Deal d = deal(sample);
  return (block_.scrambles >> d.scramble & 1) && d.index >= sums_.taken(slot_of(i), static_cast<int>(d.scramble));
}

double BlockRun::reference_sum(size_t slot) const {
  double sum = 0;
  for (int s = 0; s < sums_.scrambles(); ++s) sum += sums_.sums(slot, s)[pipeline_.reference_band_];
  return sum;
}

void BlockRun::run() {
  const auto width = static_cast<uint32_t>(next_.size());
  if (watched_) {  // a rule that looks at every sample must not be given many at a time
    const uint32_t first = *std::min_element(next_.begin(), next_.end()),
                   last = *std::max_element(end_.begin(), end_.end());
    for (uint32_t sample = first; sample < last; ++sample)
      for (uint32_t i = 0; i < width; ++i) put(i, sample);
  } else {
    for (uint32_t i = 0; i < width; ++i)
      for (uint32_t sample = next_[i]; sample < end_[i]; ++sample) put(i, sample);
  }
  if (!workspace_.lanes.empty()) run_wave();
}

void BlockRun::put(uint32_t i, uint32_t sample) {
  if (sample < next_[i] || sample >= end_[i] || !wants(i, sample)) return;
  workspace_.lanes.push_back({i, sample});
  if (workspace_.lanes.size() == workspace_.width) run_wave();
}

void BlockRun::run_wave() {
  constexpr double kGrace = 0.5;  // s: most blocks end by themselves
  stop_point(kGrace);
  const auto paths = static_cast<uint32_t>(workspace_.lanes.size());
  const uint64_t asked = __rdtsc();
  draw(paths);
  for (uint32_t p = 0; p < paths; ++p) start(p);
  const uint64_t started = __rdtsc();
  const Tracer& tracer = pipeline_.surface_.tracer();
  for (PathTracing* kernel : {workspace_.kernel.get(), workspace_.receiving.get()}) {
    if (!kernel) continue;
    complete(*kernel, tracer, statistics_.trace);
    statistics_.nodes += kernel->take_nodes();
  }
  const uint64_t completed = __rdtsc();
  for (uint32_t p = 0; p < paths; ++p) take(p);
  statistics_.sensor_cycles += started - asked;
  statistics_.path_cycles += completed - started;
  statistics_.shade_cycles += __rdtsc() - completed;
  workspace_.lanes.clear();
}

// The stream of a lane's sample, and its number there.
std::pair<SampleStream, uint32_t> BlockRun::stream_of(const WaveLane& lane) const {
  const auto [scramble, index] = deal(lane.sample);
  // Independent numbers: every sample is the first of a sequence of its own.
  if (pipeline_.options_.method == Method::paper) return {SampleStream(hash_of(keys_[lane.place], lane.sample), 0), 0};
  return {streams_[size_t{lane.place} * kMostScrambles + scramble], index};
}

// The sensor's numbers of the first lanes.
void BlockRun::draw(uint32_t paths) {
  workspace_.points.clear();
  for (uint32_t p = 0; p < paths; ++p) {
    const auto [stream, number] = stream_of(workspace_.lanes[p]);
    workspace_.points.push_back(stream.point(number, dimensions::kSensor.first, workspace_.numbers[p]));
  }
  SampleStream::draw(workspace_.points);
}

// Asks the sensor for the ray of a sample and starts its path.
void BlockRun::start(uint32_t p) {
  const WaveLane& lane = workspace_.lanes[p];
  const auto [stream, number] = stream_of(lane);
  const size_t bins = pipeline_.state_.size();
  float* const weights = &workspace_.weights[p * bins];
  const bool on_surface = stands_on_surface(lane.place);
  SensorRay ray =
      ask_ray(sensor_, capture_, problems_[lane.place], workspace_.numbers[p], stream, number, {weights, bins});
  if (on_surface) stand_off(pipeline_.surface_.tracer(), ray.ray, workspace_.touched, statistics_.trace);
  workspace_.throughputs.begin(p, static_cast<float>(ray.weight) * scale_, ray.spectral ? weights : nullptr);
  if (workspace_.stokes) workspace_.stokes->begin_rows(p, sensor_matrix(ray));
  workspace_.sink.begin(p);
  PathTracing& kernel = workspace_.kernel_of(ray);
  workspace_.kernels[p] = &kernel;
  kernel.start(p, ray, stream, number);
}

// What is up in the picture at a ray, not yet upright on it.
static Vec3 upright(const Polarimetry& how, Dir ray) {
  const double opposite = 1 + dot(how.axis, ray);
  if (how.axis == Vec3{} || opposite < 1e-9) return how.up;
  return how.up - (how.axis + ray) * (dot(how.up, ray) / opposite);
}

// From the meridian frame of the light that comes along a ray to what the sensor measures.
Mueller BlockRun::sensor_matrix(const SensorRay& ray) const {
  const Polarimetry* const how = sensor_.polarimetry();
  if (!how) return Mueller::identity();
  const Dir k = -ray.ray.direction;
  Mueller m = Mueller::identity();
  Vec3 first{};  // axis of the sensor's frame, to be made upright on k
  if (how->frame == StokesFrame::image) first = upright(*how, ray.ray.direction);
  if (how->frame == StokesFrame::scattering_plane) first = *sun_;
  first = first - k * dot(first, k);
  if (const double size = length(first); size > 1e-12) m = frame_rotation(meridian_frame(k), first / size);
  return how->analyser ? *how->analyser * m : m;
}

// Whether the samples of a problem have to be asked for surfaces that they start on: when its first one does. (Where
// rays start at many places, few happen to lie on any.)
bool BlockRun::stands_on_surface(size_t i) {
  if (on_surface_[i] >= 0) return on_surface_[i] > 0;
  const auto [stream, number] = stream_of({static_cast<uint32_t>(i), 0});
  SensorRay first = ask_ray(sensor_, capture_, problems_[i], stream.draw(number, dimensions::kSensor.first), stream,
                            number, workspace_.unused);
  const Tracer& tracer = pipeline_.surface_.tracer();
  // Most cameras look from one place.
  const bool asked =
      clear_ && clear_->origin == first.ray.origin && (!tracer.window() || clear_->time == first.ray.time);
  on_surface_[i] = !asked && stand_off(tracer, first.ray, workspace_.touched, statistics_.trace);
  if (!on_surface_[i]) clear_ = first.ray;
  return on_surface_[i] > 0;
}

// Takes what a completed path has brought.
void BlockRun::take(uint32_t p) {
  const auto [place, sample] = workspace_.lanes[p];
  if (sample >= end_[place]) return;  // a rule has ended the problem meanwhile
  const size_t slot = slot_of(place);
  const int scramble = static_cast<int>(deal(sample).scramble);
  PathTracing& kernel = *workspace_.kernels[p];
  const PathRecord& record = kernel.record(p);
  ++statistics_.paths;
  statistics_.truncated += record.truncated;
  statistics_.strayed += record.leaked;
  sums_.take(slot, scramble);
  const double sum_before = watched_ ? reference_sum(slot) : 0;
  if (!add(p, slot, scramble)) {
    ++statistics_.failures;
    ++sums_.failures(slot, scramble);
    return;
  }
  if (watched_ && sample >= pipeline_.options_.change_after) {
    const double accepted = sums_.accepted(slot), mean = reference_sum(slot) / accepted;
    if (std::fabs(mean - sum_before / (accepted - 1)) <= pipeline_.options_.change * mean) end_[place] = 0;
  }
  sums_.truncated(slot, scramble) += static_cast<float>(record.truncated);
  if (pipeline_.truth_.wanted())
    pipeline_.truth_.add({record, record.met ? &kernel.first(p) : nullptr}, sums_.truth(slot, scramble));
}

// 0, or where samples may have a sign what no number is below: light behind analysers that warm matter sends, of which
// one direction is drawn, and rounding at crossed polarizers.
inline float BlockRun::lowest(size_t channel) const {
  return pipeline_.is_signed() || pipeline_.of_stokes() || pipeline_.channels_.is_signed(channel) ? -3e38f : 0;
}

// Adds the light of a path to its problem; false, with nothing added, when that is no light.
bool BlockRun::add(uint32_t p, size_t slot, int scramble) {
  double* const sums = sums_.sums(slot, scramble);
  if (plain_) {
    const std::span<const float> light = workspace_.throughputs.light(p);
    if (!good(light, lowest(0))) return false;
    const double before = sums[pipeline_.reference_band_];
    pipeline_.projection_.add(light, {sums, pipeline_.projection_.bands()});
    sums_.note_sample(slot, scramble, sums[pipeline_.reference_band_] - before);
    return true;
  }
  if (!acceptable(p, false)) return false;
  const double before = sums[pipeline_.reference_band_];
  const bool suns = capture_.bin_by == Capture::BinBy::sun;
  const size_t bin = suns ? 0 : bin_of(capture_, workspace_.kernels[p]->record(p));
  if (bin < capture_.bins) {
    add_light(p, bin, false, sums);
  }
  if (!suns) sums_.note_sample(slot, scramble, sums[pipeline_.reference_band_] - before);
  if (sums_.keeps_missing() && bin < capture_.bins && workspace_.sink.missed(p) < RadianceSink::kNothing)
    add_missing(p, slot, scramble, bin);
  return true;
}

// One comparison rejects NaN, infinity and negative radiance alike; such a sample is counted, not averaged in.
bool BlockRun::good(std::span<const float> light, float lowest) {
  constexpr float kMost = 3e38f;
  // Numbers that are not negative ascend with their bits; all else has greater ones.
  uint32_t most = 0;
  for (const float L : light) most = std::max(most, std::bit_cast<uint32_t>(L));
  if (most < std::bit_cast<uint32_t>(kMost)) return true;
  unsigned all = 1;
  for (const float L : light) all &= static_cast<unsigned>(L >= lowest) & static_cast<unsigned>(L < kMost);
  return all;
}
bool BlockRun::acceptable(uint32_t p, bool lost) {
  const ChannelPlan& channels = pipeline_.channels_;
  bool all = true;
  for (size_t channel = 0; channel < channels.size(); ++channel)
    for (size_t group = 0; group < workspace_.groups; ++group)
      all = all && good(workspace_.throughputs.light(p, workspace_.sink.target(group, channel, lost)), lowest(channel));
  return all;
}

// Adds the light of all channels to their sums, [channel][bin][band].
void BlockRun::add_light(uint32_t p, size_t bin, bool lost, double* sums) {
  const BandProjection& projection = pipeline_.projection_;
  const size_t bands = projection.bands();
  for (size_t channel = 0; channel < pipeline_.channels_.size(); ++channel)
    for (size_t group = 0; group < workspace_.groups; ++group) {
      double* const at = sums + (channel * capture_.bins + bin + group) * bands;
      projection.add(workspace_.throughputs.light(p, workspace_.sink.target(group, channel, lost)), {at, bands});
    }
}

// Adds what a path is known to have missed.
void BlockRun::add_missing(uint32_t p, size_t slot, int scramble, size_t bin) {
  if (!acceptable(p, true)) return;
  const Accumulators::Missing missing = sums_.missing(slot, scramble);
  double* const reference = missing.light + bin * pipeline_.projection_.bands() + pipeline_.reference_band_;
  const double before = *reference, chance = workspace_.sink.missed(p);
  add_light(p, bin, true, missing.light);
  const double seen = *reference - before;
  *missing.reference += seen;
  *missing.square += chance > 0 ? seen * (seen / chance) : INFINITY;
}

}  // namespace suite
