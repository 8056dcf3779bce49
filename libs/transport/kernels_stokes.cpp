// The kernels of paths that carry polarisation.
#include "transport/estimators/standard.h"
#include "transport/kernel_back.h"
#include "transport/kernel_branch.h"
#include "transport/kernel_chain.h"
#include "transport/kernel_claims.h"
#include "transport/kernel_fly.h"
#include "transport/kernel_gloss.h"
#include "transport/kernel_go_on.h"
#include "transport/kernel_guide.h"
#include "transport/kernel_light.h"
#include "transport/kernel_refract.h"
#include "transport/kernel_side.h"
#include "transport/kernel_stokes.h"
#include "transport/media/space_field.h"
#include "transport/stokes_throughputs.h"

namespace suite {

std::unique_ptr<PathTracing> make_stokes_kernel(const KernelChoice& choice, const KernelContext& c, size_t width,
                                                StokesThroughputs& throughputs, Sink<StokesThroughputs>& sink) {
  if (choice.space == KernelChoice::Space::field)
    return std::make_unique<PathKernel<AnySurfaces, FieldSpace, StokesThroughputs, StandardEstimator>>(
        c, width, throughputs, sink);
  SUITE_CHECK(choice.space == KernelChoice::Space::nothing);
  return std::make_unique<PathKernel<AnySurfaces, NothingSpace, StokesThroughputs, StandardEstimator>>(
      c, width, throughputs, sink);
}

}  // namespace suite
