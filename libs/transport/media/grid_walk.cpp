#include "transport/media/grid_walk.h"

#include <cmath>
#include <map>
#include <mutex>

namespace suite {

namespace {
constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr int kBlock = GridBlocks::kBlock;
constexpr size_t kCells = size_t{kBlock} * kBlock * kBlock;
}  // namespace

GridBlocks::GridBlocks(const VoxelGrid& g) {
  for (size_t a = 0; a < 3; ++a) count[a] = (g.cells[a] + kBlock - 1) / kBlock;
  low = {double(g.cells[0]), double(g.cells[1]), double(g.cells[2])};
  for (uint32_t z = 0; z < count[2]; ++z)
    for (uint32_t y = 0; y < count[1]; ++y)
      for (uint32_t x = 0; x < count[0]; ++x) add(g, {x * kBlock, y * kBlock, z * kBlock});
}

void GridBlocks::add(const VoxelGrid& g, const std::array<uint32_t, 3>& corner) {
  const auto place = [&](uint32_t i, uint32_t j, uint32_t k) { return (size_t{k} * g.cells[1] + j) * g.cells[0] + i; };
  const size_t first = place(corner[0], corner[1], corner[2]);
  const auto same = [&](size_t cell) {
    if (g.density[cell] != g.density[first]) return false;
    return !(g.density[cell] > 0) || ((g.kind.empty() || g.kind[cell] == g.kind[first]) &&
                                      (g.temperature.empty() || g.temperature[cell] == g.temperature[first]));
  };
  std::array<float, kCells> values{};
  bool alike = true;
  for (uint32_t k = corner[2]; k < std::min(corner[2] + kBlock, g.cells[2]); ++k)
    for (uint32_t j = corner[1]; j < std::min(corner[1] + kBlock, g.cells[1]); ++j)
      for (uint32_t i = corner[0]; i < std::min(corner[0] + kBlock, g.cells[0]); ++i) {
        const size_t cell = place(i, j, k);
        values[((k - corner[2]) * kBlock + j - corner[1]) * kBlock + i - corner[0]] = g.density[cell];
        alike = alike && same(cell);
      }
  if (!alike || g.density[first] > 0)
    for (size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], static_cast<double>(corner[a]));
      high[a] = std::max(high[a], static_cast<double>(std::min(corner[a] + kBlock, g.cells[a])));
    }
  kind.push_back(!alike ? static_cast<uint32_t>(densities.size() / kCells) : g.density[first] > 0 ? kAlike : kEmpty);
  if (!alike) densities.insert(densities.end(), values.begin(), values.end());
}

std::shared_ptr<const GridBlocks> GridBlocks::of(const VoxelGrid& grid) {
  static std::mutex mutex;
  static std::map<const VoxelGrid*, std::weak_ptr<const GridBlocks>> known;
  const std::lock_guard lock(mutex);
  std::erase_if(known, [](const auto& k) { return k.second.expired(); });
  auto& held = known[&grid];
  auto blocks = held.lock();
  if (!blocks) held = blocks = std::make_shared<const GridBlocks>(grid);
  return blocks;
}

bool GridWalk::start(const PlacedGrid& placed, Vec3 origin, Dir direction, double time, double begin, double end) {
  placed_ = &placed, blocks_ = placed.blocks.get();
  const auto to_index = [&](const Affine3& m) { origin_ = m.point(origin), direction_ = m.vector(direction); };
  if (placed.track)
    to_index(placed.index_at(time));
  else
    to_index(placed.to_index);
  ended_ = !clip(begin, end);
  if (!ended_) start_blocks();
  return !ended_;
}

// The part of the ray between begin and end inside the box of what the grid holds; false when there is none.
bool GridWalk::clip(double begin, double end) {
  begin_ = begin, leave_ = end;
  for (int a = 0; a < 3; ++a) {
    const double o = origin_[a], low = blocks_->low[static_cast<size_t>(a)],
                 high = blocks_->high[static_cast<size_t>(a)];
    const double inverse = 1 / direction_[a];
    // What is next to level never meets a plane.
    inverse_[a] = std::isfinite(inverse) ? inverse : 0;
    if (inverse_[a] == 0) {
      if (!(o > 0 && o >= low && o < high)) return false;
      continue;
    }
    const double t0 = (low - o) * inverse, t1 = (high - o) * inverse;
    begin_ = std::max(begin_, std::min(t0, t1));
    leave_ = std::min(leave_, std::max(t0, t1));
  }
  return begin_ < leave_;
}

void GridWalk::start_blocks() {
  const std::array<uint32_t, 3>& blocks = blocks_->count;
  size_t stride = 1, block_stride = 1;
  block_ = 0;
  for (int a = 0; a < 3; ++a) {
    const bool up = !(inverse_[a] < 0);
    const int last = static_cast<int>(blocks[static_cast<size_t>(a)]) - 1;
    const double here = std::max(0.0, origin_[a] + direction_[a] * begin_);
    const int block = std::min(static_cast<int>(static_cast<unsigned>(here) / kBlock), last);
    block_ += static_cast<size_t>(block) * block_stride;
    stride_[a] = up ? stride : size_t{0} - stride;
    block_stride_[a] = up ? block_stride : size_t{0} - block_stride;
    stride *= kBlock, block_stride *= blocks[static_cast<size_t>(a)];
    to_come_[a] = up ? last - block : block;
    width_[a] = up ? kBlock : -kBlock;
    far_[a] = (up ? block + 1 : block) * kBlock;
    plane_[a] = inverse_[a] == 0 ? kForever : first_plane(a, far_[a]);
    gap_[a] = std::fabs(inverse_[a]);
  }
  kind_ = blocks_->kind[block_];
  block_end_ = end_ = std::min(std::max(nearest(plane_), begin_), leave_);
  if (kind_ == GridBlocks::kEmpty) next_block();
  if (!ended_) enter(at_);
}

// To the next block that holds anything. Returns the axis of the plane that leads there.
int GridWalk::next_block() {
  for (;;) {
    const bool later = plane_[2] < plane_[1];
    const int a = std::min(plane_[1], plane_[2]) < plane_[0] ? 1 + later : 0;
    if (!(block_end_ < leave_) || to_come_[a]-- == 0) {
      ended_ = true;
      return a;
    }
    begin_ = end_;
    block_ += block_stride_[a];
    far_[a] += width_[a];
    plane_[a] = first_plane(a, far_[a]);
    end_ = block_end_ = std::min(std::max(nearest(plane_), begin_), leave_);
    kind_ = blocks_->kind[block_];
    if (kind_ != GridBlocks::kEmpty) return a;
  }
}

// The cell of the block where the ray is at begin_; a block alike is one cell.
void GridWalk::enter(Place& p) {
  if (kind_ == GridBlocks::kAlike) {
    values_ = &placed_->grid->density[corner()];
    p = {{kForever, kForever, kForever}, 0, 0};
    return;
  }
  p.cell = p.taken = 0;
  for (int a = 0; a < 3; ++a) {
    const bool up = width_[a] > 0;
    const int corner = static_cast<int>(far_[a]) - (up ? kBlock : 0);
    // Rounding may put the ray just outside of the block.
    const int c = std::clamp(static_cast<int>(origin_[a] + direction_[a] * begin_) - corner, 0, kBlock - 1);
    p.cell |= static_cast<size_t>(c) << (3 * a);
    p.taken |= static_cast<uint32_t>(up ? c : kBlock - 1 - c) << (8 * a);
    p.plane[a] = inverse_[a] == 0 ? kForever : first_plane(a, corner + c + up);
  }
  values_ = &blocks_->densities[kind_ * kCells];
  end_ = until(p, begin_);
}

// From cell p of the last block into the cell behind the plane between them; both blocks have cells that differ.
void GridWalk::cross(int axis, Place& p) {
  p.taken -= static_cast<uint32_t>(kBlock) << (8 * axis);
  p.cell -= stride_[axis] * kBlock;
  p.plane[axis] = first_plane(axis, far_[axis] - width_[axis] + (width_[axis] > 0 ? 1 : -1));
  values_ = &blocks_->densities[kind_ * kCells];
  end_ = until(p, begin_);
}

// Into the next block that holds anything.
void GridWalk::go_on(Place& p) {
  const bool from_cell = kind_ < GridBlocks::kAlike;
  const size_t here = block_;
  const int a = next_block();
  if (ended_) return;
  // Where rounding lets cells and blocks disagree about the plane, the cell is found afresh.
  const bool beside = block_ == here + block_stride_[a] && (p.taken >> (8 * a) & kBlock);
  if (from_cell && kind_ < GridBlocks::kAlike && beside)
    cross(a, p);
  else
    enter(p);
}

size_t GridWalk::corner() const {
  size_t low[3];
  for (int a = 0; a < 3; ++a) low[a] = static_cast<size_t>(far_[a] - std::max(0.0, width_[a]));
  const std::array<uint32_t, 3>& cells = placed_->grid->cells;
  return (low[2] * cells[1] + low[1]) * cells[0] + low[0];
}

size_t GridWalk::cell() const {
  const std::array<uint32_t, 3>& cells = placed_->grid->cells;
  constexpr size_t mask = kBlock - 1;
  return corner() + (at_.cell & mask) + cells[0] * ((at_.cell >> 3 & mask) + cells[1] * (at_.cell >> 6));
}

void GridWalk::advance() {
  if (end_ < block_end_) {
    step(at_);
    if (!(at_.taken & kLeft)) {
      begin_ = end_;
      end_ = until(at_, begin_);
      return;
    }
  }
  go_on(at_);
}

double GridWalk::pass(double most) {
  double mass = 0;
  while (!ended_) {
    // In local variables, which stay in registers.
    Place at = at_;
    const float* values = values_;
    double begin = begin_, end = end_;
    for (;;) {
      const double with = mass + double{values[at.cell]} * (end - begin);
      if (with > most) {
        at_ = at, begin_ = begin, end_ = end;
        return mass;
      }
      mass = with;
      if (!(end < block_end_)) break;
      step(at);
      if (at.taken & kLeft) break;
      begin = end;
      end = until(at, begin);
    }
    at_ = at, end_ = end;
    go_on(at_);
  }
  return mass;
}

void GridWalk::add_depths(std::span<double> depth) {
  if (placed_->plain()) {
    depth[placed_->medium(0)] += pass(kForever);
    return;
  }
  // Rounding may lead into a block beyond the end of the grid, where nothing is.
  for (; !ended_; advance())
    if (density() > 0) depth[placed_->medium(cell())] += density() * (end_ - begin_);
}

}  // namespace suite
