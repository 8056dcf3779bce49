#include "heat/step_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"

namespace suite {

namespace {

constexpr size_t kFewest = 9;  // moments of which four steps make one

// Moments of longer steps: every `factor`th, and the last.
std::vector<size_t> longer(size_t moments, size_t factor) {
  std::vector<size_t> out;
  for (size_t k = 0; k + 1 < moments; k += factor) out.push_back(k);
  if (out.size() > 1 && moments - 1 - out.back() < factor) out.pop_back();
  out.push_back(moments - 1);
  return out;
}

// Means of straight lines between all moments by the hats of fewer.
class Hats {
 public:
  Hats(const std::vector<double>& times, const std::vector<size_t>& kept) : first_(times.size()), late_(times.size()) {
    weights_.assign(kept.size(), 0);
    for (size_t k = 0, to = 0; k < times.size(); ++k) {
      while (to + 2 < kept.size() && k >= kept[to + 1]) ++to;
      first_[k] = to;
      late_[k] = (times[k] - times[kept[to]]) / (times[kept[to + 1]] - times[kept[to]]);
      const double own = (k > 0 ? times[k] - times[k - 1] : 0) + (k + 1 < times.size() ? times[k + 1] - times[k] : 0);
      span_.push_back(own);
      weights_[to] += own * (1 - late_[k]), weights_[to + 1] += own * late_[k];
    }
  }
  template <class Number>
  void put(const float* values, Number* means) const {
    std::vector<double> sums(weights_.size(), 0.0);
    for (size_t k = 0; k < first_.size(); ++k) {
      const double all = span_[k] * double{values[k]};
      sums[first_[k]] += (1 - late_[k]) * all, sums[first_[k] + 1] += late_[k] * all;
    }
    for (size_t k = 0; k < sums.size(); ++k) means[k] = static_cast<Number>(sums[k] / weights_[k]);
  }

 private:
  std::vector<size_t> first_;
  std::vector<double> late_, span_, weights_;
};

// Some elements, whose faces are numbered anew.
struct Sampled {
  std::vector<SurfaceGroup> groups;
  SurfaceNeighbours neighbours;
  std::vector<uint32_t> face;  // as they were
};

// Those of a group's elements that are picked.
void add_picked(const SurfaceGroup& all, const std::vector<size_t>& picked, Sampled& out) {
  SurfaceGroup& group = out.groups.emplace_back(all);
  const auto thin = [&](auto& values, const auto& from) {
    values.clear();
    for (const size_t i : picked)
      if (!from.empty()) values.push_back(from[i]);
  };
  thin(group.cosine_up, all.cosine_up);
  thin(group.front_emissivity, all.front_emissivity), thin(group.back_emissivity, all.back_emissivity);
  for (auto rows : {&SurfaceGroup::front_rows, &SurfaceGroup::back_rows}) {
    thin(group.*rows, all.*rows);
    for (uint32_t& row : group.*rows) {
      out.face.push_back(row);
      row = static_cast<uint32_t>(out.face.size() - 1);
    }
  }
}

// All that conduct to others along the surface.
Sampled bodies(const SolvedSurfaces& s, const std::vector<bool>& touches) {
  Sampled out;
  for (const SurfaceGroup& group : s.groups) {
    std::vector<size_t> picked;
    for (size_t i = 0; i < group.front_rows.size(); ++i)
      if (touches[group.front_rows[i]]) picked.push_back(i);
    if (!picked.empty()) add_picked(group, picked, out);
  }
  std::vector<uint32_t> now(touches.size(), 0);
  for (uint32_t f = 0; f < out.face.size(); ++f) now[out.face[f]] = f;
  for (const auto& c : s.neighbours.contacts) out.neighbours.contacts.push_back({now[c.a], now[c.b], c.ratio});
  for (const uint32_t face : out.face)
    out.neighbours.areas.push_back(face < s.neighbours.areas.size() ? s.neighbours.areas[face] : 1);
  return out;
}

class Levels {
 public:
  Levels(const SolvedSurfaces& solved, const Sampled& sample, double tolerance)
      : s_(solved), sample_(sample), moments_(solved.history.moments), matrix_(sample.face.size(), sample.face.size()) {
    options_.past.tolerance = options_.coupling.tolerance = tolerance;
    // Each receives what it was found to, as if from an outside of its own.
    const auto faces = static_cast<uint32_t>(sample.face.size());
    for (uint32_t f = 0; f < faces; ++f) {
      const ExchangeMatrix::Entry all{faces + f, 1};
      matrix_.add_row({&all, 1});
    }
  }

  // K, [face][kept moment].
  std::vector<double> solve(const std::vector<size_t>& kept) const {
    const Hats hats(s_.weather.moments, kept);
    SurfaceLoads loads;
    loads.begin = s_.loads.begin, loads.air = s_.loads.air;
    for (size_t k = 0; k + 1 < kept.size(); ++k)
      loads.steps.push_back(s_.weather.moments[kept[k + 1]] - s_.weather.moments[kept[k]]);
    loads.absorbed = CompactRows(sample_.face.size(), kept.size());
    loads.outside.resize(sample_.face.size() * kept.size());
    std::vector<float> row(moments_), means(kept.size());
    for (size_t f = 0; f < sample_.face.size(); ++f) {
      s_.loads.absorbed.get(sample_.face[f], row);
      hats.put(row.data(), means.data());
      loads.absorbed.set(f, means);
      s_.history.received.get(sample_.face[f], row);
      hats.put(row.data(), &loads.outside[f * kept.size()]);
      if (!s_.loads.source.empty()) loads.source.push_back(s_.loads.source[sample_.face[f]]);
    }
    CoupledSurfaces surfaces(sample_.groups, matrix_, sample_.neighbours);
    surfaces.start(s_.history.kelvin_at(sample_.face.front(), 0));
    return surfaces.solve(loads, options_).kelvin.values();
  }

 private:
  const SolvedSurfaces& s_;
  const Sampled& sample_;
  size_t moments_;
  ExchangeMatrix matrix_;
  SurfaceOptions options_;
};

double square(double x) { return x * x; }

// Of one face through three lengths of steps, by moment of the whole: what the shortest lack. long_steps may be null.
void errors_of(const double* short_steps, const double* middle, const double* long_steps,
               const std::vector<size_t>& twice, const std::vector<size_t>& fourfold, size_t moments, float* out) {
  double first = 0, second = 0;
  std::array<double, kHeatParts> sum{}, count{};
  for (size_t k = 0; k < twice.size(); ++k) {
    const double off = square(middle[k] - short_steps[twice[k]]);
    const size_t part = std::min<size_t>(kHeatParts - 1, twice[k] * kHeatParts / moments);
    first += off / static_cast<double>(twice.size()), sum[part] += off, count[part] += 1;
  }
  for (size_t k = 0; long_steps && k < fourfold.size(); ++k) {
    const auto at = std::ranges::lower_bound(twice, fourfold[k]) - twice.begin();
    second += square(long_steps[k] - middle[at]) / static_cast<double>(fourfold.size());
  }
  const double gain = !long_steps ? std::sqrt(2.0)
                      : first > 0 ? std::clamp(std::sqrt(second / first), std::sqrt(2.0), 4.0)
                                  : 4;
  double before = std::sqrt(first);
  for (size_t p = 0; p < kHeatParts; ++p) {
    if (count[p] > 0) before = std::sqrt(sum[p] / count[p]);
    out[p] = static_cast<float>(before / (gain - 1));
  }
}

// Nothing where steps of that length find no temperatures, as of thin layers beside strong sources.
std::optional<std::vector<double>> found(const Levels& levels, const std::vector<size_t>& kept) {
  try {
    return levels.solve(kept);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<float> step_errors(const SolvedSurfaces& solved, const StepErrorOptions& options) {
  const size_t moments = solved.history.moments, faces = solved.history.kelvin.rows();
  SUITE_CHECK(moments >= kHeatParts && options.sample > 0);
  std::vector<float> out(faces * kHeatParts, 0.0f);
  if (moments < kFewest) return out;
  const std::vector<size_t> once = longer(moments, 1), twice = longer(moments, 2), fourfold = longer(moments, 4);
  const auto solve = [&](const Sampled& sample) {
    const Levels levels(solved, sample, options.tolerance);
    const std::vector<double> a = levels.solve(once);
    const auto b = found(levels, twice), c = found(levels, fourfold);
    for (size_t f = 0; f < sample.face.size(); ++f) {
      float* const to = &out[sample.face[f] * kHeatParts];
      if (!b)
        std::fill_n(to, kHeatParts, std::numeric_limits<float>::infinity());
      else
        errors_of(&a[f * once.size()], &(*b)[f * twice.size()], c ? &(*c)[f * fourfold.size()] : nullptr, twice,
                  fourfold, moments, to);
    }
  };
  std::vector<bool> touches(faces, false);
  for (const auto& c : solved.neighbours.contacts) touches[c.a] = touches[c.b] = true;
  if (!solved.neighbours.contacts.empty()) solve(bodies(solved, touches));
  for (const SurfaceGroup& group : solved.groups) {
    std::vector<size_t> alone, picked;
    for (size_t i = 0; i < group.front_rows.size(); ++i)
      if (!touches[group.front_rows[i]]) alone.push_back(i);
    if (group.layers.empty() || alone.empty()) continue;
    const size_t every = (alone.size() + options.sample - 1) / options.sample;
    for (size_t i = 0; i < alone.size(); i += every) picked.push_back(alone[i]);
    Sampled sample;
    add_picked(group, picked, sample);
    solve(sample);
    for (const auto* rows : {&group.front_rows, &group.back_rows})
      for (size_t i = 0; !rows->empty() && i < alone.size(); ++i)
        if (i % every != 0)
          std::copy_n(&out[(*rows)[alone[i - i % every]] * kHeatParts], kHeatParts,
                      &out[(*rows)[alone[i]] * kHeatParts]);
  }
  return out;
}

}  // namespace suite
