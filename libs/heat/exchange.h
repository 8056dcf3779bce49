// Longwave exchange between elements, all reflections included, and the surface histories it couples.
//
// Assumes: grey faces; every element has one temperature and one emissivity.
// Method: a row of the matrix says where what an element could emit ends: the shares of it that each element absorbs
// and that leave to the outside (B. Gebhart, "A new method for calculating radiant exchanges", ASHRAE Trans. 65, 1959).
// By reciprocity the same shares weigh what the element receives, so that one matrix, whose rows sum to 1, gives
//   received[i] = sum over j of share[i][j] emitted[j],  emitted = sigma T^4,  net flux = emissivity (received -
//   emitted)
// for black ends and mirrors alike; a box of one temperature stays at it.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "heat/histories.h"

namespace suite {

class ExchangeMatrix {
 public:
  struct Entry {
    uint32_t end;  // an element, or elements() + number of an outside
    double share;
  };
  // outsides: sky, sun-lit distance, ... whose emitted histories are given.
  ExchangeMatrix(size_t elements, size_t outsides);

  // The next element's row, in any order, an end possibly more than once. Shares are divided by their sum, so that rows
  // sum to 1 to rounding. Error: an unknown end, a share that is negative, a sum that is not 1 within 1e-6.
  void add_row(std::span<const Entry> row);
  // All rows at once, taking over what they are made of: of row i the entries begins[i] to begins[i + 1], with
  // shares of any sum above 0; an end possibly more than once.
  static ExchangeMatrix of_rows(size_t outsides, std::vector<size_t> begins, std::vector<uint32_t> ends,
                                std::vector<float> shares);
  size_t elements() const { return elements_; }
  size_t outsides() const { return outsides_; }
  size_t entries() const { return ends_.size(); }
  // Of a matrix by of_rows(), with the rows alone whose shares differ from another's by `alike` or more altogether.
  ExchangeMatrix differing(const ExchangeMatrix& other, double alike) &&;
  bool has_row(size_t element) const { return begins_[element] < begins_[element + 1]; }

  // emitted: W/m2, `moments` of the first end, then of the next, ..., outsides last; received likewise, of the
  // elements. All rows must be there. In parallel over elements.
  void receive(std::span<const double> emitted, size_t moments, std::span<double> received) const;
  // Of one element; received has a value a moment, emitted the rows of all ends.
  void receive_one(size_t element, const Histories& emitted, std::span<double> received) const;

 private:
  size_t elements_, outsides_;
  std::vector<size_t> begins_;
  std::vector<uint32_t> ends_;
  std::vector<float> shares_;    // as many as paths ended: 4 bytes each
  std::vector<double> factors_;  // of a row's shares, so that these sum to 1
};

// Is told W/m2 that a row emits, by moment.
using PutEmitted = std::function<void(uint32_t row, std::span<const double> emitted)>;
// One sweep in place: pieces of the elements (0 to pieces) answer to what all emit, some pieces to the same; then their
// answers take its place, and the next ones see that. In parallel, the same on any number of threads. Returns the
// largest change, K. Error: an answer that is not positive.
double answer_in_place(Histories& emitted, size_t pieces,
                       const std::function<void(size_t piece, const PutEmitted& put)>& answer);
// Sets all elements' rows once; returns the largest change, K.
using Sweep = std::function<double(Histories& emitted)>;

// What the elements answer when all ends emit as in `around` (elements, then outsides): sets the rows of `emitted`,
// W/m2. What an element receives is receive_one() of it.
using Respond = std::function<void(const Histories& around, Histories& emitted)>;

struct CouplingOptions {
  double tolerance = 1e-3;  // K: estimated distance from the coupled state
  int most_sweeps = 100;
  size_t memory = 0;  // differences Anderson's method keeps; 0 = plain sweeps, enough where much sky is seen
};
struct CouplingResult {
  int sweeps = 0;
  double change = 0;    // K, largest of the last sweep
  double distance = 0;  // K, as estimated from the change and its contraction
};
// Waveform relaxation in place, elements after elements (Gauss and Seidel): one history of all ends. Error: as
// couple_histories.
CouplingResult relax_histories(Histories& emitted, size_t elements, const Sweep& sweep,
                               const CouplingOptions& options = {});
// Waveform relaxation: from the emitted histories of all ends (elements, as guessed, then outsides, as given) the
// answer of every element over the whole time, and again, until the histories of the elements are within the tolerance,
// or as near as histories can tell. Plain sweeps hold two of them, the given ones and their answer; of every difference
// that is kept (`memory`) there are two more, in doubles. Error: not within most_sweeps, or an answer that is not
// positive. Based on: E. Lelarasmee, A. Ruehli, A. Sangiovanni-Vincentelli, IEEE Trans. CAD 1, 1982; Anderson 1965
// (anderson.h).
CouplingResult couple_histories(const ExchangeMatrix& exchange, Histories& emitted, const Respond& respond,
                                const CouplingOptions& options = {});

}  // namespace suite
