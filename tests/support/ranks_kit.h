// Programs on several ranks of MPI, in a test: SUITE_MPIEXEC is how they are started, empty where MPI was not found.
#pragma once
#include <string>

#include "base/error.h"

namespace suite {

// Open MPI's words, which others do not mind: more ranks than cores, as root, not each on a core of its own, in a
// container. It does not free all that it takes, so leaks are looked for in runs of one process alone.
constexpr const char* kRanksAnywhere =
    "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
    "OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_btl_vader_single_copy_mechanism=none "
    "ASAN_OPTIONS=detect_leaks=0 && ";

constexpr const char* kNoRanks = "MPI was not found when this build was configured";

inline bool has_ranks() { return *SUITE_MPIEXEC != '\0'; }

// What comes before a program that n ranks run; ended after 300 s.
inline std::string of_ranks(int n) { return strf("timeout -k 5 300 " SUITE_MPIEXEC " -n %d ", n); }

}  // namespace suite
