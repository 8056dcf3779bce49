#include "spectral/state.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace suite {

namespace {
// Of a step: overlaps and gaps that are roundings.
constexpr double kSliver = 1e-6;

void check_band(const std::string& name, double center, double width) {
  if (!(center > 0) || !std::isfinite(center))
    throw Error(strf("band '%s': centre %g um is not a wavelength", name.c_str(), center));
  if (!(width > 0) || !(width < 2 * center))
    throw Error(strf("band '%s': width %g um is not between 0 and twice the centre", name.c_str(), width));
}
}  // namespace

Band Band::gaussian(std::string name, double center, double fwhm) {
  check_band(name, center, fwhm);
  // exp(-4 ln2 (d/fwhm)^2) = 1e-4 at d = 1.8226 fwhm. 256 chords keep the curve within 2e-5 of the peak.
  const double half = fwhm * std::sqrt(std::log(1e4) / (4 * std::log(2.0)));
  std::vector<double> x, y;
  for (int i = -128; i <= 128; ++i) {
    const double d = half * i / 128.0;
    if (center + d <= 0) continue;
    x.push_back(center + d);
    y.push_back(std::exp(-4 * std::log(2.0) * (d / fwhm) * (d / fwhm)));
  }
  return {std::move(name), Curve(std::move(x), std::move(y), Outside::zero), center, fwhm};
}

Band Band::rectangular(std::string name, double center, double width) {
  check_band(name, center, width);
  return {std::move(name), Curve({center - width / 2, center + width / 2}, {1, 1}, Outside::zero), center, width};
}

Band Band::triangular(std::string name, double center, double fwhm) {
  check_band(name, center, fwhm);
  const double low = std::max(center - fwhm, 1e-6 * center);
  return {std::move(name), Curve({low, center, center + fwhm}, {0, 1, 0}, Outside::zero), center, fwhm};
}

Band Band::tabulated(std::string name, const Curve& response, const Where& where) {
  if (response.min() < 0)
    throw Error(where, "band '" + name + "': the response is negative", "responses are at least 0");
  if (!(response.max() > 0) || response.wavelength_um().size() < 2)
    throw Error(where, "band '" + name + "': the response is zero everywhere",
                "give at least two wavelengths and one positive value");
  // Cut leading and trailing zeros: the support, not the table, decides which curves must cover the band.
  const auto& x = response.wavelength_um();
  const auto& y = response.value();
  size_t first = 0, last = y.size() - 1;
  while (y[first + 1] == 0 && y[first] == 0) ++first;
  while (y[last - 1] == 0 && y[last] == 0) --last;
  const Curve cut(std::vector<double>(x.begin() + first, x.begin() + last + 1),
                  std::vector<double>(y.begin() + first, y.begin() + last + 1), Outside::zero, where);
  double area = 0, moment = 0;
  const auto& cx = cut.wavelength_um();
  const auto& cy = cut.value();
  for (size_t i = 1; i < cx.size(); ++i) {
    // Exact integrals of y and x y over a chord.
    const double dx = cx[i] - cx[i - 1];
    area += 0.5 * (cy[i] + cy[i - 1]) * dx;
    moment += dx / 6 * (cx[i - 1] * (2 * cy[i - 1] + cy[i]) + cx[i] * (cy[i - 1] + 2 * cy[i]));
  }
  const double half = 0.5 * cut.max();
  double low = cx.front(), high = cx.back();
  for (size_t i = 1; i < cx.size(); ++i)
    if (cy[i - 1] < half && cy[i] >= half) {
      low = cx[i - 1] + (half - cy[i - 1]) / (cy[i] - cy[i - 1]) * (cx[i] - cx[i - 1]);
      break;
    }
  for (size_t i = cx.size() - 1; i > 0; --i)
    if (cy[i] < half && cy[i - 1] >= half) {
      high = cx[i - 1] + (cy[i - 1] - half) / (cy[i - 1] - cy[i]) * (cx[i] - cx[i - 1]);
      break;
    }
  return {std::move(name), cut, moment / area, high - low};
}

std::vector<int> SpectralState::knot_of_bin() const {
  std::vector<int> nearest(bins.size(), 0);
  for (size_t b = 0; b < bins.size(); ++b)
    for (size_t k = 1; k < knots.size(); ++k)
      if (std::fabs(bins[knots[k]].center_um() - bins[b].center_um()) <
          std::fabs(bins[knots[nearest[b]]].center_um() - bins[b].center_um()))
        nearest[b] = static_cast<int>(k);
  return nearest;
}

std::vector<float> SpectralState::sample(const Curve& curve) const {
  std::vector<float> v(bins.size());
  for (size_t i = 0; i < bins.size(); ++i) v[i] = static_cast<float>(curve.mean(bins[i].low_um, bins[i].high_um));
  return v;
}

std::vector<double> SpectralState::key() const {
  std::vector<double> key{low_um, high_um, reference_um};
  for (const Bin& b : bins) key.insert(key.end(), {b.low_um, b.high_um, static_cast<double>(b.g), b.weight});
  for (const size_t k : knots) key.push_back(static_cast<double>(k));
  return key;
}

std::string SpectralState::text() const {
  return strf("%.4g-%.4g um, %zu bins, reference %.4g um", low_um, high_um, bins.size(), reference_um);
}

SpectralState make_state(std::span<const Band> bands, double step, double reference_um, size_t knot_count) {
  if (bands.empty()) throw Error("a spectral state needs at least one band");
  if (!(step > 0) || !std::isfinite(step)) throw Error(strf("the spectral step must be positive, found %g um", step));
  std::vector<std::pair<double, double>> spans;
  double weight = 0, moment = 0;
  for (const Band& b : bands) {
    spans.emplace_back(b.low_um(), b.high_um());
    const double area = b.response.integral(b.low_um(), b.high_um());
    weight += area;
    moment += area * b.center_um;
  }
  // Merge the supports into disjoint intervals (neighbours may miss each other by a rounding), then divide each evenly
  // into bins of at most a step: bands that stand side by side, each some steps wide, share no bin.
  std::sort(spans.begin(), spans.end());
  std::vector<std::pair<double, double>> merged;
  for (const auto& s : spans) {
    if (!merged.empty() && s.first <= merged.back().second + kSliver * step)
      merged.back().second = std::max(merged.back().second, s.second);
    else
      merged.push_back(s);
  }
  SpectralState state;
  state.low_um = merged.front().first;
  state.high_um = merged.back().second;
  double count = 0;
  for (const auto& m : merged) count += (m.second - m.first) / step + 2;
  if (count > 100000)
    throw Error(strf("a step of %g um needs about %.0f spectral bins, at most 100000 are carried", step, count),
                "use a larger step or more states");
  for (const auto& [low, high] : merged) {
    const auto n = static_cast<size_t>(std::max(1.0, std::ceil((high - low) / step - kSliver)));
    const auto edge = [&](size_t i) { return i == n ? high : low + (high - low) * static_cast<double>(i) / n; };
    for (size_t i = 0; i < n; ++i) state.bins.push_back({edge(i), edge(i + 1)});
  }
  state.reference_um = reference_um > 0 ? reference_um : moment / weight;
  place_knots(state, knot_count);
  return state;
}

void place_knots(SpectralState& state, size_t knot_count) {
  state.knots.clear();
  size_t reference = 0;
  for (size_t i = 0; i < state.bins.size(); ++i)
    if (std::fabs(state.bins[i].center_um() - state.reference_um) <
        std::fabs(state.bins[reference].center_um() - state.reference_um))
      reference = i;
  state.knots.push_back(reference);
  // Each further knot is the bin farthest in wavelength from all knots so far, so that every band has a knot near it:
  // no bin is farther from one than 1/k of the window (Gonzalez 1985: at most twice the best possible).
  std::vector<double> distance(state.bins.size(), std::numeric_limits<double>::infinity());
  const size_t wanted = std::min({knot_count, size_t{8}, state.bins.size()});
  while (state.knots.size() < wanted) {
    const double latest = state.bins[state.knots.back()].center_um();
    for (size_t i = 0; i < distance.size(); ++i)
      distance[i] = std::min(distance[i], std::fabs(state.bins[i].center_um() - latest));
    state.knots.push_back(static_cast<size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin()));
  }
}

SpectralState with_g_points(const SpectralState& state, std::span<const std::vector<double>> weights) {
  SUITE_CHECK(weights.size() == state.size());
  SpectralState split = state;
  split.bins.clear();
  std::vector<size_t> first;
  for (size_t i = 0; i < state.size(); ++i) {
    SUITE_CHECK(state.bins[i].weight == 1 && !weights[i].empty());
    first.push_back(split.bins.size());
    for (size_t g = 0; g < weights[i].size(); ++g)
      split.bins.push_back({state.bins[i].low_um, state.bins[i].high_um, static_cast<uint32_t>(g), weights[i][g]});
  }
  for (size_t& knot : split.knots) knot = first[knot];
  const size_t bands = state.shares.size() / std::max<size_t>(1, state.size());
  split.shares.clear();
  for (size_t b = 0; b < bands; ++b)
    for (size_t i = 0; i < state.size(); ++i)
      for (const double w : weights[i]) split.shares.push_back(w * state.shares[b * state.size() + i]);
  return split;
}

double band_mean(const Band& band, const Curve& curve) {
  if (curve.is_constant()) return curve.value()[0];
  std::vector<double> knots = band.response.wavelength_um();
  for (const double x : curve.wavelength_um())
    if (x > band.low_um() && x < band.high_um()) knots.push_back(x);
  std::sort(knots.begin(), knots.end());
  // Between knots both are linear: two Gauss points are exact, and never stand where a curve jumps to zero.
  double sum = 0;
  for (size_t i = 1; i < knots.size(); ++i) {
    const double half = 0.5 * (knots[i] - knots[i - 1]), middle = 0.5 * (knots[i] + knots[i - 1]);
    for (const double at : {middle - half / std::sqrt(3.0), middle + half / std::sqrt(3.0)})
      sum += half * band.response.at(at) * curve.at(at);
  }
  return sum / band.response.integral(band.low_um(), band.high_um());
}

BandProjection::BandProjection(const SpectralState& state, std::span<const Band> bands) {
  const size_t bins = state.size();
  if (!state.shares.empty() && state.shares.size() != bands.size() * bins)
    throw Error(strf("a state has %zu shares for %zu bands and %zu bins", state.shares.size(), bands.size(), bins));
  for (size_t b = 0; b < bands.size(); ++b) {
    size_t first = 0;
    std::vector<double> weights;
    if (state.shares.empty()) {
      weights = shares_of(state, bands[b], first);
    } else {
      const double* row = &state.shares[b * bins];
      while (first < bins && row[first] == 0) ++first;
      weights.assign(row + first, row + bins);
    }
    double sum = 0;
    for (const double w : weights) sum += w;
    if (!(sum > 0.999)) throw Error("band '" + bands[b].name + "' is not covered by the bins of its spectral state");
    while (weights.back() == 0) weights.pop_back();
    for (double& w : weights) w /= sum;
    add_row(first, std::move(weights));
  }
  identity_ = identity_ && rows_.size() == bins;
}

std::vector<double> BandProjection::shares_of(const SpectralState& state, const Band& band, size_t& first) const {
  std::vector<double> weights;
  const double total = band.response.integral(band.low_um(), band.high_um());
  for (size_t k = 0; k < state.bins.size(); ++k) {
    const Bin& bin = state.bins[k];
    // Bins and bands that touch may overlap by a rounding.
    const double sliver = kSliver * (bin.high_um - bin.low_um);
    const bool inside = bin.high_um > band.low_um() + sliver && bin.low_um < band.high_um() - sliver;
    if (!inside && weights.empty()) continue;
    if (weights.empty()) first = k;
    weights.push_back(inside ? bin.weight * band.response.integral(bin.low_um, bin.high_um) / total : 0);
  }
  return weights;
}

void BandProjection::add_row(size_t first, std::vector<double> weights) {
  identity_ = identity_ && weights.size() == 1 && first == rows_.size();
  rows_.push_back(
      {static_cast<uint32_t>(first), static_cast<uint32_t>(weights_.size()), static_cast<uint32_t>(weights.size())});
  weights_.insert(weights_.end(), weights.begin(), weights.end());
}

void BandProjection::add(std::span<const float> in, std::span<double> sums) const {
  if (identity_) {
    const size_t n = rows_.size();
    const float* __restrict const x = in.data();
    double* __restrict const y = sums.data();
    for (size_t b = 0; b < n; ++b) y[b] += static_cast<double>(x[b]);
    return;
  }
  const Row* const rows = rows_.data();
  const double* const weights = weights_.data();
  const float* const all = in.data();
  double* const y = sums.data();
  for (size_t b = 0, n = rows_.size(); b < n; ++b) {
    const Row row = rows[b];
    const double* w = weights + row.offset;
    const float* x = all + row.first;
    // Most bands have one or two bins, for which a loop costs more than what it does.
    double sum = w[0] * static_cast<double>(x[0]);
    if (row.count > 1) sum += w[1] * static_cast<double>(x[1]);
    for (uint32_t i = 2; i < row.count; ++i) sum += w[i] * static_cast<double>(x[i]);
    y[b] += sum;
  }
}

void BandProjection::apply(std::span<const double> in, std::span<double> out) const {
  for (size_t b = 0; b < rows_.size(); ++b) {
    double sum = 0;
    for (size_t i = 0; i < rows_[b].count; ++i) sum += weights_[rows_[b].offset + i] * in[rows_[b].first + i];
    out[b] = sum;
  }
}

double BandProjection::weight(size_t band, size_t bin) const {
  const Row& row = rows_[band];
  return bin >= row.first && bin < row.first + row.count ? weights_[row.offset + bin - row.first] : 0;
}

}  // namespace suite
