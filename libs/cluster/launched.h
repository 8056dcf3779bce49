// Whether this process was started together with others, by what launchers put into its environment.
#pragma once
#include <cstdlib>

namespace suite {

struct Launched {
  bool together = false;
  bool first = true;  // rank 0, as far as that is told
};

// Open MPI's mpirun tells sizes as OMPI_..., the launchers of MPICH and Intel MPI as PMI_SIZE; srun --mpi=pmix tells
// the rank as PMIX_RANK and the size as SLURM_NTASKS.
inline Launched launched() {
  struct Names {
    const char *size, *rank;
  };
  for (const Names& names : {Names{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"}, Names{"PMI_SIZE", "PMI_RANK"},
                             Names{"SLURM_NTASKS", "PMIX_RANK"}}) {
    const char *const size = std::getenv(names.size), *const rank = std::getenv(names.rank);
    if (size && rank) return {std::atoi(size) > 1, std::atoi(rank) == 0};
  }
  return {};
}

}  // namespace suite
