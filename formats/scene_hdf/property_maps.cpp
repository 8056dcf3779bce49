#include <algorithm>
#include <cmath>

#include "formats/scene_hdf/internal.h"

namespace suite {

namespace {
const std::string kTable = "/property_maps";
}

void write_table(h5::Writer& w, const Scene& s, PropertyMapTable) {
  const std::vector<PropertyMap>& maps = s.property_maps;
  std::vector<uint32_t> size, materials;
  std::vector<uint8_t> rule;
  std::vector<double> drape, wavelength;
  std::vector<Curve> family;
  size_t total = 0;
  for (const PropertyMap& m : maps) {
    size.insert(size.end(), {m.width, m.height, m.channels, static_cast<uint32_t>(m.materials.size()),
                             static_cast<uint32_t>(m.wavelength_um.size()), static_cast<uint32_t>(m.family.size())});
    rule.insert(rule.end(),
                {static_cast<uint8_t>(m.kind), static_cast<uint8_t>(m.projection), static_cast<uint8_t>(m.drape.extend),
                 static_cast<uint8_t>(m.filter), static_cast<uint8_t>(m.outside)});
    drape.insert(drape.end(), {m.drape.origin_x, m.drape.origin_y, m.drape.gsd_x, m.drape.gsd_y});
    materials.insert(materials.end(), m.materials.begin(), m.materials.end());
    wavelength.insert(wavelength.end(), m.wavelength_um.begin(), m.wavelength_um.end());
    family.insert(family.end(), m.family.begin(), m.family.end());
    total += m.values.size();
  }
  w.put_names(kTable + "/name", pick(maps, [](const PropertyMap& m) { return m.name; }));
  w.put_names(kTable + "/parameter", pick(maps, [](const PropertyMap& m) { return m.parameter; }));
  w.put(kTable + "/size", size, "1", 6);
  w.put(kTable + "/rule", rule, "1", 5);
  w.put(kTable + "/drape", drape, "m", 4);
  w.put(kTable + "/materials", materials, "1");
  w.put(kTable + "/wavelength", wavelength, "um");
  write_curves(w, kTable + "/family", family);
  std::vector<float> range;  // lowest and highest value
  for (const PropertyMap& m : maps) {
    float low = INFINITY, high = -INFINITY;  // gaps, NaN, change neither
    for (const float v : m.values) low = std::min(low, v), high = std::max(high, v);
    range.insert(range.end(), {low <= high ? low : 0, low <= high ? high : 0});
  }
  w.put(kTable + "/range", range, "SI", 2);
  auto values = w.column(kTable + "/values", h5::native<float>(), total, "SI");
  for (const PropertyMap& m : maps) values.append(std::span<const float>(m.values));
}

namespace {
// kind, projection, extend, filter, outside.
void take_rule(const h5::Reader& r, const uint8_t* q, PropertyMap& m) {
  if (q[0] > static_cast<uint8_t>(MapKind::opacity) || q[1] > static_cast<uint8_t>(Projection::uv) ||
      q[2] > static_cast<uint8_t>(Drape::Extend::none) || q[3] > static_cast<uint8_t>(PropertyMap::Filter::linear) ||
      q[4] > static_cast<uint8_t>(Outside::zero))
    r.fail("map '" + m.name + "' has an unknown rule");
  m.kind = static_cast<MapKind>(q[0]);
  m.projection = static_cast<Projection>(q[1]);
  m.drape.extend = static_cast<Drape::Extend>(q[2]);
  m.filter = static_cast<PropertyMap::Filter>(q[3]);
  m.outside = static_cast<Outside>(q[4]);
}
}  // namespace

void read_table(h5::Reader& r, Scene& s, Loading& loading, PropertyMapTable) {
  const std::vector<std::string> names = r.get_names(kTable + "/name");
  const auto n = static_cast<long long>(names.size());
  const std::vector<std::string> parameter = r.get_names(kTable + "/parameter", n);
  const auto size = r.get<uint32_t>(kTable + "/size", "1", 6, n);
  const auto rule = r.get<uint8_t>(kTable + "/rule", "1", 5, n);
  const auto drape = r.get<double>(kTable + "/drape", "m", 4, n);
  Stretch<uint32_t> materials(r, kTable + "/materials", "1");
  Stretch<double> wavelength(r, kTable + "/wavelength", "um");
  const auto range = r.get<float>(kTable + "/range", "SI", 2, n);
  std::vector<uint32_t>& number = loading.property_map;
  Stretch<float> values(r, kTable + "/values", "SI");
  const std::vector<Curve> family = read_curves(r, kTable + "/family");
  size_t curve = 0;
  for (size_t k = 0; k < names.size(); ++k) {
    PropertyMap m;
    m.name = names[k];
    m.parameter = parameter[k];
    const uint32_t* z = &size[6 * k];
    m.width = z[0], m.height = z[1], m.channels = z[2];
    m.drape = {drape[4 * k], drape[4 * k + 1], drape[4 * k + 2], drape[4 * k + 3]};
    take_rule(r, &rule[5 * k], m);
    // Three 32 bit numbers can overflow 64 bits only beyond this.
    if (uint64_t{z[0]} * z[1] > (uint64_t{1} << 40) || z[2] > (1u << 20)) r.fail("map '" + m.name + "' is too large");
    m.materials = materials.next(z[3]);
    m.wavelength_um = wavelength.next(z[4]);
    if (z[5] > family.size() - curve) r.fail("map '" + m.name + "' declares more curves than there are");
    m.family.assign(family.begin() + static_cast<std::ptrdiff_t>(curve),
                    family.begin() + static_cast<std::ptrdiff_t>(curve + z[5]));
    curve += z[5];
    const uint64_t pixels = uint64_t{z[0]} * z[1];
    const bool heat = m.kind == MapKind::temperature, cube = m.kind == MapKind::cube;
    LoadRow* row = heat ? &loading.row("temperatures") : cube ? &loading.row("cube channels") : nullptr;
    if (row) row->stored += 4 * pixels * m.channels;
    number.push_back(heat && !loading.glows(range[2 * k + 1]) ? kNone : static_cast<uint32_t>(s.property_maps.size()));
    if (number.back() == kNone) {
      values.skip(pixels * m.channels);
      continue;
    }
    if (cube && m.channels == m.wavelength_um.size()) {
      const auto [from, to] = loading.channels(m.wavelength_um);
      m.values = values.next_columns(pixels, m.channels, from, to - from);
      m.wavelength_um = {m.wavelength_um.begin() + static_cast<std::ptrdiff_t>(from),
                         m.wavelength_um.begin() + static_cast<std::ptrdiff_t>(to)};
      m.channels = static_cast<uint32_t>(to - from);
    } else {
      m.values = values.next(pixels * m.channels);
    }
    if (row) row->read += 4 * m.values.size();
    s.property_maps.push_back(std::move(m));
  }
  materials.finish(), wavelength.finish(), values.finish();
  if (curve != family.size()) r.fail("there are curves of no map");
}

}  // namespace suite
