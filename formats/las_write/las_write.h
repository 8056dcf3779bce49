// LAS 1.4 point clouds out: point formats 6 and 9 (with waveform packets), extra bytes, the reference system as WKT,
// adjusted standard GPS time. See FORMAT.md.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "math/vec.h"

namespace suite {

// A number of each point beside those of the format.
struct LasExtra {
  enum class Type : uint8_t { u8 = 1, u16 = 3, u32 = 5, f32 = 9, f64 = 10 };
  std::string name, description;  // at most 32 bytes each
  Type type = Type::f64;
};

// How the samples of waveform packets are meant: volts = offset + gain x raw.
struct LasWaves {
  int bits = 16;         // 8 or 16
  uint32_t samples = 0;  // of a packet
  uint32_t spacing = 0;  // ps
  double gain = 1, offset = 0;
};

enum class LasPackets { none, external, internal };  // .wdp beside the file, or a record behind the points

struct LasSpec {
  Vec3 scale{1e-3, 1e-3, 1e-3}, offset;
  std::string wkt;        // of the reference system; not empty
  std::string system;     // what recorded, "detector als"
  std::string software;   // command line, cut to 32 bytes
  int year = 0, day = 0;  // of the file's creation; 0 = not said
  std::vector<LasExtra> extra;
  LasPackets packets = LasPackets::none;  // none: point format 6, else 9
  std::vector<LasWaves> waves;            // descriptors 1, 2, ... of packets, at most 255
};

struct LasReturn {
  Vec3 place;
  uint16_t intensity = 0;
  uint32_t number = 1, of = 1;  // the format ends at 15: larger numbers are written as 15
  uint8_t kind = 0;             // classification
  uint8_t channel = 0;          // scanner channel 0..3
  double scan_angle = 0;        // rad, -pi..pi, to 0.006 degrees
  uint16_t source = 1;          // point source
  double gps_time = 0;          // s, adjusted standard GPS time
  std::vector<double> extra;    // of LasSpec::extra
  // Packet: descriptor (0 = none), what packet() said, ps from its first sample to the return, and the map's units
  // a ps from the target back to the sensor: the place of sample s is place + (location - s spacing) direction.
  uint8_t descriptor = 0;
  uint64_t packet = 0;
  float location = 0;
  Vec3 direction;
};

class LasWriter {
 public:
  // Error: not writable, a scale that is none, a descriptor of other bits.
  LasWriter(const std::string& path, LasSpec spec);
  ~LasWriter();
  // Error: a place beyond what scale and offset can hold (with the point's number), not finite; a number of an extra
  // byte outside of its type.
  void add(const LasReturn& point);
  // Samples of a packet of the descriptor (from 1), as many as it says; values 0 to 2^bits - 1. Returns its place for
  // LasReturn::packet.
  uint64_t packet(uint8_t descriptor, std::span<const uint16_t> samples);
  uint64_t points() const;
  void finish();  // both files are there from now on, whole

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

// WKT 1 (OGC 01-009) of an EPSG code: WGS84 and ETRS89, UTM and geographic, as libs/motion/map_system.h knows them.
// Empty for others.
std::string wkt_of_epsg(int epsg);
// Of a scene without a place on the Earth.
std::string wkt_of_local_scene();

}  // namespace suite
