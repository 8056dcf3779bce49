#include "radiometry/volume_field.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

namespace {
constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr size_t kTemperatures = 256;
}  // namespace

VolumeField::VolumeField(const Scene& scene, const SpectralState& state) : scene_(scene), bins_(state.size()) {
  double coldest = kForever, hottest = 0;
  for (const Volume& v : scene.volumes) {
    const VoxelGrid& g = scene.grids[v.grid];
    Placed p{&g, (v.to_world * g.to_local).inverse(), {}, {}, false};
    for (int a = 0; a < 3; ++a) p.blocks[a] = (g.cells[a] + kBlock - 1) / kBlock;
    p.block_full.assign(size_t{p.blocks[0]} * p.blocks[1] * p.blocks[2], 0);
    size_t cell = 0;
    for (uint32_t k = 0; k < g.cells[2]; ++k)
      for (uint32_t j = 0; j < g.cells[1]; ++j)
        for (uint32_t i = 0; i < g.cells[0]; ++i, ++cell)
          if (g.density[cell] > 0)
            p.block_full[(size_t{k / kBlock} * p.blocks[1] + j / kBlock) * p.blocks[0] + i / kBlock] = 1;
    for (const float t : g.temperature)
      if (t > 0) coldest = std::min(coldest, double{t}), hottest = std::max(hottest, double{t}), p.emits = true;
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

float VolumeField::blackbody(size_t bin, double kelvin) const {
  const double at = std::log(kelvin / table_kelvin_.front()) / std::log(table_kelvin_.back() / table_kelvin_.front()) *
                    (kTemperatures - 1);
  const size_t t = static_cast<size_t>(std::clamp(at, 0.0, kTemperatures - 2.0));
  const double low = 1 / table_kelvin_[t], high = 1 / table_kelvin_[t + 1];
  const double share = std::clamp((1 / kelvin - low) / (high - low), 0.0, 1.0);
  const float a = table_log_[t * bins_ + bin], b = table_log_[(t + 1) * bins_ + bin];
  return static_cast<float>(std::exp(a + share * (b - a)));
}

void FieldWalk::start(const VolumeField& field, Vec3 origin, Dir direction, double length, uint32_t background) {
  cursors_.clear();
  background_ = background;
  begin_ = end_ = 0;
  length_ = length;
  for (const VolumeField::Placed& p : field.placed()) {
    Cursor c;
    c.placed = &p;
    c.origin = p.to_index.point(origin);
    c.direction = p.to_index.vector(direction);
    if (clip(c, length)) cursors_.push_back(c);
  }
}

// The part of the ray inside the grid's box; false when there is none.
bool FieldWalk::clip(Cursor& c, double length) {
  c.enter = 0;
  c.leave = length;
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
  const bool full = c.placed->block_full[place(c.cell, block, c.placed->blocks[0], c.placed->blocks[1])];
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
    contents_.clear();
    if (background_ != kNone) contents_.push_back({background_, 1, 0});
    end_ = length_;
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
    if (!contents_.empty()) return true;
  }
}

}  // namespace suite
