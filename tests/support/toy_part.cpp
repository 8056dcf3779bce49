// A part that programs may load late: TOY_VERSION decides whether it says what version it is of.
#include "base/late_part.h"

namespace suite {
#ifdef TOY_VERSION
extern "C" {
extern const char* const suite_part_version;
const char* const suite_part_version = TOY_VERSION;
}
#else
SUITE_PART_VERSION;
#endif

extern "C" {
extern const int toy_answer;
const int toy_answer = 42;
}
}  // namespace suite
