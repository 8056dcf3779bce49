// The published table of everything scene preparation can find wrong, with stable codes.
#pragma once
#include <vector>

#include "base/report.h"

namespace suite {

// Rows in ascending order of code. Codes are never reused for another meaning.
std::vector<IssueKind> scene_issues();

}  // namespace suite
