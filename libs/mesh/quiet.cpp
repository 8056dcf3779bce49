#include "mesh/quiet.h"

#include <mutex>

#include <OpenMesh/Core/System/omstream.hh>

namespace suite {

void quiet_openmesh() {
  static std::once_flag once;
  std::call_once(once, [] { omerr().disable(); });
}

}  // namespace suite
