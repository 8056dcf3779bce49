// Elements of one construction that touch, and so conduct heat to each other along the surface, layer by layer.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace suite {

class SlabNeighbours {
 public:
  struct Contact {
    uint32_t a = 0, b = 0;  // elements
    double ratio = 0;       // of the length that they touch along to the distance of their middles
  };
  // areas: m2, of each element. Error: an unknown element, one that touches itself, ratios and areas that are not
  // positive.
  SlabNeighbours(std::span<const Contact> contacts, std::vector<double> areas);

  struct Other {
    uint32_t element;
    double ratio;  // of the contact, over this one's area, 1/m2: what a square metre of it gives, W/m2, for each W/K
  };
  size_t size() const { return areas_.size(); }
  std::span<const Other> of(size_t element) const {
    return {&others_[begins_[element]], begins_[element + 1] - begins_[element]};
  }
  double area(size_t element) const { return areas_[element]; }

 private:
  std::vector<double> areas_;
  std::vector<size_t> begins_;
  std::vector<Other> others_;
};

}  // namespace suite
