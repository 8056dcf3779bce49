#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "formats/las_write/layout.h"

namespace suite {

using namespace las;

struct LasWriter::Open {
  Open(const std::string& p, LasSpec s) : path(p), spec(std::move(s)), file(p) {
    if (spec.packets != LasPackets::none) packets = std::make_unique<AtomicFile>(packets_path());
  }
  // Beside the file, of its name; of internal ones gone when they are in it.
  std::string packets_path() const {
    const std::string stem = path.ends_with(".las") ? path.substr(0, path.size() - 4) : path;
    return stem + ".wdp";
  }
  Error fault(const std::string& what, const std::string& hint = {}) const {
    return Error(Where{path, 0, 0, {}, -1}, what, hint);
  }
  void flush(size_t most) {
    if (points.all().size() < most) return;
    file.write(points.all());
    points.clear();
  }
  std::string path;
  LasSpec spec;
  AtomicFile file;
  std::unique_ptr<AtomicFile> packets;
  uint64_t packet_bytes = 0;
  Totals totals;
  Bytes points;
};

LasWriter::LasWriter(const std::string& path, LasSpec spec) : open_(std::make_unique<Open>(path, std::move(spec))) {
  Open& o = *open_;
  for (int c = 0; c < 3; ++c)
    if (!(o.spec.scale[c] > 0 && o.spec.scale[c] < 1e6) || !std::isfinite(o.spec.offset[c]))
      throw o.fault(strf("a scale of %g and an offset of %g", o.spec.scale[c], o.spec.offset[c]), "scale: 0.001");
  for (const LasWaves& w : o.spec.waves)
    if ((w.bits != 8 && w.bits != 16) || w.samples == 0 || w.spacing == 0)
      throw o.fault(strf("waveforms of %d bits, %u samples of %u ps", w.bits, w.samples, w.spacing), "8 or 16 bits");
  SUITE_CHECK(o.spec.waves.size() < 256 && !o.spec.wkt.empty() && o.spec.wkt.size() < 60000);
  o.file.write(header(o.spec, o.totals));
  o.file.write(records(o.spec));
  if (o.packets) o.packets->write(packets_header(0));
}

LasWriter::~LasWriter() = default;
uint64_t LasWriter::points() const { return open_->totals.points; }

namespace {

// Rounded to the nearest whole number of scales.
int32_t whole(double v, double scale, double offset, int axis, uint64_t point, const std::string& path) {
  const double n = std::round((v - offset) / scale);
  if (std::fabs(n) <= 2147483647.0) return static_cast<int32_t>(n);
  throw Error(Where{path, 0, 0, {}, -1},
              strf("point %llu: %c = %.10g is beyond what a scale of %g and an offset of %.10g hold (%.10g to %.10g)",
                   static_cast<unsigned long long>(point), "xyz"[axis], v, scale, offset, offset - 2147483647 * scale,
                   offset + 2147483647 * scale),
              "a coarser scale, or an offset near the points");
}

void put_extra(Bytes& to, LasExtra::Type type, double v) {
  switch (type) {
    case LasExtra::Type::u8:
      return to.put(static_cast<uint8_t>(v));
    case LasExtra::Type::u16:
      return to.put(static_cast<uint16_t>(v));
    case LasExtra::Type::u32:
      return to.put(static_cast<uint32_t>(v));
    case LasExtra::Type::f32:
      return to.put(static_cast<float>(v));
    case LasExtra::Type::f64:
      return to.put(v);
  }
}

// The largest whole number of a type; floating ones hold all.
double largest(LasExtra::Type type) {
  return type == LasExtra::Type::u8    ? 255
         : type == LasExtra::Type::u16 ? 65535
         : type == LasExtra::Type::u32 ? 4294967295.0
                                       : -1;
}

}  // namespace

void LasWriter::add(const LasReturn& p) {
  Open& o = *open_;
  const LasSpec& s = o.spec;
  if (!finite(p.place))
    throw o.fault(strf("point %llu has no place", static_cast<unsigned long long>(o.totals.points)));
  SUITE_CHECK_EQ(p.extra.size(), s.extra.size());
  Vec3 stored;
  for (int c = 0; c < 3; ++c) {
    const int32_t n = whole(p.place[c], s.scale[c], s.offset[c], c, o.totals.points, o.path);
    o.points.put(n);
    stored[c] = n * s.scale[c] + s.offset[c];
  }
  const auto number = std::clamp<uint32_t>(p.number, 1, 15), of = std::clamp<uint32_t>(p.of, number, 15);
  o.points.put(p.intensity);
  o.points.put(static_cast<uint8_t>(number | of << 4));
  o.points.put(static_cast<uint8_t>((p.channel & 3u) << 4));
  o.points.put(p.kind), o.points.put(uint8_t{0});
  o.points.put(static_cast<int16_t>(std::clamp(std::round(p.scan_angle / kDegree / 0.006), -30000.0, 30000.0)));
  o.points.put(p.source), o.points.put(p.gps_time);
  if (s.packets != LasPackets::none) {
    SUITE_CHECK(p.descriptor <= s.waves.size());
    const bool has = p.descriptor > 0;
    const LasWaves none{16, 0, 0, 1, 0}, &w = has ? s.waves[p.descriptor - 1u] : none;
    o.points.put(p.descriptor), o.points.put(has ? p.packet : uint64_t{0});
    o.points.put(static_cast<uint32_t>(w.samples * static_cast<uint32_t>(w.bits) / 8));
    o.points.put(has ? p.location : 0.0f);
    for (int c = 0; c < 3; ++c) o.points.put(has ? static_cast<float>(p.direction[c]) : 0.0f);
  }
  for (size_t k = 0; k < s.extra.size(); ++k) {
    const double most = largest(s.extra[k].type);
    if (most > 0 && !(p.extra[k] >= 0 && p.extra[k] <= most))
      throw o.fault(strf("point %llu: '%s' is %g, 0 to %g can be written",
                         static_cast<unsigned long long>(o.totals.points), s.extra[k].name.c_str(), p.extra[k], most));
    put_extra(o.points, s.extra[k].type, p.extra[k]);
  }
  o.totals.bounds.grow(stored);
  ++o.totals.points, ++o.totals.by_number[number - 1];
  o.flush(1 << 20);
}

uint64_t LasWriter::packet(uint8_t descriptor, std::span<const uint16_t> samples) {
  Open& o = *open_;
  SUITE_CHECK(o.packets && descriptor >= 1 && descriptor <= o.spec.waves.size());
  const LasWaves& w = o.spec.waves[descriptor - 1u];
  SUITE_CHECK_EQ(samples.size(), size_t{w.samples});
  const uint64_t at = kExtendedRecord + o.packet_bytes;
  Bytes b;
  for (const uint16_t v : samples)
    if (w.bits == 8)
      b.put(static_cast<uint8_t>(v));
    else
      b.put(v);
  o.packets->write(b.all());
  o.packet_bytes += b.all().size();
  return at;
}

void LasWriter::finish() {
  Open& o = *open_;
  o.flush(0);
  if (o.packets) {
    const std::string head = packets_header(o.packet_bytes);
    o.packets->write_at(0, std::as_bytes(std::span(head)));
  }
  if (o.spec.packets == LasPackets::internal) {
    o.packets->close();
    o.totals.packets_at = kHeader + records(o.spec).size() + o.totals.points * point_bytes(o.spec);
    const RandomAccessFile from(o.packets->temporary());
    std::vector<std::byte> piece;
    for (size_t at = 0; at < from.size(); at += piece.size()) {
      piece.resize(std::min<size_t>(from.size() - at, 4 << 20));
      from.read_at(at, piece);
      o.file.write(piece);
    }
    o.packets.reset();
  }
  const std::string head = header(o.spec, o.totals);
  o.file.write_at(0, std::as_bytes(std::span(head)));
  if (o.spec.packets == LasPackets::external) o.packets->commit();
  o.file.commit();
}

}  // namespace suite
