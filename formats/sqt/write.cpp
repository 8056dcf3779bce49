#include "base/error.h"
#include "formats/sqt/container.h"
#include "formats/sqt/polarisation.h"
#include "formats/sqt/sqt.h"
#include "formats/sqt/sqt_write.h"

namespace suite {

namespace {

using sqt_file::put;

Json numbers(const std::vector<double>& v) {
  Json a = Json::array();
  for (const double x : v) a.push(x);
  return a;
}

Json function_json(const sqt::Function::Info& f) {
  Json j = Json::object();
  j.set("name", f.name);
  j.set("source", f.source);
  j.set("wavelength_um", numbers(f.wavelength_um));
  Json names = Json::array();
  for (const std::string& n : f.channel_names) names.push(n);
  j.set("channel_names", std::move(names));
  j.set("domain", f.domain == sqt::Domain::hemisphere ? "hemisphere" : "sphere");
  j.set("quantity", f.quantity == sqt::Quantity::bsdf    ? "bsdf"
                    : f.quantity == sqt::Quantity::phase ? "phase"
                                                         : "intensity");
  j.set("isotropic", f.isotropic);
  j.set("bilateral", f.bilateral);
  return j;
}

Json head(const char* method, const sqt::Function::Info& function, const SqtProvenance& p,
          const std::vector<sqt::ErrorFigures>& errors) {
  Json j = Json::object();
  j.set("format", "sqt");
  j.set("method", method);
  j.set("tool", p.tool);
  j.set("command", p.command);
  j.set("input", p.input);
  j.set("input_sha256", p.input_sha256);
  j.set("conventions", p.conventions);
  j.set("units", "value 1/sr without cosine; wavelengths um; angles rad");
  j.set("function", function_json(function));
  if (!errors.empty()) {
    Json e = Json::object();
    e.set("overall", error_json(errors.back()));
    Json per = Json::array();
    for (size_t c = 0; c + 1 < errors.size(); ++c) per.push(error_json(errors[c]));
    e.set("channels", std::move(per));
    j.set("errors", std::move(e));
  }
  return j;
}

// Matrices, with their errors, behind the payload.
void add_polarisation(const sqt::MuellerTable& table, const SqtProvenance& p, Json& header,
                      std::vector<std::byte>& payload) {
  const std::vector<std::byte> elements = sqt_file::mueller_elements(table);
  Json j = sqt_file::mueller_axes(table);
  j.set("bytes", elements.size());
  j.set("errors", mueller_error_json(p.mueller));
  header.set("polarisation", std::move(j));
  payload.insert(payload.end(), elements.begin(), elements.end());
}

std::vector<std::byte> frame(const Json& header, std::span<const std::byte> payload, size_t raw_size,
                             sqt_file::Coding coding, int version) {
  const std::string text = header.text(0);
  const std::vector<std::byte> packed = sqt_file::lzma_compress(std::as_bytes(std::span(text)));
  std::vector<std::byte> out(sizeof sqt_file::kMagic);
  std::memcpy(out.data(), sqt_file::kMagic, sizeof sqt_file::kMagic);
  put<uint32_t>(out, static_cast<uint32_t>(version));
  put<uint32_t>(out, static_cast<uint32_t>(packed.size()));
  put<uint64_t>(out, payload.size());
  put<uint64_t>(out, raw_size);
  put<uint32_t>(out, coding);
  put<uint32_t>(out, static_cast<uint32_t>(text.size()));
  // The checksum covers everything else: the fixed part before it, the header, the payload.
  uint64_t crc = sqt_file::crc64(out);
  crc = sqt_file::crc64(packed, crc);
  crc = sqt_file::crc64(payload, crc);
  put<uint64_t>(out, crc);
  out.insert(out.end(), packed.begin(), packed.end());
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

}  // namespace

Json error_json(const sqt::ErrorFigures& e) {
  Json j = Json::object();
  auto set = [&j](const char* key, double value) { j.set(key, std::stod(strf("%.6g", value))); };
  set("l1", e.l1);
  set("cos_rmse", e.cos_rmse);
  set("rmse", e.rmse);
  set("peak_ratio_20", e.peak_ratio_20);
  set("peak_ratio_45", e.peak_ratio_45);
  set("peak_ratio_70", e.peak_ratio_70);
  set("total_error", e.total_error);
  set("reciprocity_error", e.reciprocity_error);
  set("max_weight", e.max_weight);
  return j;
}

Json mueller_error_json(const sqt::MuellerErrors& e) {
  Json j = Json::object();
  j.set("rms", std::stod(strf("%.6g", e.rms)));
  j.set("lit", std::stod(strf("%.6g", e.lit)));
  j.set("largest", std::stod(strf("%.6g", e.largest)));
  return j;
}

std::vector<std::byte> pack_sqt(const sqt::AlignedFit& fit, const SqtProvenance& provenance,
                                const std::vector<sqt::ErrorFigures>& errors) {
  const sqt::AlignedLayout& l = fit.data.layout;
  const sqt::AlignedTotals& t = fit.data.totals;
  Json header = head("aligned", fit.data.function, provenance, errors);
  Json layout = Json::object();
  constexpr const char* kFrames[] = {"half", "retro", "direct", "forward"};
  layout.set("frame", kFrames[static_cast<size_t>(l.frame)]);
  layout.set("half_stored", l.half_stored);
  layout.set("upper_only", l.upper_only);
  layout.set("sheets", l.sheets);
  size_t leaves = 0;
  for (const sqt::AlignedSheet& sheet : fit.data.sheets) leaves += sheet.stored;
  layout.set("leaves", leaves);
  layout.set("quality", l.quality);
  layout.set("theta", numbers(l.theta));
  layout.set("phi_count", l.phi_count);
  if (l.refined) layout.set("refined", true);
  if (!l.spectra.empty()) layout.set("spectra", l.spectra.size() / l.channels);
  header.set("layout", std::move(layout));
  Json totals = Json::object();
  if (t.theta != sqt::total_angles(l.theta)) totals.set("theta", numbers(t.theta));
  totals.set("phi_count", t.phi_count);
  totals.set("wavelength_um", numbers(t.magnitude_um));
  constexpr const char* kDirac[] = {"none", "mirror", "retro", "through"};
  totals.set("delta", t.delta_kind != sqt::Dirac::none);
  if (t.delta_kind != sqt::Dirac::none) totals.set("delta_toward", kDirac[static_cast<size_t>(t.delta_kind)]);
  if (t.delta_core > 0) totals.set("delta_core", t.delta_core);
  header.set("totals", std::move(totals));
  std::vector<std::byte> payload;
  put<uint32_t>(payload, static_cast<uint32_t>(fit.totals_bytes.size()));
  payload.insert(payload.end(), fit.totals_bytes.begin(), fit.totals_bytes.end());
  payload.insert(payload.end(), fit.sheets_bytes.begin(), fit.sheets_bytes.end());
  const size_t raw_size = payload.size();
  int version = l.refined || !l.spectra.empty() ? kSqtRefined : kSqtOldest;
  if (fit.data.mueller) add_polarisation(*fit.data.mueller, provenance, header, payload), version = kSqtVersion;
  return frame(header, payload, raw_size, sqt_file::plain, version);
}

std::vector<std::byte> pack_sqt(const sqt::PaperData& data, const SqtProvenance& provenance,
                                const std::vector<sqt::ErrorFigures>& errors) {
  Json header = head("paper", data.function, provenance, errors);
  Json views = Json::object();
  std::vector<double> theta;
  for (size_t v = 0; v < data.views.size(); v += data.phi_count) theta.push_back(data.views[v].theta);
  views.set("theta", numbers(theta));
  views.set("phi_count", data.phi_count);
  header.set("views", std::move(views));
  header.set("magnitude_um", numbers(data.magnitude_um));
  // Totals, then per slice: leaf count, orders of the leaves in depth-first order (0x80: nothing there), their values.
  std::vector<std::byte> raw;
  for (const float m : data.magnitudes) put(raw, m);
  for (const auto& slice : data.slices) {
    std::vector<uint8_t> orders;
    uint64_t at = 0;
    auto skip_to = [&](uint64_t target) {  // as few empty cells as the gap allows
      while (at < target) {
        int order = 0;
        while ((at & ((uint64_t{1} << (2 * (sqt::kMaxOrder - order))) - 1)) ||
               at + (uint64_t{1} << (2 * (sqt::kMaxOrder - order))) > target)
          ++order;
        orders.push_back(static_cast<uint8_t>(0x80 | order));
        at += uint64_t{1} << (2 * (sqt::kMaxOrder - order));
      }
    };
    for (const auto& leaf : slice) {
      const int shift = 2 * (sqt::kMaxOrder - leaf.id.order());
      skip_to(static_cast<uint64_t>(leaf.id.index()) << shift);
      orders.push_back(static_cast<uint8_t>(leaf.id.order()));
      at += uint64_t{1} << shift;
    }
    put<uint32_t>(raw, static_cast<uint32_t>(orders.size()));
    for (const uint8_t o : orders) put(raw, o);
    for (const auto& leaf : slice) put(raw, leaf.value);
  }
  std::vector<std::byte> payload = sqt_file::lzma_compress(raw);
  if (data.mueller) add_polarisation(*data.mueller, provenance, header, payload);
  return frame(header, payload, raw.size(), sqt_file::lzma, data.mueller ? kSqtVersion : kSqtOldest);
}

}  // namespace suite
