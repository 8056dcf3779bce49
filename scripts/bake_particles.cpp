// Mie's series for scripts/bake_particles: one line in, one line out.
//   [bulk|phase|matrix] wavelength_um n k tolerance  (share kind a b)...    kind: log_normal | gamma | modified (a =
//   slope, r^1)
// bulk answers "extinction_um2 albedo asymmetry volume_um3" of a particle of the mixture by number; phase adds the
// logarithms of the phase function at the stored angles, cosines ascending; matrix in their place P12, P33 and P34 over
// P11, one after the other.
#include <cmath>
#include <iostream>
#include <sstream>

#include "air/phase_grid.h"
#include "air/size_distribution.h"

using namespace suite;

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream in(line);
    std::string what, kind;
    double wavelength, n, k, tolerance, share, a, b, extinction = 0, scattering = 0, cosine = 0, volume = 0;
    in >> what >> wavelength >> n >> k >> tolerance;
    std::vector<double> cosines, phase;
    std::vector<PlaneBlocks> matrices;
    const bool wants_matrix = what == "matrix";
    if (what == "phase" || wants_matrix) cosines.assign(stored_cosines().begin(), stored_cosines().end());
    phase.resize(cosines.size());
    matrices.assign(wants_matrix ? cosines.size() : 0, {0, 0, 0, 0, 0, 0});
    while (in >> share >> kind >> a >> b) {
      const SizeDistribution sizes = kind == "log_normal" ? SizeDistribution::log_normal(a, b)
                                     : kind == "gamma"    ? SizeDistribution::gamma(a, b)
                                                          : SizeDistribution::modified_gamma(b, a, 1);
      const BulkOptics bulk = bulk_optics(sizes, {n, k}, wavelength, cosines, tolerance,
                                          wants_matrix ? BulkMatrices::all : BulkMatrices::none);
      extinction += share * bulk.extinction_um2;
      scattering += share * bulk.scattering_um2;
      cosine += share * bulk.scattering_um2 * bulk.asymmetry;
      volume += share * bulk.volume_um3;
      for (size_t i = 0; i < phase.size(); ++i) phase[i] += share * bulk.scattering_um2 * bulk.phase[i];
      for (size_t i = 0; i < matrices.size(); ++i)
        matrices[i] = matrices[i] + bulk.matrices[i] * (share * bulk.scattering_um2 * bulk.phase[i]);
    }
    std::cout.precision(10);
    std::cout << extinction << ' ' << scattering / extinction << ' ' << cosine / scattering << ' ' << volume;
    if (wants_matrix)
      for (double PlaneBlocks::*const of : {&PlaneBlocks::b, &PlaneBlocks::c, &PlaneBlocks::d})
        for (const PlaneBlocks& m : matrices) std::cout << ' ' << m.*of / m.a;
    else
      for (const double p : phase) std::cout << ' ' << std::log(p / scattering);
    std::cout << std::endl;
  }
}
