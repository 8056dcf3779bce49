#include "transport/media/field.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

namespace {
constexpr double kNoBorder = std::numeric_limits<double>::infinity();
constexpr size_t kTemperatures = 256;
constexpr uint32_t kMostCells = 100000;  // of a periodic scene; a ray through more runs level and sees no grids then
}  // namespace

VolumeField::VolumeField(const Scene& scene, const SpectralState& state, const std::optional<Periodic>& periodic)
    : scene_(scene), periodic_(periodic), bottom_(kNoBorder), top_(-kNoBorder), bins_(state.size()) {
  double coldest = kNoBorder, hottest = 0;
  for (const Volume& v : scene.volumes) {
    const VoxelGrid& g = scene.grids[v.grid];
    PlacedGrid p{&g, v.to_world * g.to_local};
    if (v.track != kNone)
      p.track = scene.tracks[v.track].track.get();
    else
      p.to_index = p.place.inverse();
    p.blocks = GridBlocks::of(g);
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
void VolumeField::repeat_at_sides(const PlacedGrid& p) {
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
      PlacedGrid copy = p;
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
                      double time, const Shells* shells, uint32_t first_medium) {
  met_ = 0;
  background_ = background;
  begin_ = end_ = 0;
  length_ = length;
  field_ = &field;
  origin_ = origin, direction_ = direction;
  time_ = time;
  zones_.clear();
  if (shells)
    shells->walk(origin, direction, length, [&](const Shells::Piece& piece) {
      if (zones_.empty() && piece.near > 0) zones_.push_back({piece.near, kNone});
      zones_.push_back({piece.far, static_cast<uint32_t>(piece.layer)});
    });
  zone_ = 0;
  first_medium_ = first_medium;
  enter_zone();
  if (!field.periodic()) {
    piece_end_ = length;
    add_grids(origin, 0, length);
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
  if (grids_begin_ == kNoBorder) return;
  const Vec3 at = origin + direction * grids_begin_;
  const Periodic& p = *field.periodic();
  cell_[0] = std::floor((at.x - p.low.x) / p.size.x);
  cell_[1] = std::floor((at.y - p.low.y) / p.size.y);
}

void FieldWalk::enter_zone() {
  const bool in_air = zone_ < zones_.size();
  layer_ = in_air ? zones_[zone_].layer : kNone;
  zone_end_ = in_air ? zones_[zone_].end : kNoBorder;
}

// The next piece of a ray through a periodic scene: what lies before and behind the grids, or the way through one cell.
void FieldWalk::next_piece() {
  met_ = 0;
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
  add_grids(origin, begin, piece_end_);
  if (axis >= 0) cell_[axis] += direction_[axis] > 0 ? 1 : -1;
}

void FieldWalk::add_grids(Vec3 origin, double begin, double end) {
  if (grids_.empty()) grids_.resize(1);
  for (const PlacedGrid& p : field_->placed()) {
    if (!grids_[met_].start(p, origin, direction_, time_, begin, end)) continue;
    if (++met_ == grids_.size()) grids_.emplace_back();
  }
}

bool FieldWalk::next() {
  for (;;) {
    begin_ = end_;
    if (!(begin_ < length_)) return false;
    while (begin_ >= piece_end_) next_piece();
    while (begin_ >= zone_end_) ++zone_, enter_zone();
    contents_.clear();
    if (background_ != kNone) contents_.push_back({background_, 1, 0});
    if (first_medium_ != kNone && layer_ != kNone) contents_.push_back({first_medium_ + layer_, 1, 0});
    end_ = std::min(piece_end_, zone_end_);
    for (GridWalk& g : met()) {
      while (!g.ended() && g.end() <= begin_) g.advance();
      if (g.ended()) continue;
      if (begin_ < g.begin()) {
        end_ = std::min(end_, g.begin());
        continue;
      }
      end_ = std::min(end_, g.end());
      if (g.density() > 0) contents_.push_back({g.placed().medium(g.cell()), g.density(), g.placed().kelvin(g.cell())});
    }
    if (!contents_.empty() || layer_ != kNone) return true;
  }
}

uint32_t FieldWalk::lone_medium() const {
  const bool lone = background_ == kNone && zones_.empty() && met_ == 1 && grids_[0].placed().plain();
  return lone ? grids_[0].placed().medium(0) : kNone;
}

double FieldWalk::pass(double most) {
  GridWalk& g = grids_[0];
  while (!g.ended() && g.end() <= end_) g.advance();
  const double mass = g.pass(most);
  end_ = std::max(end_, g.ended() ? g.end() : g.begin());
  return mass;
}

void FieldWalk::add_depths(std::span<double> depth) {
  if (!zones_.empty()) {
    while (next())
      for (const Constituent& c : contents_) depth[c.medium] += c.density * (std::min(end_, kEndlessWay) - begin_);
    return;
  }
  if (background_ != kNone) depth[background_] += std::min(length_, kEndlessWay);
  for (;;) {
    for (GridWalk& g : met()) g.add_depths(depth);
    if (piece_end_ >= length_) return;
    next_piece();
  }
}

}  // namespace suite
