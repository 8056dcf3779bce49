// Edges of light and shadow that pass over an element: when each of its points is lit, told from what others saw.
//
// Method: an edge that passes in a straight line, evenly, comes to a point at a time that is linear in where the point
// lies (and in which point of the sun's disk it looks at). The line is fitted to the points of the commonest sequence
// of changes. What is told so need not be true: it stands as a control variate for what points that were not asked
// would have seen (J. M. Hammersley, D. C. Handscomb, Monte Carlo methods, 1964, section 5.5), which is unbiased as
// long as it is told from other points than those it is compared with.
#pragma once
#include <array>
#include <span>
#include <vector>

namespace suite {

// One point through the day.
struct PointDay {
  std::array<double, 4> place{};  // m along the element, two directions; of the sun's disk, radii
  bool lit_first = false;         // at the begin
  std::vector<double> changes;    // s, ascending: lit and dark in turn
};

class PassingEdges {
 public:
  // points: what is known, in any number. wide_sun: where on its disk they look matters. finest: s, within which
  // changes are known.
  PassingEdges(std::span<const PointDay* const> points, bool wide_sun, double finest);
  // Whether an edge was found to move; else nothing is told.
  bool moves() const { return moves_; }
  // The day at a place, with changes from `begin` to `end` (s).
  PointDay at(const std::array<double, 4>& place, double begin, double end) const;
  // Whether it is lit there at a time.
  bool lit_at(const std::array<double, 4>& place, double t) const;

 private:
  struct Line {
    double mean = 0;                // s
    std::array<double, 4> slope{};  // s/m, s/radius
  };
  double passes(const Line& line, const std::array<double, 4>& place) const;  // s
  Line fit(std::span<const PointDay* const> points, size_t change, size_t dimensions, double& score) const;

  bool lit_first_ = false, moves_ = false;
  std::array<double, 4> centre_{};
  std::vector<Line> lines_;  // by change
};

}  // namespace suite
