// What scene-prep does with its options.
#pragma once
#include "options.h"

namespace suite {

int run_scene_prep(const ScenePrepOptions& options);

}  // namespace suite
