// Lists of single photons in HDF5 with the names of ICESat-2's ATL03 product. See FORMAT.md.
#pragma once
#include <array>
#include <memory>
#include <string>

#include "motion/scene_frame.h"

namespace suite {

struct PhotonEvent {
  Geodetic place;
  double delta_time = 0;          // s, as of waveforms
  double along = 0, across = 0;   // m, from the first pulse along and across the flight
  uint32_t pixel = 0, pulse = 0;  // channel; number of the pulse
  bool signal = true;             // truth
};

class PhotonWriter {
 public:
  PhotonWriter(const std::string& path, const std::string& made_by);
  ~PhotonWriter();
  static constexpr std::array<const char*, 6> kTracks{"gt1l", "gt1r", "gt2l", "gt2r", "gt3l", "gt3r"};
  // track: 0..5.
  void add(size_t track, const PhotonEvent& event);
  // background: counts/s that are not of the laser; energy: J.
  void add_pulse(size_t track, double delta_time, double background, double energy);
  void finish();

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace suite
