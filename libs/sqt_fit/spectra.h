// The spectra of which the differences in a pyramid are made: what takes the place of the cosine transform where there
// are many channels. Internal to libs/sqt_fit.
//
// Based on: K. Karhunen 1947, M. Loeve 1948 (the transform of the data's own covariance); subspace iteration: H.
// Rutishauser, Numer. Math. 16, 1970.
#pragma once
#include "sqt_fit/aligned_source.h"

namespace suite::sqt {

// Orthonormal rows [row][channel] in units of 1/AlignedLayout::kSpectrumUnit, the most important first, so many that
// the rest of the differences lies below the steps of every useful quality; none for few channels, where they would
// cost more than they save. details of the sheets: not transformed yet.
std::vector<int16_t> choose_spectra(const AlignedLayout& layout, const AlignedTotals& totals,
                                    const std::vector<AlignedSource::Impl::Sheet>& sheets);

}  // namespace suite::sqt
