// Waveforms and photons of detected pulses under the names of public products.
#include <cmath>

#include "base/run_app.h"
#include "detect_output.h"
#include "formats/lidar_hdf/photons.h"
#include "formats/lidar_hdf/waveforms.h"

namespace suite {

namespace {

class WaveformOutput : public DetectOutput {
 public:
  explicit WaveformOutput(const DetectContext& c) : context_(c), frame_(*c.head.origin) {
    for (const auto& d : c.spec.detectors) {
      beams_.push_back(d->sample_unit() == "counts" ? kept_++ : kNone);
      if (kept_ > 16)
        throw Error("more than 16 detectors keep waveforms", "fewer of kind waveform, or no waveforms_h5");
    }
  }
  void take(const DetectedPulse& p) override {
    const size_t beam = beams_[p.detector];
    if (beam == kNone) return;
    for (size_t pixel = 0; pixel < p.records.size(); ++pixel) {
      const PixelRecord& r = p.records[pixel];
      if (r.samples.empty()) continue;
      begin(beam, p, r.grid.step);
      WaveformShot s;
      s.shot = p.number(), s.pixel = static_cast<uint32_t>(pixel);
      s.delta_time = time_of_pulse(p.head, p.pulse().time);
      s.samples = r.samples, s.ideal = r.ideal_samples, s.ideal_error = r.ideal_errors;
      s.noise_mean = r.level, s.noise_deviation = r.level_noise, s.start = r.grid.middle(0);
      const Vec3 instrument = p.pulse().reception.translation;
      const auto at = [&](double time) {
        return frame_.geodetic_from_enu(place_of_return(p.head, p.pulse(), pixel, time).value_or(instrument));
      };
      s.first = at(s.start), s.last = at(r.grid.middle(r.grid.count - 1)),
      s.instrument = frame_.geodetic_from_enu(instrument);
      writer().add(beam, s);
      ++shots_;
    }
  }
  void finish(Json& log) override {
    writer().finish();
    Json one = Json::object();
    one.set("file", "waveforms.h5"), one.set("shots", shots_);
    log.set("waveforms_h5", std::move(one));
  }

 private:
  static constexpr size_t kNone = ~size_t{0};
  WaveformWriter& writer() {
    if (!writer_) writer_.emplace(context_.folder + "/waveforms.h5", command_line());
    return *writer_;
  }
  // The transmitted pulse at samples as long as the receiver's, its maximum 1.
  void begin(size_t beam, const DetectedPulse& p, double step) {
    if (begun_.size() <= beam) begun_.resize(beam + 1, false);
    if (begun_[beam]) return;
    begun_[beam] = true;
    const PulseShape& pulse = context_.spec.pulse;
    const long reach = std::lround(std::ceil(std::max(pulse.high(), -pulse.low()) / step)) + 1;
    std::vector<double> power;
    double most = 0;
    for (long k = -reach; k <= reach; ++k) {
      const double t = static_cast<double>(k) * step;
      power.push_back(pulse.before(t + step / 2) - pulse.before(t - step / 2));
      most = std::max(most, power.back());
    }
    for (double& v : power) v /= most;
    writer().begin_beam(beam, context_.spec.detectors[p.detector]->name(), step, power);
  }

  const DetectContext context_;
  SceneFrame frame_;
  std::optional<WaveformWriter> writer_;
  std::vector<size_t> beams_;  // of each detector
  std::vector<bool> begun_;
  size_t kept_ = 0;
  uint64_t shots_ = 0;
};

class PhotonOutput : public DetectOutput {
 public:
  explicit PhotonOutput(const DetectContext& c) : context_(c), frame_(*c.head.origin) {
    size_t kept = 0;
    for (const auto& d : c.spec.detectors) tracks_.push_back(d->counts_photons() ? kept++ : kNone);
    if (kept > PhotonWriter::kTracks.size())
      throw Error("more than six detectors count photons", "fewer of them, or no photons_h5: ATL03 has six tracks");
  }
  void take(const DetectedPulse& p) override {
    const size_t track = tracks_[p.detector];
    if (track == kNone) return;
    const Vec3 emission = p.pulse().emission.translation;
    if (!first_) first_ = emission;
    const Vec3 way = emission - *first_;
    if (std::hypot(ahead_.x, ahead_.y) == 0 && std::hypot(way.x, way.y) > 0) ahead_ = normalized(Vec3{way.x, way.y, 0});
    const double time = time_of_pulse(p.head, p.pulse().time);
    double background = 0;
    for (size_t pixel = 0; pixel < p.records.size(); ++pixel) {
      const PixelRecord& r = p.records[pixel];
      background += r.background_rate;
      for (const LidarReturn& one : r.returns) {
        const auto at = place_of_return(p.head, p.pulse(), pixel, one.time);
        if (!at) continue;
        const Vec3 from = *at - *first_;
        writer().add(track,
                     {frame_.geodetic_from_enu(*at), time, dot(from, ahead_), ahead_.x * from.y - ahead_.y * from.x,
                      static_cast<uint32_t>(pixel), static_cast<uint32_t>(p.number()), one.signal});
        ++photons_;
      }
    }
    writer().add_pulse(track, time, background, p.pulse().energy);
  }
  void finish(Json& log) override {
    writer().finish();
    Json one = Json::object();
    one.set("file", "photons.h5"), one.set("photons", photons_);
    log.set("photons_h5", std::move(one));
  }

 private:
  static constexpr size_t kNone = ~size_t{0};
  PhotonWriter& writer() {
    if (!writer_) writer_.emplace(context_.folder + "/photons.h5", command_line());
    return *writer_;
  }
  const DetectContext context_;
  SceneFrame frame_;
  std::optional<PhotonWriter> writer_;
  std::vector<size_t> tracks_;  // of each detector
  std::optional<Vec3> first_;   // place of the first emission
  Vec3 ahead_;
  uint64_t photons_ = 0;
};

}  // namespace

std::unique_ptr<DetectOutput> waveform_output(const DetectContext& c) { return std::make_unique<WaveformOutput>(c); }
std::unique_ptr<DetectOutput> photon_output(const DetectContext& c) { return std::make_unique<PhotonOutput>(c); }

}  // namespace suite
