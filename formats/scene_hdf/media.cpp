// Media and voxel grids of a prepared scene.
#include "formats/scene_hdf/internal.h"

namespace suite {

namespace {

constexpr size_t kCurves = 3;  // of every medium: absorption, scattering, index

void write_phases(h5::Writer& w, const std::vector<Medium>& media) {
  std::vector<uint32_t> number_of, curve_of, text_of;
  std::vector<std::string> number_name, curve_name, text_name, texts;
  std::vector<double> numbers;
  std::vector<Curve> curves;
  for (uint32_t m = 0; m < media.size(); ++m) {
    for (const auto& [name, value] : media[m].phase.numbers)
      number_of.push_back(m), number_name.push_back(name), numbers.push_back(value);
    for (const auto& [name, value] : media[m].phase.curves)
      curve_of.push_back(m), curve_name.push_back(name), curves.push_back(value);
    for (const auto& [name, value] : media[m].phase.texts)
      text_of.push_back(m), text_name.push_back(name), texts.push_back(value);
  }
  w.put("/volume_media/numbers/medium", number_of, "1");
  w.put_names("/volume_media/numbers/name", number_name);
  w.put("/volume_media/numbers/value", numbers, "SI");
  w.put("/volume_media/texts/medium", text_of, "1");
  w.put_names("/volume_media/texts/name", text_name);
  w.put_names("/volume_media/texts/value", texts);
  w.put("/volume_media/phase_curves/medium", curve_of, "1");
  w.put_names("/volume_media/phase_curves/name", curve_name);
  write_curves(w, "/volume_media/phase_curves", curves);
}

void read_phases(h5::Reader& r, std::vector<Medium>& media) {
  const auto rows = [&](const std::string& table) {
    const auto owner = r.get<uint32_t>(table + "/medium", "1");
    for (const uint32_t m : owner)
      if (m >= media.size()) r.fail("'" + table + "' names a medium that is not there");
    return owner;
  };
  const auto number_of = rows("/volume_media/numbers"), text_of = rows("/volume_media/texts"),
             curve_of = rows("/volume_media/phase_curves");
  const auto count = [](const auto& v) { return static_cast<long long>(v.size()); };
  const std::vector<std::string> number_name = r.get_names("/volume_media/numbers/name", count(number_of)),
                                 text_name = r.get_names("/volume_media/texts/name", count(text_of)),
                                 curve_name = r.get_names("/volume_media/phase_curves/name", count(curve_of)),
                                 texts = r.get_names("/volume_media/texts/value", count(text_of));
  const auto numbers = r.get<double>("/volume_media/numbers/value", "SI", 1, count(number_of));
  const std::vector<Curve> curves = read_curves(r, "/volume_media/phase_curves");
  if (curves.size() != curve_of.size()) r.fail("curves of phase functions are missing");
  for (size_t k = 0; k < number_of.size(); ++k) media[number_of[k]].phase.numbers[number_name[k]] = numbers[k];
  for (size_t k = 0; k < text_of.size(); ++k) media[text_of[k]].phase.texts[text_name[k]] = texts[k];
  for (size_t k = 0; k < curve_of.size(); ++k) media[curve_of[k]].phase.curves[curve_name[k]] = curves[k];
}

}  // namespace

void write_table(h5::Writer& w, const Scene& s, MediumTable) {
  w.put_names("/volume_media/id", pick(s.media, [](const Medium& m) { return m.id; }));
  w.put_names("/volume_media/description", pick(s.media, [](const Medium& m) { return m.description; }));
  w.put_names("/volume_media/phase", pick(s.media, [](const Medium& m) { return m.phase.model; }));
  w.put("/volume_media/temperature", pick(s.media, [](const Medium& m) { return m.temperature_k; }), "K");
  w.put("/volume_media/priority", pick(s.media, [](const Medium& m) { return double(m.priority); }), "1");
  std::vector<Curve> curves;
  for (const Medium& m : s.media) curves.insert(curves.end(), {m.absorption, m.scattering, m.index});
  write_curves(w, "/volume_media/curves", curves);
  write_phases(w, s.media);
  w.put("/volume_media/ambient", std::vector<uint32_t>{s.ambient}, "1");
  w.put("/materials/inside", pick(s.materials, [](const Material& m) { return m.inside; }), "1");
  w.put("/materials/outside", pick(s.materials, [](const Material& m) { return m.outside; }), "1");
}

void read_table(h5::Reader& r, Scene& s, Loading&, MediumTable) {
  const std::vector<std::string> ids = r.get_names("/volume_media/id");
  const auto n = static_cast<long long>(ids.size());
  const std::vector<std::string> description = r.get_names("/volume_media/description", n),
                                 phase = r.get_names("/volume_media/phase", n);
  const auto temperature = r.get<double>("/volume_media/temperature", "K", 1, n),
             priority = r.get<double>("/volume_media/priority", "1", 1, n);
  const std::vector<Curve> curves = read_curves(r, "/volume_media/curves");
  if (curves.size() != kCurves * ids.size()) r.fail("curves of media are missing");
  for (size_t k = 0; k < ids.size(); ++k) {
    if (!(std::abs(priority[k]) <= 1e6)) r.fail("medium '" + ids[k] + "' has an absurd priority");
    Medium m{ids[k], description[k],          curves[kCurves * k], curves[kCurves * k + 1],
             {},     curves[kCurves * k + 2], temperature[k],      static_cast<int>(priority[k])};
    m.phase.model = phase[k];
    s.media.push_back(std::move(m));
  }
  read_phases(r, s.media);
  s.ambient = r.get<uint32_t>("/volume_media/ambient", "1", 1, 1)[0];
  const auto materials = static_cast<long long>(s.materials.size());
  const auto inside = r.get<uint32_t>("/materials/inside", "1", 1, materials),
             outside = r.get<uint32_t>("/materials/outside", "1", 1, materials);
  for (size_t k = 0; k < s.materials.size(); ++k)
    s.materials[k].inside = inside[k], s.materials[k].outside = outside[k];
}

void write_table(h5::Writer& w, const Scene& s, GridTable) {
  std::vector<uint32_t> size, media;
  std::vector<double> frame;
  size_t cells = 0, kinds = 0, temperatures = 0;
  for (const VoxelGrid& g : s.grids) {
    size.insert(size.end(), {g.cells[0], g.cells[1], g.cells[2], static_cast<uint32_t>(g.media.size()), !g.kind.empty(),
                             !g.temperature.empty()});
    const auto t = numbers_of(g.to_local);
    frame.insert(frame.end(), t.begin(), t.end());
    media.insert(media.end(), g.media.begin(), g.media.end());
    cells += g.density.size(), kinds += g.kind.size(), temperatures += g.temperature.size();
  }
  w.put_names("/grids/name", pick(s.grids, [](const VoxelGrid& g) { return g.name; }));
  w.put("/grids/size", size, "1", 6);
  w.put("/grids/to_local", frame, "m", 12);
  w.put("/grids/media", media, "1");
  auto density = w.column("/grids/density", h5::native<float>(), cells, "1");
  auto kind = w.column("/grids/kind", h5::native<uint8_t>(), kinds, "1");
  auto temperature = w.column("/grids/temperature", h5::native<float>(), temperatures, "K");
  for (const VoxelGrid& g : s.grids) {
    density.append(std::span<const float>(g.density));
    kind.append(std::span<const uint8_t>(g.kind));
    temperature.append(std::span<const float>(g.temperature));
  }
}

void read_table(h5::Reader& r, Scene& s, Loading&, GridTable) {
  const std::vector<std::string> names = r.get_names("/grids/name");
  const auto n = static_cast<long long>(names.size());
  const auto size = r.get<uint32_t>("/grids/size", "1", 6, n);
  const auto frame = r.get<double>("/grids/to_local", "m", 12, n);
  Stretch<uint32_t> media(r, "/grids/media", "1");
  Stretch<float> density(r, "/grids/density", "1"), temperature(r, "/grids/temperature", "K");
  Stretch<uint8_t> kind(r, "/grids/kind", "1");
  for (size_t k = 0; k < names.size(); ++k) {
    VoxelGrid g;
    const uint32_t* z = &size[6 * k];
    g.name = names[k];
    g.cells = {z[0], z[1], z[2]};
    if (uint64_t{z[0]} * z[1] > (uint64_t{1} << 40) || z[2] > (1u << 20)) r.fail("grid '" + g.name + "' is too large");
    g.to_local = transform_of(&frame[12 * k]);
    g.media = media.next(z[3]);
    g.density = density.next(g.size());
    if (z[4]) g.kind = kind.next(g.size());
    if (z[5]) g.temperature = temperature.next(g.size());
    s.grids.push_back(std::move(g));
  }
  media.finish(), density.finish(), kind.finish(), temperature.finish();
}

}  // namespace suite
