// What ranks pay for talking to each other: mpirun -n 2 link_bench prints the four numbers that
// `dirsig-render --dry-run --ranks N --link ...` takes. On one machine it measures its memory; between nodes
// (mpirun -n 2 --map-by node) their network.
#include <cstdio>

#include "cluster/ranks.h"

int main() {
  const auto ranks = suite::join_ranks();
  if (!ranks || ranks->size() != 2) {
    std::fprintf(stderr, "link_bench: error: wants two ranks: mpirun -n 2 link_bench\n");
    return ranks ? ranks->conclude(2) : 2;
  }
  const suite::LinkCosts costs = ranks->measure_link();
  if (ranks->leads())
    std::printf("--link %.3g,%.3g,%.3g,%.3g\n", 1e6 * costs.fetch, 1e6 * costs.message, 1e-9 * costs.rate,
                1e-9 * costs.take);
  return ranks->conclude(0);
}
