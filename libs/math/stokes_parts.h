// Which of a Stokes vector is asked for: V costs where it has to be solved for.
#pragma once

namespace suite {

enum class StokesParts { linear, all };  // I, Q and U; or V as well

}  // namespace suite
