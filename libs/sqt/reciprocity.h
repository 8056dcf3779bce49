// By how much values change when both directions are exchanged: the one definition that every program reports.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "sqt/bundle.h"

namespace suite::sqt {

// sum |f(o,i) - f(i,o)| / sum (|f(o,i)| + |f(i,o)|), 0 to 1, over pairs of directions uniform on the hemisphere, both
// up to 80 deg from the normal; per channel, and a last one over all channels. 25,000 fixed pairs, half of them drawn
// near the mirror direction and weighed accordingly. Pairs with a value that is not finite are left out.
std::vector<double> reciprocity_error(size_t channels,
                                      const std::function<void(Dir out, Dir in, std::span<double> f)>& value);
std::vector<double> reciprocity_error(const Bundle& bundle);  // zeros for what is no surface
inline constexpr double kNotReciprocal = 0.02;                // reported from here on

}  // namespace suite::sqt
