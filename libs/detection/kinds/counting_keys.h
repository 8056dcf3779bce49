// What the kinds that count have in common: keys, and clicks as returns.
#pragma once
#include "detection/counting.h"
#include "detection/detectors.h"

namespace suite {

// Keys dark_rate_hz, afterpulse {probability, mean_ns}, crosstalk, jitter_fwhm_ns, jitter_tail {share, mean_ns},
// hold_off_ns, resolution_ns; with_dead_time: dead_time_ns and paralysable, too.
CountingSpec read_counting(const Params& params, bool with_dead_time);
// Key step_ns: of the rates; a tenth of the pulse's FWHM, at most 1 ns, unless given.
double read_counting_step(const Params& params, const PulseShape& pulse);
// Adds clicks to the records of their pixels; `of` pixels behind each other are one record.
void add_clicks(std::span<PixelRecord> records, std::span<const Click> clicks, uint32_t of);

}  // namespace suite
