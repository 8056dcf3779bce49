// What fills space along a ray: the medium that holds there, the voxel grids on top of it and the layers of the air, as
// stretches of constant contents. Everything in double.
//
// In a periodic scene the grids repeat themselves with it: the walk goes from cell to cell of the scene, each of which
// holds what sticks out of the others, too. Grids that move stand where the ray's time finds them.
//
// Cells are constant, so optical depths along a ray are sums without an estimate in them, for all wavelengths at once:
// one number a medium (its density integrated over the way). How a ray goes through one grid: grid_walk.h.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "air/shells.h"
#include "optics/medium.h"
#include "scene/scene.h"
#include "spectral/state.h"
#include "trace/tracer.h"
#include "transport/media/grid_walk.h"

namespace suite {

class VolumeField {
 public:
  // Keeps a reference to the scene. Error: volumes that move in a periodic scene, or are more than 64 cells wide.
  VolumeField(const Scene& scene, const SpectralState& state, const std::optional<Periodic>& periodic = std::nullopt);

  size_t media() const { return scene_.media.size(); }
  bool has_grids() const { return !placed_.empty(); }

  std::span<const PlacedGrid> placed() const { return placed_; }
  const std::optional<Periodic>& periodic() const { return periodic_; }
  // Heights between which a periodic scene has grids, m.
  double bottom() const { return bottom_; }
  double top() const { return top_; }

  // Planck radiance (vacuum) of bin i at a voxel's temperature, kelvin in the range of the scene's voxels.
  // Interpolated between log-spaced temperatures, ln B linearly in 1/T; relative error below 1e-4.
  float blackbody(size_t bin, double kelvin) const;
  // What a medium emits over what it absorbs, n^2 B(T), at a voxel's temperature or, where that is 0, its own; 0 at
  // none.
  float source(const BakedMedium& m, double kelvin, size_t bin) const {
    if (kelvin > 0) return m.index_squared[bin] * blackbody(bin, kelvin);
    return m.blackbody.empty() ? 0 : m.blackbody[bin];
  }

 private:
  void repeat_at_sides(const PlacedGrid& p);
  const Scene& scene_;
  std::optional<Periodic> periodic_;
  double bottom_ = 0, top_ = 0;
  std::vector<PlacedGrid> placed_;
  std::vector<double> table_kelvin_;
  std::vector<float> table_log_;  // [kelvin][bin]
  size_t bins_;
};

// One medium's share in a stretch.
struct Constituent {
  uint32_t medium;
  double density;
  double kelvin;  // 0 = the medium's own temperature
  bool operator==(const Constituent& o) const { return medium == o.medium && kelvin == o.kelvin; }
};

inline constexpr double kEndlessWay =
    1e30;  // m, for an infinite way: finite when multiplied, opaque for any coefficient

// Walks a ray through the field, nearest stretch first.
class FieldWalk {
 public:
  // From origin along a unit direction to `length` (infinity allowed). background: medium without cells, or kNone.
  // time: s, of the ray. shells: layers of air; null = none. first_medium: that of layer 0 where layers are media.
  void start(const VolumeField& field, Vec3 origin, Dir direction, double length, uint32_t background, double time,
             const Shells* shells = nullptr, uint32_t first_medium = kNone);
  // The next stretch that holds anything; false at the end.
  bool next();
  // Nothing fills the way.
  bool empty() const { return background_ == kNone && zones_.empty() && met_ == 0 && piece_end_ >= length_; }
  // For what follows the last stretch: the medium of the only grid around, at that medium's own temperature, if there
  // is nothing else before the grid ends, no layer of the air either; else kNone.
  uint32_t lone_medium() const;
  // Where lone_medium() is not kNone: goes on in one stride, as far as the integral of density stays within `most`.
  // Returns the integral; next() gives the stretch where it would become more.
  double pass(double most);
  // Goes on to the end and adds the density integrated on the way to depth[medium].
  void add_depths(std::span<double> depth);
  uint32_t layer() const { return layer_; }  // of the air; kNone = outside
  double begin() const { return begin_; }
  double end() const { return end_; }
  const std::vector<Constituent>& contents() const { return contents_; }

 private:
  void add_grids(Vec3 origin, double begin, double end);
  void next_piece();
  void enter_zone();
  // Of the grids that the ray meets in the piece: the first met_; the others are kept for later rays.
  std::span<GridWalk> met() { return {grids_.data(), met_}; }
  std::vector<GridWalk> grids_;
  size_t met_ = 0;
  std::vector<Constituent> contents_;
  uint32_t background_ = kNone;
  double begin_ = 0, end_ = 0, length_ = 0;
  // The ray, and the piece of it that met() is for: all of it, or its way through one cell of a periodic scene.
  const VolumeField* field_ = nullptr;
  Vec3 origin_;
  Dir direction_;
  double time_ = 0, piece_end_ = 0;
  double grids_begin_ = 0, grids_end_ = 0;  // of the ray between the heights that have grids
  double cell_[2] = {};                     // of the periodic scene, whole numbers
  uint32_t cells_ = 0;
  // The ray's ways through layers of air, and which of them it is in.
  struct Zone {
    double end;      // m
    uint32_t layer;  // kNone = none
  };
  std::vector<Zone> zones_;
  size_t zone_ = 0;
  uint32_t first_medium_ = kNone;
  double zone_end_ = 0;
  uint32_t layer_ = kNone;
};

}  // namespace suite
