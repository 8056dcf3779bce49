// Ephemerides: places by Lagrange's or Hermite's polynomials through their neighbours.
//
// Based on: divided differences with repeated points, J. Stoer & R. Bulirsch, "Introduction to Numerical Analysis",
// section 2.1.5.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "motion/track_record.h"

namespace suite {

namespace {

class Interpolated final : public Track {
 public:
  explicit Interpolated(InterpolatedMotion m) : m_(std::move(m)), keys_(keyframe_track(m_.keys)) {
    const TimeSpan all = keys_->covered(), c = m_.covered;
    if (m_.degree < 1 || m_.degree > kMostDegree)
      throw Error(strf("an interpolation of degree %zu", m_.degree), strf("1 to %zu", kMostDegree));
    if (!m_.velocities.empty() && m_.velocities.size() != m_.keys.size())
      throw Error(strf("%zu velocities of %zu places", m_.velocities.size(), m_.keys.size()));
    if (!(c.begin <= c.end) || !all.contains(c.begin) || !all.contains(c.end))
      throw Error("a track is to cover more than its keys", strf("within %.9g to %.9g s", all.begin, all.end));
  }
  // The orientation turns evenly from key to key, as that of keyframes does.
  Pose at(double t) const override {
    check_time(t);
    const Pose between = keys_->at(t);
    const std::vector<PoseKey>& keys = m_.keys;
    const size_t wanted = m_.velocities.empty() ? m_.degree + 1 : std::max<size_t>((m_.degree + 1) / 2, 2);
    const size_t n = std::min(wanted, keys.size());
    const auto after =
        std::upper_bound(keys.begin(), keys.end(), t, [](double x, const PoseKey& k) { return x < k.time; });
    const auto before = static_cast<size_t>(std::max<std::ptrdiff_t>(0, after - keys.begin() - 1));
    // As many keys on both sides as there are.
    const size_t half = (n - 1) / 2, first = std::min(before > half ? before - half : 0, keys.size() - n);
    const Vec3 origin = keys[before].pose.translation;
    return {between.rotation,
            origin + (m_.velocities.empty() ? lagrange(origin, first, n, t) : hermite(origin, first, n, t))};
  }
  TimeSpan covered() const override { return m_.covered; }
  std::vector<double> kinks(TimeSpan span) const override { return keys_->kinks(span); }
  TrackRecord record() const override {
    const bool turns = !m_.velocities.empty();
    TrackRecord r{turns ? TrackRecord::Kind::hermite : TrackRecord::Kind::interpolated,
                  {static_cast<double>(m_.degree), m_.covered.begin, m_.covered.end},
                  {},
                  {}};
    for (size_t i = 0; i < m_.keys.size(); ++i) {
      r.numbers.push_back(m_.keys[i].time), record::put(r.numbers, m_.keys[i].pose);
      if (turns) r.numbers.insert(r.numbers.end(), {m_.velocities[i].x, m_.velocities[i].y, m_.velocities[i].z});
    }
    return r;
  }

 private:
  // From `origin`, through n keys from `first` on.
  Vec3 lagrange(Vec3 origin, size_t first, size_t n, double t) const {
    const std::vector<PoseKey>& keys = m_.keys;
    Vec3 sum;
    for (size_t i = first; i < first + n; ++i) {
      double weight = 1;
      for (size_t j = first; j < first + n; ++j)
        if (j != i) weight *= (t - keys[j].time) / (keys[i].time - keys[j].time);
      sum += (keys[i].pose.translation - origin) * weight;
    }
    return sum;
  }
  // Newton's form, each key taken twice: the difference of a key from itself is its velocity.
  Vec3 hermite(Vec3 origin, size_t first, size_t n, double t) const {
    Vec3 c[kMostDegree + 1];
    const auto time = [&](size_t j) { return m_.keys[first + j / 2].time; };
    for (size_t j = 0; j < 2 * n; ++j) c[j] = m_.keys[first + j / 2].pose.translation - origin;
    for (size_t k = 1; k < 2 * n; ++k)
      for (size_t j = 2 * n - 1; j >= k; --j)
        c[j] = k == 1 && j % 2 ? m_.velocities[first + j / 2] : (c[j] - c[j - 1]) / (time(j) - time(j - k));
    Vec3 sum = c[2 * n - 1];
    for (size_t j = 2 * n - 1; j-- > 0;) sum = c[j] + sum * (t - time(j));
    return sum;
  }

  static constexpr size_t kMostDegree = 15;
  InterpolatedMotion m_;
  TrackPtr keys_;
};

}  // namespace

TrackPtr interpolated_track(InterpolatedMotion motion) { return std::make_shared<Interpolated>(std::move(motion)); }

}  // namespace suite
