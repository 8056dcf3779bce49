#include "detection/kinds/counting_keys.h"

#include <algorithm>

namespace suite {

CountingSpec read_counting(const Params& p, bool with_dead_time) {
  CountingSpec s;
  if (with_dead_time) {
    s.dead = p.number_in("dead_time_ns", 0, 1e9, "ns") * 1e-9;
    s.paralysable = p.boolean("paralysable", false);
  }
  if (const auto a = p.find("afterpulse")) {
    s.afterpulse = a->number_in("probability", 0, 0.95, "");
    s.afterpulse_time = a->number_in("mean_ns", 1e-6, 1e9, "ns") * 1e-9;
  }
  s.crosstalk = p.number_in("crosstalk", 0, 0.24, "", 0);
  s.jitter = p.number_in("jitter_fwhm_ns", 0, 1e6, "ns", 0) * 1e-9;
  if (const auto t = p.find("jitter_tail")) {
    s.tail = t->number_in("share", 0, 1, "");
    s.tail_time = t->number_in("mean_ns", 1e-6, 1e6, "ns") * 1e-9;
  }
  s.hold_off = p.number_in("hold_off_ns", 0, 1e9, "ns", 0) * 1e-9;
  s.resolution = p.number_in("resolution_ns", 0, 1e6, "ns", 0) * 1e-9;
  return s;
}

double read_counting_step(const Params& p, const PulseShape& pulse) {
  const double usual = pulse.fwhm() > 0 ? std::min(pulse.fwhm() / 10, 1e-9) : 1e-10;
  return p.number_in("step_ns", 1e-4, 1e5, "ns", usual * 1e9) * 1e-9;
}

void add_clicks(std::span<PixelRecord> records, std::span<const Click> clicks, uint32_t of) {
  for (const Click& c : clicks) {
    LidarReturn r;
    r.time = c.time, r.amplitude = 1, r.signal = c.cause == Click::Cause::signal;
    records[c.pixel / of].returns.push_back(r);
  }
  for (PixelRecord& r : records) number_returns(r.returns);
}

}  // namespace suite
