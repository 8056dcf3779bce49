// DIRSIG's lidar photons (.bin): revisions 0 to 2 in, revision 2 out. See FORMAT.md.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "math/vec.h"

namespace suite {

using Matrix4 = std::array<double, 16>;  // row by row
inline constexpr Matrix4 kIdentity4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

// Where a transmitter or receiver is on its platform.
struct LidarBinPlace {
  Matrix4 to_mount = kIdentity4, mount_to_platform = kIdentity4;
  Vec3 pointing;  // rad, of the mount at the time of the pulse
  Matrix4 mueller = kIdentity4;
};

struct LidarBinPulse {
  double time = 0;                       // s from the task's start
  double gate_start = 0, gate_stop = 0;  // s
  uint32_t bins = 0, samples = 1;        // range bins; samples of a bin
  Vec3 platform, euler;                  // m; rad about x, y, z, applied y, z, x
  LidarBinPlace transmitter, receiver;
  uint32_t index = 0;   // of the focal plane
  bool packed = false;  // zlib
  // Photons: columns x rows x samples x (bins + 1), bins fastest; bin 0 is passive light.
  std::vector<double> photons;
};

struct LidarBinTask {
  std::string text, start, stop;                                          // 64, 15 and 15 bytes; times YYYYMMDDhhmm.ss
  double focal_length_mm = 0, rate_hz = 0, pulse_length = 0, energy = 0;  // s, J
  double centre_um = 0, width_um = 0;
  uint32_t pulse_count = 0;
  std::vector<LidarBinPulse> pulses;  // as they are read
};

struct LidarBinHead {
  int revision = 2;
  std::string date, version, text;  // 15, 32, 256 bytes
  double latitude = 0, longitude = 0, height = 0;
  std::string transmitter_mount, receiver_mount;  // 16 bytes
  uint32_t columns = 1, rows = 1;
  double pitch_x_um = 0, pitch_y_um = 0, offset_x_um = 0, offset_y_um = 0, k1 = 0, k2 = 0;
  uint16_t focal_plane = 0;
  uint32_t task_count = 1;
};

struct LidarBin {
  LidarBinHead head;
  std::vector<LidarBinTask> tasks;
};

// Error, with its byte: no such file, another revision, cut short, numbers of values that do not fit, packed values
// that are damaged.
LidarBin read_lidar_bin(const std::string& path);
LidarBin parse_lidar_bin(std::span<const std::byte> bytes, const std::string& file);

// Little-endian, revision 2, one task; pulse by pulse, as many as the task says.
class LidarBinWriter {
 public:
  LidarBinWriter(const std::string& path, const LidarBinHead& head, const LidarBinTask& task);
  ~LidarBinWriter();
  void add(const LidarBinPulse& pulse);
  void finish();

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace suite
