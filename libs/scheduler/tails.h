// Which reported standard errors may be far too small because rare events carry the light: the rule behind
// quality_heavy_tail.
//
// The standard error that a problem may really have is compared with the one that it reports: the flag is raised where
// the first exceeds kTailFactor times the second by more than `share` of the problem's scale (its radiance, or its
// target's absolute floor where that is more). So it never fires on ratios of small numbers, and it fires where a user
// would be misled. What a standard error may really be has three sources:
//
// - What the neighbours saw. Their mean variance of a path tells what this problem may have missed, if they look at the
//   same kind of thing: a neighbour counts when the two means agree within four of their joint standard errors or
//   within the share. Things of another brightness that are well resolved, as beyond an edge, do not; an event that one
//   of two happened to see leaves a standard error as large as itself, so its neighbour does. And they have to lie all
//   around: of eight half-planes beside the problem, each with the two problems next to it on its boundary and cut to
//   9 x 9 problems, the one with the least mean decides, so that an edge beside a problem does not count while one that
//   runs through it does. Near the rim of a picture, half-planes that are mostly outside do not count.
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

#include "sensor/sensor.h"

namespace suite {

// One problem at the reference band.
struct TailSums {
  double mean = 0, error = 0;  // W/(m2 sr um); error of the mean, may be infinite (nothing is known about it: no flag)
  float largest = 0;           // sample, W/(m2 sr um)
  uint32_t paths = 0;
  double share = 0;  // of the scale: the target for the relative error, or kTailShare
  double floor = 0;  // W/(m2 sr um), of the scale
};

// Raises quality_heavy_tail in `quality` where it holds; row-major, as many as `of`, which has whole rows of `columns`.
// neighbours: problems beside each other look at things beside each other.
void flag_heavy_tails(std::span<const TailSums> of, uint32_t columns, bool neighbours, std::span<uint8_t> quality);

}  // namespace suite
