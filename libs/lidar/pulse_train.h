// Pulses by a clock: when each leaves, where its beam goes, and from where its light is received.
//
// The scanner starts with each task: its time is 0 at the task's first pulse.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "lidar/instrument.h"
#include "motion/jitter.h"
#include "motion/track.h"
#include "sensor/deflectors/deflector.h"
#include "sensor/mount.h"

namespace suite {

// A vehicle and what is attached to it, from the vehicle outwards. Immutable; callable from many threads.
struct LidarCarrier {
  TrackPtr track;
  std::shared_ptr<const Jitter> jitter;  // of the vehicle; null = none
  std::vector<Attachment> chain;
  Pose at(double t) const;   // body to scene ENU; Error outside covered()
  TimeSpan covered() const;  // s: where the motion and all mounts are known
};

struct PulseClock {
  struct Task {
    double begin = 0;    // s, of its first pulse
    uint64_t shots = 1;  // ticks of the clock
  };
  std::vector<Task> tasks;  // in the order of time, apart
  double rate = 1;          // Hz, of the ticks
  uint32_t burst = 1;       // pulses that follow each tick, 1/burst_rate apart
  double burst_rate = 0;    // Hz
  double end(const Task& task) const { return task.begin + static_cast<double>(task.shots) / rate; }  // s, next tick
};

struct TrainSpec {
  PulseClock clock;
  LidarCarrier carrier;               // of the receiver, and of the laser unless it has its own
  std::optional<LidarCarrier> laser;  // bistatic: the scanner turns the laser's beam only
  Pose laser_place, receiver_place;   // on what carries them
  std::shared_ptr<const Deflector> deflector;
  // Whether the receiver looks where the scanner points when light comes back. Otherwise its optics make up for the
  // way that a mirror turns meanwhile: it looks where the beam was sent.
  bool scan_lag = false;
  double energy = 1, wavelength_um = 1.064, start = 0;  // J, um, s after the emission
};

class ClockedTrain : public PulseTrain {
 public:
  explicit ClockedTrain(TrainSpec spec);
  uint64_t size() const override { return size_; }
  std::optional<ResponsePulse> pulse(uint64_t i, double round_trip = 0) const override;
  uint64_t lit() const;   // pulses at which a beam leaves
  TimeSpan span() const;  // s, of the emissions
  // Least time between two pulses of one channel, s; infinite for a single pulse.
  double interval() const;
  const TrainSpec& spec() const { return spec_; }

 private:
  struct Shot {
    size_t channel = 0;
    double since = 0;  // s, after the task's begin
  };
  Shot shot_time(uint64_t in_task) const;
  TrainSpec spec_;
  std::vector<size_t> channels_;  // by their delays
  std::vector<uint64_t> first_;   // pulses before each task
  uint64_t size_ = 0;
};

// The rotation that takes -z to a direction, by the shortest way.
Quat rotation_from_down(Dir to);

}  // namespace suite
