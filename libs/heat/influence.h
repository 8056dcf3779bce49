// Elements that do not matter to what is seen: which may be left out, and how far off what is seen is at most without.
//
// Method: what is left out is put as warm as the air. All surfaces together answer more infrared with higher, less with
// lower temperatures (air, layers behind and neighbours only take from the difference), so that temperatures shifted
// by d of each element bound those with all elements when what the shift radiates makes up for what more may arrive:
//   T^4 - (T - d)^4 = sum over j of share[i][j] x[j],
//   x = (T[j] + d[j])^4 - T[j]^4 of elements that are kept, what a surface of `hottest` emits beyond the air of others,
// T the coldest of i's history, the warmest of j's. The least such d is the limit of an iteration from 0.
//
// Assumes: the shares that the paths found, for both; nothing is warmer than `hottest`; properties of layers that do
// not depend on temperature; diffuse surfaces in the infrared (what mirrors show is not a mean over directions).
#pragma once
#include <vector>

#include "heat/exchange_paths.h"

namespace suite {

class Influence {
 public:
  // exchange: of all faces. hottest: K, what nothing that is left out is warmer than. Keeps references.
  Influence(const ExchangePaths& exchange, const HeatFaces& faces, double hottest);
  double hottest() const { return hottest_; }

  // K, coldest and warmest of a span, by face of all.
  struct Range {
    std::vector<double> low, high;
  };
  // By element, whether it is kept, the fewest found: all that are seen, and what keeps off_at_most() within the limit
  // (K) when all temperatures are near one (K).
  std::vector<bool> kept_for(const std::vector<bool>& seen, double limit, double kelvin) const;
  // K, of the elements that are seen; hottest() where there is no bound. air: coldest and warmest, K. Of elements that
  // are left out ranges do not matter.
  double off_at_most(const std::vector<bool>& seen, const std::vector<bool>& kept, const Range& range,
                     std::array<double, 2> air) const;

 private:
  std::vector<double> importance(const std::vector<bool>& seen) const;
  const ExchangePaths& exchange_;
  const HeatFaces& faces_;
  std::vector<uint32_t> element_;  // by face
  size_t elements_ = 0, outsides_;
  double hottest_;
  ExchangeMatrix matrix_;
};

// The paths of the faces that are left when elements (and their faces) are: what ended on the others ends on what is as
// warm as the air. kept: by element of `all`.
ExchangePaths left_of(const ExchangePaths& exchange, const HeatFaces& all, const HeatFaces& left,
                      const std::vector<bool>& kept);

}  // namespace suite
