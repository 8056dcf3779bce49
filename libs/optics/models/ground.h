// What the empirical models of natural ground share: they diverge at grazing and have no closed total.
#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "optics/models/bpdf.h"
#include "optics/models/cosine_lobe.h"
#include "optics/models/directional_table.h"

namespace suite {

// Beyond 85 deg these models are evaluated at 85 deg: they were made for satellite and field geometries and grow
// without bound towards the horizon.
inline constexpr double kGroundMinCosine = 0.08715574274765817;
inline Dir not_grazing(Dir d) {
  if (d.z >= kGroundMinCosine) return d;
  const double scale = std::sqrt((1 - kGroundMinCosine * kGroundMinCosine) / (d.x * d.x + d.y * d.y));
  return {d.x * scale, d.y * scale, kGroundMinCosine};
}

// Quadrature over the upper hemisphere for functions even in azimuth: nodes with y >= 0 and weights cos(theta) d(omega)
// that sum to pi. Nodes crowd towards the direction `out` (azimuth 0), where the hot spot has its cusp.
struct GroundNode {
  Dir in;
  double weight;
};
std::vector<GroundNode> ground_nodes(Dir out);

// Totals come from a table over the polar angle, integrated when the model is made. Polarisation comes from a BPDF
// where one is given; else nothing is known of it.
class GroundModel : public CosineLobe {
 public:
  explicit GroundModel(const ModelSpec& spec);
  void total(Dir out, std::span<float> W) const final {
    if (out.z == 0) return zero(W);
    table_.at(up(out), W);
  }
  Polarised mueller(Dir out, Dir in, std::span<Mueller> m) const final;

 protected:
  // integrate: the totals W of a direction on the upper side. Error, naming the model and what would help, when more
  // than all of the light returns.
  void fill_totals(const char* model, const char* help, const SpectralState& state,
                   const std::function<void(Dir out, std::span<float> W)>& integrate);

 private:
  DirectionalTable table_;
  Bpdf bpdf_;
};

// The parameter `bpdf` of these models, and what checks it. Error, located at `where`.
Parameter bpdf_parameter();
void check_bpdf(const std::string& model, const std::string& text, const Where& where);

}  // namespace suite
