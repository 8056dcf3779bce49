#include "heat_span.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

// From the first capture's begin to the last one's end.
TimeSpan captured(const Simulation& sim) {
  TimeSpan span{INFINITY, -INFINITY};
  for (const auto& sensor : sim.sensors)
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures)
        span = {std::min(span.begin, c.window.begin), std::max(span.end, c.window.end)};
  return span;
}

// Seconds of the simulation at the midnight of the sun before a time: where the hour angle is half a turn.
double midnight_before(double t, double longitude_deg, const Clock& clock) {
  const Utc utc = clock.utc(t);
  const double local = utc.hour * 3600.0 + utc.minute * 60.0 + utc.second + longitude_deg * 240;
  return t - (local - std::floor(local / 86400) * 86400);
}

}  // namespace

TimeSpan span_of(const Simulation& sim, double longitude_deg) {
  const HeatRequest& heat = *sim.heat;
  const TimeSpan seen = captured(sim);
  if (heat.span) {
    if (!heat.spec.periodic && (seen.begin < heat.span->begin || seen.end > heat.span->end))
      throw Error(heat.where,
                  strf("temperatures are found from %g to %g s, captures are taken from %g to %g s", heat.span->begin,
                       heat.span->end, seen.begin, seen.end),
                  "let 'from' and 'to' cover them");
    return *heat.span;
  }
  const double begin = std::round(midnight_before(seen.begin, longitude_deg, Clock(*sim.epoch)) / 60) * 60;
  if (seen.end > begin + 86400)
    throw Error(
        heat.where,
        strf("the captures take %g hours, which are more than one day of temperatures", (seen.end - seen.begin) / 3600),
        "give heat 'from' and 'to'");
  return {begin, begin + 86400};
}

}  // namespace suite
