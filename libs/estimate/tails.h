// Which reported standard errors may be far too small because rare events carry the light: the rule behind
// quality_heavy_tail.
//
// The standard error that a problem may really have is compared with the one that it reports: the flag is raised where
// the first exceeds kTailFactor times the second by more than `share` of the problem's scale (its radiance, or its
// target's absolute floor where that is more). So it never fires on ratios of small numbers, and it fires where a user
// would be misled. What a standard error may really be has three sources:
//
// - What the neighbours on all sides saw, if they look at the same kind of thing (around.h, four problems far): their
//   mean variance of a path tells what this problem may have missed. The reported error knows half of it already
//   (pooled_errors.h).
// - The problem's own few events. When fewer than twelve samples like the largest make up all of the sum, and the
//   largest is at least three times the mean (no ordinary side of an edge), their count c scatters like Poisson's,
//   and the standard error is sqrt(c + 1) of their effect on the mean, also when the scrambles happen to agree. It is
//   taken twice (what the count leaves possible at 95 %), but at most three times what the neighbours saw: an edge
//   through a problem is sampled far better than Poisson's law.
// - Scrambles that agree better than a tenth of what one sample like the largest moves the mean by: the few values that
//   an edge leaves were dealt evenly, and two samples more or less would not have been noticed.
//
// What it costs: a problem between edges on all sides within four problems, of things many times brighter than itself,
// is flagged although nothing may be missing; from its samples it cannot be told from one among rare glints.
// Only the reference band of the first bin is judged: bands share their paths. An event that neither the problem nor
// any neighbour saw leaves no trace; where problems have no neighbours only the first source exists.
#pragma once
#include <span>
#include <vector>

#include "sensor/sensor.h"

namespace suite {

// One problem at the reference band.
struct TailSums {
  double mean = 0;     // W/(m2 sr um)
  double error = 0;    // of the mean, as reported; may be infinite (nothing is known about it: no flag)
  double sampled = 0;  // error of the mean as the problem's own scrambles tell it
  float largest = 0;   // sample, W/(m2 sr um)
  uint32_t paths = 0;
  double share = 0;  // of the scale: the target for the relative error, or kTailShare
  double floor = 0;  // W/(m2 sr um), of the scale
};

// Standard errors at the reference band that the problems around each one let expect (around.h), [problem]: those two
// problems far, or where nobody there knows of any, four.
std::vector<double> errors_around(std::span<const TailSums> of, uint32_t columns);

// Raises quality_heavy_tail in `quality` where it holds; row-major, as many as `of`, which has whole rows of `columns`.
// neighbours: problems beside each other look at things beside each other.
void flag_heavy_tails(std::span<const TailSums> of, uint32_t columns, bool neighbours, std::span<uint8_t> quality);

}  // namespace suite
