// Without MPI a process is always alone.
#include "base/error.h"
#include "cluster/launched.h"
#include "cluster/ranks.h"

namespace suite {

std::unique_ptr<Ranks> join_ranks() {
  const Launched how = launched();
  if (!how.together) return nullptr;
  // All would say the same.
  if (!how.first) throw EndedElsewhere();
  throw Error("started as one of several ranks, but MPI was not there when this program was built",
              "install it (scripts/install does) and rebuild, or run parts (--part)");
}

}  // namespace suite
