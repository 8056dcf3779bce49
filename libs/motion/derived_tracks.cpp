// Tracks made from other tracks: in each other's frame, later, with ends.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "motion/track_record.h"

namespace suite {

namespace {

class Composed final : public Track {
 public:
  Composed(TrackPtr outer, TrackPtr inner) : outer_(std::move(outer)), inner_(std::move(inner)) {
    SUITE_CHECK(outer_ && inner_);
  }
  Pose at(double t) const override { return outer_->at(t) * inner_->at(t); }
  TimeSpan covered() const override {
    const TimeSpan a = outer_->covered(), b = inner_->covered();
    return {std::fmax(a.begin, b.begin), std::fmin(a.end, b.end)};
  }
  std::vector<double> kinks(TimeSpan span) const override {
    std::vector<double> times = outer_->kinks(span), more = inner_->kinks(span), all;
    std::merge(times.begin(), times.end(), more.begin(), more.end(), std::back_inserter(all));
    return all;
  }

  TrackRecord record() const override {
    return {TrackRecord::Kind::composed, {}, {}, {outer_->record(), inner_->record()}};
  }

 private:
  TrackPtr outer_, inner_;
};

class Delayed final : public Track {
 public:
  Delayed(TrackPtr track, double seconds) : track_(std::move(track)), later_(seconds) {
    SUITE_CHECK(track_ != nullptr);
    if (!std::isfinite(seconds)) throw Error("a track's delay is not finite");
  }
  Pose at(double t) const override { return track_->at(t - later_); }
  Vec3 velocity(double t) const override { return track_->velocity(t - later_); }
  TimeSpan covered() const override {
    const TimeSpan c = track_->covered();
    return {c.begin + later_, c.end + later_};
  }
  bool absent_outside() const override { return track_->absent_outside(); }
  std::vector<double> kinks(TimeSpan span) const override {
    std::vector<double> times = track_->kinks({span.begin - later_, span.end - later_});
    for (double& t : times) t += later_;
    return times;
  }

 private:
  TrackPtr track_;
  double later_;
};

class Ending final : public Track {
 public:
  explicit Ending(TrackPtr track) : track_(std::move(track)) { SUITE_CHECK(track_ != nullptr); }
  Pose at(double t) const override { return track_->at(t); }
  Vec3 velocity(double t) const override { return track_->velocity(t); }
  TimeSpan covered() const override { return track_->covered(); }
  bool absent_outside() const override { return true; }
  std::vector<double> kinks(TimeSpan span) const override { return track_->kinks(span); }
  TrackRecord record() const override { return {TrackRecord::Kind::ending, {}, {}, {track_->record()}}; }

 private:
  TrackPtr track_;
};

}  // namespace

TrackPtr composed_track(TrackPtr outer, TrackPtr inner) {
  return std::make_shared<Composed>(std::move(outer), std::move(inner));
}
TrackPtr delayed_track(TrackPtr track, double seconds) { return std::make_shared<Delayed>(std::move(track), seconds); }
TrackPtr ending_track(TrackPtr track) { return std::make_shared<Ending>(std::move(track)); }

}  // namespace suite
