// Totals of the data before reduction, by the points of a pyramid's leaves. Internal to libs/sqt_fit.
#pragma once
#include "sqt_fit/aligned_source.h"

namespace suite::sqt {

// A leaf of the pyramid and its node there; -1 = no pyramid yet, or nothing is known of it.
struct SurveyedLeaf {
  CellId id;
  ptrdiff_t node = -1;
};

// Leaves of an assembled sheet. Those of which nothing is known, nor of any cell above them, have no node.
std::vector<SurveyedLeaf> leaves_of(const AlignedLayout& layout, const AlignedSource::Impl::Sheet& sheet);

// Totals at every fine view angle: the function at the points of the leaves ([sheet][leaf]); where it has no data above
// the horizon, what the pyramid knows of the leaf from the nearest views. sheets may be empty when no leaf has a node.
// totals: theta, phi_count and magnitude_um are set; fills magnitudes.
void survey_totals(const Function& function, const AlignedLayout& layout,
                   const std::vector<std::vector<SurveyedLeaf>>& leaves,
                   const std::vector<AlignedSource::Impl::Sheet>& sheets, AlignedTotals& totals);

// The Dirac lobe beside the values, if there is one.
void survey_dirac(const Function& function, const AlignedLayout& layout, AlignedTotals& totals);

// Mean log2 weight that StepRule refers to, from the totals; rounded so that it can be stored in a byte.
int step_reference(const AlignedTotals& totals, const AlignedLayout& layout);

}  // namespace suite::sqt
