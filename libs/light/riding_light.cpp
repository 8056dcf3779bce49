#include "light/riding_light.h"

#include <algorithm>

namespace suite {

RidingLight::RidingLight(std::shared_ptr<const Light> carried, TrackPtr track)
    : carried_(std::move(carried)), track_(std::move(track)), covered_(track_->covered()) {
  nature_ = carried_->nature();
  if (nature_.far || !nature_.delta)
    throw Error("only points and spots ride", "let what glows move with its placement");
  nature_.moves = true;
}

Pose RidingLight::pose(double time) const { return track_->at(std::clamp(time, covered_.begin, covered_.end)); }

namespace {

LightReceiver seen_from(const Pose& frame, const LightReceiver& at) {
  const Pose back = frame.inverse();
  return {back.point(at.position), back.vector(at.normal), at.two_sided};
}

std::optional<LightSample> turned(const Pose& frame, std::optional<LightSample> s) {
  if (s) s->direction = frame.vector(s->direction), s->end = frame.point(s->end);
  return s;
}

}  // namespace

std::optional<LightSample> RidingLight::sample(const LightReceiver& at, const std::array<double, 4>& u,
                                               double time) const {
  const Pose frame = pose(time);
  return turned(frame, carried_->sample(seen_from(frame, at), u, time));
}

std::optional<LightSample> RidingLight::sample_member(size_t member, double probability, const LightReceiver& at,
                                                      const std::array<double, 4>& u, double time) const {
  const Pose frame = pose(time);
  return turned(frame, carried_->sample_member(member, probability, seen_from(frame, at), u, time));
}

namespace {

class RidingSpec final : public LightSpec {
 public:
  RidingSpec(LightSpecPtr carried, TrackPtr track) : carried_(std::move(carried)), track_(std::move(track)) {}
  std::string key() const override { return carried_->key(); }
  size_t entries() const override { return carried_->entries(); }
  std::shared_ptr<const Light> bake(const Tracer& tracer, const SpectralState& state) const override {
    if (tracer.periodic()) throw Error("a lamp rides through a scene that repeats itself");
    return std::make_shared<const RidingLight>(carried_->bake(tracer, state), track_);
  }
  const SourceTime* date() const override { return carried_->date(); }
  LightSpecPtr resolved(const LightMoment& at) const override { return again(carried_->resolved(at)); }
  LightSpecPtr standing(double zenith) const override { return again(carried_->standing(zenith)); }
  bool shines(double low_um, double high_um) const override { return carried_->shines(low_um, high_um); }
  void add_spectra(std::vector<LightSpectra>& to) const override { carried_->add_spectra(to); }
  std::vector<std::string> hardly_met(double enough) const override { return carried_->hardly_met(enough); }

 private:
  LightSpecPtr again(LightSpecPtr carried) const { return carried ? riding(std::move(carried), track_) : nullptr; }
  const LightSpecPtr carried_;
  const TrackPtr track_;
};

}  // namespace

LightSpecPtr riding(LightSpecPtr carried, TrackPtr track) {
  return std::make_shared<const RidingSpec>(std::move(carried), std::move(track));
}

}  // namespace suite
