// The kernel of media in air whose light knows the scene.
#include "transport/estimators/standard.h"
#include "transport/kernel_beside.h"
#include "transport/kernel_fill.h"
#include "transport/kernel_fly.h"
#include "transport/kernel_go_on.h"
#include "transport/kernel_light.h"
#include "transport/kernel_meet.h"
#include "transport/media/space_lit_field.h"

namespace suite {

std::unique_ptr<PathTracing> make_lit_field_kernel(const KernelContext& c, size_t width,
                                                   SpectralThroughputs& throughputs, Sink<SpectralThroughputs>& sink) {
  return std::make_unique<PathKernel<Wave<AnySurfaces, LitFieldSpace, SpectralThroughputs, StandardEstimator>>>(
      c, width, throughputs, sink);
}

}  // namespace suite
