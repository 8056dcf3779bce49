#include <zlib.h>

#include <cstring>

#include "base/files.h"
#include "formats/dirsig_bin/dirsig_bin.h"

namespace suite {

struct LidarBinWriter::Open {
  Open(const std::string& path, const LidarBinHead& h, const LidarBinTask& t) : file(path), head(h), task(t) {}
  AtomicFile file;
  LidarBinHead head;
  LidarBinTask task;
  uint32_t pulses = 0;
  std::string bytes;

  template <class T>
  void put(T value) {
    const size_t at = bytes.size();
    bytes.resize(at + sizeof value);
    std::memcpy(bytes.data() + at, &value, sizeof value);
  }
  void text(std::string t, size_t size) {
    t.resize(size, '\0');
    bytes += t;
  }
  void point(Vec3 v) { put(v.x), put(v.y), put(v.z); }
  void matrix(const Matrix4& m) {
    for (const double v : m) put(v);
  }
  void place(const LidarBinPlace& p) { matrix(p.to_mount), point(p.pointing), matrix(p.mount_to_platform); }
  void flush() {
    file.write(bytes);
    bytes.clear();
  }
};

LidarBinWriter::LidarBinWriter(const std::string& path, const LidarBinHead& head, const LidarBinTask& task)
    : open_(std::make_unique<Open>(path, head, task)) {
  Open& o = *open_;
  o.bytes = "DIRSIGPROTO";
  o.put(uint8_t{2}), o.put(uint8_t{1});
  o.text(head.date, 15), o.text(head.version, 32), o.text(head.text, 256);
  o.put(head.latitude), o.put(head.longitude), o.put(head.height);
  o.text(head.transmitter_mount, 16), o.text(head.receiver_mount, 16);
  o.put(head.columns), o.put(head.rows);
  for (const double v : {head.pitch_x_um, head.pitch_y_um, head.offset_x_um, head.offset_y_um, head.k1, head.k2})
    o.put(v);
  o.put(uint32_t{1}), o.put(head.focal_plane);
  SUITE_CHECK_EQ(o.bytes.size(), size_t{434});
  o.text(task.text, 64), o.text(task.start, 15), o.text(task.stop, 15);
  for (const double v :
       {task.focal_length_mm, task.rate_hz, task.pulse_length, task.energy, task.centre_um, task.width_um})
    o.put(v);
  o.put(task.pulse_count);
  o.flush();
}

LidarBinWriter::~LidarBinWriter() = default;

void LidarBinWriter::add(const LidarBinPulse& p) {
  Open& o = *open_;
  SUITE_CHECK_EQ(p.photons.size(), uint64_t{o.head.columns} * o.head.rows * p.samples * (uint64_t{p.bins} + 1));
  o.put(p.time), o.put(p.gate_start), o.put(p.gate_stop);
  o.put(p.bins), o.put(p.samples);
  o.point(p.platform), o.point(p.euler);
  o.place(p.transmitter), o.place(p.receiver);
  const size_t whole = p.photons.size() * sizeof(double);
  std::string content(reinterpret_cast<const char*>(p.photons.data()), whole);
  if (p.packed) {
    uLongf packed = compressBound(whole);
    std::string small(packed, '\0');
    SUITE_CHECK(compress2(reinterpret_cast<Bytef*>(small.data()), &packed,
                          reinterpret_cast<const Bytef*>(content.data()), whole, 1) == Z_OK);
    small.resize(packed);
    content = std::move(small);
  }
  o.put(int32_t{5}), o.put(static_cast<uint8_t>(p.packed)), o.put(p.index),
      o.put(static_cast<uint64_t>(content.size()));
  o.matrix(p.transmitter.mueller), o.matrix(p.receiver.mueller);
  SUITE_CHECK_EQ(o.bytes.size(), size_t{913});
  o.bytes += content;
  o.flush();
  ++o.pulses;
}

void LidarBinWriter::finish() {
  SUITE_CHECK_EQ(open_->pulses, open_->task.pulse_count);
  open_->file.commit();
}

}  // namespace suite
