// The text of the Error an action throws; "no error" when it throws none.
#pragma once
#include <string>

#include "base/error.h"

namespace suite {

template <class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace suite
