// Whether a bundle keeps its promises: values, totals, masses, sampling. (What the bytes must satisfy was checked when
// the file was read.)
#pragma once
#include "base/report.h"
#include "sqt/bundle.h"

namespace suite {

// The kinds of findings, IN101 to IN108.
std::vector<IssueKind> check_issues();
// Files every violation under `asset`. samples: draws per view and channel for the tests of sampling (significance 1e-3
// over all of them).
Report check_bundle(const sqt::Bundle& bundle, const std::string& asset, size_t samples);

}  // namespace suite
