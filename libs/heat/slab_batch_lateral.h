// Equations of all elements of a batch at once, with conduction along the surface between them.
//
// Method: conjugate gradients (M. R. Hestenes, E. Stiefel, J. Res. Natl. Bur. Stand. 49, 1952) in the inner product
// weighed by area, in which the equations are symmetric; each element's own, its neighbours held, precondition them. So
// elements that hardly feel each other take a turn or two, and any others as many as they need. Sums are taken block by
// block in their order: the same bits on any number of threads.
#pragma once
#include "heat/slab_batch.h"

namespace suite {

class SlabBatch::Lateral {
 public:
  // Conductivities that depend on temperature are those at the batch's present state. Keeps a reference to the batch.
  explicit Lateral(const SlabBatch& batch);
  using State = std::vector<Lanes>;  // by block and node

  // Adds the factor times what flows in from neighbours, W/m2.
  void add(const State& kelvin, double factor, State& to) const;
  // heat(x) - scale gain(x) = history by Newton's method, from the guess in kelvin; gives what is stored then. faces at
  // the fraction of the step. False: none is found.
  bool solve(const State& history, const std::vector<FaceEnds>& faces, double fraction, double scale, State& kelvin,
             State& heat);
  // The matrix of that at temperatures, for solve_linear.
  void linearise(const State& kelvin, const std::vector<FaceEnds>& faces, double fraction, double scale);
  // (capacity C + weight (K + L + faces)): of the batch's present properties, slopes W/(m2 K) by element.
  void linearise(double capacity, double weight, std::span<const double> top, std::span<const double> bottom);
  // In place, until what is left, as a share of `first` (of the right side, when 0, which it is set to), is small, or
  // after very many turns, which the next change of solve() shows.
  void solve_linear(State& right, double share, double& first);

 private:
  size_t blocks() const { return blocks_; }
  struct Link {  // of an element to a neighbour
    uint32_t lane;
    size_t other;  // of its top node's number, in doubles
    double ratio;  // 1/m2
  };
  // Calls with the node, W/(m2 K) between, where the other's value is, and the element's lane, of all links of a block.
  template <class Use>
  void every_link(size_t block, const Use& use) const;
  double along(size_t node, double kelvin) const {
    return along_[0][node] + kelvin * (along_[1][node] + kelvin * (along_[2][node] + kelvin * along_[3][node]));
  }
  template <class Body>
  void every_block(const Body& body) const;
  template <class Term>
  double sum(const Term& term) const;  // of blocks
  Lanes weights(size_t block) const;
  void factor(size_t block, double scale);
  void precondition(size_t block, const State& right, State& out) const;
  void take_neighbours(size_t block, const State& of, State& from) const;
  double product(size_t block, const State& a, const State& b) const;

  const SlabBatch& b_;
  const SlabNeighbours& net_;
  size_t n_, blocks_;
  double scale_ = 0;
  std::array<std::vector<double>, 4> along_;  // W/K by node: coefficients of 1, T, T^2, T^3
  std::vector<Link> links_;                   // block by block
  std::vector<size_t> first_link_;            // by block; blocks + 1
  std::vector<Row> rows_;                     // factored: diagonal = 1 / pivot
  double floor_ = 0;                          // of products: nothing, in kelvin
};

}  // namespace suite
