// Expected photons as DIRSIG's, and one pulse as text.
#include <cmath>
#include <cstdio>

#include "base/files.h"
#include "base/run_app.h"
#include "detect_output.h"
#include "formats/dirsig_bin/dirsig_bin.h"
#include "spectral/planck.h"

namespace suite {

namespace {

Matrix4 matrix_of(const Pose& pose) {
  const Affine3 a = pose.affine();
  return {a.a[0], a.a[1], a.a[2], a.b.x, a.a[3], a.a[4], a.a[5], a.b.y, a.a[6], a.a[7], a.a[8], a.b.z, 0, 0, 0, 1};
}

class DirsigBinOutput : public DetectOutput {
 public:
  explicit DirsigBinOutput(const DetectContext& c) : context_(c) {
    const ResponseHead& h = c.head;
    const double values = static_cast<double>(h.pixel_count()) * (h.bins + 1.0);
    if (values > 1e9 || c.pulses > 0xFFFFFFFFu)
      throw Error(strf("dirsig_bin: %g values a pulse, %llu pulses", values, static_cast<unsigned long long>(c.pulses)),
                  "at most 1e9 values a pulse: fewer pixels or bins");
  }
  void take(const DetectedPulse& p) override {
    if (p.detector != 0) return;  // photons are before all detectors
    if (!writer_) open(p.pulse());
    const ResponseHead& h = p.head;
    const ResponsePulse& from = p.pulse();
    LidarBinPulse out;
    out.time = from.time;
    out.gate_start = from.start, out.gate_stop = from.start + h.bins * h.bin;
    out.bins = h.bins, out.packed = true;
    // The platform stands in the scene's frame and is not turned: poses are of the instruments.
    out.transmitter.to_mount = matrix_of(from.emission), out.receiver.to_mount = matrix_of(from.reception);
    out.photons.assign(h.pixel_count() * (size_t{h.bins} + 1), 0);
    for (size_t pixel = 0; pixel < h.pixel_count(); ++pixel) {
      const ResponseRow row = p.row(pixel);
      for (size_t k = 0; k < row.size(); ++k) out.photons[pixel * (size_t{h.bins} + 1) + row.bin(k)] = row.photons(k);
    }
    writer_->add(out);
  }
  void finish(Json& log) override {
    if (!writer_) return;
    writer_->finish();
    log.set("dirsig_bin", "photons.bin");
  }

 private:
  void open(const ResponsePulse& pulse) {
    const ResponseHead& h = context_.head;
    LidarBinHead head;
    head.columns = h.columns, head.rows = h.rows, head.version = "2", head.text = command_line().substr(0, 255);
    if (h.origin)
      head.latitude = h.origin->latitude_deg, head.longitude = h.origin->longitude_deg,
      head.height = h.origin->height_m;
    head.transmitter_mount = head.receiver_mount = "static";
    // Pitch of the central pixels at a focal length of 1 m.
    constexpr double kMetre = 1e6;  // um
    if (h.columns > 1)
      head.pitch_x_um = kMetre * std::fabs(h.pixels[1].x / h.pixels[1].z - h.pixels[0].x / h.pixels[0].z);
    if (h.rows > 1)
      head.pitch_y_um =
          kMetre * std::fabs(h.pixels[h.columns].y / h.pixels[h.columns].z - h.pixels[0].y / h.pixels[0].z);
    LidarBinTask task;
    task.focal_length_mm = 1000, task.energy = pulse.energy, task.centre_um = pulse.wavelength_um;
    task.pulse_length = context_.spec.pulse.fwhm();
    task.pulse_count = static_cast<uint32_t>(context_.pulses);
    if (h.epoch)
      task.start = head.date = strf("%04d%02d%02d%02d%02d.%02d", h.epoch->year, h.epoch->month, h.epoch->day,
                                    h.epoch->hour, h.epoch->minute, static_cast<int>(h.epoch->second));
    writer_ = std::make_unique<LidarBinWriter>(context_.folder + "/photons.bin", head, task);
  }
  const DetectContext context_;
  std::unique_ptr<LidarBinWriter> writer_;
};

class CsvOutput : public DetectOutput {
 public:
  CsvOutput(const Params& params, const DetectContext& c) : context_(c) {
    if (const auto p = params.find("csv")) wanted_ = static_cast<uint64_t>(p->integer("pulse", 0, 1LL << 53, 0));
    if (wanted_ >= c.pulses)
      throw params.find("csv").value_or(params).error(
          strf("pulse %llu is not there", static_cast<unsigned long long>(wanted_)),
          strf("pulses are 0 to %llu", static_cast<unsigned long long>(c.pulses - 1)));
  }
  void take(const DetectedPulse& p) override {
    if (p.number() != wanted_) return;
    const std::string stem = context_.folder + "/" + context_.spec.detectors[p.detector]->name() +
                             strf("_pulse_%llu", static_cast<unsigned long long>(wanted_));
    std::string samples = "pixel,time_ns,range_m,sample,ideal,ideal_error\n",
                returns =
                    "pixel,ideal,time_ns,range_m,deviation_ns,amplitude,width_ns,number,of,signal,tag,multiple,east_m,"
                    "north_m,up_m\n";
    for (size_t pixel = 0; pixel < p.records.size(); ++pixel) {
      const PixelRecord& r = p.records[pixel];
      const auto of = [](const std::vector<double>& v, size_t k) {
        return k < v.size() ? strf("%.9g", v[k]) : std::string();
      };
      for (size_t k = 0; k < std::max(r.samples.size(), r.ideal_samples.size()); ++k) {
        const double t = r.grid.middle(k);
        samples += strf("%zu,%.12g,%.12g,", pixel, t * 1e9, t * kSpeedOfLight / 2) + of(r.samples, k) + "," +
                   of(r.ideal_samples, k) + "," + of(r.ideal_errors, k) + "\n";
      }
      for (const LidarReturn& one : r.returns) returns += line(p, pixel, one, false);
      for (const LidarReturn& one : r.ideal_returns) returns += line(p, pixel, one, true);
    }
    write_file(stem + ".csv", samples);
    write_file(stem + "_returns.csv", returns);
  }
  void finish(Json& log) override { log.set("csv_pulse", wanted_); }

 private:
  std::string line(const DetectedPulse& p, size_t pixel, const LidarReturn& r, bool ideal) const {
    const double reach = std::max({context_.spec.pulse.fwhm(), 2 * r.width, p.head.bin});
    const ReturnTruth truth = truth_of(p.head, p.row(pixel), r.time, reach);
    const Vec3 at = place_of_return(p.head, p.pulse(), pixel, r.time).value_or(Vec3{NAN, NAN, NAN});
    return strf("%zu,%d,%.12g,%.12g,%.6g,%.9g,%.6g,%u,%u,%d,", pixel, ideal, r.time * 1e9, r.time * kSpeedOfLight / 2,
                r.deviation * 1e9, r.amplitude, r.width * 1e9, r.number, r.of, r.signal) +
           (truth.tag < 0 ? std::string() : p.head.channels[static_cast<size_t>(truth.tag)]) +
           strf(",%.6g,%.12g,%.12g,%.12g\n", truth.multiple, at.x, at.y, at.z);
  }
  const DetectContext context_;
  uint64_t wanted_ = 0;
};

}  // namespace

std::unique_ptr<DetectOutput> dirsig_bin_output(const DetectContext& c) { return std::make_unique<DirsigBinOutput>(c); }
std::unique_ptr<DetectOutput> csv_output(const Params& params, const DetectContext& c) {
  return std::make_unique<CsvOutput>(params, c);
}

}  // namespace suite
