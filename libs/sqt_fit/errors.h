// How far a bundle is from the function it was fitted to. The reference values are asked once, so that many fits of one
// function can be measured.
//
// Definitions (f the data, g the bundle, both without cosine; sums over both directions uniform on the hemisphere):
//   l1       = sum |g - f| cos_i / sum f cos_i, polar angles up to 80 deg
//   cos_rmse = sqrt( sum ((g - f) cos_i)^2 / sum (f cos_i)^2 ), up to 80 deg
//   rmse     = sqrt( mean (g - f)^2 ), 1/sr, whole hemisphere (the paper's metric)
//   peak_ratio_20/45/70 = largest g over largest f in the plane of incidence at that view angle, up to 80 deg
//   total_error = largest |W_g - W_f| / W_f over view angles up to 80 deg, W_g integrated from g where f is valid
//   reciprocity_error: sqt/reciprocity.h
//   max_weight = largest w / (pdf W) met while sampling the bundle, up to 80 deg
// For functions over the sphere "hemisphere" reads sphere; cos_i is 1 for phase functions and intensities.
// Pairs where the data are not valid are left out. The uniform sums are estimated with half of the pairs drawn near the
// mirror direction and weighed accordingly.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sqt/bundle.h"

namespace suite::sqt {

struct ErrorFigures {
  double l1 = 0, cos_rmse = 0, rmse = 0, peak_ratio_20 = 0, peak_ratio_45 = 0, peak_ratio_70 = 0, total_error = 0,
         reciprocity_error = 0, max_weight = 0;
};

class Reference {
 public:
  // pairs: number of direction pairs. The same seed gives the same pairs.
  Reference(const Function& function, size_t pairs, uint64_t seed = 1,
            const std::function<void(double)>& progress = {});
  // One entry per channel and a last one over all channels (sums over channels; maxima of the maxima).
  std::vector<ErrorFigures> measure(const Bundle& bundle) const;
  // l1 and cos_rmse over all channels only (fast).
  struct Brief {
    double l1 = 0, cos_rmse = 0;
  };
  Brief brief(const Bundle& bundle) const;
  double l1(const Bundle& bundle) const { return brief(bundle).l1; }
  // Largest g over largest f in the plane of incidence at view angles of 20, 45 and 70 deg, of a channel. Phase
  // functions and intensities: the plane through the pole.
  std::array<double, 3> peaks(const Bundle& bundle, size_t channel) const;
  // The same of the channel where it is smallest, at every angle.
  std::array<double, 3> least_peaks(const Bundle& bundle) const;
  // Unphysical data, measured on the way.
  struct Findings {
    double largest_total = 0;      // over view angles up to 80 deg and channels
    double reciprocity_error = 0;  // of the data
    double negative_share = 0, invalid_share = 0;
  };
  const Findings& findings() const { return findings_; }

 private:
  struct Pair {
    Dir out, in;
    float weight;  // of the uniform measure
    bool narrow;   // both within 80 deg
  };
  const Function& function_;
  bool weighted_;
  size_t channels_;
  std::vector<Pair> pairs_;
  std::vector<float> value_;    // [pair][channel]
  std::vector<double> theta_;   // of the totals
  std::vector<double> total_;   // [theta][channel]
  std::vector<uint8_t> valid_;  // [theta][point] of the integration
  struct Plane {                // of incidence at a view angle of the peaks
    Dir out;
    std::vector<Dir> in;       // where the data are valid
    std::vector<double> peak;  // [channel], of the data
  };
  std::array<Plane, 3> planes_;
  struct Sums;  // of squares and differences
  void ask(Pair& pair, const std::array<double, 4>& u, double w, std::span<double> f, float* value) const;
  void find_totals();
  void find_peaks();
  void find_unphysical();
  void add_pairs(const Bundle& bundle, size_t begin, size_t end, std::span<Sums> sums) const;
  void measure_channel(const Bundle& bundle, size_t channel, ErrorFigures& out) const;
  Findings findings_;
  // Totals per channel; points where not every channel is finite do not count.
  std::vector<double> integrate(const std::function<void(size_t, Dir, Dir, std::span<double>)>& f, Dir out) const;
};

}  // namespace suite::sqt
