// Differences of families from the plane of their parent; see aligned.h.
#include <algorithm>

#include "base/parallel.h"
#include "sqt/block_transform.h"
#include "sqt_fit/aligned_source.h"
#include "sqt_fit/families.h"

namespace suite::sqt {

// Differences of every divided node from the plane of the data.
void find_details(const AlignedLayout& layout, AlignedSource::Impl::Sheet& sheet) {
  const size_t width = layout.width();
  sheet.detail_index.assign(sheet.data.size(), -1);
  std::vector<size_t> divided;
  for (size_t i = 0; i < sheet.data.size(); ++i)
    if (sheet.data.node(i).first_child >= 0)
      sheet.detail_index[i] = static_cast<int32_t>(divided.size()), divided.push_back(i);
  sheet.details.resize(divided.size() * 3 * width);
  parallel_for(0, divided.size(), 64, [&](size_t begin, size_t end) {
    std::vector<float> predicted(4 * width);
    for (size_t n = begin; n < end; ++n) {
      for (uint32_t k = 0; k < 4; ++k) sheet.data.predict(divided[n], k, {&predicted[k * width], width});
      family_details(layout, sheet, divided[n], sheet.data.values(), predicted,
                     {&sheet.details[n * 3 * width], 3 * width});
    }
  });
}
void transform_details(const AlignedLayout& layout, AlignedSource::Impl::Sheet& sheet) {
  const size_t width = layout.width();
  const BlockTransform transform(layout);
  parallel_for(0, sheet.details.size() / width, 64, [&](size_t begin, size_t end) {
    std::vector<float> details(width);
    for (size_t n = begin; n < end; ++n) {
      const std::span<float> row{&sheet.details[n * width], width};
      std::copy(row.begin(), row.end(), details.begin());
      transform.forward(details, row);
    }
  });
}

void family_details(const AlignedLayout& layout, const AlignedSource::Impl::Sheet& sheet, size_t source,
                    std::span<const float> values, std::span<const float> predicted, std::span<float> details) {
  const size_t views = layout.views(), channels = layout.channels, width = layout.width();
  const Lattice::Node& family = sheet.data.node(source);
  std::vector<int> known(views, 0);
  for (size_t v = 0; v < views; ++v) {
    unsigned present = 0;
    size_t child[4] = {}, next = static_cast<size_t>(family.first_child);
    for (uint32_t k = 0; k < 4; ++k) {
      if (!(family.child_mask & (1u << k))) continue;
      child[k] = next++;
      if (sheet.valid[child[k] * views + v]) present |= 1u << k;
    }
    known[v] = present != 0;
    for (size_t c = 0; c < channels; ++c) {
      const size_t j = v * channels + c;
      float r[4] = {};
      for (uint32_t k = 0; k < 4; ++k)
        if (present & (1u << k)) r[k] = values[child[k] * width + j] - predicted[k * width + j];
      complete_differences(present, r);
      details[j] = 0.25f * (-r[0] + r[1] - r[2] + r[3]);
      details[width + j] = 0.25f * (-r[0] - r[1] + r[2] + r[3]);
      details[2 * width + j] = 0.25f * (r[0] - r[1] - r[2] + r[3]);
    }
  }
  // Views from which the cell lies below the horizon follow their nearest neighbour: nobody will look.
  fill_unknown(layout, known, details, 3);
}

void fill_unknown(const AlignedLayout& layout, std::span<const int> known, std::span<float> rows, size_t count) {
  const size_t np = layout.phi_count, nt = layout.theta.size(), channels = layout.channels, width = layout.width();
  for (size_t p = 0; p < np; ++p)
    for (size_t t = 0; t < nt; ++t) {
      if (known[t * np + p]) continue;
      size_t from = nt;
      for (size_t distance = 1; distance < nt && from == nt; ++distance) {
        if (t >= distance && known[(t - distance) * np + p])
          from = t - distance;
        else if (t + distance < nt && known[(t + distance) * np + p])
          from = t + distance;
      }
      for (size_t r = 0; r < count; ++r)
        for (size_t c = 0; c < channels; ++c)
          rows[r * width + (t * np + p) * channels + c] =
              from < nt ? rows[r * width + (from * np + p) * channels + c] : 0.0f;
    }
}

}  // namespace suite::sqt
