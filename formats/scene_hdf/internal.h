// Names, numbers and helpers that reader and writer share.
#pragma once
#include <string>
#include <vector>

#include "formats/hdf5/h5.h"
#include "formats/scene_hdf/needs.h"
#include "scene/scene.h"

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
  bool conducts = false;  // some temperature model asks for layers

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

void write_media(h5::Writer& w, const Scene& scene);
void read_media(h5::Reader& r, Scene& scene);
void write_tracks(h5::Writer& w, const Scene& scene);
void read_tracks(h5::Reader& r, Scene& scene, Loading& loading);

void write_property_maps(h5::Writer& w, const Scene& scene);
void read_property_maps(h5::Reader& r, Scene& scene, Loading& loading);
void write_temperatures(h5::Writer& w, const Scene& scene);
void read_temperatures(h5::Reader& r, Scene& scene, Loading& loading);

}  // namespace suite
