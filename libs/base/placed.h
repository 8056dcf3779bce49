// Faults that a library found in what a user wrote, where only the caller knows the place of that.
#pragma once
#include <string>

#include "base/error.h"

namespace suite {

// The fault at its own place, else at `where`, with `whose` before its message.
inline Error placed(const Error& fault, const Where& where, const std::string& whose = {}) {
  return Error(fault.where().file.empty() ? where : fault.where(), whose + fault.message(), fault.hint(), fault.code());
}

}  // namespace suite
