#include "heat/slab_neighbours.h"

#include <cmath>

#include "base/error.h"

namespace suite {

SlabNeighbours::SlabNeighbours(std::span<const Contact> contacts, std::vector<double> areas)
    : areas_(std::move(areas)), begins_(areas_.size() + 2, 0) {
  for (const double a : areas_)
    if (!(a > 0 && std::isfinite(a))) throw Error(strf("an element of %g m2 has neighbours", a), "more than 0");
  for (const Contact& c : contacts) {
    if (c.a >= size() || c.b >= size() || c.a == c.b || !(c.ratio > 0 && std::isfinite(c.ratio)))
      throw Error(strf("elements %u and %u touch, length over distance %g", c.a, c.b, c.ratio),
                  strf("two of %zu, more than 0", size()));
    ++begins_[c.a + 2], ++begins_[c.b + 2];
  }
  for (size_t e = 2; e < begins_.size(); ++e) begins_[e] += begins_[e - 1];
  others_.resize(2 * contacts.size() + 1);
  for (const Contact& c : contacts) {
    others_[begins_[c.a + 1]++] = {c.b, c.ratio / areas_[c.a]};
    others_[begins_[c.b + 1]++] = {c.a, c.ratio / areas_[c.b]};
  }
}

}  // namespace suite
