// The cards that a run repeats before its spectra: fixed columns of 5 and 10 characters.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "formats/tape7/tape7.h"

namespace suite {

struct Tape7Cards {
  std::optional<int> mode, multiple;  // IEMSCT, IMULT of card 1
  std::optional<Tape7Geometry> geometry;
};
// lines: what stands between two runs. first, last: the wavenumbers of the run, by which its card 4 is known. What the
// cards do not say in a known place is left out.
Tape7Cards tape7_cards(const std::vector<std::string>& lines, double first, double last);

}  // namespace suite
