// Mueller matrices that can exist: their coherency matrix H = 1/4 sum m_ij sigma_i x sigma_j* (least_coherency) has no
// negative eigenvalue.
// Based on: S. R. Cloude, "Group theory and polarisation algebra", Optik 75, 1986.
#pragma once
#include "math/mueller.h"

namespace suite {

// Whether all eigenvalues of H exceed a number: faster than the least of them.
bool coherency_exceeds(const Mueller& m, double least);

// The same matrix with negative eigenvalues of H taken as 0, and its m11, >= 0, kept: what noise of a measurement or an
// approximation has made impossible becomes possible. A matrix that is possible stays as it is.
Mueller physical(const Mueller& m);

}  // namespace suite
