#include "light/kinds/clear_sky.h"

#include <algorithm>
#include <cmath>

#include "light/environment.h"
#include "light/kinds/rows.h"
#include "light/kinds/sun.h"
#include "light/perez_sky.h"

namespace suite {

namespace {

struct Row {
  double wavelength_um, water, ozone, mixed;
};
constexpr Row kRows[] = {
#include "light/kinds/clear_sky_table.inc"
};
constexpr size_t kCount = sizeof(kRows) / sizeof(kRows[0]);
static_assert(kCount == 122);

// Transmittances of the parts of the atmosphere at one wavelength (section 2).
struct Parts {
  double rayleigh, aerosol, water, ozone, mixed;
  double aerosol_scatter, aerosol_absorb;  // equations 3-9 and 3-10
};
Parts parts_of(const ClearSkySpec& s, const Row& row, double mass, double ozone_mass) {
  const double w = row.wavelength_um, pressure_mass = mass * s.pressure / 101300;
  const double depth = s.aerosol_depth_500 * std::pow(w / 0.5, -s.angstrom);
  const double albedo = s.albedo_400 * std::exp(-0.095 * std::pow(std::log(w / 0.4), 2));  // 3-16
  const double wm = row.water * s.water_cm * mass, um = row.mixed * pressure_mass;
  Parts p;
  p.rayleigh = std::exp(-pressure_mass / (std::pow(w, 4) * (115.6406 - 1.3366 / (w * w))));  // 2-4
  p.aerosol = std::exp(-depth * mass);                                                       // 2-6
  p.water = std::exp(-0.2385 * wm / std::pow(1 + 20.07 * wm, 0.45));                         // 2-8
  p.ozone = std::exp(-row.ozone * s.ozone_cm * ozone_mass);                                  // 2-9
  p.mixed = std::exp(-1.41 * um / std::pow(1 + 118.3 * um, 0.45));                           // 2-11
  p.aerosol_scatter = std::exp(-albedo * depth * mass);
  p.aerosol_absorb = std::exp(-(1 - albedo) * depth * mass);
  return p;
}

// Direct transmittance, and the diffuse irradiance on the horizontal per extraterrestrial irradiance (section 3).
// Returns what share of the diffuse light molecules have scattered.
double spectral(const ClearSkySpec& s, double mu, const Row& row, double& direct, double& diffuse) {
  const double h = 22.0 / 6370, mass = air_mass(std::acos(mu));
  const auto ozone_mass = [h](double cosine) { return (1 + h) / std::sqrt(cosine * cosine + 2 * h); };  // 2-10
  const Parts p = parts_of(s, row, mass, ozone_mass(mu)), q = parts_of(s, row, 1.8, ozone_mass(mu));
  direct = p.rayleigh * p.aerosol * p.water * p.ozone * p.mixed;
  const double alg = std::log(1 - s.asymmetry);                         // 3-14
  const double a = alg * (1.459 + alg * (0.1595 + alg * 0.4129));       // 3-12
  const double b = alg * (0.0783 + alg * (-0.3824 - alg * 0.5874));     // 3-13
  const double forward = 1 - 0.5 * std::exp((a + b * mu) * mu);         // 3-11
  const double forward_mean = 1 - 0.5 * std::exp((a + b / 1.8) / 1.8);  // 3-15
  const double common = mu * p.ozone * p.mixed * p.water * p.aerosol_absorb;
  const double by_rayleigh = common * (1 - std::pow(p.rayleigh, 0.95)) * 0.5;                        // 3-5
  const double by_aerosol = common * std::pow(p.rayleigh, 1.5) * (1 - p.aerosol_scatter) * forward;  // 3-6
  const double sky = q.mixed * q.water * q.aerosol_absorb *
                     (0.5 * (1 - q.rayleigh) + (1 - forward_mean) * q.rayleigh * (1 - q.aerosol_scatter));  // 3-8
  const double by_ground =
      (direct * mu + by_rayleigh + by_aerosol) * sky * s.ground_albedo / (1 - sky * s.ground_albedo);  // 3-7
  const double correction = row.wavelength_um <= 0.45 ? std::pow(row.wavelength_um + 0.55, 1.8) : 1;   // 3-17
  diffuse = (by_rayleigh + by_aerosol + by_ground) * correction;
  return by_rayleigh / (by_rayleigh + by_aerosol + by_ground);
}

// Integral of (bilinear table) times cos over the hemisphere, by Gauss' rule of three points in every cell: the same
// function that the renderer evaluates.
double hemispheric_integral(const SkySpec& sky) {
  constexpr double node[3] = {0.1127016653792583, 0.5, 0.8872983346207417}, weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  const size_t rows = sky.zeniths - 1;
  const double step = kPi / 2 / static_cast<double>(rows);
  double sum = 0;
  for (size_t r = 0; r < rows; ++r)
    for (int i = 0; i < 3; ++i) {
      const double theta = (static_cast<double>(r) + node[i]) * step;
      double ring = 0;
      for (size_t c = 0; c < sky.azimuths; ++c)
        ring += (1 - node[i]) * sky.table[r * sky.azimuths + c] + node[i] * sky.table[(r + 1) * sky.azimuths + c];
      sum += weight[i] * step * std::sin(theta) * std::cos(theta) * ring * 2 * kPi / static_cast<double>(sky.azimuths);
    }
  return sum;
}

void check(const ClearSkySpec& s, Dir sun) {
  const auto in = [](const char* name, double v, double low, double high) {
    if (!(v >= low && v <= high))
      throw Error(strf("clear sky: %s = %g is outside its range", name, v), strf("give %g to %g", low, high));
  };
  in("pressure", s.pressure, 1000, 120000);
  in("water_cm", s.water_cm, 0, 10);
  in("ozone_cm", s.ozone_cm, 0, 1);
  in("aerosol_optical_depth_500", s.aerosol_depth_500, 0, 2);
  in("angstrom", s.angstrom, -1, 4);
  in("albedo_400", s.albedo_400, 0, 1);
  in("asymmetry", s.asymmetry, 0, 0.95);
  in("ground_albedo", s.ground_albedo, 0, 1);
  if (!(sun.z > std::cos(89.5 * kDegree)))
    throw Error("a clear sky needs a sun at least half a degree above the horizon",
                "give a table, an image or a constant for twilight and night");
}

}  // namespace

double air_mass(double zenith) {
  const double degrees = std::min(zenith / kDegree, 90.0);
  return 1 / (std::cos(degrees * kDegree) + 0.50572 * std::pow(96.07995 - degrees, -1.6364));
}

ClearSpectra clear_spectra(const ClearSkySpec& spec, Dir sun, const Curve& top) {
  check(spec, sun);
  const double mu = sun.z;
  std::vector<double> coarse, transmittance, scattered, by_molecules;
  for (const Row& row : kRows) {
    coarse.push_back(row.wavelength_um);
    by_molecules.push_back(spectral(spec, mu, row, transmittance.emplace_back(), scattered.emplace_back()));
  }
  // Transmittances vary slower than the Sun's spectrum: interpolate them and keep its lines.
  const Curve direct(coarse, transmittance, Outside::error), diffuse(coarse, scattered, Outside::error);
  std::vector<double> x = coarse;
  for (const double w : top.wavelength_um())
    if (w > coarse.front() && w < coarse.back()) x.push_back(w);
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end(), [](double a, double b) { return b - a < 1e-9; }), x.end());
  std::vector<double> e(x.size()), s(x.size());
  for (size_t i = 0; i < x.size(); ++i) e[i] = top.at(x[i]) * direct.at(x[i]), s[i] = top.at(x[i]) * diffuse.at(x[i]);
  constexpr double kEyeUm = 0.55;
  ClearSpectra result{Curve(x, e, Outside::error), Curve(x, s, Outside::error),
                      Curve(coarse, by_molecules, Outside::error).at(kEyeUm)};
  if (!(result.diffuse.integral(0.3, 4) > 0)) throw Error("the sun of a clear sky gives no light between 0.3 and 4 um");
  return result;
}

ClearSky clear_sky(const ClearSkySpec& spec, Dir sun, const Curve& top) {
  const ClearSpectra spectra = clear_spectra(spec, sun, top);
  ClearSky result{spectra.direct, spectra.diffuse, {}};
  const double zenith = polar_angle(sun), normal = result.direct.integral(0.3, 4),
               horizontal = result.diffuse.integral(0.3, 4), extraterrestrial = top.integral(0.3, 4);
  const PerezSky perez(zenith, normal, horizontal, extraterrestrial, air_mass(zenith));
  SkySpec& sky = result.sky;
  sky.zeniths = 91, sky.azimuths = 180;
  for (size_t r = 0; r < sky.zeniths; ++r)
    for (size_t c = 0; c < sky.azimuths; ++c) {
      const Dir d = dir_from_angles(static_cast<double>(r) * kPi / 180,
                                    static_cast<double>(c) * 2 * kPi / static_cast<double>(sky.azimuths));
      sky.table.push_back(perez.at(d.z, angle_between(d, sun)));
    }
  const double integral = hemispheric_integral(sky);
  for (double& v : sky.table) v /= integral;
  sky.radiance = result.diffuse;
  constexpr double kMolecules = 0.94;
  sky.polarisation = RayleighPattern{sun, spec.polarisation.value_or(kMolecules * spectra.by_molecules)};
  return result;
}

namespace {

class ClearSkyLight final : public LightSpec {
 public:
  explicit ClearSkyLight(ClearSkySpec spec) : spec_(std::move(spec)) {}
  std::string key() const override { return "sky"; }
  std::string needs_sun_up() const override { return "a clear sky"; }

  void check_beside(const SourceSpecs& all) const override {
    if (!all.sun()) throw Error(spec_.where, "a clear sky needs a sun", "give `sun`");
    if (all.has_air())
      throw Error(all.where_air(), "a clear sky stands for the atmosphere as well", "drop one of the two");
    for (const LightSpecPtr& light : all.lights)
      if (light.get() != this && light->key() == key())
        throw Error(spec_.where, "a clear sky stands beside another sky", "drop one of the two");
  }

  void settle(SourceSpecs& all, size_t own, std::vector<std::string>& said) const override {
    check_beside(all);
    const FarDisk above = *all.sun()->disk();
    ClearSky clear = clear_sky(spec_, normalized(above.direction), above.irradiance);
    said.push_back(strf("clear sky: direct %.1f W/m2 facing the sun, diffuse %.1f W/m2 on the horizontal (0.3 to 4 um)",
                        clear.direct.integral(0.3, 4), clear.diffuse.integral(0.3, 4)));
    for (LightSpecPtr& light : all.lights)
      if (light->is_sun()) light = make_light(SunSpec{{above.direction, above.half_angle, std::move(clear.direct)}});
    all.lights[own] = make_light(std::move(clear.sky));
  }

  // Before it is settled nothing is known of its spectrum.
  bool shines(double, double) const override { return true; }
  void add_spectra(std::vector<LightSpectra>&) const override { unsettled(); }
  bool in_scene() const override { return false; }
  std::vector<std::string> hardly_met(double) const override { return {}; }
  std::shared_ptr<const Light> bake(const Tracer&, const SpectralState&) const override { unsettled(); }

 private:
  [[noreturn]] static void unsettled() { throw Bug("a clear sky has not been resolved"); }
  const ClearSkySpec spec_;
};

LightSpecPtr read_clear(const Params& p, const LightContext&) {
  ClearSkySpec c;
  c.pressure = p.number_in("pressure_pa", 1000, 120000, "Pa", c.pressure);
  c.water_cm = p.number_in("water_cm", 0, 10, "cm", c.water_cm);
  c.ozone_cm = p.number_in("ozone_cm", 0, 1, "atm-cm", c.ozone_cm);
  c.aerosol_depth_500 = p.number_in("aerosol_optical_depth_500", 0, 2, "", c.aerosol_depth_500);
  c.angstrom = p.number_in("angstrom", -1, 4, "", c.angstrom);
  c.albedo_400 = p.number_in("albedo_400", 0, 1, "", c.albedo_400);
  c.asymmetry = p.number_in("asymmetry", 0, 0.95, "", c.asymmetry);
  c.ground_albedo = p.number_in("ground_albedo", 0, 1, "", c.ground_albedo);
  if (p.find("polarisation")) c.polarisation = p.number_in("polarisation", 0, 1, "", 0);
  c.where = p.where();
  return make_light(std::move(c));
}

}  // namespace

LightSpecPtr make_light(ClearSkySpec spec) { return std::make_shared<const ClearSkyLight>(std::move(spec)); }

LightRow sky_clear_row() {
  return {{"sky clear", "analytic clear sky: Bird & Riordan 1984 irradiances after Perez 1993; needs a sun", "",
           read_clear},
          false,
          {},
          "sun: {direction: {zenith_deg: 50, azimuth_deg: 180}, collimated: true}\nsky: {kind: clear, water_cm: 2}\n"};
}

}  // namespace suite
