// How bright a scene is from above: its albedo for even light.
//
// Method: paths from all over the scene's outline, their directions as of even light from above, are reflected and
// transmitted by its surfaces until they leave again; what leaves upwards of what met something is the albedo, all
// bins along the same paths. Media are passed by; beyond surfaces without end the scene's finite part is looked at.
// Error: the standard error of the mean over bins is returned.
#pragma once
#include <memory>
#include <vector>

#include "air/air_spec.h"
#include "surface/optics.h"
#include "trace/tracer.h"

namespace suite {

struct SceneAlbedo {
  std::vector<float> of_bins;  // 0..1; empty: nothing was met
  double error = 0;            // standard error of their mean
};
// At a time (s) within the tracer's window. The same on any number of threads.
SceneAlbedo scene_albedo(const Tracer& tracer, const Optics& optics, double time);

inline bool asks_for_scene(const std::shared_ptr<const AirSpec>& air) {
  return air && (air->ground_of_scene || air->ground_of_any_scene);
}
// Air whose even ground is as bright as the scene, if it asks for that, else the air itself; the albedo runs through
// the middles of the bins' intervals. Error: nothing was met, and it must be.
std::shared_ptr<const AirSpec> over_scene(const std::shared_ptr<const AirSpec>& air, const Tracer& tracer,
                                          const Optics& optics, double time);

}  // namespace suite
