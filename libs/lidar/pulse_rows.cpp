#include "lidar/pulse_rows.h"

#include <algorithm>

#include "base/interrupt.h"
#include "math/instrument_frame.h"
#include "spectral/planck.h"
#include "transport/dimensions.h"
#include "transport/serve.h"

namespace suite {

namespace {

constexpr size_t kWave = 64;  // paths

// From the meridian frame of the light that comes along a ray of the receiver to the receiver's x.
Mueller sensor_matrix(const PulseAtWork& pulse, Dir direction) {
  const Dir way = -direction;
  return frame_rotation(meridian_frame(way), frame_about(way, pulse.receiver.vector({1, 0, 0})).e1);
}

}  // namespace

struct PulseRows::Job {
  Environment environment;
  PipelineOptions options;
  KernelContext context;
  uint16_t end;
  RangeSink sink;
  std::unique_ptr<StokesRangeSink> stokes_sink;  // where paths carry polarisation; else null
  std::unique_ptr<StokesThroughputs> stokes;
  std::unique_ptr<SpectralThroughputs> spectral;  // where they do not
  std::unique_ptr<PathTracing> kernel;
  bool passive, active;
  LaserEnd* laser;       // as Asked's
  bool scatters;         // media scatter its paths: PathRecord::scattered_first is known
  uint32_t waiting = 0;  // started paths

  // laser: where paths carry polarisation and look for it.
  struct Asked {
    bool tags, passive, active, polarised;
    LaserEnd* laser;
  };
  Job(const LineKit& kit, Environment lit, const PipelineOptions& method, uint16_t end_, const ReceiverEnd* receiver,
      uint32_t orders, bool without_first, const Asked& asked)
      : environment(std::move(lit)),
        options(method),
        context{.surface = kit.surface,
                .optics = kit.optics,
                .environment = environment,
                .options = options,
                .keep_first = asked.tags,
                .stokes = asked.polarised,
                .end = asked.active ? size_t{end_} : kNoLight},
        end(end_),
        sink(kWave, end, receiver, orders, without_first),
        kernel(make(asked)),
        passive(asked.passive),
        active(asked.active),
        laser(asked.laser),
        scatters(choose_kernel(context).in_media()) {}

  std::unique_ptr<PathTracing> make(const Asked& asked) {
    const size_t bins = context.optics.state().size();
    const KernelChoice choice = choose_kernel(context);
    if (!asked.polarised) {
      spectral = std::make_unique<SpectralThroughputs>(kWave, bins, 1);
      return make_kernel(choice, context, kWave, *spectral, sink);
    }
    stokes = std::make_unique<StokesThroughputs>(kWave, bins, 1);
    stokes_sink = std::make_unique<StokesRangeSink>(sink, asked.laser);
    return make_stokes_kernel(choice, context, kWave, *stokes, *stokes_sink);
  }

  void begin(uint32_t p, const Mueller& sensor) {
    if (spectral) return spectral->begin(p, 1, nullptr);
    stokes->begin(p, 1, nullptr);
    stokes->begin_rows(p, sensor);
  }

  void finish(const Tracer& tracer, PulseReport& report) {
    TraceStatistics statistics;
    complete(*kernel, tracer, statistics);
    for (uint32_t p = 0; p < waiting; ++p) report.truncated += kernel->record(p).truncated;
    report.paths += waiting;
    waiting = 0;
    if (laser) laser->forget();
  }
};

PulseRows::PulseRows(const TracePlan& plan, const LineKit& kit)
    : plan_(plan),
      kit_(kit),
      directions_(plan.beam, plan.field, kSpeedOfLight * plan.instrument.gate.start / 2,
                  kSpeedOfLight * plan.instrument.gate.stop / 2,
                  plan.instrument.orders == 1 && !kit.shines() ? FirstDirection::InField::spared
                                                               : FirstDirection::InField::needed) {
  const size_t bins = kit.optics.state().size();
  SUITE_CHECK_EQ(bins, size_t{1});
  if (plan.polarised && kit.environment.atmosphere)
    throw Error("the light of this air is known without its polarisation",
                "a laser without `stokes` and a receiver without `analysers`, or no air");
  End end;
  if (plan.laser_first) {
    const auto receiver = std::make_shared<ReceiverEnd>(plan.field, pulses_, bins);
    end = {receiver, receiver.get(), nullptr};
  } else {
    const auto stokes = plan.polarised ? std::optional<Stokes>(plan.instrument.laser.stokes) : std::nullopt;
    const auto laser = std::make_shared<LaserEnd>(plan.beam, pulses_, bins, stokes);
    end = {laser, nullptr, plan.polarised ? laser.get() : nullptr};
  }
  if (FirstScattering::any(kit)) once_ = std::make_unique<FirstScattering>(kit, *end.light, end.laser);
  active_ = make_job(end, !plan.laser_first && kit.shines());
  if (!plan.laser_first) return;
  if (kit.shines()) passive_ = make_job({}, true);
}

PulseRows::~PulseRows() = default;

auto PulseRows::make_job(const End& end, bool passive) -> std::unique_ptr<Job> {
  Environment lit = kit_.environment;
  if (!passive) lit.lights.clear(), lit.specs.clear(), lit.sun = kNoLight;
  const auto index = static_cast<uint16_t>(lit.lights.size());
  const bool active = end.light != nullptr;
  if (active) lit.lights.push_back(end.light), lit.specs.emplace_back();
  PipelineOptions method = plan_.options.method;
  method.seed = plan_.options.seed;
  method.gloss_photons = 0;
  if (!passive) {  // passive light has no last order
    const KernelContext context{kit_.surface, kit_.optics, lit, method};
    // Smooth interfaces are no orders of their own: a path may pass some more.
    constexpr uint32_t kPasses = 16;
    const uint32_t more = refracts(context) ? kPasses : 0;
    method.max_nodes = static_cast<int>(std::min<uint32_t>(plan_.instrument.orders, 1u << 20) + more);
    method.max_scatterings = plan_.instrument.orders;
  }
  const bool tags = plan_.tags.any();
  auto job = std::make_unique<Job>(kit_, std::move(lit), method, active ? index : uint16_t{0xfffd}, end.receiver,
                                   plan_.instrument.orders, once_ != nullptr,
                                   Job::Asked{tags, passive, active, plan_.polarised, end.laser});
  job->sink.serve(*job->kernel);
  if (plan_.polarised)
    job->sink.analyse(plan_.instrument.receiver.analysers,
                      plan_.head.channels.size() - plan_.instrument.receiver.analysers.size());
  if (tags) job->sink.tell_apart(plan_.tags);
  return job;
}

SensorRay PulseRows::from_receiver(Job& job, const PulseAtWork& pulse, size_t pixel, const std::array<double, 4>& u,
                                   RangeSink::Lane& lane) const {
  // Passive light needs the whole field; alone it is spread evenly over it.
  FirstDirection::Drawn drawn;
  if (job.active) {
    drawn = directions_.draw(pulse, pixel, u);
  } else {
    const Dir local = plan_.field.sample(pixel, {u[0], u[1]});
    drawn.direction = pulse.receiver.vector(local);
    if (const auto seen = plan_.field.at(local); seen && seen->pixel == pixel)
      drawn.importance = seen->importance / plan_.field.density(local);
  }
  const double photons = drawn.importance * kit_.photons_of_joule;
  lane.active = job.active ? photons * pulse.pulse.energy : 0;
  lane.passive = job.passive ? photons * plan_.instrument.receiver.filter_um * plan_.instrument.gate.bin : 0;
  return {{pulse.receiver.translation, drawn.direction, pulse.time}, 1};
}

SensorRay PulseRows::from_laser(const PulseAtWork& pulse, const SampleStream& stream, uint32_t sample,
                                const std::array<double, 4>& u) const {
  const std::array<double, 4> more = stream.draw(sample, dimensions::kSensorMore.first);
  const LaserBeam::Start start = plan_.beam.start({u[0], u[1]}, {more[0], more[1]});
  return {{pulse.laser.point(start.place), pulse.laser.vector(start.direction), pulse.time}, 1};
}

// Places on the first ray where matter scatters: as many that, over the paths of a scramble, most range bins of the
// gate have one.
void PulseRows::scatter_once(Job& job, const PulseAtWork& pulse, const Ray& ray, const FirstScattering::Strata& strata,
                             const Mueller& sensor, RangeSink::Lane& lane) {
  const Vec3 end = plan_.laser_first ? pulse.receiver.translation : pulse.laser.translation;
  const double start = pulse.pulse.start, stop = start + static_cast<double>(plan_.head.bins) * plan_.head.bin;
  once_->trace(ray, end, {start * kSpeedOfLight, stop * kSpeedOfLight}, strata, scattered_);
  for (const FirstScattering::Scattered& s : scattered_)
    job.sink.add_single(lane, s.arrival, s.light, s.spectrum, plan_.polarised ? sensor * s.stokes : s.stokes);
  lane.once_at_surface = once_->surface_share();
}

void PulseRows::start(Job& job, const SensorRay& ray, const SampleStream& stream, uint32_t sample,
                      const RangeSink::Lane& lane, const Mueller& sensor, PulseReport& report) {
  const uint32_t p = job.waiting++;
  job.sink.begin(p, lane);
  job.begin(p, sensor);
  job.kernel->start(p, ray, stream, sample);
  if (job.waiting == kWave) job.finish(plan_.tracer, report);
}

// Paths that leave the laser look for all pixels.
void PulseRows::add_path(std::span<RangeBins> rows) {
  for (RangeBins& row : rows) row.add_paths(1);
}

// Scramble s of n paths has those that are left over by one each from the first on.
void PulseRows::run(Job& job, const RowRange& range, bool from_laser, PulseReport& report) {
  const size_t pixels = range.last_pixel - range.first_pixel;
  const uint64_t paths = from_laser ? plan_.paths() : plan_.instrument.paths;
  const auto scrambles = static_cast<uint64_t>(plan_.scrambles);
  const auto directions = plan_.options.method.side_flights ? FirstScattering::Directions::towards_end
                                                            : FirstScattering::Directions::by_scattering;
  for (size_t k = 0; k < pulses_.size(); ++k) {
    const PulseAtWork& pulse = pulses_[k];
    for (size_t pixel = range.first_pixel; pixel < (from_laser ? range.first_pixel + 1 : range.last_pixel); ++pixel) {
      const uint64_t key =
          SampleStream::problem_key(plan_.options.seed, plan_.instrument_key, hash_of(pulse.number, pixel, job.active));
      RangeBins* const row = &rows_[k * pixels + pixel - range.first_pixel];
      for (uint64_t s = 0; s < scrambles; ++s) {
        const SampleStream stream(key, static_cast<uint32_t>(s));
        const auto count = static_cast<uint32_t>(paths / scrambles + (s < paths % scrambles));
        for (uint32_t sample = 0; sample < count; ++sample) {
          const std::array<double, 4> u = stream.draw(sample, dimensions::kSensor.first);
          RangeSink::Lane lane{row, static_cast<int>(s), pulse.pulse.energy * kit_.photons_of_joule, 0};
          SensorRay ray =
              from_laser ? this->from_laser(pulse, stream, sample, u) : from_receiver(job, pulse, pixel, u, lane);
          lane.active /= count, lane.passive /= count;
          if (job.active) add_path(from_laser ? std::span(rows_).subspan(k * pixels, pixels) : std::span(row, 1));
          if (lane.active == 0 && lane.passive == 0) continue;
          ray.ray.draw = static_cast<uint32_t>(hash_of(stream.key(), sample));  // as the kernel's path has it
          const Mueller sensor = plan_.polarised ? sensor_matrix(pulse, ray.ray.direction) : Mueller::identity();
          if (once_ && lane.active > 0)
            scatter_once(job, pulse, ray.ray,
                         {sample, count, std::clamp(plan_.head.bins / count, 4u, 128u), hash_of(key, s, 0x6f6e6365)},
                         sensor, lane);
          std::optional<FirstScattering::Onward> on;
          const SampleStream onward(key, static_cast<uint32_t>(scrambles + s));
          if (once_ && lane.active > 0 && plan_.instrument.orders > 1 && job.scatters &&
              plan_.options.forced_scattering)
            on = once_->go_on(ray.ray, onward.draw(sample, dimensions::kSensor.first), directions);
          lane.first_elsewhere = on.has_value();
          start(job, ray, stream, sample, lane, sensor, report);
          if (!on) continue;
          lane.active *= on->weight, lane.passive = 0;
          lane.arrival = on->arrival, lane.orders = 1, lane.first_elsewhere = false;
          start(job, {on->ray, 1}, onward, sample, lane, sensor * on->scattered, report);
        }
      }
    }
  }
  if (job.waiting > 0) job.finish(plan_.tracer, report);
}

void PulseRows::trace(const RowRange& range, ResponseBlock& block, PulseReport& report) {
  const FlushDenormals flush;
  const AtWork at_work(plan_.tracer);
  pulses_.clear(), rows_.clear();
  for (const PulseAtWork& pulse : range.pulses) {
    pulses_.add(pulse);
    for (size_t pixel = range.first_pixel; pixel < range.last_pixel; ++pixel)
      rows_.emplace_back(plan_.head, pulse.pulse.start, plan_.scrambles);
  }
  const double before_light = active_->sink.photons(), before_unknown = active_->sink.unknown();
  const uint64_t failed = active_->sink.failures() + (passive_ ? passive_->sink.failures() : 0);
  run(*active_, range, plan_.laser_first, report);
  if (passive_) run(*passive_, range, false, report);
  report.failures += active_->sink.failures() + (passive_ ? passive_->sink.failures() : 0) - failed;
  for (RangeBins& row : rows_) {
    report.outside += row.outside();
    row.end_row(block);
  }
  report.rows += rows_.size();
  const RangeSink& sink = active_->sink;
  report.met += sink.photons() - before_light, report.unknown_polarisation += sink.unknown() - before_unknown;
}

}  // namespace suite
