// Gathers the contributions of one row: photons at their optical arrival, scramble by scramble, into range bins with
// variances.
//
// An impulse between the middles of two bins is split by its place (linear), so that sum and centroid are exact; nearer
// to an end of the gate than half a bin all of it goes to the last bin. The variance of a bin is that of the mean of
// the scrambles, which are independent of each other. Based on: PBRT's and mitransient's rules of deposit differ
// (nearest bin); the linear split is the cloud-in-cell assignment of Hockney & Eastwood, "Computer Simulation Using
// Particles", 1988, chapter 5.
#pragma once
#include <map>

#include "detection/response.h"

namespace suite {

class RangeBins {
 public:
  // scrambles: >= 2; every one estimates the whole value.
  RangeBins(const ResponseHead& head, double start, int scrambles);
  // A further channel that has a share of the photons.
  struct Part {
    size_t channel;
    double share;
  };
  // photons: of this path, its weight and 1 / paths of the scramble in it, >= 0. tag: channel above kMultiple, 0 =
  // none. Arrivals outside of the bins are counted in outside().
  void deposit(int scramble, double arrival, double photons, bool multiple, size_t tag = 0,
               std::span<const Part> parts = {});
  // Photons within a bin's width.
  void passive(int scramble, double photons, bool multiple, size_t tag = 0, std::span<const Part> parts = {});
  // Paths that were asked, of all scrambles.
  void add_paths(uint64_t n) { paths_ += n; }
  double outside() const { return outside_; }  // photons, mean of the scrambles

  // Appends the row to a block and forgets it. The bound of bins never reached: with N paths none of which came, at
  // most 3 / N do (95 %, rule of three; Hanley & Lippman-Hand, JAMA 249, 1983), each with at most the largest
  // contribution of the row: 3 x the largest photons of a single path. NaN when no path contributed.
  void end_row(ResponseBlock& block);

 private:
  void add(uint32_t bin, int scramble, double photons, bool multiple, size_t tag, std::span<const Part> parts);
  struct Cell {
    uint32_t contributions = 0;
    std::vector<double> sums;  // scrambles x channels
  };
  const ResponseHead& head_;
  double start_;
  int scrambles_;
  uint64_t paths_ = 0;
  double outside_ = 0, largest_ = 0;
  std::map<uint32_t, Cell> cells_;
};

}  // namespace suite
