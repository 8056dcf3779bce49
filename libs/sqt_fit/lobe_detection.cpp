#include "sqt_fit/lobe_detection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "sqt_fit/aligned_fit.h"

namespace suite::sqt {

namespace {

constexpr double kUndecided = 2;  // frames that change up to this much more than the stillest may code best
constexpr double kMarked = 0.85;  // another frame must cost less than this much of what half vectors do
constexpr double kStill = 0.03;   // log2 units: what changes less has no lobe to follow
constexpr double kLargest = 6;    // log2 units
constexpr double kStep = 5 * kDegree;
constexpr double kNear = 1e-3;    // half vectors: heavy-tailed around the pole, 1 - z = kNear u / (1 + kNear - u)
constexpr uint32_t kPairs = 192;  // a view
constexpr size_t kTrialAzimuths = 32;

// Density per steradian of half vectors over 1 - z.
double near_pdf(double s) { return (1 + kNear) * kNear / ((s + kNear) * (s + kNear)) / (2 * kPi); }

// Mean over channels; none where there are no data.
std::optional<double> mean_value(const Function& function, Dir out, Dir in, std::vector<double>& f) {
  function.value(out, in, f);
  double mean = 0;
  for (const double v : f) mean += std::max(0.0, v) / static_cast<double>(f.size());
  for (const double v : f)
    if (!std::isfinite(v)) return std::nullopt;
  return mean;
}

struct Pair {
  Dir in;
  double weight;  // 1 / density
};

// An incident direction on the side of `out`: near the mirror direction, near the viewer, or anywhere.
std::optional<Pair> draw(Dir out, const std::array<double, 4>& u) {
  const Dir back{-out.x, -out.y, out.z};
  Dir in;
  if (u[0] < 1.0 / 3) {
    in = uniform_sphere({0.5 * u[2], u[3]});
  } else {
    const Dir folded = u[0] < 2.0 / 3 ? out : back;
    const double s = kNear * u[2] / (1 + kNear - u[2]), r = std::sqrt(s * (2 - s));
    const Dir h{r * std::cos(2 * kPi * u[3]), r * std::sin(2 * kPi * u[3]), 1 - s};
    in = h * (2 * dot(h, folded)) - folded;
  }
  if (!(in.z > 1e-3)) return std::nullopt;
  double density = 1 / (2 * kPi);
  for (const Dir folded : {out, back}) {
    const Dir h = normalized(in + folded);
    density += near_pdf(1 - h.z) / (4 * std::max(1e-9, std::fabs(dot(h, folded))));
  }
  return Pair{in, 3 / density};
}

std::vector<double> azimuths_of(const Function& function) {
  if (function.info().isotropic) return {0};
  return {0.2, 0.2 + kPi / 4, 0.2 + kPi / 2, 0.2 + 3 * kPi / 4};
}

}  // namespace

double change_with_view(const Function& function, LobeFrame frame) {
  const std::vector<double> azimuths = azimuths_of(function);
  const int sheets = function.info().domain == Domain::sphere ? 2 : 1;
  struct Sum {
    double change = 0, weight = 0;
  };
  std::vector<Sum> sums(16);
  parallel_for(0, sums.size(), 1, [&](size_t begin, size_t end) {
    std::vector<double> f(function.info().wavelength_um.size());
    for (size_t v = begin; v < end; ++v)
      for (const double phi : azimuths) {
        const Dir here = dir_from_angles(static_cast<double>(v) * kStep, phi),
                  there = dir_from_angles(static_cast<double>(v + 1) * kStep, phi);
        const SampleStream stream(17, v, 0);
        for (uint32_t n = 0; n < kPairs; ++n) {
          const auto pair = draw(here, stream.draw(n, 0));
          for (int s = 0; pair && s < sheets; ++s) {
            const Dir in{pair->in.x, pair->in.y, s ? -pair->in.z : pair->in.z};
            const LobeMap from(frame, here, s == 1), to(frame, there, s == 1);
            const Dir moved = to.incident(from.cell_direction(in));
            if (s ? !(moved.z < 0) : !(moved.z > 0)) continue;
            const auto a = mean_value(function, here, in, f), b = mean_value(function, there, moved, f);
            if (!a || !b || !(*a > 0)) continue;
            const double weight = pair->weight * *a * pair->in.z * (std::sin(static_cast<double>(v) * kStep) + 0.02);
            const double change = *b > 0 ? std::fabs(std::log2(*b / *a)) : kLargest;
            sums[v].change += weight * std::min(kLargest, change);
            sums[v].weight += weight;
          }
        }
      }
  });
  Sum all;
  for (const Sum& s : sums) all.change += s.change, all.weight += s.weight;
  return all.weight > 0 ? all.change / all.weight : 0;
}

namespace {

// Bytes of a coarse fit, brought to one error by l1 ~ bytes^(-3/4), as fits of one function at several qualities go.
double coding_cost(const Function& function, LobeFrame frame) {
  AlignedSource::Options options;
  options.frame = frame;
  options.base_order = 4;
  options.max_order = 7;
  options.detail = 1e-5;
  options.azimuths = 8;
  const AlignedFit fit = encode_aligned(AlignedSource(function, options), 0.15);
  const auto bundle = make_bundle(fit.data);
  constexpr uint32_t kViews = 128, kEach = 24;
  std::vector<double> f(function.info().wavelength_um.size()), g(f.size());
  double error = 0, sum = 0;
  for (uint32_t v = 0; v < kViews; ++v) {
    const SampleStream stream(19, v, 0);
    const auto u = stream.draw(0, 1);
    const Dir out = dir_from_angles(std::acos(1 - (1 - std::cos(80 * kDegree)) * u[0]), 2 * kPi * u[1]);
    for (uint32_t n = 0; n < kEach; ++n) {
      const auto pair = draw(out, stream.draw(n, 0));
      if (!pair || !mean_value(function, out, pair->in, f)) continue;
      bundle->value(out, pair->in, g);
      for (size_t c = 0; c < f.size(); ++c) {
        error += pair->weight * pair->in.z * std::fabs(g[c] - f[c]);
        sum += pair->weight * pair->in.z * std::max(0.0, f[c]);
      }
    }
  }
  return sum > 0 ? static_cast<double>(fit.sheets_bytes.size()) * std::pow(error / sum, 4.0 / 3) : 0;
}

}  // namespace

LobeFrame detect_frame(const Function& function) {
  constexpr LobeFrame frames[] = {LobeFrame::half, LobeFrame::retro, LobeFrame::direct};
  double change[3], least = kLargest;
  for (size_t k = 0; k < 3; ++k) {
    change[k] = change_with_view(function, frames[k]);
    least = std::min(least, change[k]);
  }
  if (change[0] < kStill) return LobeFrame::half;
  std::vector<size_t> candidates;
  for (size_t k = 0; k < 3; ++k)
    if (change[k] <= kUndecided * least) candidates.push_back(k);
  if (candidates.size() == 1) return frames[candidates[0]];
  double best = 0;
  LobeFrame found = LobeFrame::half;
  for (const size_t k : candidates) {
    const double cost = coding_cost(function, frames[k]) * (frames[k] == LobeFrame::half ? kMarked : 1);
    if (k == candidates[0] || cost < best) best = cost, found = frames[k];
  }
  return found;
}

size_t count_azimuths(const Function& function, LobeFrame frame, double allowed) {
  constexpr double kAngles[] = {20 * kDegree, 45 * kDegree, 70 * kDegree};
  const int sheets = function.info().domain == Domain::sphere ? 2 : 1;
  const double step = 2 * kPi / kTrialAzimuths;
  struct Sum {
    double bend = 0, weight = 0;
  };
  std::vector<Sum> sums(kTrialAzimuths);
  parallel_for(0, kTrialAzimuths, 1, [&](size_t begin, size_t end) {
    std::vector<double> f(function.info().wavelength_um.size());
    for (size_t j = begin; j < end; ++j)
      for (const double theta : kAngles) {
        const Dir middle = dir_from_angles(theta, step * static_cast<double>(j));
        const SampleStream stream(18, j, 0);
        for (uint32_t n = 0; n < kPairs / 2; ++n) {
          const auto pair = draw(middle, stream.draw(n, 0));
          for (int s = 0; pair && s < sheets; ++s) {
            const Dir in{pair->in.x, pair->in.y, s ? -pair->in.z : pair->in.z};
            const Dir point = LobeMap(frame, middle, s == 1).cell_direction(in);
            double level[3] = {}, power = 0;
            bool there = true;
            for (int k = -1; k <= 1 && there; ++k) {
              const Dir out = dir_from_angles(theta, step * (static_cast<double>(j) + k));
              const auto value = mean_value(function, out, k ? LobeMap(frame, out, s == 1).incident(point) : in, f);
              there = value && *value > 0;
              if (there) level[k + 1] = std::log2(*value);
              if (there && k == 0) power = *value;
            }
            if (!there) continue;
            const double weight = pair->weight * power * pair->in.z * std::sin(theta);
            sums[j].bend += weight * std::min(kLargest, std::fabs(level[0] - 2 * level[1] + level[2]));
            sums[j].weight += weight;
          }
        }
      }
  });
  Sum all;
  for (const Sum& s : sums) all.bend += s.bend, all.weight += s.weight;
  // Linear interpolation over a step of h trial steps errs by at most bend h^2 / 8.
  const double bend = all.weight > 0 ? all.bend / all.weight : 0;
  const double asked = std::ceil(0.5 * kTrialAzimuths * std::sqrt(bend / (8 * allowed)));
  // At least 16: totals are interpolated between the same azimuths, and the verbs agree to 1e-3 in between.
  return 2 * static_cast<size_t>(std::clamp(asked, 8.0, 16.0));
}

}  // namespace suite::sqt
