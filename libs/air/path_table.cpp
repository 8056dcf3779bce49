#include "air/path_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "spectral/curve.h"

namespace suite {

namespace {

// Coordinates closer than this part of the larger one are the same: files carry five digits and more.
constexpr double kSame = 1e-6;
bool same(double a, double b) { return std::fabs(a - b) <= kSame * std::max(std::fabs(a), std::fabs(b)) + 1e-12; }

using Spectrum = std::vector<double> PathSpectra::*;
struct Quantity {
  Spectrum member;
  const char* name;
  double most;
};
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Rounded transmittances may exceed 1 in their last digit.
constexpr Quantity kQuantities[] = {{&PathSpectra::transmittance, "transmittance", 1 + 1e-4},
                                    {&PathSpectra::radiance, "path radiance", kInfinity},
                                    {&PathSpectra::two_way, "two-way transmittance", 1 + 1e-2},
                                    {&PathSpectra::irradiance, "irradiance", kInfinity}};

// So that opaque is a depth, too: 690.
double depth_of(double transmittance) { return -std::log(std::clamp(transmittance, 1e-300, 1.0)); }
// Below this depth the radiance of a path, of five digits, says nothing about its source.
constexpr double kClear = 1e-7;

std::string first_is(const PathRun& run) {
  const std::string where = to_text(run.where);
  return where.empty() ? where : "the other one: " + where;
}

}  // namespace

std::string PathTable::shown(size_t axis, double value) const {
  const PathAxis& a = axes_[axis];
  return strf("%g ", value * a.shown_per_unit) + (a.shown_unit.empty() ? a.unit : a.shown_unit);
}

std::string PathTable::place(std::span<const double> at) const {
  std::string text;
  for (size_t a = 0; a < axes_.size(); ++a) text += (a ? ", " : "") + axes_[a].name + " " + shown(a, at[a]);
  return text;
}

void PathTable::check(const PathRun& run) const {
  SUITE_CHECK_EQ(run.at.size(), axes_.size());
  for (const Quantity& q : kQuantities) {
    const std::vector<double>& values = run.spectra.*q.member;
    if (values.empty()) continue;
    if (values.size() != wavelength_um_.size())
      throw Error(run.where,
                  strf("%zu values of %s for %zu wavelengths", values.size(), q.name, wavelength_um_.size()));
    for (size_t i = 0; i < values.size(); ++i)
      if (!(values[i] >= 0 && values[i] <= q.most))
        throw Error(run.where, strf("the %s at %g um is %g at ", q.name, wavelength_um_[i], values[i]) + place(run.at),
                    q.most < 2 ? "0 to 1" : "a value that is not negative");
  }
}

size_t PathTable::node_of(const PathRun& run) const {
  size_t node = 0;
  for (size_t a = 0; a < axes_.size(); ++a) {
    const auto tick = std::find_if(ticks_[a].begin(), ticks_[a].end(), [&](double t) { return same(t, run.at[a]); });
    node = node * ticks_[a].size() + static_cast<size_t>(tick - ticks_[a].begin());
  }
  return node;
}

PathTable::PathTable(std::vector<PathAxis> axes, std::vector<double> wavelength_um, std::vector<PathRun> runs)
    : axes_(std::move(axes)), wavelength_um_(std::move(wavelength_um)), ticks_(axes_.size()) {
  if (runs.empty()) throw Error("a path table without a run");
  for (size_t i = 1; i < wavelength_um_.size(); ++i)
    if (!(wavelength_um_[i] > wavelength_um_[i - 1]))
      throw Error(runs[0].where, strf("wavelengths of a path table do not ascend at %g um", wavelength_um_[i]));
  for (const PathRun& run : runs) {
    check(run);
    for (const Quantity& q : kQuantities)
      if ((run.spectra.*q.member).empty() != (runs[0].spectra.*q.member).empty())
        throw Error(run.where, strf("of this run and the first of the table only one has %s", q.name),
                    first_is(runs[0]));
    for (size_t a = 0; a < axes_.size(); ++a) {
      if (!std::isfinite(run.at[a])) throw Error(run.where, "the " + axes_[a].name + " is not finite");
      auto& ticks = ticks_[a];
      if (std::none_of(ticks.begin(), ticks.end(), [&](double t) { return same(t, run.at[a]); }))
        ticks.insert(std::upper_bound(ticks.begin(), ticks.end(), run.at[a]), run.at[a]);
    }
  }
  const Where first = runs[0].where;
  size_t nodes = 1;
  for (const auto& ticks : ticks_) {
    nodes *= ticks.size();
    if (nodes > 16 * runs.size() + 4096) throw Error(runs[0].where, "the runs of a path table stand on no grid");
  }
  nodes_.resize(nodes);
  std::vector<bool> filled(nodes);
  for (PathRun& run : runs) {
    const size_t node = node_of(run);
    if (filled[node]) throw Error(run.where, "two runs at " + place(run.at), first_is(nodes_[node]));
    filled[node] = true;
    nodes_[node] = std::move(run);
  }
  if (const auto hole = std::find(filled.begin(), filled.end(), false); hole != filled.end()) {
    std::vector<double> missing(axes_.size());
    size_t left = static_cast<size_t>(hole - filled.begin());
    for (size_t a = axes_.size(); a-- > 0; left /= ticks_[a].size()) missing[a] = ticks_[a][left % ticks_[a].size()];
    throw Error(first, "a path table has no run at " + place(missing), "runs at every combination of the axes' values");
  }
  add_zero_ranges();
}

void PathTable::add_zero_ranges() {
  for (size_t a = 0; a < axes_.size(); ++a) {
    if (!axes_[a].from_zero) continue;
    if (!(ticks_[a].front() > 0))
      throw Error(nodes_[0].where, "a path table begins at a range of " + shown(a, ticks_[a].front()));
    size_t inner = 1;
    for (size_t b = a + 1; b < axes_.size(); ++b) inner *= ticks_[b].size();
    const size_t block = inner * ticks_[a].size();
    std::vector<PathRun> with;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      if (i % block == 0)
        for (size_t k = i; k < i + inner; ++k) {
          PathRun none = nodes_[k];
          none.at[a] = 0;
          std::fill(none.spectra.transmittance.begin(), none.spectra.transmittance.end(), 1.0);
          std::fill(none.spectra.radiance.begin(), none.spectra.radiance.end(), 0.0);
          // The Sun's way to the beginning of the path is not in the runs: no two-way path ends there.
          std::fill(none.spectra.two_way.begin(), none.spectra.two_way.end(), std::nan(""));
          with.push_back(std::move(none));
        }
      with.push_back(std::move(nodes_[i]));
    }
    nodes_ = std::move(with);
    ticks_[a].insert(ticks_[a].begin(), 0);
  }
}

void PathTable::at(std::span<const double> place, PathSpectra& path) const {
  SUITE_CHECK_EQ(place.size(), axes_.size());
  // The corners of the cell, and their weights.
  std::vector<std::pair<size_t, double>> corners = {{0, 1.0}};
  for (size_t a = 0; a < axes_.size(); ++a) {
    const std::vector<double>& t = ticks_[a];
    const double x = place[a];
    if (!(x >= t.front() || same(x, t.front())) || !(x <= t.back() || same(x, t.back())))
      throw Error("the path table does not reach to " + axes_[a].name + " " + shown(a, x),
                  strf("it covers %g to ", t.front() * axes_[a].shown_per_unit) + shown(a, t.back()));
    size_t i = static_cast<size_t>(std::upper_bound(t.begin(), t.end(), x) - t.begin());
    i = std::clamp<size_t>(i, 1, std::max<size_t>(1, t.size() - 1)) - 1;
    const double w = t.size() > 1 ? std::clamp((x - t[i]) / (t[i + 1] - t[i]), 0.0, 1.0) : 0;
    std::vector<std::pair<size_t, double>> next;
    for (const auto& [node, weight] : corners) {
      if (w < 1) next.emplace_back(node * t.size() + i, weight * (1 - w));
      if (w > 0) next.emplace_back(node * t.size() + i + 1, weight * w);
    }
    corners = std::move(next);
  }

  const PathSpectra& first = nodes_[0].spectra;
  const size_t n = wavelength_um_.size();
  for (const Quantity& q : kQuantities) (path.*q.member).assign((first.*q.member).empty() ? 0 : n, 0.0);
  for (size_t i = 0; i < n; ++i) {
    double depth = 0, source = 0, known = 0, radiance = 0, two_way = 0, irradiance = 0;
    for (const auto& [node, weight] : corners) {
      const PathSpectra& s = nodes_[node].spectra;
      if (!s.radiance.empty()) radiance += weight * s.radiance[i];
      if (!s.two_way.empty()) two_way += weight * (std::isnan(s.two_way[i]) ? std::nan("") : depth_of(s.two_way[i]));
      if (!s.irradiance.empty()) irradiance += weight * std::log(std::max(s.irradiance[i], 1e-300));
      if (s.transmittance.empty()) continue;
      const double d = depth_of(s.transmittance[i]);
      depth += weight * d;
      if (s.radiance.empty() || d < kClear) continue;
      source += weight * s.radiance[i] / -std::expm1(-d);
      known += weight;
    }
    if (!path.transmittance.empty()) path.transmittance[i] = depth > 600 ? 0 : std::exp(-depth);
    // Sources of the corners that have air; where none has any, the radiance itself.
    if (!path.radiance.empty())
      path.radiance[i] = path.transmittance.empty() || !(known > 0) ? radiance : source / known * -std::expm1(-depth);
    if (!path.two_way.empty()) {
      if (std::isnan(two_way)) {
        path.two_way.clear();
      } else {
        path.two_way[i] = two_way > 600 ? 0 : std::exp(-two_way);
      }
    }
    if (!path.irradiance.empty()) path.irradiance[i] = irradiance < -600 ? 0 : std::exp(irradiance);
  }
}

PathTable PathTable::averaged(std::span<const std::pair<double, double>> intervals) const {
  PathTable bands = *this;
  bands.wavelength_um_.clear();
  for (const auto& [low, high] : intervals) {
    if (!(low >= wavelength_um_.front() && high <= wavelength_um_.back()))
      throw Error(strf("the path table does not cover %g to %g um", low, high),
                  strf("it covers %g to %g um", wavelength_um_.front(), wavelength_um_.back()));
    bands.wavelength_um_.push_back(0.5 * (low + high));
  }
  for (PathRun& node : bands.nodes_)
    for (const Quantity& q : kQuantities) {
      std::vector<double>& values = node.spectra.*q.member;
      if (values.empty()) continue;
      const bool known = !std::isnan(values[0]);
      const Curve curve = known ? Curve(wavelength_um_, values, Outside::error) : Curve::constant(0);
      values.clear();
      for (const auto& [low, high] : intervals) values.push_back(known ? curve.mean(low, high) : std::nan(""));
    }
  return bands;
}

}  // namespace suite
