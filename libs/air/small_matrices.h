// Dense matrices of a few rows, as the discrete ordinates need them: products, factors and the symmetric eigenproblem.
//
// Shapes: n x n, row by row, n = 1..64; vectors of n. Nothing allocates. A factor is what factor_* left in place.
// Based on: H. Bowdler, R. S. Martin, C. Reinsch, J. H. Wilkinson, "The QR and QL algorithms for symmetric matrices",
// Numer. Math. 11, 1968; R. S. Martin, C. Reinsch, J. H. Wilkinson, "Householder's tridiagonalization of a symmetric
// matrix", same volume; G. Golub, C. Van Loan, "Matrix computations", 1996, chapters 3 and 4.
#pragma once

namespace suite::small {

constexpr int kMostRows = 64;

void multiply(const double* a, const double* b, double* product, int n);
// y = a x, y = a^T x.
void apply(const double* a, const double* x, double* y, int n);
void apply_transposed(const double* a, const double* x, double* y, int n);
// sum over j of w_j (column j of a) (column j of a)^T.
void weighted_square(const double* a, const double* w, double* sum, int n);

// The lower triangle L of a = L L^T in the place of a's lower triangle; false when a is not positive definite.
bool factor_cholesky(double* a, int n);
// x (n x columns, row by row) becomes L^-1 x or L^-T x.
void solve_lower(const double* factor, double* x, int n, int columns);
void solve_lower_transposed(const double* factor, double* x, int n, int columns);

// a = P L U with row exchanges in pivot; x (n x columns) becomes a^-1 x. A zero pivot is left to give infinities.
void factor_lu(double* a, int* pivot, int n);
void solve_lu(const double* factor, const int* pivot, double* x, int n, int columns);

// Eigenvalues of a symmetric matrix, and orthonormal eigenvectors as the columns of a in its place, in no order. Most
// accurate for the small ones when the large entries of a stand at its lower right end. False: no convergence (never
// seen; NaNs).
bool symmetric_modes(double* a, double* values, int n);

}  // namespace suite::small
