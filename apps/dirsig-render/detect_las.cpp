// Point clouds of detected pulses: one a detector.
#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/run_app.h"
#include "detect_output.h"
#include "formats/las_write/las_write.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kMostIntensity = 65535;

struct LasWishes {
  double scale = 1e-3;
  LasPackets packets = LasPackets::none;
  bool extra = true;
  double intensity = 1;  // counts of intensity a unit of amplitude
};

class LasOutput : public DetectOutput {
 public:
  LasOutput(const Params& params, const DetectContext& c)
      : context_(c), map_(map_of(params, c)), clouds_(c.spec.detectors.size()) {
    if (const auto p = params.find("las")) {
      wishes_.scale = p->number_in("scale_m", 1e-6, 100, "m", 1e-3);
      wishes_.extra = p->boolean("extra_bytes", true);
      wishes_.intensity = p->number_in("intensity_scale", 1e-9, 1e9, "", 1);
      if (const auto packets = p->find("packets"))
        wishes_.packets = std::array{LasPackets::none, LasPackets::external,
                                     LasPackets::internal}[packets->as_choice({"none", "external", "internal"})];
    }
  }
  void take(const DetectedPulse& p) override {
    Cloud& cloud = clouds_[p.detector];
    if (!cloud.writer) open(cloud, p);
    const double angle = scan_angle(cloud, p.pulse());
    for (size_t pixel = 0; pixel < p.records.size(); ++pixel) {
      const PixelRecord& r = p.records[pixel];
      if (r.returns.empty()) continue;
      const bool wave = cloud.samples && !r.samples.empty();
      const uint64_t packet = wave ? add_packet(cloud, p, r) : 0;
      for (const LidarReturn& one : r.returns) {
        const auto at = place_of_return(p.head, p.pulse(), pixel, one.time);
        if (!at) {
          ++cloud.placeless;
          continue;
        }
        const double intensity = one.amplitude * wishes_.intensity;
        cloud.cut += intensity > kMostIntensity, cloud.brightest = std::max(cloud.brightest, intensity);
        LasReturn out = return_of(p, pixel, one);
        out.place = map_.place(*at), out.scan_angle = angle;
        if (wave) {
          out.descriptor = 1, out.packet = packet;
          out.location = static_cast<float>((one.time - r.grid.middle(0)) * 1e12);
          constexpr double kNanosecond = 1e-9;
          if (const auto later = place_of_return(p.head, p.pulse(), pixel, one.time + kNanosecond))
            out.direction = (out.place - map_.place(*later)) / 1000;
        }
        cloud.writer->add(out);
      }
    }
  }
  void finish(Json& log) override {
    Json list = Json::array();
    for (size_t d = 0; d < clouds_.size(); ++d) {
      if (!clouds_[d].writer) continue;
      clouds_[d].writer->finish();
      Json one = Json::object();
      one.set("file", context_.spec.detectors[d]->name() + ".las");
      one.set("points", clouds_[d].writer->points());
      one.set("returns_without_place", clouds_[d].placeless);
      one.set("intensities_cut", clouds_[d].cut);
      if (clouds_[d].cut > 0)
        note(strf(
            "detector '%s': %llu of %llu intensities are beyond the 65535 of LAS and cut there (`amplitude` is not); "
            "'las: {intensity_scale: %.2g}' keeps all of them",
            context_.spec.detectors[d]->name().c_str(), static_cast<unsigned long long>(clouds_[d].cut),
            static_cast<unsigned long long>(clouds_[d].writer->points()),
            0.99 * wishes_.intensity * kMostIntensity / clouds_[d].brightest));
      list.push(std::move(one));
    }
    log.set("las", std::move(list));
  }

 private:
  struct Cloud {
    std::unique_ptr<LasWriter> writer;
    size_t samples = 0;               // of a packet, 0 = none
    uint64_t placeless = 0, cut = 0;  // returns; of those with a place, beyond what an intensity can be
    double brightest = 0;
    std::optional<Vec3> last;  // place of the emission before
    Vec3 flight;
  };

  static DetectMap map_of(const Params& params, const DetectContext& c) {
    const auto p = params.find("las");
    const int epsg = p ? static_cast<int>(p->integer("epsg", 0, 999999, 0)) : 0;
    return {c.head, epsg, p ? p->where() : params.where()};
  }

  void open(Cloud& cloud, const DetectedPulse& p) const {
    LasSpec s;
    s.scale = Vec3{1, 1, 1} * wishes_.scale;
    // A round place near the first pulse: scale and offset span 2147 km with millimetres.
    const Vec3 near = map_.place(place_of_return(p.head, p.pulse(), 0, p.pulse().start + p.head.bins * p.head.bin)
                                     .value_or(p.pulse().emission.translation));
    for (int k = 0; k < 2; ++k) s.offset[k] = std::round(near[k] / 1000) * 1000;
    s.wkt = map_.wkt();
    const LidarDetector& detector = *context_.spec.detectors[p.detector];
    s.system = "detector " + detector.name(), s.software = command_line();
    if (wishes_.extra)
      s.extra = {{"amplitude", "in the detector's unit", LasExtra::Type::f32},
                 {"width_ns", "standard deviation", LasExtra::Type::f32},
                 {"deviation_m", "standard deviation of range", LasExtra::Type::f32},
                 {"range_m", "c t / 2", LasExtra::Type::f64},
                 {"return_number", "beyond 15, too", LasExtra::Type::u16},
                 {"pixel", "", LasExtra::Type::u32},
                 {"tag", "truth: channel of response", LasExtra::Type::u16},
                 {"multiple", "truth: multiply scattered", LasExtra::Type::f32},
                 {"signal", "truth: of the laser", LasExtra::Type::u8}};
    if (wishes_.packets != LasPackets::none && detector.sample_unit() == "counts") {
      for (const PixelRecord& r : p.records) cloud.samples = std::max(cloud.samples, r.samples.size());
      if (cloud.samples) {
        s.packets = wishes_.packets;
        const double spacing = std::round(p.records[0].grid.step * 1e12);
        s.waves = {{16, static_cast<uint32_t>(cloud.samples), static_cast<uint32_t>(spacing), 1, 0}};
      }
    }
    cloud.writer = std::make_unique<LasWriter>(context_.folder + "/" + detector.name() + ".las", std::move(s));
  }

  // Shorter waveforms are filled with the level without light.
  uint64_t add_packet(Cloud& cloud, const DetectedPulse& p, const PixelRecord& r) const {
    if (r.samples.size() > cloud.samples)
      throw Error(strf("pulse %llu has %zu samples, the packets of the first pulse %zu",
                       static_cast<unsigned long long>(p.number()), r.samples.size(), cloud.samples),
                  "a fixed gate, or las: {packets: none}");
    std::vector<uint16_t> samples(cloud.samples, static_cast<uint16_t>(std::clamp(std::round(r.level), 0.0, 65535.0)));
    for (size_t k = 0; k < r.samples.size(); ++k) samples[k] = static_cast<uint16_t>(r.samples[k]);
    return cloud.writer->packet(1, samples);
  }

  LasReturn return_of(const DetectedPulse& p, size_t pixel, const LidarReturn& r) const {
    LasReturn out;
    out.intensity = static_cast<uint16_t>(std::clamp(std::round(r.amplitude * wishes_.intensity), 0.0, kMostIntensity));
    out.number = r.number, out.of = r.of;
    out.gps_time = time_of_pulse(p.head, p.pulse().time);
    if (!wishes_.extra) return out;
    const double reach = std::max({context_.spec.pulse.fwhm(), 2 * r.width, p.head.bin});
    const ReturnTruth truth = truth_of(p.head, p.row(pixel), r.time, reach);
    out.extra = {r.amplitude,
                 r.width * 1e9,
                 r.deviation * kSpeedOfLight / 2,
                 r.time * kSpeedOfLight / 2,
                 static_cast<double>(std::min(r.number, 65535u)),
                 static_cast<double>(pixel),
                 truth.tag < 0 ? 0.0 : truth.tag,
                 truth.multiple,
                 r.signal ? 1.0 : 0.0};
    return out;
  }

  // From straight down, negative to the left of the flight.
  static double scan_angle(Cloud& cloud, const ResponsePulse& pulse) {
    if (cloud.last && !(pulse.emission.translation == *cloud.last))
      cloud.flight = pulse.emission.translation - *cloud.last;
    cloud.last = pulse.emission.translation;
    const Dir beam = pulse.emission.vector({0, 0, -1});
    const double angle = std::atan2(std::hypot(beam.x, beam.y), -beam.z);
    const double right = beam.x * cloud.flight.y - beam.y * cloud.flight.x;
    return right < 0 ? -angle : angle;
  }

  const DetectContext context_;
  DetectMap map_;
  LasWishes wishes_;
  std::vector<Cloud> clouds_;  // of each detector
};

}  // namespace

std::unique_ptr<DetectOutput> las_output(const Params& params, const DetectContext& context) {
  return std::make_unique<LasOutput>(params, context);
}

}  // namespace suite
