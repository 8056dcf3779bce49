#include "sqt/region.h"

namespace suite::sqt {

bool Region::holds(CellXY c, int order) const {
  if (half_only) {
    // Azimuths in (0, pi): faces 0, 1, 5, 8, 9 whole, faces 4 and 6 up to their diagonal.
    if (c.face == 2 || c.face == 3 || c.face == 7 || c.face == 10 || c.face == 11) return false;
    if (c.face == 4 && c.x < c.y) return false;
    if (c.face == 6 && c.x > c.y) return false;
  }
  if (upper_only) {
    if (c.face >= 8) return false;
    // In the belt z falls with x + y; z = 0 at x + y = 1.
    if (c.face >= 4 && c.x + c.y < (1u << order) - 1) return false;
  }
  return true;
}

}  // namespace suite::sqt
