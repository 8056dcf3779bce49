// Searches for ways through smooth interfaces that wait for their rays beside each other, as a stage of the kernel has
// begun them.
#pragma once
#include <vector>

#include "transport/refracted/search.h"
#include "transport/trace_request.h"

namespace suite {

class RefractedSearches {
 public:
  void clear() { waiting_.clear(), answered_ = false; }
  // One more begins, with the first call of next(). Numbers ascend from 0.
  void add() {
    if (waiting_.size() == searches_.size()) searches_.emplace_back();
    waiting_.push_back(static_cast<uint32_t>(waiting_.size()));
  }
  // The next request, to be served before the next call; false when none waits any longer. advance(i, search, hit)
  // takes search i on: hit, what the ray of its leg has met, is null the first time; false: it needs no more rays.
  template <class Advance>
  bool next(TraceRequest& request, const Advance& advance) {
    size_t kept = 0;
    rays_.resize(waiting_.size());
    for (size_t j = 0; j < waiting_.size(); ++j) {
      const uint32_t i = waiting_[j];
      if (!advance(i, searches_[i], answered_ ? &hits_[j] : nullptr)) continue;
      waiting_[kept] = i;
      rays_[kept++] = searches_[i].leg.ray;
    }
    waiting_.resize(kept), rays_.resize(kept), hits_.resize(kept);
    answered_ = true;
    request = {TraceRequest::Kind::nearest, rays_, false, hits_, {}, {}};
    return kept > 0;
  }

 private:
  std::vector<RefractedSearch> searches_;  // the others keep their memory
  std::vector<uint32_t> waiting_;          // of them
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  bool answered_ = false;  // hits_ are those of waiting_
};

}  // namespace suite
