// The paper's texture maps: every pixel of an image gets one of a family of measured curves, so that the variation is
// correlated in space as the image is and across wavelengths as the curves are.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "spectral/curve.h"

namespace suite {

// The number of the curve of each pixel. image: pixels x bands (row-major); band b of it stands for the mean over
// bands_um[b]. Pixels are ranked by their standardised band values along the direction in which the curves vary most,
// curves likewise, and equal ranks are matched: every curve is used equally often (to one pixel), so the mean and the
// whole covariance across wavelengths of the family are those of the map, whatever the image's own contrast. Error:
// fewer than one curve, a curve that does not cover a band. Based on: Goodenough & Brown, section III-A-3 (texture maps
// after Schott et al. 1995); D. Coltuc et al., "Exact histogram specification", IEEE TIP 15, 2006.
std::vector<uint16_t> choose_curves(std::span<const float> image, size_t bands, std::span<const Curve> family,
                                    std::span<const std::array<double, 2>> bands_um);

}  // namespace suite
