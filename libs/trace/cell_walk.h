// Takes rays through the cells of a periodic scene: each round they run to the side of the cell they are in, then come
// in again on the other side (paper, section IV-A, step 3a: account for the path, reinitialise at the scene boundary).
#pragma once
#include <span>
#include <vector>

#include "trace/tracer.h"

namespace suite {

class CellWalk {
 public:
  // Brings the rays to where they enter the heights that hold anything, and into the cell. distance: how far each may
  // go; empty = without end.
  void start(const Periodic& periodic, const Box3& bounds, std::span<const Ray> rays, std::span<const double> distance);
  // Fills how far every remaining ray may go in this round; false when none remains.
  bool next(std::vector<double>& reach) const;
  const std::vector<Ray>& rays() const { return rays_; }            // of this round
  size_t owner(size_t i) const { return state_[i].owner; }          // index in the list given to start
  double travelled(size_t i) const { return state_[i].travelled; }  // before this round
  void stop(size_t i) { state_[i].left = -1; }
  // Moves all others to the next cell and drops those that are done.
  void advance();

 private:
  struct State {
    size_t owner;
    double travelled, left;  // m
    double side;             // to the side of the cell
    uint32_t cells;
  };
  double to_side(const Ray& ray) const;
  void wrap(Ray& ray) const;
  Periodic cell_;
  double low_ = 0, high_ = 0;  // heights that hold anything
  std::vector<Ray> rays_;
  std::vector<State> state_;
};

}  // namespace suite
