#include "transport/sight.h"

namespace suite {

bool PlainSight::look(size_t begin, size_t end, bool coherent, TraceRequest& request) const {
  if (begin == end) return false;
  const size_t n = end - begin;
  request = {TraceRequest::Kind::occluded,        rays_->rays().subspan(begin, n),   coherent, {},
             rays_->distance().subspan(begin, n), rays_->blocked().subspan(begin, n)};
  return true;
}

bool PlainSight::next(TraceRequest& request) {
  if (part_ == 0 && ++part_ && look(0, rays_->parallel, rays_->first, request)) return true;
  if (part_ == 1 && ++part_ && look(rays_->parallel, rays_->size(), false, request)) return true;
  if (!lost_) return false;
  if (part_ == 2 && ++part_) {
    wanted_.resize(rays_->size());
    for (size_t i = 0; i < wanted_.size(); ++i) wanted_[i] = rays_->blocked()[i] && rays_->losable()[i];
    lost_->begin(rays_->rays(), rays_->distance(), wanted_);
  }
  return lost_->next(request);
}

}  // namespace suite
