#include "formats/las_write/layout.h"

namespace suite::las {

size_t bytes_of(LasExtra::Type type) {
  switch (type) {
    case LasExtra::Type::u8:
      return 1;
    case LasExtra::Type::u16:
      return 2;
    case LasExtra::Type::u32:
    case LasExtra::Type::f32:
      return 4;
    case LasExtra::Type::f64:
      return 8;
  }
  return 8;
}

size_t point_bytes(const LasSpec& spec) {
  size_t bytes = spec.packets == LasPackets::none ? 30 : 59;
  for (const LasExtra& e : spec.extra) bytes += bytes_of(e.type);
  return bytes;
}

namespace {

void record(Bytes& to, const char* user, uint16_t id, const std::string& content, const char* description) {
  to.put(uint16_t{0});
  to.text(user, 16);
  to.put(id), to.put(static_cast<uint16_t>(content.size()));
  to.text(description, 32);
  to.text(content, content.size());
}

std::string extra_content(const LasSpec& spec) {
  Bytes b;
  for (const LasExtra& e : spec.extra) {
    b.put(uint16_t{0}), b.put(static_cast<uint8_t>(e.type)), b.put(uint8_t{0});
    b.text(e.name, 32);
    b.text("", 4 + 5 * 24);  // unused, no data, minima, maxima, scale, offset: not given
    b.text(e.description, 32);
  }
  return b.all();
}

std::string waves_content(const LasWaves& w) {
  Bytes b;
  b.put(static_cast<uint8_t>(w.bits)), b.put(uint8_t{0});
  b.put(w.samples), b.put(w.spacing);
  b.put(w.gain), b.put(w.offset);
  return b.all();
}

}  // namespace

size_t record_count(const LasSpec& spec) {
  return 1 + (spec.extra.empty() ? 0 : 1) + (spec.packets == LasPackets::none ? 0 : spec.waves.size());
}

std::string records(const LasSpec& spec) {
  Bytes b;
  record(b, "LASF_Projection", 2112, spec.wkt + '\0', "OGC WKT of the reference system");
  if (!spec.extra.empty()) record(b, "LASF_Spec", 4, extra_content(spec), "Extra bytes");
  if (spec.packets != LasPackets::none)
    for (size_t k = 0; k < spec.waves.size(); ++k)
      record(b, "LASF_Spec", static_cast<uint16_t>(100 + k), waves_content(spec.waves[k]),
             "Waveform packet descriptor");
  return b.all();
}

std::string header(const LasSpec& spec, const Totals& t) {
  constexpr uint16_t kGpsTime = 1, kInternal = 2, kExternal = 4, kWkt = 16;
  const uint16_t packets = spec.packets == LasPackets::none       ? 0
                           : spec.packets == LasPackets::internal ? kInternal
                                                                  : kExternal;
  Bytes b;
  b.text("LASF", 4);
  b.put(uint16_t{0}), b.put(static_cast<uint16_t>(kGpsTime | kWkt | packets));
  b.text("", 16);
  b.put(uint8_t{1}), b.put(uint8_t{4});
  b.text(spec.system, 32), b.text(spec.software, 32);
  b.put(static_cast<uint16_t>(spec.day)), b.put(static_cast<uint16_t>(spec.year));
  b.put(static_cast<uint16_t>(kHeader)), b.put(static_cast<uint32_t>(kHeader + records(spec).size()));
  b.put(static_cast<uint32_t>(record_count(spec)));
  b.put(static_cast<uint8_t>(format_of(spec))), b.put(static_cast<uint16_t>(point_bytes(spec)));
  b.text("", 4 + 5 * 4);  // the counts of older versions are 0 for these formats
  b.point(spec.scale), b.point(spec.offset);
  for (int c = 0; c < 3; ++c) {
    const bool none = t.bounds.empty();
    b.put(none ? 0.0 : t.bounds.high[c]), b.put(none ? 0.0 : t.bounds.low[c]);
  }
  b.put(t.packets_at), b.put(t.packets_at);
  b.put(static_cast<uint32_t>(t.packets_at ? 1 : 0));
  b.put(t.points);
  for (const uint64_t n : t.by_number) b.put(n);
  SUITE_CHECK_EQ(b.all().size(), kHeader);
  return b.all();
}

std::string packets_header(uint64_t bytes) {
  Bytes b;
  b.put(uint16_t{0});
  b.text("LASF_Spec", 16);
  b.put(uint16_t{65535}), b.put(bytes);
  b.text("Waveform packets", 32);
  return b.all();
}

}  // namespace suite::las
