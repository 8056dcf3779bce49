#include "heat/day_sun.h"

#include <algorithm>
#include <cmath>

#include "light/kinds/clear_sky.h"

namespace suite {

namespace {

constexpr int kLooks = 1000;  // times of the span at which the sun is looked for

}  // namespace

std::vector<SunMoment> sun_moments(TimeSpan span, const std::function<Dir(double t)>& towards, size_t most) {
  std::vector<SunMoment> sunny, asked;
  for (int k = 0; k < kLooks; ++k) {
    const double t = span.begin + (span.end - span.begin) * (k + 0.5) / kLooks;
    const Dir d = towards(t);
    if (d.z > 0) sunny.push_back({t, 1353 * std::pow(0.7, std::pow(air_mass(polar_angle(d)), 0.678)), d});
  }
  const size_t count = std::min(most, sunny.size());
  for (size_t k = 0; k < count; ++k) asked.push_back(sunny[(2 * k + 1) * sunny.size() / (2 * count)]);
  return asked;
}

DaySun day_sun(const Tracer& tracer, std::vector<SunMoment> moments) {
  const size_t count = moments.size();
  return {count, [&tracer, asked = std::move(moments)](std::span<const Hit> places, std::span<float> sun) {
            std::ranges::fill(sun, 0.0f);
            std::vector<Ray> rays;
            std::vector<size_t> to;
            for (size_t p = 0; p < places.size(); ++p)
              for (size_t k = 0; k < asked.size(); ++k) {
                const double cosine = dot(asked[k].towards, places[p].normal);
                if (!(cosine > 0)) continue;
                sun[p * asked.size() + k] = static_cast<float>(cosine * asked[k].direct);
                to.push_back(p * asked.size() + k);
                rays.push_back({tracer.leave(places[p], asked[k].towards), asked[k].towards, asked[k].time,
                                static_cast<uint32_t>(p)});
              }
            std::vector<double> reach(rays.size(), INFINITY);
            std::vector<uint8_t> blocked(rays.size(), 0);
            TraceStatistics counted;
            if (!rays.empty()) tracer.occluded(rays, reach, blocked, true, counted);
            for (size_t i = 0; i < rays.size(); ++i)
              if (blocked[i]) sun[to[i]] = 0;
          }};
}

}  // namespace suite
