#include "scheduler/products.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace suite {

namespace {

constexpr double kSameShape = 1e-6;

bool multiplies(SpectrumRole role) { return role == SpectrumRole::scatters || role == SpectrumRole::passes; }
bool shines(SpectrumRole role) { return role == SpectrumRole::light || role == SpectrumRole::glow; }

double mean_of(const std::vector<float>& v) {
  double sum = 0;
  for (const float x : v) sum += static_cast<double>(x);
  return sum / static_cast<double>(v.size());
}

// The largest difference of two spectra, each over its mean.
double unlikeness(const std::vector<float>& a, const std::vector<float>& b) {
  const double p = mean_of(a), q = mean_of(b);
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i)
    most = std::max(most, std::fabs(static_cast<double>(a[i]) / p - static_cast<double>(b[i]) / q));
  return most;
}

}  // namespace

ProductRecipe::ProductRecipe(const std::vector<SeenSpectra>& seen, const SpectralState& state, bool white_light,
                             const ProductDepth& depth)
    : depth_(depth) {
  keep(seen, state);
  choose_leaders(values(state));
  for (size_t i = 0; i < std::min(depth_.powers, leaders_.size()); ++i)
    if (role_[leaders_[i]] == SpectrumRole::scatters)
      for (const int exponent : {4, 8}) powers_.push_back({leaders_[i], exponent});
  list_products(white_light);
}

// Leaves out what has the shape of an earlier spectrum that does the same, factors that are constant, and the black.
void ProductRecipe::keep(const std::vector<SeenSpectra>& seen, const SpectralState& state) {
  seen_ = seen;
  std::vector<std::vector<float>> kept;
  const std::vector<float> one(state.size(), 1.0f);
  for (const SeenSpectra& s : seen_) {
    const std::vector<std::vector<float>> rows = s.over(state);
    for (size_t i = 0; i < rows.size(); ++i) {
      bool keeps = mean_of(rows[i]) > 0 && (shines(s.role) || unlikeness(rows[i], one) > kSameShape);
      for (size_t k = 0; k < kept.size() && keeps; ++k)
        keeps = role_[k] != s.role || unlikeness(rows[i], kept[k]) > kSameShape;
      kept_.push_back(keeps);
      if (!keeps) continue;
      kept.push_back(rows[i]);
      role_.push_back(s.role);
      absorbed_.push_back(s.unabsorbed != nullptr);
      name_.push_back(s.names[i]);
    }
  }
}

void ProductRecipe::choose_leaders(const std::vector<std::vector<float>>& spectra) {
  const std::vector<float> one(spectra.empty() ? 0 : spectra[0].size(), 1.0f);
  std::vector<double> distance(role_.size(), 0.0);  // from the nearest leader
  for (size_t i = 0; i < role_.size(); ++i)
    if (multiplies(role_[i])) distance[i] = unlikeness(spectra[i], one);
  while (leaders_.size() < depth_.pairs) {
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (farthest == distance.end() || *farthest <= kSameShape) return;
    leaders_.push_back(static_cast<uint32_t>(farthest - distance.begin()));
    for (size_t i = 0; i < role_.size(); ++i)
      if (distance[i] > 0) distance[i] = std::min(distance[i], unlikeness(spectra[i], spectra[leaders_.back()]));
    distance[leaders_.back()] = 0;
  }
}

void ProductRecipe::list_products(bool white_light) {
  constexpr uint32_t one = SpectralProducts::kOne;
  std::vector<uint32_t> lights;
  for (uint32_t i = 0; i < role_.size(); ++i)
    if (shines(role_[i])) lights.push_back(i);
  if (lights.empty() || white_light) lights.push_back(one);
  for (const uint32_t l : lights) {
    products_.push_back({l, {one, one, one}});
    if (l != one && absorbed_[l]) {
      list_through_gases(l);
      continue;
    }
    const bool glows = l != one && role_[l] == SpectrumRole::glow;
    for (uint32_t f = 0; f < role_.size(); ++f)
      if (!shines(role_[f]) && (glows || role_[f] != SpectrumRole::emitting)) products_.push_back({l, {f, one, one}});
    std::map<uint32_t, uint32_t> twice;  // the product of a leader with itself
    for (size_t i = 0; i < leaders_.size(); ++i)
      for (size_t j = i; j < leaders_.size(); ++j) {
        if (i == j) twice[leaders_[i]] = static_cast<uint32_t>(products_.size());
        products_.push_back({l, {leaders_[i], leaders_[j], one}});
        for (size_t k = j; k < std::min(depth_.triples, leaders_.size()); ++k)
          products_.push_back({l, {leaders_[i], leaders_[j], leaders_[k]}});
      }
    // Where light arrives after many reflections, that of two does as well.
    for (uint32_t p = 0; p < powers_.size(); ++p)
      products_.push_back({l, {static_cast<uint32_t>(role_.size()) + p, one, one}, twice.at(powers_[p].of)});
  }
}

void ProductRecipe::list_through_gases(uint32_t light) {
  constexpr uint32_t one = SpectralProducts::kOne;
  for (size_t i = 0; i < std::min(depth_.through_gases, leaders_.size()); ++i)
    products_.push_back({light, {leaders_[i], one, one}});
  if (role_[light] != SpectrumRole::glow) return;
  size_t emitting = 0;
  for (uint32_t f = 0; f < role_.size() && emitting < depth_.through_gases; ++f)
    if (role_[f] == SpectrumRole::emitting) products_.push_back({light, {f, one, one}}), ++emitting;
}

bool ProductRecipe::any_kept(size_t row, size_t rows) const {
  const auto begin = kept_.begin() + static_cast<long>(row);
  return std::any_of(begin, begin + static_cast<long>(rows), [](bool k) { return k; });
}

ProductRecipe::Rows ProductRecipe::values(const SpectralState& state) const {
  Rows all;
  size_t row = 0;
  for (const SeenSpectra& s : seen_) {
    if (any_kept(row, s.names.size())) {
      Rows rows = s.over(state);
      for (size_t i = 0; i < rows.size(); ++i)
        if (kept_[row + i]) all.push_back(std::move(rows[i]));
    }
    row += s.names.size();
  }
  for (const Power& p : powers_) {
    std::vector<float>& v = all.emplace_back(all[p.of]);
    for (float& x : v) x = std::pow(x, static_cast<float>(p.exponent));
  }
  return all;
}

// Of the kept spectra; empty when there are none of gases.
ProductRecipe::Rows ProductRecipe::unabsorbed(const SpectralState& state) const {
  if (std::none_of(seen_.begin(), seen_.end(), [](const SeenSpectra& s) { return s.unabsorbed != nullptr; })) return {};
  Rows all;
  size_t row = 0;
  for (const SeenSpectra& s : seen_) {
    Rows rows(s.names.size());
    if (s.unabsorbed && any_kept(row, rows.size())) rows = s.unabsorbed(state);
    for (size_t i = 0; i < rows.size(); ++i)
      if (kept_[row + i]) all.push_back(std::move(rows[i]));
    row += s.names.size();
  }
  return all;
}

SpectralProducts ProductRecipe::over(const SpectralState& state) const {
  return {values(state), products_, state.size(), unabsorbed(state)};
}

std::string ProductRecipe::name_of(size_t product) const {
  if (product >= products_.size()) return {};
  const SpectralProducts::Product& p = products_[product];
  const auto name = [&](uint32_t i) {
    return i < name_.size()
               ? name_[i]
               : name_[powers_[i - name_.size()].of] + strf(" %d times", powers_[i - name_.size()].exponent);
  };
  std::string text = p.light == SpectralProducts::kOne ? "white light" : name(p.light);
  for (size_t i = 0; i < p.factors.size() && p.factors[i] != SpectralProducts::kOne; ++i)
    text += (i ? " and on the " : " on the ") + name(p.factors[i]);
  return text;
}

}  // namespace suite
