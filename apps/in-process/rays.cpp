#include "apps/in-process/rays.h"

#include <algorithm>
#include <map>

#include "apps/in-process/border.h"

namespace suite {

RaySensor::RaySensor(std::string name, SpectralState state, std::vector<Band> bands, const Capture& like,
                     const RayRequests& rays, const RayAnswers& answers)
    : name_(std::move(name)), state_(std::move(state)), bands_(std::move(bands)), rays_(rays), answers_(answers) {
  std::map<double, std::vector<size_t>> by_time;
  for (size_t i = 0; i < rays.count; ++i) by_time[rays.time[i]].push_back(i);
  Task task{"rays", {by_time.begin()->first, by_time.rbegin()->first}, {}};
  for (auto& [time, members] : by_time) {
    Capture capture;
    capture.name = strf("rays at %.9g s", time);
    capture.window = {time, time};
    capture.columns = static_cast<uint32_t>(members.size());
    capture.rows = 1;
    capture.convergence = like.convergence;
    capture.band_targets = like.band_targets;
    capture.neighbours = false;
    capture.reversed = 0;
    capture.bin_by = Capture::BinBy::none;
    task.captures.push_back(std::move(capture));
    members_.push_back(std::move(members));
  }
  tasks_.push_back(std::move(task));
}

SensorRay RaySensor::ray(const RayRequest& request) const {
  // Captures are told apart by their times, which ascend.
  const auto later = [](const Capture& c, double t) { return c.window.begin < t; };
  const std::vector<Capture>& all = tasks_[0].captures;
  const auto at = std::lower_bound(all.begin(), all.end(), request.capture.window.begin, later) - all.begin();
  const size_t i = members_[static_cast<size_t>(at)][request.problem];
  return {{row3(rays_.origin, i), normalized(row3(rays_.direction, i)), rays_.time[i]}};
}

void RaySensor::accept(CaptureResult&& result) {
  const std::vector<size_t>& members = members_[result.capture];
  for (size_t p = 0; p < members.size(); ++p) {
    const auto from = static_cast<std::ptrdiff_t>(p * result.bands);
    const size_t to = members[p] * result.bands;
    std::copy_n(result.radiance.begin() + from, result.bands, answers_.radiance + to);
    std::copy_n(result.standard_error.begin() + from, result.bands, answers_.standard_error + to);
    if (answers_.quality) answers_.quality[members[p]] = result.quality[p];
  }
}

}  // namespace suite
