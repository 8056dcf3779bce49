// The Mueller matrices of a suffix's events over their m11, as a product from the node on towards the light: what lies
// between a path and a light that a technique connects it with. Matrices stand between meridian frames of the world
// (math/mueller.h), so that neighbours multiply as they are. Where no event tells wavelengths apart there is one
// product for all of them.
#pragma once
#include <span>
#include <vector>

#include "math/mueller.h"
#include "optics/scatter_model.h"
#include "transport/contribution.h"

namespace suite {

class SuffixMatrices {
 public:
  // Nothing has happened yet.
  void begin() { size_ = 0, event_.unknown = 0; }
  // That of another.
  void begin(const SuffixMatrices& as);
  // Memory for the matrices of the next event towards the light, one a bin; all events have as many.
  std::span<Mueller> next(size_t bins) {
    next_.resize(bins);
    return next_;
  }
  // Takes what stands there: on the right of the product.
  void take(ScatterModel::Polarised next);
  // All of it as one event; null: nothing has happened. Stays until the next change.
  const PolarisedEvent* event() {
    event_.matrices = {product_.data(), size_};
    return size_ > 0 ? &event_ : nullptr;
  }

 private:
  std::vector<Mueller> product_, next_;
  size_t size_ = 0;  // of the product: 1 or the bins; 0: there is none
  PolarisedEvent event_;
};

// Of algebras that carry no polarisation.
struct NoMatrices {
  void begin(const NoMatrices&) {}
};

}  // namespace suite
