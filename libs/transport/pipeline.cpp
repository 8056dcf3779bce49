#include "transport/pipeline.h"

#include <immintrin.h>

#include "light/kinds/sun.h"
#include "transport/block_run.h"
#include "transport/workspace.h"

namespace suite {

namespace {

// Sums of one wave: paths of many suns run fewer together.
constexpr size_t kMostFloats = size_t{1} << 22;

}  // namespace

void check(const PipelineOptions& options) {
  if (options.lamp_draws < 1 || options.lamp_draws > LightNature::kMostDraws)
    throw Error(strf("%d lamps a node are not between 1 and %d", options.lamp_draws, LightNature::kMostDraws));
  if (options.max_nodes < 0) throw Error(strf("max nodes %d is not 0 (no limit) or more", options.max_nodes));
}

Pipeline::Pipeline(const Surface& surface, const Optics& optics, const Environment& environment,
                   const SpectralState& state, const BandProjection& projection, size_t reference_band,
                   const TruthPlan& truth, const ChannelPlan& channels, const PipelineOptions& options)
    : surface_(surface),
      optics_(optics),
      environment_(environment),
      state_(state),
      projection_(projection),
      reference_band_(reference_band),
      truth_(truth),
      channels_(channels),
      options_(options) {
  if (options_.method == Method::paper && !optics.media().empty())
    throw Error("the paper's estimator knows surfaces only", "render scenes with media by the standard method");
  if (of_stokes()) check_stokes();
  check(options_);
  if (options_.method == Method::paper && options_.max_nodes == 0) options_.max_nodes = kPaperNodes;
  choice_ = choose_kernel(context(environment_));
  gloss_ = make_gloss();
  mirrors_ = make_mirrors();
}

Pipeline::~Pipeline() = default;

void Pipeline::check_stokes() const {
  if (options_.method == Method::paper)
    throw Error("the paper's estimator knows no polarisation", "render Stokes vectors by the standard method");
  if (environment_.atmosphere && !optics_.media().empty())
    throw Error("the light of air around media is known without its polarisation",
                "Stokes vectors need the air traced: `scattering: traced` for `air`; or no media, or no air");
  if (environment_.atmosphere && !environment_.atmosphere->polarisation(channels_.parts()))
    throw Error("the light of this air is known without its polarisation",
                "Stokes vectors need air with a `profile`, or no air");
}

namespace {

// What shines on a capture under many suns: they, and nothing else.
std::unique_ptr<const Environment> suns_of(const Capture& capture, const SpectralState& state) {
  if (capture.bin_by != Capture::BinBy::sun) return nullptr;
  auto suns = std::make_unique<Environment>();
  SunSpec spec;
  spec.half_angle = 0;
  spec.irradiance = Curve::constant(1);
  for (const Dir& towards : capture.suns) {
    spec.direction = towards;
    suns->lights.push_back(std::make_shared<Sun>(spec, state));
  }
  return suns;
}

}  // namespace

// Suns of a capture of their own are other lights than those that photons have been sent by.
KernelContext Pipeline::context(const Environment& environment) const {
  return {surface_,
          optics_,
          environment,
          options_,
          truth_.wanted(),
          false,
          true,
          channels_.of_water(),
          &environment == &environment_ ? gloss_.get() : nullptr,
          channels_.of_stokes(),
          mirrors_.get(),
          channels_.parts()};
}

std::unique_ptr<const GlossGuide> Pipeline::make_gloss() const {
  if (choice_.matte || options_.gloss_photons == 0 || !options_.explicit_sources || options_.method != Method::standard)
    return nullptr;
  std::vector<GlossPhoton> photons = gloss_photons(surface_, optics_, environment_, options_.gloss_photons);
  return photons.empty() ? nullptr : std::make_unique<GlossGuide>(std::move(photons));
}

// Images of far points are unpolarised light, which a mirror does not leave so.
std::unique_ptr<const FlatMirrors> Pipeline::make_mirrors() const {
  const auto& lights = environment_.lights;
  const bool points = std::any_of(lights.begin(), lights.end(), [](const auto& light) { return light->points(); });
  if (!points || choice_.matte || !leaves_points() || of_stokes()) return nullptr;
  auto mirrors = std::make_unique<const FlatMirrors>(surface_.tracer(), optics_);
  return mirrors->any() ? std::move(mirrors) : nullptr;
}

bool Pipeline::may_miss(const Capture& capture) const {
  const auto suns = suns_of(capture, state_);
  return may_lose(context(suns ? *suns : environment_));
}

namespace {
// Not where a path's one end says where its light belongs.
KernelContext with_branches(KernelContext context, const Capture& capture) {
  context.branches = capture.bin_by != Capture::BinBy::escape;
  return context;
}
}  // namespace

Pipeline::Workspace::Workspace(const KernelContext& x, std::unique_ptr<const Environment> own, const Capture& capture,
                               size_t w, size_t g, const ChannelPlan& channels, bool lost)
    : environment(std::move(own)),
      suns(capture.suns),
      context(with_branches(x, capture)),
      width(w),
      groups(g),
      sink(w, g, channels, lost),
      stokes_sink(sink),
      plain(x.stokes ? nullptr : std::make_unique<SpectralThroughputs>(w, x.optics.state().size(), sink.targets())),
      stokes(x.stokes ? std::make_unique<StokesThroughputs>(w, x.optics.state().size(), sink.targets()) : nullptr),
      throughputs(stokes ? *stokes : *plain),
      kernel(make()),
      numbers(width),
      kernels(width),
      weights(width * x.optics.state().size()),
      unused(x.optics.state().size()) {}

bool Pipeline::Workspace::serves(const Capture& capture, const ChannelPlan& channels) const {
  const auto same = [](const Dir& a, const Dir& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
  return sink.channels() == channels && context.branches == with_branches(context, capture).branches &&
         (environment != nullptr) == (capture.bin_by == Capture::BinBy::sun) &&
         (!environment || std::equal(suns.begin(), suns.end(), capture.suns.begin(), capture.suns.end(), same));
}

std::unique_ptr<PathTracing> Pipeline::Workspace::make() {
  return stokes ? make_stokes_kernel(choose_kernel(context), context, width, *stokes, stokes_sink)
                : make_kernel(choose_kernel(context), context, width, throughputs, sink);
}

PathTracing& Pipeline::Workspace::kernel_of(const SensorRay& ray) {
  if (ray.receiver == SensorRay::Receiver::none) return *kernel;
  if (!receiving) {
    context.receivers = true;
    receiving = make();
  }
  return *receiving;
}

std::unique_ptr<Pipeline::Workspace> Pipeline::borrow(const Capture& capture) const {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      std::unique_ptr<Workspace> found = std::move(idle_.back());
      idle_.pop_back();
      if (found->serves(capture, channels_)) return found;
      idle_.clear();
    }
  }
  auto suns = suns_of(capture, state_);
  const KernelContext from = context(suns ? *suns : environment_);
  const bool lost = may_lose(from);
  const size_t groups = suns ? capture.suns.size() : 1;
  const size_t targets = RadianceSink(1, groups, channels_, lost).targets();
  const size_t width = std::clamp<size_t>(kMostFloats / (targets * state_.size()), 1, kWaveWidth);
  return std::make_unique<Workspace>(from, std::move(suns), capture, width, groups, channels_, lost);
}

void Pipeline::run(const Sensor& sensor, const Capture& capture, uint64_t capture_id, const Block& block,
                   std::span<const uint32_t> to, Accumulators& sums, Slots slots, RunStatistics& statistics) const {
  const FlushDenormals flush;
  const uint64_t start = __rdtsc();
  std::unique_ptr<Workspace> workspace = borrow(capture);
  BlockRun(*this, sensor, capture, capture_id, block, to, sums, slots, statistics, *workspace).run();
  statistics.cycles += __rdtsc() - start;
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(workspace));
}

}  // namespace suite
