#include "sqt/polar_profile.h"

#include <array>
#include <cmath>

#include "sqt/portable_math.h"

namespace suite::sqt {

namespace {

constexpr int kAzimuths = 32;  // of half a ring
constexpr float kDark = 0x1p-119f;

}  // namespace

double PolarProfile::below_at(size_t knot) {
  return std::bit_cast<float>(kFirst + (static_cast<uint32_t>(knot) << kShift)) - static_cast<double>(kFinest);
}

PolarProfile::PolarProfile(size_t channels, bool half, std::vector<LogScale> scales, const Ask& ask)
    : row_(padded_row(channels) + 8), scales_(std::move(scales)), numbers_(scales_.size() * kKnots * row_, 0.0f) {
  const int azimuths = half ? kAzimuths : 2 * kAzimuths;
  std::vector<Dir> ring;
  for (int k = 0; k < azimuths; ++k) ring.push_back(dir_from_angles(kPi / 2, kPi * (k + 0.5) / kAzimuths));
  std::vector<float> f(channels), sum(channels);
  for (size_t s = 0; s < scales_.size(); ++s)
    for (size_t i = 0; i < kKnots; ++i) {
      const double below = std::min(1.0, below_at(i)), r = std::sqrt(below * (2 - below));
      std::fill(sum.begin(), sum.end(), 0.0f);
      for (const Dir& d : ring) {
        ask(s, {r * d.x, r * d.y, 1 - below}, f);
        for (size_t c = 0; c < channels; ++c) sum[c] += f[c];
      }
      const float per_octave = static_cast<float>(1 << scales_[s].fraction_bits);
      for (size_t c = 0; c < channels; ++c) {
        const double mean = std::max(kDark, sum[c] / static_cast<float>(azimuths));
        numbers_[(s * kKnots + i) * row_ + c] =
            static_cast<float>(portable_log2(mean) - scales_[s].offset) * per_octave;
      }
    }
}

double PolarProfile::integral(size_t channel, const std::function<double(double)>& weight) const {
  // Gauss & Legendre's four points between two knots.
  constexpr std::array<double, 4> place{0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
  constexpr std::array<double, 4> share{0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
  double sum = 0;
  for (size_t s = 0; s < scales_.size(); ++s)
    for (size_t i = 0; i + 2 < kKnots; ++i) {
      const double below = below_at(i), width = below_at(i + 1) - below;
      for (size_t k = 0; k < place.size(); ++k) {
        const double w = weight(std::min(1.0, below + place[k] * width));
        if (w > 0) sum += share[k] * width * w * portable_exp2(log2(s, {i, static_cast<float>(place[k])}, channel));
      }
    }
  return 2 * kPi * sum;
}

void PolarProfile::set_integral(size_t channel, const std::function<double(double)>& weight, double wanted) {
  const double now = empty() ? 0 : integral(channel, weight);
  if (!(now > 0) || !(wanted > 0)) return;
  const double octaves = portable_log2(wanted / now);
  for (size_t s = 0; s < scales_.size(); ++s)
    for (size_t i = 0; i < kKnots; ++i)
      numbers_[(s * kKnots + i) * row_ + channel] +=
          static_cast<float>(octaves * static_cast<double>(1 << scales_[s].fraction_bits));
}

PolarProfile polar_profile(const AlignedLayout& layout, bool isotropic, const std::vector<LogScale>& scales,
                           const std::function<LeafPlace(size_t sheet, Dir d)>& find) {
  if (!layout.cosine_weighted || !isotropic || layout.theta.front() != 0) return {};
  return {layout.channels, layout.half_stored, scales, [&](size_t sheet, Dir d, std::span<float> f) {
            const LeafPlace at = find(sheet, d);
            for (size_t c = 0; c < f.size(); ++c) {
              const int16_t* p = at.numbers + c * at.step;
              f[c] =
                  at.numbers
                      ? portable_exp2(scales[sheet].value(static_cast<float>(p[0]) + at.dx * static_cast<float>(p[1]) +
                                                          at.dy * static_cast<float>(p[2])))
                      : 0;
            }
          }};
}

std::function<double(double)> polar_weight(const AlignedLayout& layout) {
  if (layout.frame == LobeFrame::direct) return [](double below) { return 1 - below; };
  return [](double below) {
    const double z = 1 - below;
    return 4 * z * std::max(0.0, 2 * z * z - 1);
  };
}

}  // namespace suite::sqt
