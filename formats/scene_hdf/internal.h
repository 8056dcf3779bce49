// Names, numbers and helpers that reader and writer share.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "formats/hdf5/h5.h"
#include "formats/scene_hdf/needs.h"
#include "scene/tables.h"

namespace suite {

namespace h5 {
inline constexpr const char* kFormat = "suite.scene";
inline constexpr const char* kVersionText = "3";
inline constexpr int kConstantCurve = 255;  // in place of an Outside rule
}  // namespace h5

// One column of a table of structs.
template <class Row, class Get>
auto pick(const std::vector<Row>& rows, Get get) {
  std::vector<std::decay_t<decltype(get(rows.front()))>> out;
  out.reserve(rows.size());
  for (const Row& r : rows) out.push_back(get(r));
  return out;
}

// 3 x 4, row-major.
inline std::array<double, 12> numbers_of(const Affine3& t) {
  return {t.a[0], t.a[1], t.a[2], t.b.x, t.a[3], t.a[4], t.a[5], t.b.y, t.a[6], t.a[7], t.a[8], t.b.z};
}
inline Affine3 transform_of(const double* t) {
  return {{t[0], t[1], t[2], t[4], t[5], t[6], t[8], t[9], t[10]}, {t[3], t[7], t[11]}};
}

// Hands out consecutive stretches of one dataset; Error when it is shorter or longer than what the table declares.
template <class T>
class Stretch {
 public:
  Stretch(h5::Reader& r, const std::string& name, const char* units)
      : r_(r), name_(name), d_(r.open(name, h5::native<T>(), units, 1, -1)) {}
  // n values, in a vector with `pad` more values of 0.
  std::vector<T> next(uint64_t n, size_t pad = 0) {
    if (n > d_.count - at_) r_.fail("dataset '" + name_ + "' is shorter than its table says");
    std::vector<T> out(n + pad);
    r_.read(name_, d_, h5::native<T>(), out.data(), at_, n);
    at_ += n;
    return out;
  }
  void skip(uint64_t n) {
    if (n > d_.count - at_) r_.fail("dataset '" + name_ + "' is shorter than its table says");
    at_ += n;
  }
  // The next rows x stride values, of which [from, from + run) of every row is kept.
  std::vector<T> next_columns(uint64_t rows, uint64_t stride, uint64_t from, uint64_t run) {
    const size_t start = at_;
    skip(rows * stride);
    std::vector<T> out(rows * run);
    r_.read_strided(name_, d_, h5::native<T>(), out.data(), start + from, rows, stride, run);
    return out;
  }
  void finish() const {
    if (at_ != d_.count) r_.fail("dataset '" + name_ + "' is longer than its table says");
  }

 private:
  h5::Reader& r_;
  std::string name_;
  h5::Reader::Opened d_;
  size_t at_ = 0;
};

// What is wanted of the file, and the account of what was read. Parts that the needs leave out are stepped over.
struct Loading {
  SceneNeeds needs;
  LoadReport report;
  bool conducts = false;               // some temperature model asks for layers
  std::vector<uint32_t> property_map;  // of each stored property map, its number among those read; kNone = left out

  bool sees(double low_um, double high_um) const;  // some window overlaps; true without windows
  // Whether a blackbody at this temperature shows in some window.
  bool glows(double kelvin) const;
  // [from, to) of the channels that decide what the windows see; all without windows, none only for no channels.
  std::pair<size_t, size_t> channels(const std::vector<double>& wavelength_um) const;
  // The points within the windows and one on either side.
  Curve within(const Curve& curve) const;
  LoadRow& row(const char* feature);
};
// Which meshes need texture coordinates; materials, maps, bindings, placements and parts must be there.
std::vector<bool> meshes_with_uvs(const Scene& scene, Loading& loading);
// Drops what the windows do not see from what has been read: temperatures and points of curves.
void drop_unseen(Scene& scene, Loading& loading);

// Curves as four datasets below `table`.
void write_curves(h5::Writer& w, const std::string& table, const std::vector<Curve>& curves);
std::vector<Curve> read_curves(h5::Reader& r, const std::string& table);

// Tables whose descriptor (scene/tables.h) has no columns are stored in a way of their own.
#define SUITE_OWN_WAY(Table)                                  \
  void write_table(h5::Writer& w, const Scene& scene, Table); \
  void read_table(h5::Reader& r, Scene& scene, Loading& loading, Table)
SUITE_OWN_WAY(GroupTable);
SUITE_OWN_WAY(TagTable);
SUITE_OWN_WAY(TrackTable);
SUITE_OWN_WAY(ScheduleTable);
SUITE_OWN_WAY(MaterialTable);
SUITE_OWN_WAY(PropertyMapTable);
SUITE_OWN_WAY(MediumTable);  // and which of them is ambient, and those behind and in front of materials
SUITE_OWN_WAY(GridTable);
SUITE_OWN_WAY(TemperatureTable);
#undef SUITE_OWN_WAY
// What the materials are decides what is read of the meshes, so they are read after everything else.
void write_table(h5::Writer& w, const Scene& scene, MeshTable);
void read_meshes(h5::Reader& r, const std::string& path, Scene& scene, Loading& loading);

}  // namespace suite
