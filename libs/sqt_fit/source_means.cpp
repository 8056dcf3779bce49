#include "sqt_fit/source_means.h"

#include <algorithm>
#include <cmath>

#include "sqt/portable_math.h"
#include "sqt_fit/families.h"
#include "sqt_fit/source_totals.h"

namespace suite::sqt {

namespace {

using Sheet = AlignedSource::Impl::Sheet;

// Children of a node by their place, and which of them a view knows; all that are there when it knows none.
struct Family {
  size_t child[4] = {};
  unsigned there = 0;
  Family(const Sheet& sheet, size_t node) {
    const Lattice::Node& n = sheet.data.node(node);
    size_t next = static_cast<size_t>(n.first_child);
    for (uint32_t k = 0; k < 4; ++k)
      if (n.child_mask & (1u << k)) child[k] = next++, there |= 1u << k;
  }
  unsigned known(const Sheet& sheet, size_t view, size_t views) const {
    unsigned present = 0;
    for (uint32_t k = 0; k < 4; ++k)
      if ((there & (1u << k)) && sheet.valid[child[k] * views + view]) present |= 1u << k;
    return present ? present : there;
  }
};

// Average over the four children of rows [view][channel].
void average(const AlignedLayout& layout, const Sheet& sheet, size_t node, std::vector<float>& rows) {
  const size_t views = layout.views(), channels = layout.channels, width = layout.width();
  const Family family(sheet, node);
  for (size_t v = 0; v < views; ++v) {
    const unsigned present = family.known(sheet, v, views);
    for (size_t j = v * channels; j < (v + 1) * channels; ++j) {
      float f[4] = {};
      for (uint32_t k = 0; k < 4; ++k)
        if (present & (1u << k)) f[k] = rows[family.child[k] * width + j];
      complete_values(present, f);
      rows[node * width + j] = 0.25f * (f[0] + f[1] + f[2] + f[3]);
    }
  }
}

Center middle_of(CellId id) {
  const Dir d = center_of(id);
  return {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
}

}  // namespace

void find_means(const AlignedLayout& layout, Sheet& sheet) {
  const size_t width = layout.width();
  sheet.mean.resize(sheet.data.size() * width);
  for (size_t i = sheet.data.size(); i-- > 0;)
    if (sheet.data.node(i).first_child >= 0)
      average(layout, sheet, i, sheet.mean);
    else
      for (size_t j = 0; j < width; ++j) sheet.mean[i * width + j] = portable_exp2(sheet.data.value(i)[j]);
}

NodeLevels::NodeLevels(const AlignedLayout& layout)
    : value(padded_row(layout.views()), 0.0f), mean(padded_row(layout.views()), 0.0f) {}

void NodeLevels::look(const AlignedLayout& layout, const Sheet& sheet, size_t node) {
  const size_t channels = layout.channels;
  const float* f = &sheet.mean[node * layout.width()];
  for (size_t v = 0; v < layout.views(); ++v) {
    float level = 0, sum = 0;
    for (size_t c = v * channels; c < (v + 1) * channels; ++c) level += sheet.data.value(node)[c], sum += f[c];
    value[v] = level / static_cast<float>(channels);
    mean[v] = static_cast<float>(portable_log2(std::max(1e-36f, sum / static_cast<float>(channels))));
  }
}

bool needs_finer_steps(const AlignedLayout& asked, const AlignedTotals& totals, const std::vector<Sheet>& sheets) {
  constexpr double kShare = 0.01;
  constexpr int kOctaves = 2;
  AlignedLayout layout = asked;
  layout.quality = 1;
  const StepRule steps(layout, 0.25 * step_reference(totals, layout));
  NodeLevels levels(layout);
  for (const Sheet& sheet : sheets) {
    double whole = 0;
    for (int pass = 0; pass < 2; ++pass)  // the whole first
      for (size_t i = 0; i < sheet.data.size(); ++i) {
        const Lattice::Node& node = sheet.data.node(i);
        if (node.first_child < 0 || (pass == 0 && node.id.order() > Lattice::kRootOrder)) continue;
        levels.look(layout, sheet, i);
        double light = 0;
        for (size_t v = 0; v < layout.views(); ++v) light += portable_exp2(levels.mean[v]);
        light *= cell_solid_angle(node.id.order());
        if (pass == 0)
          whole += light;
        else if (light > kShare * whole &&
                 steps.finer(middle_of(node.id), node.id.order(), levels.value.data(), levels.mean.data()) >= kOctaves)
          return true;
      }
  }
  return false;
}

std::vector<float> reduced_values(const AlignedLayout& layout, const Sheet& sheet,
                                  const std::vector<uint8_t>& divided) {
  const size_t width = layout.width();
  std::vector<float> values(sheet.data.size() * width);
  for (size_t i = sheet.data.size(); i-- > 0;) {
    if (divided[i]) {
      average(layout, sheet, i, values);
      continue;
    }
    const std::span<const float> x = sheet.data.slope(i, 0), y = sheet.data.slope(i, 1);
    for (size_t j = 0; j < width; ++j)
      values[i * width + j] = static_cast<float>(
          portable_log2(std::max(1e-36f, sheet.mean[i * width + j] / (mean_exp2(x[j]) * mean_exp2(y[j])))));
  }
  return values;
}

}  // namespace suite::sqt
