#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/files.h"
#include "base/params.h"
#include "formats/voxel/voxel.h"

namespace suite {

namespace {

constexpr double kMostCells = 2147483648.0;  // 2^31

template <class T>
std::vector<float> converted(const std::vector<std::byte>& bytes, size_t n) {
  std::vector<T> raw(n);
  std::memcpy(raw.data(), bytes.data(), n * sizeof(T));
  return std::vector<float>(raw.begin(), raw.end());
}

// Values of a raw file: little-endian, as this machine is, nothing before or after them.
std::vector<float> read_raw(const Params& file, size_t type, size_t n) {
  constexpr size_t sizes[] = {4, 8, 1, 2};
  const std::string path = file.as_path();
  try {
    if (const size_t there = file_size(path), wanted = n * sizes[type]; there != wanted)
      throw file.error(strf("'%s' has %zu bytes, the grid needs %zu", file.as_text().c_str(), there, wanted));
  } catch (const Error& e) {
    if (!e.where().file.empty() && e.where().file == file.file()) throw;
    throw file.error("file '" + file.as_text() + "' " + e.message(), e.hint());
  }
  const std::vector<std::byte> bytes = read_bytes(path, n * sizes[type]);
  if (type == 0) return converted<float>(bytes, n);
  if (type == 1) return converted<double>(bytes, n);
  return type == 2 ? converted<uint8_t>(bytes, n) : converted<uint16_t>(bytes, n);
}

// One field: a number for all cells, `values`, or a raw `file`; each value times `scale` plus `offset`.
std::vector<float> read_field(const Params& p, size_t n, std::vector<std::string>& files) {
  if (p.kind() == Params::Kind::scalar) return std::vector<float>(n, static_cast<float>(p.as_number()));
  std::vector<float> values;
  if (const auto list = p.find("values")) {
    const std::vector<double> all = list->as_numbers();
    if (all.size() != n) throw list->error(strf("%zu values, the grid has %zu cells", all.size(), n));
    values.assign(all.begin(), all.end());
  } else {
    const Params file = p.at("file");
    const size_t type = p.has("type") ? p.at("type").as_choice({"float32", "float64", "uint8", "uint16"}) : 0;
    values = read_raw(file, type, n);
    files.push_back(file.as_text());
  }
  const double scale = p.number("scale", 1), offset = p.number("offset", 0);
  if (scale != 1 || offset != 0)
    for (float& v : values) v = static_cast<float>(v * scale + offset);
  return values;
}

// Error naming the first cell whose value is outside [low, high].
void check_range(const Params& p, const std::vector<float>& values, double low, double high, const char* what) {
  for (size_t i = 0; i < values.size(); ++i)
    if (!(values[i] >= low && values[i] <= high))
      throw p.error(strf("cell %zu has a %s of %g", i, what, values[i]), strf("%g to %g", low, high));
}

std::vector<uint16_t> whole(const Params& p, const std::vector<float>& values, const char* what) {
  check_range(p, values, 0, 65535, what);
  for (size_t i = 0; i < values.size(); ++i)
    if (values[i] != std::floor(values[i]))
      throw p.error(strf("cell %zu has a %s of %g", i, what, values[i]), "whole numbers");
  return std::vector<uint16_t>(values.begin(), values.end());
}

}  // namespace

VoxelData read_voxels(const std::string& path) {
  const Params root = Params::parse_file(path);
  root.integer("voxels", 1, 1);
  VoxelData data;
  const Params cells = root.at("cells");
  double count = 1;
  const auto n = cells.as_vec3();
  for (size_t a = 0; a < 3; ++a) {
    if (!(n[a] >= 1 && n[a] <= 1e6 && n[a] == std::floor(n[a])))
      throw cells.error("cells are three whole numbers from 1 to 1000000");
    data.cells[a] = static_cast<uint32_t>(n[a]);
    count *= n[a];
  }
  if (count > kMostCells) throw cells.error(strf("%g cells", count), "at most 2^31");
  const Params cell = root.at("cell_m");
  const auto size = cell.kind() == Params::Kind::list
                        ? cell.as_vec3()
                        : std::array<double, 3>{cell.as_number(), cell.as_number(), cell.as_number()};
  for (const double s : size)
    if (!(s > 0 && s <= 1e9)) throw cell.error(strf("a cell of %g m", s), "above 0, at most 1e9 m");
  const auto origin = root.has("origin_m") ? root.at("origin_m").as_vec3() : std::array<double, 3>{};
  data.to_local = translation({origin[0], origin[1], origin[2]}) * scaling({size[0], size[1], size[2]});
  const Params fields = root.at("fields");
  // A number for all cells of a huge grid would be made in memory; only a file of that size may ask for it.
  for (const std::string& name : fields.keys())
    if (fields.at(name).kind() == Params::Kind::scalar && count > 1 << 27)
      throw fields.at(name).error("one number for so many cells", "use larger cells");
  const size_t total = data.size();
  if (const auto f = fields.find("density"))
    check_range(*f, data.density = read_field(*f, total, data.raw_files), 0, 3e38, "density");
  if (const auto f = fields.find("temperature_k"))
    check_range(*f, data.temperature = read_field(*f, total, data.raw_files), 0, 1e5, "temperature");
  if (const auto f = fields.find("medium")) data.medium = whole(*f, read_field(*f, total, data.raw_files), "medium");
  if (const auto f = fields.find("material"))
    data.material = whole(*f, read_field(*f, total, data.raw_files), "material");
  if (const auto f = fields.find("shares"))
    for (const Params& share : f->items()) {
      data.shares.push_back(read_field(share, total, data.raw_files));
      check_range(share, data.shares.back(), 0, 3e38, "share");
    }
  root.reject_unread();
  if (!data.shares.empty() && !data.medium.empty()) throw fields.error("'medium' and 'shares' cannot be combined");
  if (data.density.empty() && data.medium.empty() && data.material.empty() && data.shares.empty())
    throw fields.error("the grid holds nothing", "give 'density', 'medium', 'shares' or 'material'");
  return data;
}

}  // namespace suite
