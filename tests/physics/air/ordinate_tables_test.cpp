// The discrete ordinates against published tables, as DISORT's test problems 1 to 9 collect them: H. van de Hulst,
// "Multiple light scattering", 1980, tables 12 and 37; A. Sweigart, "Radiative transfer in atmospheres scattering
// according to the Rayleigh phase function with absorption", Astrophys. J. Suppl. 22, 1970, table 1; R. Garcia,
// C. Siewert 1985, tables 12 to 20; M. Ozisik, S. Shouman 1980, table 1; C. Devaux et al. 1979, tables 6 and 7. The
// digits are those of the answers in DISORT's test program DISOTEST (K. Stamnes, S.-C. Tsay, W. Wiscombe, I. Laszlo,
// "DISORT, a general-purpose Fortran program for discrete-ordinate-method radiative transfer", report, 2000), printed
// to six; those of 7c and 7d are DISORT's own.
#include <gtest/gtest.h>

#include "air/discrete_ordinates.h"
#include "support/phase_moments.h"

namespace suite::test::ordinate_tables_test {
namespace {

struct Fluxes {
  double depth, direct, down, up;
};
struct View {
  double depth, mu, degrees, value;
};

struct Table {
  const char* name;
  int streams;
  std::vector<DiffuseLayer> layers;
  std::vector<std::vector<double>> moments;
  DiffuseProblem problem;
  std::vector<Fluxes> fluxes;
  std::vector<View> views;
  double tolerance = 2e-5;  // of the fluxes: the digits printed
  double view_tolerance = 1e-4;
};
void PrintTo(const Table& t, std::ostream* out) { *out << t.name; }

// One layer under a beam of irradiance pi, or of pi over a plane across the horizon.
Table one_layer(const char* name, int streams, double depth, double albedo, std::vector<double> chi, double sun,
                double beam, double above, std::vector<Fluxes> fluxes, std::vector<View> views) {
  Table t{name, streams, {}, {std::move(chi)}, {}, std::move(fluxes), std::move(views)};
  t.layers.resize(1);
  t.layers[0].depth = depth;
  t.layers[0].albedo = albedo;
  t.problem.beam.cosine = sun;
  t.problem.beam.irradiance = beam;
  t.problem.top_radiance = above;
  return t;
}

std::vector<Table> van_de_hulst() {
  const double dim = kPi / 0.1, thin = 0.03125, pi = 3.14159;
  return {
      one_layer("1a", 16, thin, 0.2, isotropic(), 0.1, dim, 0, {{0, pi, 0, 7.99451e-2}, {thin, 2.29844, 7.94108e-2, 0}},
                {{0, 0.1, 0, 1.17771e-1},
                 {0, 0.5, 0, 2.64170e-2},
                 {0, 1, 0, 1.34041e-2},
                 {thin, -1, 0, 1.33826e-2},
                 {thin, -0.5, 0, 2.63324e-2},
                 {thin, -0.1, 0, 1.15898e-1}}),
      one_layer("1b", 16, thin, 1, isotropic(), 0.1, dim, 0, {{0, pi, 0, 4.22922e-1}, {thin, 2.29844, 4.20233e-1, 0}},
                {{0, 0.1, 0, 6.22884e-1},
                 {0, 0.5, 0, 1.39763e-1},
                 {0, 1, 0, 7.09192e-2},
                 {thin, -1, 0, 7.08109e-2},
                 {thin, -0.5, 0, 1.39337e-1},
                 {thin, -0.1, 0, 6.13458e-1}}),
      one_layer("1c", 16, thin, 0.99, isotropic(), 0.1, 0, 1, {{0, 0, pi, 9.06556e-2}, {thin, 0, 3.04897, 0}},
                {{0, 0.1, 0, 1.33177e-1},
                 {0, 0.5, 0, 2.99879e-2},
                 {0, 1, 0, 1.52233e-2},
                 {thin, -1, 0, 9.84447e-1},
                 {thin, -0.5, 0, 9.69363e-1},
                 {thin, -0.1, 0, 8.63946e-1}}),
      one_layer("1d", 16, 32, 0.2, isotropic(), 0.1, dim, 0, {{0, pi, 0, 2.59686e-1}, {32, 0, 0, 0}},
                {{0, 0.1, 0, 2.62972e-1}, {0, 0.5, 0, 9.06967e-2}, {0, 1, 0, 5.02853e-2}}),
      one_layer("1e", 16, 32, 1, isotropic(), 0.1, dim, 0, {{0, pi, 0, 3.07390}, {32, 0, 6.76954e-2, 0}},
                {{0, 0.1, 0, 1.93321},
                 {0, 0.5, 0, 1.02732},
                 {0, 1, 0, 7.97199e-1},
                 {32, -1, 0, 2.71316e-2},
                 {32, -0.5, 0, 1.87805e-2},
                 {32, -0.1, 0, 1.16385e-2}}),
      one_layer("1f", 16, 32, 0.99, isotropic(), 0.1, 0, 1, {{0, 0, pi, 2.49618}, {32, 0, 4.60048e-3, 0}},
                {{0, 0.1, 0, 8.77510e-1},
                 {0, 0.5, 0, 8.15136e-1},
                 {0, 1, 0, 7.52715e-1},
                 {32, -1, 0, 1.86840e-3},
                 {32, -0.5, 0, 1.26492e-3},
                 {32, -0.1, 0, 7.79280e-4}}),
  };
}

std::vector<Table> sweigart() {
  const double sun = 0.080442, direct = 2.52716e-1;
  return {
      one_layer("2a", 16, 0.2, 0.5, rayleigh_moments(), sun, kPi, 0,
                {{0, direct, 0, 5.35063e-2}, {0.2, 2.10311e-2, 4.41791e-2, 0}},
                {{0, 0.018014, 0, 1.61796e-1},
                 {0, 0.538263, 0, 2.11501e-2},
                 {0, 0.981986, 0, 7.86713e-3},
                 {0.2, -0.981986, 0, 7.71897e-3},
                 {0.2, -0.538263, 0, 2.00778e-2},
                 {0.2, -0.018014, 0, 2.57685e-2}}),
      one_layer("2b", 16, 0.2, 1, rayleigh_moments(), sun, kPi, 0,
                {{0, direct, 0, 1.25561e-1}, {0.2, 2.10311e-2, 1.06123e-1, 0}},
                {{0, 0.018014, 0, 3.47678e-1},
                 {0, 0.538263, 0, 4.87120e-2},
                 {0, 0.981986, 0, 1.89387e-2},
                 {0.2, -0.981986, 0, 1.86027e-2},
                 {0.2, -0.538263, 0, 4.64061e-2},
                 {0.2, -0.018014, 0, 6.77603e-2}}),
      one_layer("2c", 16, 5, 0.5, rayleigh_moments(), sun, kPi, 0, {{0, direct, 0, 6.24730e-2}, {5, 0, 2.51683e-4, 0}},
                {{0, 0.018014, 0, 1.62566e-1},
                 {0, 0.538263, 0, 2.45786e-2},
                 {0, 0.981986, 0, 1.01498e-2},
                 {5, -0.981986, 0, 1.70004e-4},
                 {5, -0.538263, 0, 3.97168e-5},
                 {5, -0.018014, 0, 1.32472e-5}}),
      one_layer("2d", 16, 5, 1, rayleigh_moments(), sun, kPi, 0, {{0, direct, 0, 2.25915e-1}, {5, 0, 2.68008e-2, 0}},
                {{0, 0.018014, 0, 3.64010e-1},
                 {0, 0.538263, 0, 8.26993e-2},
                 {0, 0.981986, 0, 4.92370e-2},
                 {5, -0.981986, 0, 1.05950e-2},
                 {5, -0.538263, 0, 7.69337e-3},
                 {5, -0.018014, 0, 3.79276e-3}}),
  };
}

// Problems 3 to 5: the forward peak beyond the streams. Their answers contain the phase
// function cut after 32 moments (3, 4) or 298 (5).
constexpr double kWhole = 3.14159, kHalf = 1.90547, kRest = 1.15573;  // of a beam from the zenith, at depths 0, 0.5, 1

std::vector<Table> henyey_greensteins() {
  return {
      one_layer("3a", 16, 1, 1, henyey_greenstein(0.75, 33), 1, kPi, 0,
                {{0, kWhole, 0, 2.47374e-1}, {1, kRest, 1.73849, 0}},
                {{0, 0.1, 0, 1.51159e-1},
                 {0, 0.5, 0, 1.01103e-1},
                 {0, 1, 0, 3.95460e-2},
                 {1, -0.5, 0, 2.66648e-1},
                 {1, -0.1, 0, 2.13750e-1}}),
      one_layer("3b", 16, 8, 1, henyey_greenstein(0.75, 33), 1, kPi, 0,
                {{0, kWhole, 0, 1.59096}, {8, 1.05389e-3, 1.54958, 0}},
                {{0, 0.1, 0, 3.79740e-1},
                 {0, 0.5, 0, 5.19598e-1},
                 {0, 1, 0, 4.93302e-1},
                 {8, -0.5, 0, 4.22350e-1},
                 {8, -0.1, 0, 2.36362e-1}}),
  };
}

std::vector<Table> haze() {
  const std::vector<double> chi = from_published(std::span(kHazeL).first(32));
  return {
      one_layer("4a", 32, 1, 1, chi, 1, kPi, 0,
                {{0, kWhole, 0, 1.73223e-1}, {0.5, kHalf, 1.17401, 1.11113e-1}, {1, kRest, 1.81264, 0}},
                {{0, 0.1, 0, 9.26837e-2},
                 {0, 0.5, 0, 6.59569e-2},
                 {0.5, -0.5, 0, 1.19287e-1},
                 {0.5, -0.1, 0, 1.34962e-1},
                 {0.5, 0.1, 0, 1.23887e-1},
                 {0.5, 0.5, 0, 4.02058e-2},
                 {1, -0.5, 0, 2.19835e-1},
                 {1, -0.1, 0, 1.56893e-1}}),
      one_layer("4b", 32, 1, 0.9, chi, 1, kPi, 0,
                {{0, kWhole, 0, 1.23665e-1}, {0.5, kHalf, 1.01517, 7.88690e-2}, {1, kRest, 1.51554, 0}},
                {{0, 0.1, 0, 6.53056e-2},
                 {0, 0.5, 0, 4.55144e-2},
                 {0.5, -0.5, 0, 9.66049e-2},
                 {0.5, -0.1, 0, 9.61335e-2},
                 {0.5, 0.1, 0, 8.43278e-2},
                 {1, -0.5, 0, 1.67698e-1},
                 {1, -0.1, 0, 1.08115e-1}}),
      one_layer(
          "4c", 32, 1, 0.9, chi, 0.5, kPi, 0,
          {{0, 1.57080, 0, 2.25487e-1}, {0.5, 5.77864e-1, 7.02764e-1, 1.23848e-1}, {1, 2.12584e-1, 8.03294e-1, 0}},
          {{0, 0.1, 0, 8.70812e-1},
           {0, 0.5, 0, 2.24960e-1},
           {0.5, -0.5, 0, 3.02631},
           {0.5, -0.1, 0, 1.41195},
           {0.5, 0.1, 0, 6.97692e-1},
           {1, -0.5, 0, 2.70538},
           {0, 0.1, 90, 8.88117e-2},
           {0, 0.5, 90, 5.77411e-2},
           {0.5, -0.1, 90, 1.04502e-1},
           {1, -0.5, 90, 9.42187e-2},
           {0, 0.1, 180, 6.98247e-2},
           {0, 0.5, 180, 5.02877e-2},
           {0.5, 0.1, 180, 5.91273e-2},
           {1, -0.1, 180, 4.67155e-2}}),
  };
}

std::vector<Table> cloud() {
  const std::vector<double> chi = from_published(std::span(kCloudC1).first(298));
  return {
      one_layer("5a", 48, 64, 1, chi, 1, kPi, 0,
                {{0, kWhole, 0, 2.66174}, {32, 0, 2.24768, 1.76783}, {64, 0, 4.79851e-1, 0}},
                {{0, 0.1, 0, 4.58927e-1},
                 {0, 0.5, 0, 7.72983e-1},
                 {0, 1, 0, 1.07196},
                 {32, -1, 0, 7.53662e-1},
                 {32, -0.1, 0, 6.50541e-1},
                 {32, 0.5, 0, 5.81809e-1},
                 {64, -1, 0, 1.95230e-1},
                 {64, -0.1, 0, 7.20655e-2}}),
      one_layer("5b", 48, 64, 0.9, chi, 1, kPi, 0,
                {{3.2, 1.28058e-1, 1.74767, 2.70485e-1},
                 {12.8, 8.67322e-6, 2.33975e-1, 3.74252e-2},
                 {48, 0, 6.38345e-5, 1.02904e-5}},
                {{12.8, -0.5, 0, 4.92736e-2},
                 {12.8, 0.1, 0, 2.02154e-2},
                 {12.8, 0.5, 0, 1.29661e-2},
                 {48, -1, 0, 3.41286e-5},
                 {48, 0.5, 0, 3.58245e-6}}),
  };
}

// Problems 8 and 9: layers that differ, under isotropic light.
std::vector<Table> layered() {
  const auto make = [](const char* name, std::vector<double> depths, std::vector<double> albedos,
                       std::vector<double> chi, std::vector<Fluxes> fluxes, std::vector<View> views) {
    Table t{name, 8, {}, {}, {}, std::move(fluxes), std::move(views)};
    for (size_t l = 0; l < depths.size(); ++l) {
      t.layers.push_back({.depth = depths[l], .albedo = albedos[l], .moments = {}});
      t.moments.push_back(chi);
    }
    t.problem.top_radiance = 1 / kPi;
    return t;
  };
  const std::vector<double> forward{
      1, 2.00916 / 3, 1.56339 / 5, 0.67407 / 7, 0.22215 / 9, 0.04725 / 11, 0.00671 / 13, 0.00068 / 15, 0.00005 / 17};
  const std::vector<double> six{1, 2, 3, 4, 5, 6}, albedos{0.65, 0.7, 0.75, 0.8, 0.85, 0.9};
  return {
      make("8a", {0.25, 0.25}, {0.5, 0.3}, isotropic(),
           {{0, 0, 1, 9.29633e-2}, {0.25, 0, 7.22235e-1, 2.78952e-2}, {0.5, 0, 5.13132e-1, 0}},
           {{0, 0.2, 60, 5.62566e-2},
            {0, 1, 60, 1.94423e-2},
            {0.25, -1, 60, 2.62711e-1},
            {0.25, -0.2, 60, 1.36952e-1},
            {0.5, -0.2, 60, 5.60376e-2}}),
      make("8b", {0.25, 0.25}, {0.8, 0.95}, isotropic(),
           {{0, 0, 1, 2.25136e-1}, {0.25, 0, 7.95332e-1, 1.26349e-1}, {0.5, 0, 6.50417e-1, 0}},
           {{0, 0.2, 60, 1.23687e-1}, {0.25, 0.2, 60, 8.35695e-2}, {0.5, -0.2, 60, 1.29291e-1}}),
      make("8c", {1, 2}, {0.8, 0.95}, isotropic(),
           {{0, 0, 1, 3.78578e-1}, {1, 0, 4.86157e-1, 2.43397e-1}, {3, 0, 1.59984e-1, 0}},
           {{0, 1, 60, 1.04766e-1}, {1, -1, 60, 1.89020e-1}, {3, -0.2, 60, 2.96698e-2}}),
      make("9a", six, albedos, isotropic(),
           {{0, 0, 1, 2.27973e-1},
            {1.05, 0, 3.55151e-1, 8.75098e-2},
            {2.1, 0, 1.44265e-1, 3.61819e-2},
            {6, 0, 6.71445e-3, 2.19291e-3},
            {21, 0, 6.16968e-7, 0}},
           {{0, 0.2, 60, 9.98915e-2},
            {1.05, -0.2, 60, 5.09531e-2},
            {2.1, 1, 60, 9.72307e-3},
            {6, -1, 60, 3.72784e-3},
            {21, -1, 60, 2.87656e-7}}),
      make("9b", six, albedos, forward,
           {{0, 0, 1, 1.00079e-1},
            {1.05, 0, 4.52357e-1, 4.52014e-2},
            {2.1, 0, 2.36473e-1, 2.41941e-2},
            {6, 0, 2.76475e-2, 4.16016e-3},
            {21, 0, 7.41853e-5, 0}},
           {{0, 0.2, 60, 7.39198e-2}, {1.05, -0.2, 60, 5.92369e-2}, {6, 1, 60, 7.77890e-4}, {21, -1, 60, 3.37742e-5}}),
  };
}

// Problems 7c and 7d: emission, a beam, light from above, a black warm or a white ground. Planck radiances over all
// wavelengths.
std::vector<Table> everything() {
  const auto planck = [](double kelvin) { return 5.670374419e-8 * std::pow(kelvin, 4) / kPi; };
  std::vector<Table> tables{
      one_layer("7c", 12, 1, 0.5, henyey_greenstein(0.8, 13), 0.5, 200, 100 + planck(100),
                {{0, 100, 319.830, 429.572}, {0.5, 36.7879, 354.099, 447.018}, {1, 13.5335, 301.334, 594.576}},
                {{0, 0.1, 0, 146.775},
                 {0, 1, 0, 149.033},
                 {0.5, -1, 0, 106.583},
                 {0.5, -0.1, 0, 128.565},
                 {0.5, 0.1, 90, 94.8418},
                 {1, -0.1, 90, 74.9310}}),
      one_layer("7d", 12, 1, 0.5, henyey_greenstein(0.8, 13), 0.5, 200, 100 + planck(100),
                {{0, 100, 319.830, 312.563}, {0.5, 36.7879, 350.555, 268.126}, {1, 13.5335, 292.063, 305.596}},
                {{0, 0.1, 0, 140.977}, {0, 1, 0, 96.2764}, {0.5, -0.1, 90, 100.969}, {1, 1, 0, 97.2743}}),
  };
  for (Table& t : tables) {
    t.layers[0].planck_top = planck(300);
    t.layers[0].planck_bottom = planck(200);
    t.tolerance = t.view_tolerance = 2e-4;  // their constants of radiation are of 1986
  }
  tables[0].problem.ground_emission = planck(320);
  tables[1].problem.ground_albedo = 1;
  return tables;
}

class Tables : public testing::TestWithParam<Table> {};

DiffusePlace place_of(const Table& t, double depth) {
  for (size_t l = 0; l < t.layers.size(); ++l) {
    const int layer = static_cast<int>(l);
    if (depth <= t.layers[l].depth * (1 + 1e-12)) return {layer, std::min(1.0, depth / t.layers[l].depth)};
    depth -= t.layers[l].depth;
  }
  return {static_cast<int>(t.layers.size()) - 1, 1};
}

// The largest error of the fluxes in tolerances.
double worst_flux(const Table& table, double factor) {
  Table t = table;
  for (size_t l = 0; l < t.layers.size(); ++l) t.layers[l].moments = t.moments[l];
  t.problem.layers = t.layers;
  DiscreteOrdinates solver(t.streams);
  solver.solve(t.problem);
  double worst = 0;
  for (const Fluxes& row : t.fluxes) {
    const DiffuseFluxes f = solver.fluxes(place_of(t, row.depth));
    const double pairs[3][2] = {{f.direct, row.direct}, {f.down, row.down}, {f.up, row.up}};
    for (const auto& [ours, theirs] : pairs)
      worst = std::max(worst, std::fabs(ours - factor * theirs) / (t.tolerance * std::fabs(theirs) + 1e-9));
  }
  return worst;
}

TEST_P(Tables, Fluxes) {
  EXPECT_LT(worst_flux(GetParam(), 1), 1);
  EXPECT_GT(worst_flux(GetParam(), 1.02), 10) << "a table 2 % off must fail";
}

TEST_P(Tables, Radiances) {
  Table t = GetParam();
  for (size_t l = 0; l < t.layers.size(); ++l) t.layers[l].moments = t.moments[l];
  t.problem.layers = t.layers;
  DiscreteOrdinates solver(t.streams);
  t.problem.azimuth_tolerance = 1e-7;
  solver.solve(t.problem);
  for (const View& v : t.views) {
    const double phi = v.degrees * kPi / 180;
    std::vector<double> phase;
    for (const auto& chi : t.moments)
      phase.push_back(phase_of(chi, scattering_cosine(t.problem.beam.cosine, v.mu, phi)));
    const double ours = solver.radiance(place_of(t, v.depth), v.mu, phi, phase);
    EXPECT_NEAR(ours, v.value, t.view_tolerance * v.value)
        << "depth " << v.depth << " mu " << v.mu << " phi " << v.degrees;
  }
}

const auto name = [](const testing::TestParamInfo<Table>& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(VanDeHulst, Tables, testing::ValuesIn(van_de_hulst()), name);
INSTANTIATE_TEST_SUITE_P(Sweigart, Tables, testing::ValuesIn(sweigart()), name);
INSTANTIATE_TEST_SUITE_P(HenyeyGreenstein, Tables, testing::ValuesIn(henyey_greensteins()), name);
INSTANTIATE_TEST_SUITE_P(Haze, Tables, testing::ValuesIn(haze()), name);
INSTANTIATE_TEST_SUITE_P(Cloud, Tables, testing::ValuesIn(cloud()), name);
INSTANTIATE_TEST_SUITE_P(Layered, Tables, testing::ValuesIn(layered()), name);
INSTANTIATE_TEST_SUITE_P(Everything, Tables, testing::ValuesIn(everything()), name);

}  // namespace
}  // namespace suite::test::ordinate_tables_test
