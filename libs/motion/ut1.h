// UT1 over a span of time: it runs through leap seconds without a step, so that UT1 - UTC steps by one there.
#pragma once
#include "motion/time.h"

namespace suite {

// UT1 - UTC (s) at an instant, of one that is dut1 at `epoch`. Between leap seconds it is taken as constant (it drifts
// by 1 to 2 ms a day).
double dut1_at(Instant instant, Instant epoch, double dut1);

}  // namespace suite
