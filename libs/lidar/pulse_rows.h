// Traces the rows of a few pulses: the working memory of one thread, with its kernels.
#pragma once
#include <memory>
#include <vector>

#include "lidar/first_direction.h"
#include "lidar/first_scattering.h"
#include "lidar/line_kit.h"
#include "lidar/range_sink.h"
#include "lidar/trace.h"

namespace suite {

// What does not change from pulse to pulse. Everything referred to outlives those who use it.
struct TracePlan {
  const Tracer& tracer;
  const LidarInstrument& instrument;
  const TraceOptions& options;
  const ResponseHead& head;
  LaserBeam beam;
  ReceiverField field;
  bool laser_first, polarised;
  RangeSink::Tags tags;
  uint64_t instrument_key;  // of random numbers
  int scrambles;
  // Paths of a row: of a pixel, or of a pulse where they leave the laser.
  uint64_t paths() const { return uint64_t{instrument.paths} * (laser_first ? field.pixels() : 1); }
};

// Pulses [0, pulses) times pixels [first_pixel, last_pixel).
struct RowRange {
  std::span<const PulseAtWork> pulses;
  size_t first_pixel, last_pixel;
};

class PulseRows {
 public:
  // kit: of the pulses' line.
  PulseRows(const TracePlan& plan, const LineKit& kit);
  ~PulseRows();
  const LineKit& kit() const { return kit_; }
  // Adds the rows of a range to a block, without its pulses, and what was done to the report.
  void trace(const RowRange& range, ResponseBlock& block, PulseReport& report);

 private:
  struct Job;  // one kernel and what it needs
  struct End {
    std::shared_ptr<const Light> light;     // null: passive light alone
    const ReceiverEnd* receiver = nullptr;  // which of both it is
    LaserEnd* laser = nullptr;
  };
  std::unique_ptr<Job> make_job(const End& end, bool passive);
  void run(Job& job, const RowRange& range, bool from_laser, PulseReport& report);
  static void add_path(std::span<RangeBins> rows);
  void scatter_once(Job& job, const PulseAtWork& pulse, const Ray& ray, const FirstScattering::Strata& strata,
                    const Mueller& sensor, RangeSink::Lane& lane);
  // sensor: of the path's polarisation, where it carries any.
  void start(Job& job, const SensorRay& ray, const SampleStream& stream, uint32_t sample, const RangeSink::Lane& lane,
             const Mueller& sensor, PulseReport& report);
  SensorRay from_receiver(Job& job, const PulseAtWork& pulse, size_t pixel, const std::array<double, 4>& u,
                          RangeSink::Lane& lane) const;
  SensorRay from_laser(const PulseAtWork& pulse, const SampleStream& stream, uint32_t sample,
                       const std::array<double, 4>& u) const;
  const TracePlan& plan_;
  const LineKit& kit_;
  PulsesAtWork pulses_;
  FirstDirection directions_;
  std::vector<RangeBins> rows_;
  std::unique_ptr<FirstScattering> once_;  // null: nothing scatters but surfaces
  std::vector<FirstScattering::Scattered> scattered_;
  std::unique_ptr<Job> active_, passive_;  // passive: where paths leave the laser and anything shines
};

}  // namespace suite
