#include "transport/truth/truth.h"

#include <algorithm>
#include <limits>

#include "scene/leaves.h"

namespace suite {

const Registry<TruthRow>& truth_rows() {
  static const Registry<TruthRow> table("truth", "", [] {
    std::vector<TruthRow> rows;
    add_place_rows(rows);
    add_angle_rows(rows);
    add_matter_rows(rows);
    add_warmth_rows(rows);
    add_air_rows(rows);
    add_account_rows(rows);
    return rows;
  }());
  return table;
}

void TruthCollector::join(const double* others, double* own) const {
  for (size_t i = 0; i < slots(); ++i) own[i] += others[i];
}

namespace {

// With tags and instances comes what is one thing, where instances alone do not say so: a label is of a thing.
std::vector<std::string> completed(std::span<const std::string> given, const Scene& scene) {
  std::vector<std::string> names(given.begin(), given.end());
  const auto has = [&](const char* name) { return std::ranges::count(names, name) > 0; };
  if (has("tag") && has("instance") && !has("object") && tags_groups(scene)) names.emplace_back("object");
  return names;
}

}  // namespace

TruthPlan::TruthPlan(std::span<const std::string> given, const TruthContext& context) {
  if (!given.empty()) slots_ = 1;
  for (const std::string& name : completed(given, context.tracer.scene())) {
    collectors_.push_back(truth_rows().find(name).make(context));
    const std::vector<std::string> columns = collectors_.back()->columns();
    widths_.push_back(columns.size());
    columns_.insert(columns_.end(), columns.begin(), columns.end());
    slots_ += collectors_.back()->slots();
  }
}

void TruthPlan::add(const TruthSample& sample, double* slots) const {
  if (sample.first) ++slots[0];
  ++slots;
  for (const auto& collector : collectors_) {
    collector->add(sample, slots);
    slots += collector->slots();
  }
}

void TruthPlan::finish(std::span<const double> scrambles, uint32_t paths, double* values) const {
  std::fill_n(values, columns_.size(), std::numeric_limits<double>::quiet_NaN());
  if (!paths || !wanted()) return;
  std::vector<double> joined(scrambles.begin(), scrambles.begin() + static_cast<std::ptrdiff_t>(slots_));
  for (size_t from = slots_; from < scrambles.size(); from += slots_) {
    joined[0] += scrambles[from];
    size_t at = 1;
    for (const auto& collector : collectors_) {
      collector->join(scrambles.data() + from + at, joined.data() + at);
      at += collector->slots();
    }
  }
  const TruthCounts counts{static_cast<double>(paths), joined[0]};
  size_t at = 1;
  for (size_t i = 0; i < collectors_.size(); ++i) {
    collectors_[i]->finish(joined.data() + at, counts, values);
    at += collectors_[i]->slots();
    values += widths_[i];
  }
}

}  // namespace suite
