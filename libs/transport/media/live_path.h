// The paths that travel through media.
#pragma once
#include "transport/lane.h"

namespace suite {
using LivePath = Lane<kMaxKnots>;
}  // namespace suite
