// The working memory of one thread in a pipeline: the kernel and what its paths gather.
#pragma once
#include <memory>
#include <vector>

#include "transport/pipeline.h"
#include "transport/sinks/radiance.h"
#include "transport/sinks/stokes.h"

namespace suite {

// A path of a wave: which problem of the block it belongs to, and which of its samples it is.
struct WaveLane {
  uint32_t place, sample;
};

struct Pipeline::Workspace {
  // own: the capture's own lights, null where the pipeline's environment shines; context: over what shines. width:
  // paths that run together; groups, channels, lost: of RadianceSink.
  Workspace(const KernelContext& context, std::unique_ptr<const Environment> own, const Capture& capture, size_t width,
            size_t groups, const ChannelPlan& channels, bool lost);
  // Whether it is what would be made for a capture with channels.
  bool serves(const Capture& capture, const ChannelPlan& channels) const;
  std::unique_ptr<PathTracing> make();
  // The kernel that serves a ray: what was chosen for the state, or, for rays that start at receivers, a general one.
  PathTracing& kernel_of(const SensorRay& ray);

  std::unique_ptr<const Environment> environment;
  std::vector<Dir> suns;
  KernelContext context;
  size_t width, groups;
  RadianceSink sink;
  StokesSink stokes_sink;
  std::unique_ptr<SpectralThroughputs> plain;  // one of the two
  std::unique_ptr<StokesThroughputs> stokes;
  SpectralThroughputs& throughputs;
  std::unique_ptr<PathTracing> kernel, receiving;
  std::vector<WaveLane> lanes;                 // of the wave that is being filled or run
  std::vector<std::array<double, 4>> numbers;  // [path] of the sensor
  std::vector<SampleStream::Point> points;
  std::vector<PathTracing*> kernels;  // [path]
  std::vector<float> weights;         // [path][bin], of rays that weigh wavelengths
  std::vector<float> unused;          // [bin], of rays that are only looked at
  std::vector<Hit> touched;
};

}  // namespace suite
