// The kernels of paths that carry polarisation.
#include "transport/estimators/standard.h"
#include "transport/kernel_beside.h"
#include "transport/kernel_fill.h"
#include "transport/kernel_fly.h"
#include "transport/kernel_go_on.h"
#include "transport/kernel_light.h"
#include "transport/kernel_meet.h"
#include "transport/media/space_field.h"
#include "transport/stokes_throughputs.h"
#include "transport/wave_stokes.h"

namespace suite {

std::unique_ptr<PathTracing> make_stokes_kernel(const KernelChoice& choice, const KernelContext& c, size_t width,
                                                StokesThroughputs& throughputs, Sink<StokesThroughputs>& sink) {
  if (choice.space == KernelChoice::Space::field)
    return std::make_unique<PathKernel<Wave<AnySurfaces, FieldSpace, StokesThroughputs, StandardEstimator>>>(
        c, width, throughputs, sink);
  if (choice.space == KernelChoice::Space::air)
    return std::make_unique<PathKernel<Wave<AnySurfaces, AirSpace, StokesThroughputs, StandardEstimator>>>(
        c, width, throughputs, sink);
  SUITE_CHECK(choice.space == KernelChoice::Space::nothing);
  return std::make_unique<PathKernel<Wave<AnySurfaces, NothingSpace, StokesThroughputs, StandardEstimator>>>(
      c, width, throughputs, sink);
}

}  // namespace suite
