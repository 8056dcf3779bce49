#include "formats/sqt/polarisation.h"

#include "base/error.h"
#include "formats/sqt/container.h"

namespace suite::sqt_file {

namespace {

constexpr size_t kMostAxis = 4096;  // angles, and wavelengths
constexpr size_t kMostElements = size_t{1} << 28;

Json json_of(const std::vector<double>& v) {
  Json a = Json::array();
  for (const double x : v) a.push(x);
  return a;
}

std::vector<double> axis_of(const Params& p, const char* key) {
  std::vector<double> v = p.at(key).as_numbers();
  if (v.empty() || v.size() > kMostAxis) throw p.at(key).error("1 to 4096 numbers expected");
  return v;
}

// Where the elements stand in the file: those of one element and wavelength together, along theta_h first.
size_t stored_at(const sqt::MuellerTable::Data& d, size_t node, size_t wavelength, size_t element) {
  return (element * d.wavelength_um.size() + wavelength) * d.grid.nodes() + node;
}

// f(index in the file, index in the table) in the order of the file.
void every_element(const sqt::MuellerTable::Data& d, const auto& f) {
  const size_t nodes = d.grid.nodes(), channels = d.wavelength_um.size();
  constexpr size_t kElements = sqt::MuellerTable::kElements;
  for (size_t e = 0; e < kElements; ++e)
    for (size_t w = 0; w < channels; ++w)
      for (size_t n = 0; n < nodes; ++n) f(stored_at(d, n, w, e), (n * channels + w) * kElements + e);
}

}  // namespace

Json mueller_axes(const sqt::MuellerTable& table) {
  const sqt::MuellerTable::Data& d = table.data();
  Json j = Json::object();
  j.set("theta_h", json_of(d.grid.theta_h));
  j.set("theta_d", json_of(d.grid.theta_d));
  j.set("phi_d", json_of(d.grid.phi_d));
  j.set("wavelength_um", json_of(d.wavelength_um));
  return j;
}

std::vector<std::byte> mueller_elements(const sqt::MuellerTable& table) {
  const sqt::MuellerTable::Data& d = table.data();
  // Differences along the file, low bytes ahead of high ones: what neighbours share packs well.
  std::vector<std::byte> raw(2 * d.elements.size());
  uint16_t before = 0;
  every_element(d, [&](size_t stored, size_t at) {
    const auto value = static_cast<uint16_t>(d.elements[at]);
    const auto step = static_cast<uint16_t>(value - before);
    raw[stored] = static_cast<std::byte>(step & 0xFF);
    raw[d.elements.size() + stored] = static_cast<std::byte>(step >> 8);
    before = value;
  });
  return lzma_compress(raw);
}

std::shared_ptr<const sqt::MuellerTable> mueller_of(const Params& p, std::span<const std::byte> elements) {
  sqt::MuellerTable::Data d;
  d.grid = {axis_of(p, "theta_h"), axis_of(p, "theta_d"), axis_of(p, "phi_d")};
  d.wavelength_um = axis_of(p, "wavelength_um");
  const size_t count = d.grid.nodes() * d.wavelength_um.size() * sqt::MuellerTable::kElements;
  if (count > kMostElements) throw p.error("more elements of matrices than this reader accepts");
  const std::vector<std::byte> raw = lzma_expand(elements, 2 * count);
  d.elements.resize(count);
  uint16_t before = 0;
  every_element(d, [&](size_t stored, size_t at) {
    const auto step =
        static_cast<uint16_t>(static_cast<unsigned>(raw[stored]) | static_cast<unsigned>(raw[count + stored]) << 8);
    before = static_cast<uint16_t>(before + step);
    d.elements[at] = static_cast<int16_t>(before);
  });
  return std::make_shared<const sqt::MuellerTable>(std::move(d));
}

}  // namespace suite::sqt_file
