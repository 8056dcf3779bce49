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

std::string bpdf_text(const ModelSpec& spec) {
  const auto text = spec.texts.find("bpdf");
  return text == spec.texts.end() ? std::string() : text->second;
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

GroundModel::GroundModel(const ModelSpec& spec) : bpdf_(bpdf_text(spec)) {}

ScatterModel::Polarised GroundModel::mueller(Dir out, Dir in, std::span<Mueller> m) const {
  if (!bpdf_.any()) return CosineLobe::mueller(out, in, m);
  if (!same_side(out, in)) return depolarised(m);
  thread_local std::vector<float> w;
  w.resize(m.size());
  eval(out, in, w);
  const Bpdf::Polarised b = bpdf_.at(out, in);
  const double most = b.r11 / kPi * std::fabs(in.z);
  for (size_t i = 0; i < m.size(); ++i) {
    const double share = w[i] > 0 ? std::min(1.0, most / w[i]) : 0;
    m[i] = b.matrix * share;
    m[i](0, 0) = 1;
  }
  return {m.size() == 1, 0};
}

Parameter bpdf_parameter() {
  return {"bpdf",
          Parameter::Kind::text,
          "",
          "polarised part: `breon cover 0.6`, `maignan c 6.11 ndvi 0.5`, `nadal_breon rho 0.0145 beta 120` or "
          "`litvinov alpha 0.8 variance 0.146 shadow 1`",
          0,
          0,
          false};
}
void check_bpdf(const std::string& model, const std::string& text, const Where& where) {
  try {
    (void)Bpdf(text);
  } catch (const Error& e) {
    throw Error(where, "model '" + model + "': " + e.message(), e.hint());
  }
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
