#include "optics/mixed_model.h"

#include <algorithm>

namespace suite {

namespace {
std::span<float> scratch(size_t n) {
  thread_local std::vector<float> memory;
  memory.resize(std::max(memory.size(), n));
  return {memory.data(), n};
}
void add_scaled(const float* value, float scale, const float* spectrum, std::span<float> sum) {
  if (spectrum)
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += scale * spectrum[i] * value[i];
  else
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += scale * value[i];
}
}  // namespace

void MixedModel::reset(std::span<const size_t> knots) {
  parts_.clear();
  products_.clear();
  knots_ = knots;
  std::fill_n(chance_sum_, kMaxKnots, 0.0);
}

void MixedModel::add(const ScatterModel& model, float share, std::span<const float> spectrum) {
  Part part{&model, share, spectrum.empty() ? nullptr : spectrum.data(), {}};
  float mean = 1;
  if (part.spectrum) {
    mean = 0;
    for (const float s : spectrum) mean += s;
    mean /= static_cast<float>(spectrum.size());
  }
  for (size_t k = 0; k < knots_.size(); ++k) {
    part.chance[k] = share * (part.spectrum ? 0.9f * spectrum[knots_[k]] + 0.1f * mean : 1);
    chance_sum_[k] += part.chance[k];
  }
  parts_.push_back(part);
}

void MixedModel::add(const MixedModel& other, size_t first, size_t end, std::span<const float> factor) {
  for (size_t p = first; p < end; ++p) {
    const Part& part = other.parts_[p];
    std::span<const float> spectrum = factor;
    if (part.spectrum) {
      std::vector<float>& product = products_.emplace_back(factor.begin(), factor.end());
      for (size_t i = 0; i < product.size(); ++i) product[i] *= part.spectrum[i];
      spectrum = product;
    }
    add(*part.model, part.share, spectrum);
  }
}

void MixedModel::eval(Dir out, Dir in, std::span<float> w) const {
  std::fill(w.begin(), w.end(), 0.0f);
  const std::span<float> one = scratch(w.size());
  for (const Part& p : parts_) {
    if (const auto factored = p.model->factored(out, in)) {
      add_scaled(factored->spectrum, p.share * factored->scale, p.spectrum, w);
      continue;
    }
    p.model->eval(out, in, one);
    add_scaled(one.data(), p.share, p.spectrum, w);
  }
}

void MixedModel::total(Dir out, std::span<float> W) const {
  std::fill(W.begin(), W.end(), 0.0f);
  const std::span<float> one = scratch(W.size());
  for (const Part& p : parts_) {
    p.model->total(out, one);
    add_scaled(one.data(), p.share, p.spectrum, W);
  }
}

std::optional<ScatterModel::Sample> MixedModel::sample(Dir out, Vec2 u, double lobe_u, int knot) const {
  const auto k = static_cast<size_t>(knot);
  double rest = lobe_u;
  for (size_t i = 0; i < parts_.size(); ++i) {
    const double mine = chance(parts_[i], k);
    if (rest >= mine && i + 1 < parts_.size()) {
      rest -= mine;
      continue;
    }
    if (!(mine > 0)) return std::nullopt;
    auto drawn = parts_[i].model->sample(out, u, std::clamp(rest / mine, 0.0, 0x1.fffffffffffffp-1), knot);
    if (drawn) drawn->lobe = drawn->lobe * static_cast<int>(parts_.size()) + static_cast<int>(i);
    return drawn;
  }
  return std::nullopt;
}

void MixedModel::pdf(Dir out, Dir in, std::span<float> p) const {
  float one[kMaxKnots];
  std::fill(p.begin(), p.end(), 0.0f);
  for (const Part& part : parts_) {
    part.model->pdf(out, in, {one, p.size()});
    for (size_t k = 0; k < p.size(); ++k) p[k] += static_cast<float>(chance(part, k)) * one[k];
  }
}

void MixedModel::delta_weight(Dir out, int lobe, int knot, std::span<float> weight) const {
  const auto n = static_cast<int>(parts_.size());
  const Part& part = parts_[static_cast<size_t>(lobe % n)];
  const std::span<float> one = scratch(weight.size());
  part.model->delta_weight(out, lobe / n, knot, one);
  std::fill(weight.begin(), weight.end(), 0.0f);
  add_scaled(one.data(), part.share, part.spectrum, weight);
}

void MixedModel::delta_probability(Dir out, int lobe, int knot, std::span<float> probability) const {
  const auto n = static_cast<int>(parts_.size());
  const Part& part = parts_[static_cast<size_t>(lobe % n)];
  part.model->delta_probability(out, lobe / n, knot, probability);
  for (size_t k = 0; k < probability.size(); ++k) probability[k] *= static_cast<float>(chance(part, k));
}

ScatterModel::Polarised MixedModel::mueller(Dir out, Dir in, std::span<Mueller> m) const {
  thread_local std::vector<Mueller> matrices;
  thread_local std::vector<float> w, all;
  matrices.resize(m.size()), w.resize(m.size()), all.assign(m.size(), 0);
  std::fill(m.begin(), m.end(), Mueller{});
  double unknown = 0, sum = 0;
  for (const Part& p : parts_) {
    p.model->eval(out, in, w);
    const Polarised of = p.model->mueller(out, in, matrices);
    for (size_t i = 0; i < m.size(); ++i) {
      const float mine = w[i] * p.share * (p.spectrum ? p.spectrum[i] : 1);
      m[i] = m[i] + matrices[of.grey ? 0 : i] * double{mine};
      all[i] += mine, sum += mine, unknown += of.unknown * mine;
    }
  }
  for (size_t i = 0; i < m.size(); ++i) m[i] = all[i] > 0 ? m[i] * (1 / double{all[i]}) : Mueller::depolariser();
  return {m.size() == 1, sum > 0 ? unknown / sum : 0};
}
ScatterModel::Polarised MixedModel::delta_mueller(Dir out, int lobe, int knot, std::span<Mueller> m) const {
  const auto n = static_cast<int>(parts_.size());
  return parts_[static_cast<size_t>(lobe % n)].model->delta_mueller(out, lobe / n, knot, m);
}

bool MixedModel::has_delta() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& p) { return p.model->has_delta(); });
}
bool MixedModel::opaque() const {
  return std::all_of(parts_.begin(), parts_.end(), [](const Part& p) { return p.model->opaque(); });
}
bool MixedModel::isotropic() const {
  return std::all_of(parts_.begin(), parts_.end(), [](const Part& p) { return p.model->isotropic(); });
}

}  // namespace suite
