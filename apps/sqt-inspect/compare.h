// A bundle against the data it was fitted to. Written without regard to the fitter's own error code: another set of
// directions, sums taken afresh.
//
// Figures (f data, g bundle, both over cosine-free values; directions uniform on the hemisphere, or on the sphere for
// data of both sides; c = |cos in|, 1 for phase functions and intensities):
//   l1 = sum |g - f| c / sum f c, cos_rmse = sqrt(sum ((g - f) c)^2 / sum (f c)^2): polar angles up to 80 deg;
//   rmse = sqrt(mean (g - f)^2), 1/sr, whole hemisphere; bias = sum (g - f) c / sum f c;
//   peak_ratio_t = largest g / largest f in the plane of incidence at view t deg, polar angles up to 80 deg.
#pragma once
#include <string>
#include <vector>

#include "base/json.h"
#include "formats/picture/picture.h"
#include "sqt/bundle.h"
#include "sqt_fit/samples.h"

namespace suite {

struct Comparison {
  struct Figures {
    double l1 = 0, cos_rmse = 0, rmse = 0, bias = 0, peak_ratio_20 = 1, peak_ratio_45 = 1, peak_ratio_70 = 1;
  };
  std::vector<Figures> channels;
  Figures overall;  // sums over channels; the peak ratio farthest from 1
  size_t pairs = 0, invalid = 0;
  std::string text() const;
  Json json() const;
};

// Error when the channels of a fit and of data differ in number or wavelength.
void require_same_channels(const sqt::Bundle& bundle, const sqt::Function::Info& data);

// The channels must be the same. pairs: directions asked (Sobol points, half of them in a lobe around the mirror
// direction, weighed back to the uniform measure).
Comparison compare(const sqt::Bundle& bundle, const sqt::Function& data, size_t pairs);
// Over the samples themselves; each pair counts once, with its cosine. No peak ratios.
Comparison compare(const sqt::Bundle& bundle, const sqt::Samples& data);

// Sheet of (g - f) / (g + f) over incident directions at six view angles, -1 blue to +1 red.
Canvas draw_errors(const sqt::Bundle& bundle, const sqt::Function& data, size_t channel, const std::string& title);

}  // namespace suite
