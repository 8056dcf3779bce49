#include "transport/media/field.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

namespace {
constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr size_t kTemperatures = 256;
constexpr uint32_t kMostCells = 100000;  // of a periodic scene; a ray through more runs level and sees no grids then
}  // namespace

VolumeField::VolumeField(const Scene& scene, const SpectralState& state, const std::optional<Periodic>& periodic)
    : scene_(scene), periodic_(periodic), bottom_(kForever), top_(-kForever), bins_(state.size()) {
  double coldest = kForever, hottest = 0;
  for (const Volume& v : scene.volumes) {
    const VoxelGrid& g = scene.grids[v.grid];
    Placed p{&g, v.to_world * g.to_local, nullptr, {}, {}, {}, false};
    if (v.track != kNone)
      p.track = scene.tracks[v.track].track.get();
    else
      p.to_index = p.place.inverse();
    for (int a = 0; a < 3; ++a) p.blocks[a] = (g.cells[a] + kBlock - 1) / kBlock;
    auto full = std::make_shared<std::vector<uint8_t>>(size_t{p.blocks[0]} * p.blocks[1] * p.blocks[2], uint8_t{0});
    size_t cell = 0;
    for (uint32_t k = 0; k < g.cells[2]; ++k)
      for (uint32_t j = 0; j < g.cells[1]; ++j)
        for (uint32_t i = 0; i < g.cells[0]; ++i, ++cell)
          if (g.density[cell] > 0)
            (*full)[(size_t{k / kBlock} * p.blocks[1] + j / kBlock) * p.blocks[0] + i / kBlock] = 1;
    p.block_full = std::move(full);
    for (const float t : g.temperature)
      if (t > 0) coldest = std::min(coldest, double{t}), hottest = std::max(hottest, double{t}), p.emits = true;
    if (periodic_)
      repeat_at_sides(p);
    else
      placed_.push_back(std::move(p));
  }
  if (!(hottest > 0)) return;
  hottest = std::max(hottest, coldest * 1.0001);
  for (size_t t = 0; t < kTemperatures; ++t) {
    const double kelvin = coldest * std::pow(hottest / coldest, static_cast<double>(t) / (kTemperatures - 1));
    table_kelvin_.push_back(kelvin);
    for (const Bin& b : state.bins) {
      const double mean = planck_band_radiance(b.low_um, b.high_um, kelvin) / (b.high_um - b.low_um);
      table_log_.push_back(static_cast<float>(std::log(std::max(mean, 1e-37))));  // below that floats hold nothing
    }
  }
}

// One copy for each cell that the grid reaches into, shifted into the first.
void VolumeField::repeat_at_sides(const Placed& p) {
  if (p.track) throw Error("a periodic scene cannot hold a volume that moves", "drop the motion, or the periodic cell");
  const Box3 box = transformed(
      Box3{{0, 0, 0}, {double(p.grid->cells[0]), double(p.grid->cells[1]), double(p.grid->cells[2])}}, p.place);
  bottom_ = std::min(bottom_, box.low.z), top_ = std::max(top_, box.high.z);
  const double size[2] = {periodic_->size.x, periodic_->size.y}, low[2] = {periodic_->low.x, periodic_->low.y};
  long first[2], last[2];
  for (int a = 0; a < 2; ++a) {
    const double from = (box.low[a] - low[a]) / size[a], to = (box.high[a] - low[a]) / size[a];
    if (!(to - from <= 64)) throw Error("a volume is more than 64 times as wide as the cell of the periodic scene");
    first[a] = static_cast<long>(std::floor(from));
    last[a] = std::max(first[a], static_cast<long>(std::ceil(to)) - 1);
  }
  for (long x = first[0]; x <= last[0]; ++x)
    for (long y = first[1]; y <= last[1]; ++y) {
      Placed copy = p;
      copy.place = translation({-static_cast<double>(x) * size[0], -static_cast<double>(y) * size[1], 0}) * p.place;
      copy.to_index = copy.place.inverse();
      placed_.push_back(std::move(copy));
    }
}

float VolumeField::blackbody(size_t bin, double kelvin) const {
  const double at = std::log(kelvin / table_kelvin_.front()) / std::log(table_kelvin_.back() / table_kelvin_.front()) *
                    (kTemperatures - 1);
  const size_t t = static_cast<size_t>(std::clamp(at, 0.0, kTemperatures - 2.0));
  const double low = 1 / table_kelvin_[t], high = 1 / table_kelvin_[t + 1];
  const double share = std::clamp((1 / kelvin - low) / (high - low), 0.0, 1.0);
  const float a = table_log_[t * bins_ + bin], b = table_log_[(t + 1) * bins_ + bin];
  return static_cast<float>(std::exp(a + share * (b - a)));
}

void FieldWalk::start(const VolumeField& field, Vec3 origin, Dir direction, double length, uint32_t background,
                      double time, std::span<const double> bounds) {
  bounds_ = bounds;
  layer_ = kNone, zone_end_ = kForever;
  cursors_.clear();
  background_ = background;
  begin_ = end_ = 0;
  length_ = length;
  field_ = &field;
  origin_ = origin, direction_ = direction;
  time_ = time;
  if (!bounds.empty())
    enter_zone(std::max(static_cast<size_t>(std::upper_bound(bounds.begin(), bounds.end(), origin.z) - bounds.begin()),
                        size_t{1}));
  if (!field.periodic()) {
    piece_end_ = length;
    add_cursors(origin, 0, length);
    return;
  }
  // Where the ray is between the heights that hold grids, and the scene's cell there.
  piece_end_ = cells_ = 0;
  grids_begin_ = 0, grids_end_ = field.placed().empty() ? 0 : length;
  const double below = field.bottom() - origin.z, above = field.top() - origin.z;
  if (direction.z == 0) {
    if (below > 0 || above < 0) grids_end_ = 0;
  } else {
    grids_begin_ = std::max(grids_begin_, std::min(below / direction.z, above / direction.z));
    grids_end_ = std::min(grids_end_, std::max(below / direction.z, above / direction.z));
  }
  if (!(grids_begin_ < grids_end_)) grids_begin_ = grids_end_ = length;
  if (grids_begin_ == kForever) return;
  const Vec3 at = origin + direction * grids_begin_;
  const Periodic& p = *field.periodic();
  cell_[0] = std::floor((at.x - p.low.x) / p.size.x);
  cell_[1] = std::floor((at.y - p.low.y) / p.size.y);
}

// The layer below bound `zone`, or what lies above the last one.
void FieldWalk::enter_zone(size_t zone) {
  zone_ = zone;
  const bool above = zone == bounds_.size();
  layer_ = above ? kNone : static_cast<uint32_t>(zone - 1);
  zone_end_ = kForever;
  if (direction_.z > 0 && !above) zone_end_ = (bounds_[zone] - origin_.z) / direction_.z;
  if (direction_.z < 0 && zone > 1) zone_end_ = (bounds_[zone - 1] - origin_.z) / direction_.z;
}

// The next piece of a ray through a periodic scene: what lies before and behind the grids, or the way through one cell.
void FieldWalk::next_piece() {
  cursors_.clear();
  const double begin = piece_end_;
  if (begin < grids_begin_) {
    piece_end_ = std::min(grids_begin_, length_);
    return;
  }
  if (begin >= grids_end_ || ++cells_ > kMostCells) {
    piece_end_ = length_;
    return;
  }
  const Periodic& p = *field_->periodic();
  const double size[2] = {p.size.x, p.size.y}, low[2] = {p.low.x, p.low.y};
  const Vec3 origin = origin_ - Vec3{cell_[0] * size[0], cell_[1] * size[1], 0};
  piece_end_ = grids_end_;
  int axis = -1;
  for (int a = 0; a < 2; ++a) {
    if (direction_[a] == 0) continue;
    const double t = (low[a] + (direction_[a] > 0 ? size[a] : 0) - origin[a]) / direction_[a];
    if (t < piece_end_) piece_end_ = t, axis = a;
  }
  piece_end_ = std::max(piece_end_, begin);
  add_cursors(origin, begin, piece_end_);
  if (axis >= 0) cell_[axis] += direction_[axis] > 0 ? 1 : -1;
}

void FieldWalk::add_cursors(Vec3 origin, double begin, double end) {
  for (const VolumeField::Placed& p : field_->placed()) {
    Cursor c;
    c.placed = &p;
    const Affine3 to_index = p.index_at(time_);
    c.origin = to_index.point(origin);
    c.direction = to_index.vector(direction_);
    if (clip(c, begin, end)) cursors_.push_back(c);
  }
}

// The part of the ray between begin and end inside the grid's box; false when there is none.
bool FieldWalk::clip(Cursor& c, double begin, double end) {
  c.enter = begin;
  c.leave = end;
  for (int a = 0; a < 3; ++a) {
    const double o = c.origin[a], d = c.direction[a], top = c.placed->grid->cells[static_cast<size_t>(a)];
    if (d == 0) {
      if (!(o > 0 && o < top)) return false;
      continue;
    }
    const double t0 = -o / d, t1 = (top - o) / d;
    c.enter = std::max(c.enter, std::min(t0, t1));
    c.leave = std::min(c.leave, std::max(t0, t1));
  }
  return c.enter < c.leave;
}

double FieldWalk::plane(const Cursor& c, int axis, int at) {
  return c.direction[axis] == 0 ? kForever : (at - c.origin[axis]) / c.direction[axis];
}

void FieldWalk::enter(Cursor& c) {
  for (int a = 0; a < 3; ++a) {
    const int top = static_cast<int>(c.placed->grid->cells[static_cast<size_t>(a)]) - 1;
    c.cell[a] = std::clamp(static_cast<int>(std::floor(c.origin[a] + c.direction[a] * c.enter)), 0, top);
  }
  c.inside = true;
  settle(c, c.enter);
}

void FieldWalk::settle(Cursor& c, double at) {
  const VoxelGrid& g = *c.placed->grid;
  constexpr int block = VolumeField::kBlock;
  const auto place = [](const int* cell, int size, uint32_t nx, uint32_t ny) {
    return (static_cast<size_t>(cell[2] / size) * ny + static_cast<size_t>(cell[1] / size)) * nx +
           static_cast<size_t>(cell[0] / size);
  };
  const bool full = (*c.placed->block_full)[place(c.cell, block, c.placed->blocks[0], c.placed->blocks[1])];
  c.until = kForever;
  c.axis = 0;
  for (int a = 0; a < 3; ++a) {
    c.low[a] = full ? c.cell[a] : c.cell[a] / block * block;
    c.high[a] = full ? c.cell[a] + 1 : std::min(c.low[a] + block, static_cast<int>(g.cells[static_cast<size_t>(a)]));
    const double t = plane(c, a, c.direction[a] > 0 ? c.high[a] : c.low[a]);
    if (t < c.until) c.until = t, c.axis = a;
  }
  c.until = std::min(std::max(c.until, at), c.leave);
  c.index = kNone;
  if (!full) return;
  const size_t cell = place(c.cell, 1, g.cells[0], g.cells[1]);
  if (g.density[cell] > 0) c.index = static_cast<uint32_t>(cell);
}

// Goes on through the nearest plane; on the other axes the cell follows the ray but never turns back, so that rounding
// cannot keep a ray in place.
void FieldWalk::advance(Cursor& c) {
  const int top = static_cast<int>(c.placed->grid->cells[static_cast<size_t>(c.axis)]);
  const double at = c.until;
  for (int a = 0; a < 3; ++a) {
    if (a == c.axis) {
      c.cell[a] = c.direction[a] > 0 ? c.high[a] : c.low[a] - 1;
    } else if (c.high[a] - c.low[a] > 1 && c.direction[a] != 0) {
      const int where = static_cast<int>(std::floor(c.origin[a] + c.direction[a] * at));
      c.cell[a] =
          c.direction[a] > 0 ? std::clamp(where, c.cell[a], c.high[a] - 1) : std::clamp(where, c.low[a], c.cell[a]);
    }
  }
  if (c.cell[c.axis] < 0 || c.cell[c.axis] >= top || at >= c.leave)
    c.enter = c.until = kForever;
  else
    settle(c, at);
}

bool FieldWalk::next() {
  for (;;) {
    begin_ = end_;
    if (!(begin_ < length_)) return false;
    while (begin_ >= piece_end_) next_piece();
    while (begin_ >= zone_end_) enter_zone(direction_.z > 0 ? zone_ + 1 : zone_ - 1);
    contents_.clear();
    if (background_ != kNone) contents_.push_back({background_, 1, 0});
    end_ = std::min(piece_end_, zone_end_);
    for (Cursor& c : cursors_) {
      if (c.enter == kForever) continue;
      if (begin_ < c.enter) {
        end_ = std::min(end_, c.enter);
        continue;
      }
      if (!c.inside) enter(c);
      while (c.until <= begin_ && c.enter != kForever) advance(c);
      if (c.enter == kForever) continue;
      end_ = std::min(end_, c.until);
      if (c.index == kNone) continue;
      const VoxelGrid& g = *c.placed->grid;
      contents_.push_back({g.media[g.kind.empty() ? 0 : g.kind[c.index]], g.density[c.index],
                           g.temperature.empty() ? 0 : g.temperature[c.index]});
    }
    if (!contents_.empty() || layer_ != kNone) return true;
  }
}

}  // namespace suite
