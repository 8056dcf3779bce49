#include <algorithm>

#include "base/files.h"
#include "base/params.h"
#include "formats/sqt/container.h"
#include "formats/sqt/polarisation.h"
#include "formats/sqt/sqt.h"
#include "sqt/aligned.h"
#include "sqt/paper.h"

namespace suite {

namespace {

constexpr size_t kMaxHeader = 16 << 20;
constexpr size_t kMaxRaw = size_t{1} << 30;
constexpr size_t kMaxSide = 1024;        // views, and channels
constexpr size_t kMaxNumbers = 1 << 25;  // leaves x views x channels

sqt::Function::Info function_of(const Params& p) {
  sqt::Function::Info f;
  f.name = p.text("name");
  f.source = p.text("source");
  f.wavelength_um = p.at("wavelength_um").as_numbers();
  if (f.wavelength_um.empty() || f.wavelength_um.size() > 10000)
    throw p.at("wavelength_um").error("1 to 10000 wavelengths expected");
  for (const Params& n : p.at("channel_names").items()) f.channel_names.push_back(n.as_text());
  f.domain = p.at("domain").as_choice({"hemisphere", "sphere"}) == 0 ? sqt::Domain::hemisphere : sqt::Domain::sphere;
  const size_t quantity = p.at("quantity").as_choice({"bsdf", "phase", "intensity"});
  f.quantity = quantity == 0 ? sqt::Quantity::bsdf : quantity == 1 ? sqt::Quantity::phase : sqt::Quantity::intensity;
  f.isotropic = p.at("isotropic").as_bool();
  f.bilateral = p.at("bilateral").as_bool();
  return f;
}

std::vector<double> angles_of(const Params& p) {
  std::vector<double> theta = p.as_numbers();
  if (theta.empty() || theta.size() > 10000) throw p.error("1 to 10000 angles expected");
  for (size_t i = 0; i < theta.size(); ++i)
    if (!(theta[i] >= 0 && theta[i] <= kPi) || (i && !(theta[i] > theta[i - 1])))
      throw p.error("angles must ascend within [0, pi]");
  return theta;
}

using MuellerPtr = std::shared_ptr<const sqt::MuellerTable>;

std::shared_ptr<const sqt::Bundle> aligned_of(const Params& header, std::span<const std::byte> raw,
                                              MuellerPtr mueller) {
  sqt::AlignedData d;
  d.function = function_of(header.at("function"));
  const Params l = header.at("layout"), t = header.at("totals");
  sqt::AlignedLayout& layout = d.layout;
  layout.frame = static_cast<sqt::LobeFrame>(l.at("frame").as_choice({"half", "retro", "direct", "forward"}));
  layout.half_stored = l.at("half_stored").as_bool();
  layout.upper_only = l.at("upper_only").as_bool();
  layout.cosine_weighted = d.function.quantity == sqt::Quantity::bsdf;
  layout.sheets = static_cast<int>(l.integer("sheets", 1, 2));
  layout.quality = l.number_in("quality", 1e-6, 1e3, "log2 units");
  layout.theta = angles_of(l.at("theta"));
  layout.phi_count = static_cast<size_t>(l.integer("phi_count", 1, 10000));
  layout.channels = d.function.wavelength_um.size();
  layout.refined = l.boolean("refined", false);
  if (l.find("spectra"))
    layout.spectra.resize(static_cast<size_t>(l.integer("spectra", 1, static_cast<long long>(layout.channels))) *
                          layout.channels);
  d.totals.theta = t.find("theta") ? angles_of(t.at("theta")) : sqt::total_angles(layout.theta);
  d.totals.phi_count = static_cast<size_t>(t.integer("phi_count", 1, 10000));
  d.totals.magnitude_um = t.at("wavelength_um").as_numbers();
  if (t.boolean("delta", false))
    d.totals.delta_kind = static_cast<sqt::Dirac>(1 + t.at("delta_toward").as_choice({"mirror", "retro", "through"}));
  if (t.find("delta_core")) d.totals.delta_core = t.number_in("delta_core", 0, 1, "rad");
  // Every number of the tables costs the file something; these bounds keep memory in proportion.
  if (layout.theta.size() * layout.phi_count > kMaxSide || layout.channels > kMaxSide)
    throw l.error("more views or channels than this reader accepts", "at most 1024 of each");
  if (d.totals.theta.size() * d.totals.phi_count * std::max(d.totals.magnitude_um.size(), layout.channels) >
      (size_t{1} << 24))
    throw t.error("the table of totals exceeds what this reader accepts");
  sqt_file::Reader reader(raw);
  const auto length = reader.get<uint32_t>();
  const auto totals = reader.take(length);
  if (!reader.ok()) throw Error("SQT payload is damaged: its totals end too early");
  sqt::decode_totals(totals, layout.channels, d.totals.delta_kind != sqt::Dirac::none, d.totals);
  const auto trees = reader.take(reader.left());
  // A divided node takes two bits at least and adds three leaves; what they need in memory is bounded as well.
  const auto leaves = static_cast<size_t>(l.integer("leaves", 1, 1 << 28));
  if (leaves > 64 + 12 * trees.size() || leaves * layout.width() > kMaxNumbers)
    throw l.error("implausible number of leaves");
  d.sheets = sqt::decode_sheets(layout, trees, leaves);
  size_t found = 0;
  for (const sqt::AlignedSheet& sheet : d.sheets) found += sheet.stored;
  if (found != leaves) throw Error("SQT payload is damaged: its leaves are not those announced");
  d.mueller = std::move(mueller);
  return sqt::make_bundle(std::move(d));
}

std::shared_ptr<const sqt::Bundle> paper_of(const Params& header, std::span<const std::byte> raw, MuellerPtr mueller) {
  sqt::PaperData d;
  d.function = function_of(header.at("function"));
  const Params v = header.at("views");
  const std::vector<double> theta = angles_of(v.at("theta"));
  d.phi_count = static_cast<size_t>(v.integer("phi_count", 1, 10000));
  d.magnitude_um = header.at("magnitude_um").as_numbers();
  const size_t views = theta.size() * d.phi_count, slices = views * d.function.wavelength_um.size();
  if (raw.size() / 4 < views * d.magnitude_um.size() || raw.size() / 4 < slices)
    throw Error("SQT payload is damaged: too short for its slices");
  for (const double t : theta)
    for (size_t j = 0; j < d.phi_count; ++j)
      d.views.push_back({t, 2 * kPi * static_cast<double>(j) / static_cast<double>(d.phi_count)});
  sqt_file::Reader reader(raw);
  for (size_t i = 0; i < views * d.magnitude_um.size(); ++i) d.magnitudes.push_back(reader.get<float>());
  for (size_t s = 0; s < slices; ++s) {
    const auto count = reader.get<uint32_t>();
    const auto orders = reader.take(count);
    if (!reader.ok()) break;
    d.slices.emplace_back();
    uint64_t at = 0;
    for (const std::byte b : orders) {
      const int order = static_cast<int>(b) & 0x7F;
      if (order > sqt::kMaxOrder) throw Error("SQT payload is damaged: a cell of an order that does not exist");
      const int shift = 2 * (sqt::kMaxOrder - order);
      if (at + (uint64_t{1} << shift) > (uint64_t{12} << (2 * sqt::kMaxOrder)) || (at & ((uint64_t{1} << shift) - 1)))
        throw Error("SQT payload is damaged: cells do not fit the sphere");
      if (!(static_cast<int>(b) & 0x80))
        d.slices.back().push_back({sqt::CellId::of(order, static_cast<uint32_t>(at >> shift)), 0});
      at += uint64_t{1} << shift;
    }
    for (auto& leaf : d.slices.back()) leaf.value = reader.get<float>();
  }
  if (!reader.ok() || reader.left()) throw Error("SQT payload is damaged: its length does not fit its slices");
  d.mueller = std::move(mueller);
  return sqt::make_bundle(std::move(d));
}

}  // namespace

SqtFile parse_sqt(std::span<const std::byte> bytes, const std::string& file_name) {
  auto fail = [&](size_t at, const std::string& what, const std::string& hint = {}) {
    return Error(Where{file_name, 0, 0, {}, static_cast<long long>(at)}, what, hint);
  };
  if (bytes.size() < sizeof sqt_file::kMagic ||
      std::memcmp(bytes.data(), sqt_file::kMagic, sizeof sqt_file::kMagic) != 0)
    throw fail(0, "not an SQT file", "files written by sqt-fit begin with \"SQTbund\"");
  sqt_file::Reader reader(bytes.subspan(sizeof sqt_file::kMagic));
  SqtFile file;
  const auto version = reader.get<uint32_t>(), header_size = reader.get<uint32_t>();
  const auto payload_size = reader.get<uint64_t>(), raw_size = reader.get<uint64_t>();
  const auto coding = reader.get<uint32_t>(), text_size = reader.get<uint32_t>();
  const auto checksum = reader.get<uint64_t>();
  if (!reader.ok()) throw fail(bytes.size(), "the file ends within its first 48 bytes");
  if (version < kSqtOldest || version > kSqtVersion)
    throw fail(8, strf("SQT version %u", version),
               strf("this program reads versions %d to %d", kSqtOldest, kSqtVersion));
  if (header_size > kMaxHeader || text_size > kMaxHeader || raw_size > kMaxRaw || coding > 1)
    throw fail(12, "implausible sizes in the SQT header");
  if (header_size > reader.left() || payload_size != reader.left() - header_size)
    throw fail(bytes.size(),
               strf("the file has %zu bytes, its header announces %llu", bytes.size(),
                    static_cast<unsigned long long>(sqt_file::kFixed + header_size + payload_size)),
               "is it truncated?");
  const auto header_bytes = reader.take(header_size), payload = reader.take(static_cast<size_t>(payload_size));
  uint64_t crc = sqt_file::crc64(bytes.first(sqt_file::kFixed - 8));
  crc = sqt_file::crc64(header_bytes, crc);
  crc = sqt_file::crc64(payload, crc);
  if (crc != checksum) throw fail(sqt_file::kFixed - 8, "checksum mismatch: the file is damaged");
  file.version = static_cast<int>(version);
  file.bytes = bytes.size();
  try {
    const std::vector<std::byte> text = sqt_file::lzma_expand(header_bytes, text_size);
    file.header.assign(reinterpret_cast<const char*>(text.data()), text.size());
    const Params header = Params::parse_json(file.header, file_name);
    std::vector<std::byte> expanded;
    MuellerPtr mueller;
    std::span<const std::byte> raw = payload;
    if (header.find("polarisation")) {
      const Params p = header.at("polarisation");
      const auto behind = static_cast<size_t>(p.integer("bytes", 1, static_cast<long long>(payload.size())));
      raw = payload.first(payload.size() - behind);
      mueller = sqt_file::mueller_of(p, payload.last(behind));
    }
    const size_t stored = raw.size();
    if (coding == sqt_file::lzma) {
      expanded = sqt_file::lzma_expand(raw, static_cast<size_t>(raw_size));
      raw = expanded;
    } else if (raw_size != stored) {
      throw Error("implausible sizes in the SQT header");
    }
    file.bundle = header.at("method").as_choice({"aligned", "paper"}) == 0 ? aligned_of(header, raw, std::move(mueller))
                                                                           : paper_of(header, raw, std::move(mueller));
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;
    throw Error(Where{file_name, 0, 0, {}, -1}, e.message(), e.hint(), e.code());
  }
  return file;
}

SqtFile read_sqt(const std::string& path) { return parse_sqt(read_bytes(path), path); }

}  // namespace suite
