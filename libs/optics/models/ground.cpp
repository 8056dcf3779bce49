#include "optics/models/ground.h"

namespace suite {

namespace {

// Points of 4-point Gauss-Legendre on [0, 1].
constexpr double kNode[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
constexpr double kWeight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};

// Composite rule on [a, b] with panels that shrink quadratically towards a (toward_low) or b.
void panels(double a, double b, int count, bool toward_low, std::vector<std::pair<double, double>>& rule) {
  for (int p = 0; p < count; ++p) {
    const double s = static_cast<double>(p) / count, t = static_cast<double>(p + 1) / count;
    const double from = toward_low ? a + (b - a) * s * s : b - (b - a) * t * t,
                 to = toward_low ? a + (b - a) * t * t : b - (b - a) * s * s;
    for (int k = 0; k < 4; ++k) rule.push_back({from + (to - from) * kNode[k], (to - from) * kWeight[k]});
  }
}

}  // namespace

std::vector<GroundNode> ground_nodes(Dir out) {
  const double edge = std::acos(kGroundMinCosine), theta_o = std::fmin(polar_angle(out), edge);
  std::vector<std::pair<double, double>> polar, around;
  if (theta_o > 1e-3) panels(0, theta_o, 6, false, polar);
  if (theta_o < edge - 1e-3) panels(theta_o, edge, 10, true, polar);
  panels(edge, kPi / 2, 1, true, polar);
  panels(0, kPi, 6, true, around);
  std::vector<GroundNode> nodes;
  double sum = 0;
  for (const auto& [theta, wt] : polar)
    for (const auto& [phi, wp] : around) {
      nodes.push_back({dir_from_angles(theta, phi), 2 * wt * wp * std::sin(theta) * std::cos(theta)});
      sum += nodes.back().weight;
    }
  for (GroundNode& n : nodes) n.weight *= kPi / sum;
  return nodes;
}

void GroundModel::fill_totals(const char* model, const char* help, const SpectralState& state,
                              const std::function<void(Dir out, std::span<float> W)>& integrate) {
  constexpr size_t kRows = 97;
  table_ = DirectionalTable(1, 1, kRows, state.size(), [&](Dir out, std::span<float> W) {
    integrate(out, W);
    for (size_t i = 0; i < W.size(); ++i)
      if (W[i] > 1)
        throw Error(strf("model '%s': seen from %.1f deg the ground returns %.3f of the light at %g um", model,
                         polar_angle(out) / kDegree, static_cast<double>(W[i]), state.bins[i].center_um()),
                    std::string("more than it receives; ") + help);
  });
}

}  // namespace suite
