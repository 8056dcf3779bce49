// Real air of a simulation text: `atmosphere` with a `profile`.
#pragma once
#include <memory>

#include "air/air_spec.h"
#include "base/params.h"
#include "light/light_rows.h"

namespace suite {

// Located Error for anything wrong.
std::shared_ptr<const AirSpec> read_air(const Params& p, const LightContext& context);

}  // namespace suite
