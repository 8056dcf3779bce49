// The discrete ordinates against other programs: numbers printed by ordinate_reference.py, which names the programs and
// their versions. PythonicDISORT is of the same method. Its radiances contain single scattering with the truncated
// phase function.
#include <gtest/gtest.h>

#include "air/discrete_ordinates.h"
#include "support/phase_moments.h"

namespace suite::test::ordinate_reference_test {
namespace {

struct Flux {
  int place;
  double direct, down, up;
};
struct View {
  int place;
  double mu, value[3];  // at azimuths of 0, 1 and 3
};

const std::vector<Flux> kMixedFluxes = {{0, 1.88495559215, 0.157079632679, 1.44683215578},
                                        {1, 0.617076420487, 1.19387433148, 1.37193065284},
                                        {2, 0.093846412937, 1.41928955796, 1.08225932199}};
const std::vector<View> kMixedViews = {{0, 0.019855071751231912, {0.529600038654, 0.453935350694, 0.533631245836}},
                                       {0, 0.59171732124782483, {0.487417604342, 0.457114440521, 0.488547419184}},
                                       {0, 0.98014492824876809, {0.428896805202, 0.430610620439, 0.439352449314}},
                                       {1, -0.98014492824876809, {0.263743234722, 0.240336472048, 0.205480970302}},
                                       {1, -0.59171732124782483, {1.64664064715, 0.362440079704, 0.257222708494}},
                                       {1, -0.019855071751231912, {0.918046013376, 0.556314299502, 0.396807680041}},
                                       {1, 0.019855071751231912, {0.871455282255, 0.554752967604, 0.401867470034}},
                                       {1, 0.59171732124782483, {0.471322074082, 0.445276893829, 0.42894890592}},
                                       {1, 0.98014492824876809, {0.404963292873, 0.404930151112, 0.405528514405}},
                                       {2, -0.98014492824876809, {0.406394476551, 0.38191249299, 0.34165770744}},
                                       {2, -0.59171732124782483, {1.09448634574, 0.473469394898, 0.386888995003}},
                                       {2, -0.019855071751231912, {0.426294897887, 0.416359142888, 0.424996293076}}};
const std::vector<Flux> kColumnFluxes = {{0, 0.25, 0, 0.117884088485},
                                         {1, 0.223694705684, 0.0162935605153, 0.108727953119},
                                         {2, 0.0120755376148, 0.0826202851428, 0.037878329103}};
const std::vector<View> kColumnViews = {
    {0, 0.019855071751231912, {0.132063197506, 0.0953430527685, 0.131814656735}},
    {0, 0.59171732124782483, {0.0417476536264, 0.0344523768027, 0.0436009659508}},
    {0, 0.98014492824876809, {0.0250559792568, 0.0251090493014, 0.0263793859025}},
    {1, -0.98014492824876809, {0.00250956345118, 0.00240119748158, 0.00221889449497}},
    {1, -0.59171732124782483, {0.00594274544982, 0.00454789572795, 0.00474490937935}},
    {1, -0.019855071751231912, {0.101175161892, 0.0730025376164, 0.0995905230999}},
    {1, 0.019855071751231912, {0.119540789238, 0.0870575560762, 0.118561806791}},
    {1, 0.59171732124782483, {0.0387518793125, 0.0320038531144, 0.0395042104082}},
    {1, 0.98014492824876809, {0.0234933944867, 0.0235218555409, 0.0245580404526}},
    {2, -0.98014492824876809, {0.0188921202538, 0.0180260088973, 0.0165080863169}},
    {2, -0.59171732124782483, {0.0535818393768, 0.0279999597579, 0.0244870547333}},
    {2, -0.019855071751231912, {0.0577608545521, 0.021679377097, 0.0182655454897}}};

struct Case {
  std::vector<std::vector<double>> moments;
  std::vector<DiffuseLayer> layers;
  DiffuseProblem problem;
  std::vector<DiffusePlace> places;
};

Case mixed() {
  Case c{{rayleigh_moments(), henyey_greenstein(0.75, 17), rayleigh_moments()}, {}, {}, {{0, 0}, {1, 0.37}, {2, 1}}};
  c.layers = {{.depth = 0.3, .albedo = 0.9, .moments = {}, .planck_top = 0.1, .planck_bottom = 0.2},
              {.depth = 1, .albedo = 0.99, .moments = {}, .planck_top = 0.2, .planck_bottom = 0.5},
              {.depth = 0.5, .albedo = 0.999, .moments = {}, .planck_top = 0.5, .planck_bottom = 0.6}};
  c.problem.beam.irradiance = kPi;
  c.problem.beam.cosine = 0.6;
  c.problem.ground_albedo = 0.3;
  c.problem.ground_emission = 0.2;
  c.problem.top_radiance = 0.05;
  return c;
}

Case column() {
  Case c{{}, {}, {}, {{0, 0}, {9, 1}, {19, 1}}};
  for (int l = 0; l < 20; ++l) {
    const double top = 40 - 2 * l, bottom = top - 2;
    const auto part = [&](double height) { return std::exp(-bottom / height) - std::exp(-top / height); };
    const double molecules = 0.36 * part(8), haze = 0.3 * part(1.5), gas = 0.1 * part(4),
                 scattered = molecules + 0.92 * haze;
    std::vector<double> chi;
    for (int i = 0; i < 17; ++i)
      chi.push_back((molecules * (i == 0 ? 1 : i == 2 ? 0.1 : 0) + 0.92 * haze * std::pow(0.7, i)) / scattered);
    c.moments.push_back(chi);
    const double depth = molecules + haze + gas;
    c.layers.push_back({.depth = depth, .albedo = scattered / depth, .moments = {}});
  }
  c.problem.beam.irradiance = 1;
  c.problem.beam.cosine = 0.25;
  c.problem.ground_albedo = 0.4;
  return c;
}

void compare(Case c, const std::vector<Flux>& fluxes, const std::vector<View>& views) {
  for (size_t l = 0; l < c.layers.size(); ++l) c.layers[l].moments = c.moments[l];
  c.problem.layers = c.layers;
  c.problem.azimuth_tolerance = 0;
  DiscreteOrdinates solver(16);
  solver.solve(c.problem);
  for (const Flux& f : fluxes) {
    const DiffuseFluxes ours = solver.fluxes(c.places[f.place]);
    EXPECT_NEAR(ours.direct, f.direct, 1e-9);
    EXPECT_NEAR(ours.down, f.down, 1e-9);
    EXPECT_NEAR(ours.up, f.up, 1e-9);
  }
  const double azimuths[3] = {0, 1, 3};
  for (const View& v : views)
    for (int a = 0; a < 3; ++a) {
      std::vector<double> phase;
      for (const auto& chi : c.moments) {
        std::vector<double> cut = chi;
        cut.resize(16);
        for (double& x : cut) x -= chi.size() > 16 ? chi[16] : 0;
        phase.push_back(phase_of(cut, scattering_cosine(c.problem.beam.cosine, v.mu, azimuths[a])));
      }
      EXPECT_NEAR(solver.radiance(c.places[v.place], v.mu, azimuths[a], phase), v.value[a], 2e-8 * v.value[a]) << v.mu;
    }
}

TEST(OrdinateReference, ThreeLayersWithEverySource) { compare(mixed(), kMixedFluxes, kMixedViews); }
TEST(OrdinateReference, ColumnUnderALowSun) { compare(column(), kColumnFluxes, kColumnViews); }

// Molecules and haze over a Lambert ground of 0.3, 20 views under each of two suns: rows of mu = 0.15, 0.3, 0.5, 0.75,
// 1, columns of azimuth 0, 60, 120, 180 degrees. The reference has sources linear between the faces of layers of 2 km;
// it differs by up to 0.35 %.
TEST(OrdinateReference, TwentyViewsUnderTwoSuns) {
  const double reference[2][5][4] = {{{0.101131, 0.0905459, 0.0949568, 0.108973},
                                      {0.0868031, 0.0805524, 0.0869134, 0.0985644},
                                      {0.0745985, 0.0729903, 0.0809339, 0.0900632},
                                      {0.0677982, 0.0691884, 0.076583, 0.0825006},
                                      {0.071255, 0.071255, 0.071255, 0.071255}},
                                     {{0.107847, 0.0741065, 0.0756192, 0.101081},
                                      {0.0820127, 0.0583016, 0.0602739, 0.0780136},
                                      {0.0566273, 0.0450838, 0.048082, 0.0595312},
                                      {0.0388075, 0.0355796, 0.0387722, 0.0446138},
                                      {0.0313222, 0.0313222, 0.0313222, 0.0313222}}};
  const double suns[2] = {0.8, 0.35}, cosines[5] = {0.15, 0.3, 0.5, 0.75, 1};
  double worst = 0, wrong = 0;
  for (int s = 0; s < 2; ++s) {
    Case c = column();
    c.problem.beam.cosine = suns[s];
    c.problem.ground_albedo = 0.3;
    for (size_t l = 0; l < c.layers.size(); ++l) {
      // The column's moments end where 16 streams do; here the whole forward peak.
      const double molecules = c.moments[l][2] - std::pow(0.7, 2), haze = 0.1 - std::pow(0.7, 2);
      const double share = molecules / haze;  // of what molecules scatter
      for (int i = 17; i < 64; ++i) c.moments[l].push_back((1 - share) * std::pow(0.7, i));
      c.layers[l].moments = c.moments[l];
    }
    c.problem.layers = c.layers;
    DiscreteOrdinates solver(16);
    solver.solve(c.problem);
    for (int i = 0; i < 5; ++i)
      for (int a = 0; a < 4; ++a) {
        std::vector<double> phase;
        for (const auto& chi : c.moments)
          phase.push_back(phase_of(chi, scattering_cosine(suns[s], cosines[i], a * kPi / 3)));
        const double ours = solver.radiance({0, 0}, cosines[i], a * kPi / 3, phase);
        worst = std::max(worst, std::fabs(ours / reference[s][i][a] - 1));
        wrong = std::max(wrong, std::fabs(ours / (1.02 * reference[s][i][a]) - 1));
      }
  }
  EXPECT_LT(worst, 0.005);
  EXPECT_GT(wrong, 0.01) << "references 2 % off must fail";
}

}  // namespace
}  // namespace suite::test::ordinate_reference_test
