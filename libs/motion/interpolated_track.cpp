// Ephemerides: places by Lagrange's polynomials through their neighbours.
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
    if (!(c.begin <= c.end) || !all.contains(c.begin) || !all.contains(c.end))
      throw Error("a track is to cover more than its keys", strf("within %.9g to %.9g s", all.begin, all.end));
  }
  // The orientation turns evenly from key to key, as that of keyframes does.
  Pose at(double t) const override {
    check_time(t);
    const Pose between = keys_->at(t);
    const std::vector<PoseKey>& keys = m_.keys;
    const size_t n = std::min(m_.degree + 1, keys.size());
    const auto after =
        std::upper_bound(keys.begin(), keys.end(), t, [](double x, const PoseKey& k) { return x < k.time; });
    const auto before = static_cast<size_t>(std::max<std::ptrdiff_t>(0, after - keys.begin() - 1));
    // As many keys on both sides as there are.
    const size_t half = (n - 1) / 2, first = std::min(before > half ? before - half : 0, keys.size() - n);
    const Vec3 origin = keys[before].pose.translation;
    Vec3 sum;
    for (size_t i = first; i < first + n; ++i) {
      double weight = 1;
      for (size_t j = first; j < first + n; ++j)
        if (j != i) weight *= (t - keys[j].time) / (keys[i].time - keys[j].time);
      sum += (keys[i].pose.translation - origin) * weight;
    }
    return {between.rotation, origin + sum};
  }
  TimeSpan covered() const override { return m_.covered; }
  std::vector<double> kinks(TimeSpan span) const override { return keys_->kinks(span); }
  TrackRecord record() const override {
    TrackRecord r{
        TrackRecord::Kind::interpolated, {static_cast<double>(m_.degree), m_.covered.begin, m_.covered.end}, {}, {}};
    for (const PoseKey& k : m_.keys) r.numbers.push_back(k.time), record::put(r.numbers, k.pose);
    return r;
  }

 private:
  static constexpr size_t kMostDegree = 15;
  InterpolatedMotion m_;
  TrackPtr keys_;
};

}  // namespace

TrackPtr interpolated_track(InterpolatedMotion motion) { return std::make_shared<Interpolated>(std::move(motion)); }

}  // namespace suite
