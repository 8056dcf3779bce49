#include <limits>

#include "base/error.h"
#include "formats/brdf_csv/brdf_csv.h"
#include "math/vec.h"

namespace suite {

namespace {

// At a pole all azimuths are one direction.
size_t azimuths(double theta_deg, const std::vector<double>& phi) {
  return theta_deg == 0 || theta_deg == 180 ? 1 : phi.size();
}
size_t directions(const std::vector<double>& theta, const std::vector<double>& phi) {
  size_t n = 0;
  for (const double t : theta) n += azimuths(t, phi);
  return n;
}

const char* name_of(sqt::Quantity q) {
  return q == sqt::Quantity::bsdf ? "bsdf" : q == sqt::Quantity::phase ? "phase" : "intensity";
}

}  // namespace

size_t AngleGrid::pairs() const { return directions(theta_o, phi_o) * directions(theta_i, phi_i); }

std::string brdf_csv_of(const sqt::Function& function, const AngleGrid& grid, const std::string& comment) {
  const sqt::Function::Info& info = function.info();
  std::string csv =
      "# name: " + info.name + "\n# quantity: " + name_of(info.quantity) + "\n# " + comment +
      "\n# angles in deg, directions point away from the surface, phi_i - phi_o = 180 is the mirror's side; "
      "value in 1/sr without cosine";
  csv += info.quantity == sqt::Quantity::bsdf ? ", weight = value x |cos theta_i|\n" : "\n";
  csv += "theta_o_deg,phi_o_deg,theta_i_deg,phi_i_deg,wavelength_um,value\n";
  std::vector<double> f(info.wavelength_um.size());
  // The reader's own arithmetic, so that its directions are these to the last bit.
  auto direction = [](double theta, double phi) { return dir_from_angles(theta * kDegree, phi * kDegree); };
  for (const double to : grid.theta_o)
    for (size_t po = 0; po < azimuths(to, grid.phi_o); ++po)
      for (const double ti : grid.theta_i)
        for (size_t pi = 0; pi < azimuths(ti, grid.phi_i); ++pi) {
          function.value(direction(to, grid.phi_o[po]), direction(ti, grid.phi_i[pi]), f);
          for (size_t c = 0; c < f.size(); ++c)
            csv += strf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", to, grid.phi_o[po], ti, grid.phi_i[pi],
                        info.wavelength_um[c], f[c]);
        }
  return csv;
}

}  // namespace suite
