// Definitions of kernel.h: its stages, and how paths fly.
#pragma once
#include "transport/kernel_start.h"

namespace suite {

template <class Wave>
bool PathKernel<Wave>::next(TraceRequest& request) {
  for (;;) switch (stage_) {
      case Stage::leave:
        if (active_.empty() && received_.empty() && !techniques_.residual.any_returned()) {
          first_stage_ = true;
          return false;
        }
        stage_ = Stage::beside;
        if (active_.empty()) break;  // all start at receivers or places in the air
        request_hits(request);
        return true;
      case Stage::beside:
        stage_ = techniques_.equiangular.begin(wave_, active_) ? Stage::look_beside : Stage::arrive;
        nodes_met_ += techniques_.equiangular.take_nodes();
        break;
      case Stage::look_beside:
        if (wave_.space.sight().next(request)) return true;
        techniques_.equiangular.answer(wave_);
        stage_ = Stage::arrive;
        break;
      case Stage::arrive:
        if (first_stage_ && above_) see_from_above();
        if constexpr (Space::kFills) fly();
        arrive();
        sample_lights();
        stage_ = Stage::look;
        break;
      case Stage::look:
        if (wave_.space.sight().next(request)) return true;
        if (techniques_.manifold.on()) look_through();
        stage_ = Stage::look_through;
        break;
      case Stage::look_through:
        if (next_through(request)) return true;
        resolve();
        stage_ = Stage::go_on;
        if (!techniques_.side.begin(wave_, request)) break;
        stage_ = Stage::fly_aside;
        return true;
      case Stage::fly_aside:
        nodes_met_ += techniques_.side.fly(wave_);
        stage_ = Stage::look_aside;
        break;
      case Stage::look_aside:
        if (wave_.space.sight().next(request)) return true;
        techniques_.side.answer(wave_);
        stage_ = Stage::go_on;
        break;
      case Stage::go_on:
        go_on();
        stage_ = Stage::settle;
        break;
      case Stage::settle:
        if (techniques_.chains.next_settled(wave_, techniques_.manifold, request)) return true;
        end_stage();
        stage_ = Stage::leave;
        break;
    }
}

template <class Wave>
void PathKernel<Wave>::request_hits(TraceRequest& request) {
  const size_t n = active_.size();
  for (size_t i = 0; i < n; ++i) {
    const Path& path = wave_.paths[active_[i]];
    rays_[i].set(wave_.space.ray_from(active_[i], path), path.direction, path.time, path.draw);
  }
  request = {TraceRequest::Kind::nearest, {rays_.data(), n}, first_stage_, {wave_.hits.data(), n}, {}, {}};
}

}  // namespace suite
