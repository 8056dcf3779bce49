// Based on: the public readers of github.com/pavdpr/DIRSIG (MIT), revisions 0 to 2; checked with files that were
// written after them.
#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "base/bytes.h"
#include "base/files.h"
#include "formats/dirsig_bin/dirsig_bin.h"

namespace suite {

namespace {

constexpr uint64_t kBestRatio = 1040;         // deflate packs no better
constexpr uint64_t kMostValues = 1ull << 31;  // of a pulse

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& file) : in_(bytes, file) {}
  LidarBin run() {
    LidarBin all;
    read_head(all.head);
    constexpr size_t kLeastTask = 146;
    if (all.head.task_count > in_.left() / kLeastTask)
      throw in_.error(strf("%u tasks cannot be in %zu bytes", all.head.task_count, in_.left()));
    for (uint32_t t = 0; t < all.head.task_count; ++t) all.tasks.push_back(read_task(all.head));
    return all;
  }

 private:
  template <class T>
  T get(const char* what) {
    T value;
    std::array<std::byte, sizeof(T)> raw;
    const auto taken = in_.take(sizeof(T), what);
    std::copy(taken.begin(), taken.end(), raw.begin());
    if (big_) std::reverse(raw.begin(), raw.end());
    std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }
  double number(const char* what) {
    const double v = get<double>(what);
    if (!std::isfinite(v)) throw in_.error(strf("%s is %g", what, v));
    return v;
  }
  Vec3 vector(const char* what) {
    Vec3 v;
    for (int k = 0; k < 3; ++k) v[k] = number(what);
    return v;
  }
  Matrix4 matrix(const char* what) {
    Matrix4 m;
    for (double& v : m) v = number(what);
    return m;
  }
  std::string text(size_t n, const char* what) {
    const auto raw = in_.take(n, what);
    const std::string all(reinterpret_cast<const char*>(raw.data()), n);
    return all.substr(0, std::min(all.find('\0'), all.find_last_not_of(' ') + 1));
  }
  void read_head(LidarBinHead& h);
  LidarBinTask read_task(const LidarBinHead& h);
  LidarBinPulse read_pulse(const LidarBinHead& h);
  void read_place(LidarBinPlace& place, int revision);
  void read_photons(const LidarBinHead& h, LidarBinPulse& p, uint64_t bytes, int type);

  ByteReader in_;
  bool big_ = false;
};

void Reader::read_head(LidarBinHead& h) {
  constexpr char kMagic[] = "DIRSIGPROTO";
  const auto magic = in_.take(11, "the first word");
  if (std::memcmp(magic.data(), kMagic, 11) != 0)
    throw in_.error("is no file of lidar photons", "it begins with DIRSIGPROTO");
  h.revision = get<uint8_t>("the revision");
  if (h.revision > 2) throw in_.error(strf("revision %d", h.revision), "0 to 2 are read: newer ones are not public");
  const auto endian = get<uint8_t>("the order of bytes");
  if (endian > 1) throw in_.error(strf("the order of bytes %u", endian), "0 = big end first, 1 = little end first");
  big_ = endian == 0;
  h.date = text(15, "the date"), h.version = text(32, "the version"), h.text = text(256, "the description");
  h.latitude = number("the latitude"), h.longitude = number("the longitude"), h.height = number("the height");
  h.transmitter_mount = text(16, "a mount"), h.receiver_mount = text(16, "a mount");
  h.columns = get<uint32_t>("the columns"), h.rows = get<uint32_t>("the rows");
  if (!h.columns || !h.rows || uint64_t{h.columns} * h.rows > kMostValues)
    throw in_.error(strf("a focal plane of %u x %u", h.columns, h.rows));
  h.pitch_x_um = number("the pitch"), h.pitch_y_um = number("the pitch");
  if (h.revision >= 1) {
    h.offset_x_um = number("the offset"), h.offset_y_um = number("the offset");
    h.k1 = number("the distortion"), h.k2 = number("the distortion");
  }
  h.task_count = get<uint32_t>("the number of tasks");
  if (h.revision >= 2) h.focal_plane = get<uint16_t>("the focal plane");
}

LidarBinTask Reader::read_task(const LidarBinHead& h) {
  LidarBinTask t;
  t.text = text(64, "a task"), t.start = text(15, "a task's start"), t.stop = text(15, "a task's stop");
  t.focal_length_mm = number("the focal length"), t.rate_hz = number("the pulse rate");
  t.pulse_length = number("the pulse length"), t.energy = number("the energy");
  t.centre_um = number("the wavelength"), t.width_um = number("the line width");
  t.pulse_count = get<uint32_t>("the number of pulses");
  constexpr size_t kLeastPulse = 200;
  if (t.pulse_count > in_.left() / kLeastPulse)
    throw in_.error(strf("%u pulses cannot be in %zu bytes", t.pulse_count, in_.left()));
  for (uint32_t p = 0; p < t.pulse_count; ++p) t.pulses.push_back(read_pulse(h));
  return t;
}

void Reader::read_place(LidarBinPlace& place, int revision) {
  if (revision >= 2) {
    place.to_mount = matrix("a matrix to the mount");
  } else {
    const Vec3 offset = vector("an offset");
    in_.take(3, "an order of angles");
    place.to_mount[3] = offset.x, place.to_mount[7] = offset.y, place.to_mount[11] = offset.z;
  }
  place.pointing = vector("a pointing");
  if (revision >= 2) place.mount_to_platform = matrix("a matrix to the platform");
}

LidarBinPulse Reader::read_pulse(const LidarBinHead& h) {
  LidarBinPulse p;
  p.time = number("a pulse's time"), p.gate_start = number("a gate"), p.gate_stop = number("a gate");
  p.bins = get<uint32_t>("the number of bins");
  if (h.revision >= 1) p.samples = get<uint32_t>("the samples of a bin");
  p.platform = vector("a platform's place");
  if (h.revision < 2) in_.take(3, "an order of angles");
  p.euler = vector("a platform's angles");
  read_place(p.transmitter, h.revision), read_place(p.receiver, h.revision);
  const int type = get<int32_t>("a data type");
  const auto packed = get<uint8_t>("a kind of packing");
  if (packed > 1) throw in_.error(strf("packing %u", packed), "0 = none, 1 = zlib");
  p.packed = packed == 1;
  if (h.revision >= 2)
    p.index = get<uint32_t>("an index");
  else
    get<uint8_t>("a flag of differences");
  const auto bytes = get<uint64_t>("a number of bytes");
  if (h.revision >= 2)
    p.transmitter.mueller = matrix("a Mueller matrix"), p.receiver.mueller = matrix("a Mueller matrix");
  read_photons(h, p, bytes, type);
  return p;
}

void Reader::read_photons(const LidarBinHead& h, LidarBinPulse& p, uint64_t bytes, int type) {
  if (type != 5) throw in_.error(strf("data type %d", type), "5, doubles, is read");
  const uint64_t pixels = uint64_t{h.columns} * h.rows, line = (uint64_t{p.bins} + 1) * p.samples;
  if (!p.samples || line > kMostValues || pixels > kMostValues / line)
    throw in_.error(strf("a pulse of %llu pixels with %u bins of %u samples", static_cast<unsigned long long>(pixels),
                         p.bins, p.samples));
  const uint64_t values = pixels * line, whole = values * sizeof(double);
  if (p.packed ? whole / kBestRatio > bytes : bytes != whole)
    throw in_.error(strf("a pulse of %llu values in %llu bytes", static_cast<unsigned long long>(values),
                         static_cast<unsigned long long>(bytes)));
  const size_t at = in_.offset();
  const auto raw = in_.take(static_cast<size_t>(std::min<uint64_t>(bytes, SIZE_MAX)), "the photons of a pulse");
  p.photons.resize(values);
  auto* out = reinterpret_cast<Bytef*>(p.photons.data());
  if (p.packed) {
    uLongf unpacked = whole;
    if (uncompress(out, &unpacked, reinterpret_cast<const Bytef*>(raw.data()), bytes) != Z_OK || unpacked != whole)
      throw Error(Where{in_.file(), 0, 0, {}, static_cast<long long>(at)}, "the photons of a pulse are damaged",
                  strf("zlib data of %llu bytes", static_cast<unsigned long long>(whole)));
  } else {
    std::memcpy(out, raw.data(), whole);
  }
  for (double& v : p.photons) {
    if (big_) {
      auto* b = reinterpret_cast<std::byte*>(&v);
      std::reverse(b, b + sizeof v);
    }
    if (!std::isfinite(v) || v < 0)
      throw Error(Where{in_.file(), 0, 0, {}, static_cast<long long>(at)}, strf("a pulse has %g photons in a bin", v));
  }
}

}  // namespace

LidarBin parse_lidar_bin(std::span<const std::byte> bytes, const std::string& file) {
  return Reader(bytes, file).run();
}
LidarBin read_lidar_bin(const std::string& path) { return parse_lidar_bin(read_bytes(path, size_t{16} << 30), path); }

}  // namespace suite
