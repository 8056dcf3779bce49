// What the problems around one tell about the variance of its paths.
//
// A neighbour counts when the two means agree within four of their joint standard errors or within a given difference:
// then both look at the same kind of thing. Things of another brightness that are well resolved, as beyond an edge, do
// not; an event that one of two happened to see leaves a standard error as large as itself, so its neighbour does. And
// they have to lie all around: of eight half-planes beside the problem, each with the two problems next to it on its
// boundary and cut to (2 reach + 1)^2 problems, the one with the least mean decides, so that an edge beside a problem
// does not count while one that runs through it does. A half-plane of which the picture holds less than a third of
// what it holds of another does not count.
//
// Assumes: problems beside each other look at things beside each other.
#pragma once
#include <vector>

namespace suite {

// A problem as its neighbours see it.
struct Seen {
  double mean = 0;      // W/(m2 sr um)
  double square = 0;    // of its standard error
  double variance = 0;  // of one path
};

// Row-major.
struct SeenGrid {
  long columns, rows;
  std::vector<Seen> seen;
};

// Variance of one path of problem (x, y), as those around tell it; 0 when none is alike. same: difference of means that
// is none. reach: of the half-planes, 2 or 4 problems.
double variance_around(const SeenGrid& grid, long x, long y, double same, long reach);

// The mean over all problems within four, on whatever side, whose means differ by `same` at most: less careful about
// edges, and never 0 where one of them varies.
double variance_nearby(const SeenGrid& grid, long x, long y, double same);

}  // namespace suite
