#include "sqt/aligned_tables.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "sqt/lattice.h"
#include "sqt/portable_math.h"

namespace suite::sqt {

namespace {

// Leaves are divided at least to this order for sampling, so that cosine and stretch vary little within one.
constexpr int kSampleOrder = 4;
// A cell within reach of the horizon keeps this much of its mass when cut away, so that neighbouring views can draw it.
constexpr float kHorizonFloor = 1e-3f;
constexpr size_t kStride = AlignedSheet::kStride;

// Divides coarse leaves, the planes go on: the first part takes the place of the leaf, the others follow at the end.
void refine(AlignedSheet& sheet, const Region& region, size_t width) {
  const size_t row = width * kStride, stored = sheet.leaves.size();
  for (size_t i = 0; i < stored; ++i) {
    const CellId id = sheet.leaves[i];
    const int extra = kSampleOrder - id.order();
    if (extra <= 0) continue;
    const std::vector<float> whole(sheet.plane.begin() + static_cast<ptrdiff_t>(i * row),
                                   sheet.plane.begin() + static_cast<ptrdiff_t>((i + 1) * row));
    const uint32_t side = 1u << extra;
    const float scale = 1 / static_cast<float>(side);
    bool first = true;
    for (uint32_t k = 0; k < side * side; ++k) {
      const CellId part = CellId::of(kSampleOrder, (id.index() << (2 * extra)) + k);
      if (!region.holds(part)) continue;  // across the symmetry plane or below the horizon
      const size_t n = first ? i : sheet.leaves.size();
      if (!first) sheet.leaves.push_back(part), sheet.plane.resize(sheet.leaves.size() * row);
      sheet.leaves[n] = part;
      first = false;
      const CellXY at = xy_of(part);
      const float dx = (static_cast<float>(at.x % side) + 0.5f) * scale - 0.5f,
                  dy = (static_cast<float>(at.y % side) + 0.5f) * scale - 0.5f;
      float* q = &sheet.plane[n * row];
      for (size_t j = 0; j < row; j += kStride) {
        q[j] = whole[j] + dx * whole[j + 1] + dy * whole[j + 2];
        q[j + 1] = whole[j + 1] * scale, q[j + 2] = whole[j + 2] * scale;
        q[j + 3] = portable_exp2(q[j]) * mean_exp2(q[j + 1]) * mean_exp2(q[j + 2]);
      }
    }
  }
}

// Integral of |cos| stretch (or 1) over a leaf for all views at once, kept above a floor near the horizon.
class LeafWeights {
 public:
  explicit LeafWeights(const AlignedLayout& layout) : layout_(layout) {
    for (const double theta : layout.theta)
      for (size_t j = 0; j < layout.phi_count; ++j) {
        Dir out = dir_from_angles(theta, 2 * kPi * static_cast<double>(j) / static_cast<double>(layout.phi_count));
        if (layout.frame == LobeFrame::retro) out.x = -out.x, out.y = -out.y;
        x_.push_back(static_cast<float>(out.x));
        y_.push_back(static_cast<float>(out.y));
        z_.push_back(static_cast<float>(out.z));
      }
  }
  // weight: one number per view.
  void of(CellId id, double copies, std::span<float> weight) const {
    const double area = cell_solid_angle(id.order());
    const bool reflects = layout_.frame == LobeFrame::half || layout_.frame == LobeFrame::retro;
    if (!layout_.cosine_weighted && !reflects) {
      std::fill(weight.begin(), weight.end(), static_cast<float>(area * copies));
      return;
    }
    // As far below the horizon as a point may be while a part of its leaf is above: the cosine changes by at most twice
    // the angle, and a leaf reaches about 0.8 of its width from its middle.
    const float reach = static_cast<float>(2 * std::sqrt(area));
    const int side = id.order() >= 6 ? 1 : 2;
    const float share = static_cast<float>(area * copies / (side * side));
    std::fill(weight.begin(), weight.end(), 0.0f);
    for (int k = 0; k < side * side; ++k) {
      const Dir d = direction_fast(point_in(id, {(k % side + 0.5) / side, (k / side + 0.5) / side}));
      const float dx = static_cast<float>(d.x), dy = static_cast<float>(d.y), dz = static_cast<float>(d.z);
      for (size_t v = 0; v < weight.size(); ++v) {
        const float along = dx * x_[v] + dy * y_[v] + dz * z_[v];
        const float stretch = reflects ? 4 * std::fabs(along) : 1;
        const float cosine = reflects ? 2 * (dz > 0 ? along : std::max(along, 0.0f)) * dz - z_[v] : dz;
        const float seen = layout_.upper_only ? cosine : std::fabs(cosine);
        const float counted = layout_.cosine_weighted ? (seen > kHorizonFloor ? seen : kHorizonFloor) : 1;
        weight[v] += layout_.upper_only && cosine < -reach ? 0 : share * stretch * counted;
      }
    }
  }

 private:
  const AlignedLayout& layout_;
  std::vector<float> x_, y_, z_;
};

}  // namespace

AlignedTables::AlignedTables(const AlignedLayout& layout, std::vector<AlignedSheet> stored) {
  const size_t width = layout.width();
  for (AlignedSheet& s : stored) {
    refine(s, {layout.upper_only, layout.half_stored}, width);
    sheets_.push_back({Tree(s.leaves), std::move(s.plane), {}, leaves_});
    leaves_ += s.leaves.size();
  }
  std::vector<double> sum(width, 0.0);
  weigh(layout, sum);
  accumulate(width, sum);
}

// Unnormalised masses into the planes, their sums per column.
void AlignedTables::weigh(const AlignedLayout& layout, std::vector<double>& sum) {
  const size_t width = layout.width(), channels = layout.channels;
  const LeafWeights weights(layout);
  constexpr size_t kBlock = 256;
  for (Sheet& s : sheets_) {
    const size_t blocks = (s.tree.size() + kBlock - 1) / kBlock;
    s.inverse_area.resize(s.tree.size());
    std::vector<double> partial(blocks * width, 0.0);
    parallel_for(0, blocks, 1, [&](size_t begin, size_t end) {
      std::vector<float> weight(layout.views()), spread(width);
      for (size_t i = begin * kBlock; i < std::min(s.tree.size(), end * kBlock); ++i) {
        const CellId id = s.tree.cell(i);
        const double copies = layout.half_stored && mirrored(id) != id ? 2 : 1;
        s.inverse_area[i] = static_cast<float>(1 / (cell_solid_angle(id.order()) * copies));
        weights.of(id, copies, weight);
        for (size_t v = 0; v < weight.size(); ++v)
          for (size_t c = 0; c < channels; ++c) spread[v * channels + c] = weight[v];
        float* plane = &s.plane[i * width * kStride];
        double* total = &partial[i / kBlock * width];
        for (size_t j = 0; j < width; ++j) total[j] += plane[j * kStride + 3] *= spread[j];
      }
    });
    for (size_t b = 0; b < blocks; ++b)
      for (size_t j = 0; j < width; ++j) sum[j] += partial[b * width + j];
  }
}

// Masses to integers that sum to 2^32, and probabilities to what those integers say.
void AlignedTables::accumulate(size_t width, std::span<const double> sum) {
  cumulative_.resize(width * leaves_);
  guide_.resize(width * (kGuide + 1));
  for (size_t j = 0; j < width; ++j) empty_.push_back(!(sum[j] > 0));
  constexpr size_t kColumns = 16;  // one line of cache of the planes' masses serves four of them
  parallel_for(0, (width + kColumns - 1) / kColumns, 1, [&](size_t begin, size_t end) {
    const size_t first = begin * kColumns, last = std::min(width, end * kColumns), n = last - first;
    std::vector<double> running(n, 0.0), scale(n);
    std::vector<uint32_t> before(n, 0);
    for (size_t j = 0; j < n; ++j) scale[j] = empty_[first + j] ? 0 : 0x1p32 / sum[first + j];
    for (Sheet& s : sheets_)
      for (size_t i = 0; i < s.tree.size(); ++i) {
        float* p = &s.plane[(i * width + first) * kStride];
        const bool final = s.first + i + 1 == leaves_;
        uint32_t* to = &cumulative_[first * leaves_ + s.first + i];
        for (size_t j = 0; j < n; ++j, p += kStride) {
          to[j * leaves_] = before[j];
          running[j] += p[3];
          const int64_t next =
              final ? int64_t{1} << 32 : std::min<int64_t>(0xFFFFFFFF, static_cast<int64_t>(running[j] * scale[j]));
          p[3] = empty_[first + j] ? 0 : static_cast<float>(next - before[j]) * 0x1p-32f;
          before[j] = static_cast<uint32_t>(next);
        }
      }
    for (size_t column = first; column < last; ++column) {
      const uint32_t* c = &cumulative_[column * leaves_];
      uint32_t* guide = &guide_[column * (kGuide + 1)];
      // Leaf i is the answer for targets from its sum to the next leaf's.
      size_t g = 0;
      for (size_t i = 0; i + 1 < leaves_; ++i)
        for (; g <= kGuide && (uint64_t{g} << kGuideShift) < c[i + 1]; ++g) guide[g] = static_cast<uint32_t>(i);
      for (; g <= kGuide; ++g) guide[g] = static_cast<uint32_t>(leaves_ - 1);
    }
  });
}

}  // namespace suite::sqt
