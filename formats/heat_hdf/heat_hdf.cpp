#include "formats/heat_hdf/heat_hdf.h"

#include <cmath>

#include "base/files.h"
#include "formats/hdf5/format_version.h"
#include "formats/hdf5/h5.h"
#include "formats/heat_hdf/cut_hdf.h"

namespace suite {

namespace {

constexpr const char *kFormat = "suite heat", *kVersion = "6";

// A number of 64 bits as two of 32, exactly.
std::vector<uint32_t> halves(uint64_t v) { return {static_cast<uint32_t>(v >> 32), static_cast<uint32_t>(v)}; }

void check_kind(h5::Reader& r) {
  if (r.text("format") != kFormat) r.fail("holds no temperatures of elements");
  h5::check_version(r, kVersion);
}

void check_finite(h5::Reader& r, const std::vector<float>& values, const char* name, float low, float high) {
  for (const float v : values)
    if (!(v >= low && v <= high))
      r.fail(strf("%s holds %g, %g to %g are read", name, double{v}, double{low}, double{high}));
}

}  // namespace

void write_heat(const std::string& path, const HeatResult& h, const Elements& elements, const HeatFaces& faces,
                const std::vector<std::string>& materials, const HeatCut& cut, const std::string& made_by) {
  AtomicFile file(path);
  h5::Writer w(file.temporary(), path, [](const std::string&) { return 1; });
  w.attribute("format", kFormat);
  w.attribute("version", kVersion);
  w.attribute("arguments", made_by);
  const double span[3] = {h.span.begin, h.span.end, h.periodic ? 1.0 : 0.0};
  w.attribute("begin_s_end_s_repeats", span);
  put_cut(w, cut);
  const double errors[4] = {h.past_error, h.sweep_error, static_cast<double>(h.sweeps), h.unfinished};
  w.attribute("past_error_K_sweep_error_K_sweeps_unfinished", errors);
  const auto& b = h.balance;
  const double balance[7] = {b.sunlight, b.infrared, b.emitted, b.to_air, b.source, b.behind, b.stored};
  w.attribute("balance_W_sunlight_infrared_emitted_to_air_source_behind_stored", balance);
  w.put("/fingerprint", halves(elements.fingerprint()), "1");
  std::vector<uint32_t> material;
  std::vector<double> centre, normal, area;
  for (size_t e = 0; e < elements.size(); ++e) {
    material.push_back(elements[e].material);
    area.push_back(elements[e].area);
    for (int k = 0; k < 3; ++k) centre.push_back(elements[e].centre[k]), normal.push_back(elements[e].normal[k]);
  }
  std::vector<uint32_t> element;
  std::vector<uint8_t> back;
  for (size_t f = 0; f < faces.size(); ++f) element.push_back(faces.element(f)), back.push_back(faces.is_back(f));
  w.put_names("/materials", materials);
  w.put("/elements/material", material, "1");
  w.put("/elements/area", area, "m2");
  w.put("/elements/centre", centre, "m", 3);
  w.put("/elements/normal", normal, "1", 3);
  w.put("/faces/element", element, "1");
  w.put("/faces/is_back", back, "1");
  w.put("/faces/emissivity", h.emissivity, "1");
  w.put("/faces/absorptance", h.absorptance, "1");
  w.put("/faces/sun_hours", h.sun_hours, "h");
  w.put("/faces/path_error", h.path_error, "K", kHeatParts);
  w.put("/faces/size_error", h.size_error, "K", kHeatParts);
  w.put("/faces/step_error", h.step_error, "K", kHeatParts);
  w.put("/faces/temperature", h.kelvin, "K", h.moments);
  w.put("/faces/absorbed_sunlight", h.absorbed, "W/m2", h.moments);
  if (!h.straight.empty()) w.put("/faces/straight_sunlight", h.straight, "W/m2", h.moments);
  w.put("/faces/received_infrared", h.received, "W/m2", h.moments);
  w.put("/air/temperature", h.air_kelvin, "K");
  w.close();
  file.commit();
}

HeatCut heat_cut(const std::string& path) {
  h5::Reader r(path, "find the temperatures again");
  check_kind(r);
  return take_cut(r);
}

HeatResult read_heat(const std::string& path, const Elements& elements, const HeatFaces& faces, bool fluxes) {
  h5::Reader r(path, "find the temperatures again");
  check_kind(r);
  if (r.get<uint32_t>("/fingerprint", "1", 1, 2) != halves(elements.fingerprint()))
    r.fail("is of another scene, or of one with other materials");
  HeatResult h;
  const std::vector<double> span = r.numbers("begin_s_end_s_repeats", 3);
  h.span = {span[0], span[1]}, h.periodic = span[2] != 0;
  if (!(h.span.begin < h.span.end)) r.fail("has a span of time that ends before it begins");
  const std::vector<double> errors = r.numbers("past_error_K_sweep_error_K_sweeps_unfinished", 4);
  h.past_error = errors[0], h.sweep_error = errors[1], h.sweeps = static_cast<int>(errors[2]);
  h.unfinished = errors[3];
  const std::vector<double> b = r.numbers("balance_W_sunlight_infrared_emitted_to_air_source_behind_stored", 7);
  h.balance = {b[0], b[1], b[2], b[3], b[4], b[5], b[6]};
  const auto n = static_cast<long long>(faces.size());
  h.air_kelvin = r.get<float>("/air/temperature", "K");
  h.moments = h.air_kelvin.size();
  if (h.moments < 2) r.fail("has fewer than two moments");
  h.step = (h.span.end - h.span.begin) / static_cast<double>(h.moments - 1);
  h.kelvin = r.get<float>("/faces/temperature", "K", h.moments, n);
  h.path_error = r.get<float>("/faces/path_error", "K", kHeatParts, n);
  h.size_error = r.get<float>("/faces/size_error", "K", kHeatParts, n);
  h.step_error = r.get<float>("/faces/step_error", "K", kHeatParts, n);
  h.emissivity = r.get<float>("/faces/emissivity", "1", 1, n);
  h.absorptance = r.get<float>("/faces/absorptance", "1", 1, n);
  h.sun_hours = r.get<float>("/faces/sun_hours", "h", 1, n);
  if (fluxes) {
    h.absorbed = r.get<float>("/faces/absorbed_sunlight", "W/m2", h.moments, n);
    h.received = r.get<float>("/faces/received_infrared", "W/m2", h.moments, n);
  }
  if (r.has("/faces/straight_sunlight")) h.straight = r.get<float>("/faces/straight_sunlight", "W/m2", h.moments, n);
  check_finite(r, h.straight, "/faces/straight_sunlight", -1e5f, 1e5f);
  check_finite(r, h.emissivity, "/faces/emissivity", 0, 1);
  check_finite(r, h.sun_hours, "/faces/sun_hours", -1e9f, 1e9f);
  check_finite(r, h.absorbed, "/faces/absorbed_sunlight", -1e9f, 1e9f);
  check_finite(r, h.received, "/faces/received_infrared", -1e9f, 1e9f);
  check_finite(r, h.kelvin, "/faces/temperature", 1, 1e4f);
  check_finite(r, h.air_kelvin, "/air/temperature", 1, 1e4f);
  check_finite(r, h.path_error, "/faces/path_error", 0, 1e4f);
  check_finite(r, h.size_error, "/faces/size_error", 0, 1e4f);
  check_finite(r, h.step_error, "/faces/step_error", 0, 1e4f);
  return h;
}

}  // namespace suite
