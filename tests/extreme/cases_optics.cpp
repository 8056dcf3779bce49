// Phase functions at their limits, Fresnel, furnaces of every model, Ward at grazing, quad-trees of hard inputs.
#include <cfloat>
#include <cmath>

#include "base/error.h"
#include "extreme/case.h"
#include "math/sampling.h"
#include "math/stats.h"
#include "optics/fresnel.h"
#include "optics/phase_function.h"
#include "spectral/planck.h"
#include "sqt_fit/fit.h"
#include "sqt_fit/scattered.h"
#include "support/model_examples.h"
#include "support/sqt_examples.h"
#include "tests/support/radiometry_kit.h"

namespace suite::extreme {

namespace {

using namespace suite::test;

// One bin, so that a model's first value is its only one.
constexpr double kStep = 0.02;
SpectralState one_state() {
  const SpectralState state = make_state(one_band(), kStep);
  SUITE_CHECK_EQ(state.size(), size_t{1});
  return state;
}

// ---- Henyey-Greenstein ----
std::unique_ptr<const PhaseFunction> henyey(double g) {
  ModelSpec spec{"hg", {}, {{"g", Curve::constant(g)}}, {}, nullptr};
  return bake_phase(spec, one_state());
}
// x = 1 - abs(g).
Case henyey_mean(double sign) {
  return {"phase function",
          sign > 0 ? "mean cosine of draws, g = 0.9999" : "mean cosine of draws, g = -0.9999",
          "closed form: g",
          "1 - abs(g)",
          0.02,
          [sign](const Numerics&, double x) {
            const double g = sign * static_cast<float>(1 - x);
            const auto p = henyey(g);
            double sum = 0;
            const int n = 1 << 16;
            for (int i = 0; i < n; ++i) sum += 1 - sign * p->sample((i + 0.5) / n, 0);
            return std::fabs(sum / n / (1 - std::fabs(g)) - 1);
          },
          {"1 - abs(g)", "1", 1e-4, 1, 10},
          {}};
}
Case henyey_mass(double g) {
  return {"phase function",
          strf("density of draws integrates to 1, g = %g", g),
          "closed form",
          "1",
          1e-4,
          [](const Numerics&, double value) {
            const auto p = henyey(value);
            // Bins equal in the logarithm of the distance from the lobe's end.
            double mass = 0;
            const int n = 20000;
            const double near = 1e-14, ratio = std::pow(2 / near, 1.0 / n);
            float f = 0;
            for (int i = 0; i < n; ++i) {
              const double a = near * std::pow(ratio, i), b = a * ratio, middle = std::sqrt(a * b);
              p->eval(value > 0 ? 1 - middle : middle - 1, {&f, 1});
              mass += 2 * kPi * f * (b - a);
            }
            return std::fabs(mass - 1);
          },
          {"g", "1", g, g, 2},
          {}};
}

// ---- Furnaces ----
// A flat piece of every example of a model in a uniform field: how far the radiance it returns is from W(out) L0,
// relative, beyond four standard errors.
double furnace(const ModelRow& row, double zenith) {
  double worst = 0;
  const SpectralState state = one_state();
  for (const ModelSpec& spec : test::examples_of(row)) {
    const auto scene = scene_of({quad(1, 0, 0)}, {material("m", spec)});
    SourceSpecs sources;
    sources.add(uniform_sky(2, true));
    const Dir out = dir_from_angles(zenith, 0.7);
    const auto run =
        render(scene, sources,
               std::make_unique<RaySensor>(std::vector<Ray>{{out * 10.0, -out, 0}}, one_band(), 1 << 13, kStep));
    const auto model = bake(scene->materials[0].surface, state);
    std::vector<float> W(state.size());
    model->total(out, W);
    const double expected = 2.0 * static_cast<double>(W[0]);
    const double beyond = std::fabs(run.result.radiance[0] - expected) - 4 * run.result.standard_error[0];
    if (run.result.standard_error[0] > 0.02 * expected + 1e-4) return INFINITY;  // too noisy to mean anything
    worst = std::fmax(worst, beyond / std::fmax(expected, 1e-3));
  }
  return worst;
}

// A closed isothermal box of emissivity e: B(T) short of (1 - e)^nodes.
double closed_box(double emissivity, int nodes, double kelvin) {
  Material wall = material("wall", lambert(1 - emissivity));
  wall.temperature_k = kelvin;
  const auto scene = scene_of({box({-1, -1, -1}, {1, 1, 1}, 0, false)}, {wall});
  PipelineOptions options;
  options.max_nodes = nodes;
  options.roulette_after = 1000;
  const auto run = render(scene, {},
                          std::make_unique<RaySensor>(std::vector<Ray>{{{0.1, 0.2, -0.3}, dir_from_angles(0.9, 2), 0}},
                                                      std::vector<Band>{Band::rectangular("lwir", 10, 1)}, 256, 0.1),
                          options);
  const double expected = planck_band_radiance(9.5, 10.5, kelvin) * (1 - std::pow(1 - emissivity, nodes));
  const double truncated = run.report.statistics.truncated / static_cast<double>(run.report.statistics.paths);
  return std::fmax(std::fabs(run.result.radiance[0] / expected - 1),
                   std::fabs(truncated - std::pow(1 - emissivity, nodes)));
}

// ---- Ward at grazing incidence: mean of w / pdf of its draws against W, and W within 0..1. ----
double ward_total(double roughness, double zenith_deg) {
  ModelSpec spec{"ward", {{"roughness", roughness}}, {{"specular", Curve::constant(1)}}, {}, nullptr};
  check_model(spec);
  const auto model = bake(spec, one_state());
  const Dir out = dir_from_angles(zenith_deg * kDegree, 0.4);
  std::vector<float> W(1), w(1), p;
  const SpectralState state = one_state();
  p.resize(state.knots.size());
  model->total(out, W);
  if (!(W[0] >= 0 && W[0] <= 1.0001f)) return INFINITY;
  const int n = 1 << 16;
  const SampleStream stream(1, 2, 3);
  double sum = 0;
  for (uint32_t i = 0; i < static_cast<uint32_t>(n); ++i) {
    const auto u = stream.draw(i, 0);
    const auto s = model->sample(out, {u[0], u[1]}, u[2], 0);
    if (!s) continue;
    model->eval(out, s->in, w);
    model->pdf(out, s->in, p);
    if (!(p[0] > 0) || !std::isfinite(w[0])) return INFINITY;
    sum += static_cast<double>(w[0]) / static_cast<double>(p[0]);
  }
  return std::fabs(sum / n - static_cast<double>(W[0])) / std::fmax(1e-3, static_cast<double>(W[0]));
}

// ---- Quad-trees ----
double lost_total(const sqt::Bundle& b, double expected) {
  double worst = 0;
  for (const double theta : {0.0, 0.5, 1.2, 1.5})
    worst = std::fmax(worst, std::fabs(b.total(dir_from_angles(theta, 1), 0) - expected));
  return worst;
}
// Mean of w / pdf of draws against the total, at a view.
double sqt_draws(const sqt::Bundle& b, double theta) {
  const Dir out = dir_from_angles(theta, 0.3);
  const double W = b.total(out, 0);
  Pcg32 rng(11);
  RunningStats s;
  for (int i = 0; i < 100000; ++i) {
    const auto in = b.sample(out, {rng.uniform(), rng.uniform()}, rng.uniform(), 0);
    if (in && !(b.pdf(out, *in, 0) > 0)) return INFINITY;
    s.add(in ? b.eval(out, *in, 0) / b.pdf(out, *in, 0) : 0);
  }
  return std::fabs(s.mean() - W) / W;
}

}  // namespace

static void add_phase_and_fresnel(std::vector<Case>& c) {
  c.push_back(henyey_mean(1));
  c.push_back(henyey_mean(-1));
  c.push_back(henyey_mass(0.9999));
  c.push_back(henyey_mass(-0.9999));
  c.push_back({"Fresnel",
               "index ratio 1 + 1e-6, normal incidence",
               "closed form ((n-1)/(n+1))^2",
               "1",
               1e-12,
               [](const Numerics&, double x) {
                 const double eta = 1 + x, excess = eta - 1;  // what x is after rounding
                 return std::fabs(fresnel_dielectric(1, eta).reflectance / std::pow(excess / (eta + 1), 2) - 1);
               },
               {"index ratio - 1", "1", 1e-6, 1e-15, 10},
               {}});
  c.push_back({"Fresnel",
               "glass 1e-6 short of grazing, transmittance",
               "long double",
               "1",
               1e-12,
               [](const Numerics&, double x) {
                 const long double ci = x, eta = 1.5L, q = std::sqrt(eta * eta - 1 + ci * ci);
                 const long double t = 0.5L * (4 * ci * q / ((ci + q) * (ci + q)) +
                                               4 * eta * eta * ci * q / ((eta * eta * ci + q) * (eta * eta * ci + q)));
                 return static_cast<double>(std::fabs(fresnel_dielectric(x, 1.5).transmittance / t - 1));
               },
               {"cosine of incidence", "1", 1e-6, 1e-150, 10},
               {}});
}

static void add_furnaces(std::vector<Case>& c) {
  for (const ModelRow& row : models())
    c.push_back({"open furnace",
                 row.name + ": convex body returns W(out) L0",
                 "closed form, beyond 4 standard errors",
                 "1",
                 1e-3,
                 [&row](const Numerics&, double zenith_deg) { return furnace(row, zenith_deg * kDegree); },
                 {"view zenith", "deg", 40, 88, 1.25},
                 {}});
  c.push_back({"closed furnace",
               "emissivity 1 (one node is enough)",
               "closed form B(T)",
               "1",
               1e-5,
               [](const Numerics&, double T) { return closed_box(1, 1, T); },
               {"temperature", "K", 300, 1e4, 2},
               {}});
  c.push_back({"closed furnace",
               "emissivity 0.3 at 300 K, 24 nodes",
               "closed form B(T) (1 - (1-e)^nodes)",
               "1",
               1e-5,
               [](const Numerics&, double T) { return closed_box(0.3, 24, T); },
               {"temperature", "K", 300, 1e4, 2},
               {}});
  c.push_back({"closed furnace",
               "emissivity 0.01, 64 nodes: the cut is reported",
               "closed form B(T) (1 - (1-e)^nodes)",
               "1",
               1e-5,
               [](const Numerics&, double e) { return closed_box(e, 64, 300); },
               {"emissivity", "1", 0.01, 1e-4, 10},
               {}});
}

static void add_grazing(std::vector<Case>& c) {
  for (const double roughness : {1e-4, 1e-2, 0.3, 1.0})
    c.push_back({"Ward",
                 strf("roughness %g at 89.9 deg: draws against W, W <= 1", roughness),
                 "identity E[w/pdf] = W",
                 "1",
                 5e-3,
                 [roughness](const Numerics&, double grazing) { return ward_total(roughness, 90 - grazing); },
                 {"angle above the horizon", "deg", 0.1, 1e-6, 10},
                 {}});
  c.push_back({"views",
               "0 deg exactly: every model is finite, W <= 1 on the side without glass",
               "invariant",
               "1",
               0,
               [](const Numerics&, double) {
                 double faults = 0;
                 const SpectralState state = one_state();
                 std::vector<float> W(state.size());
                 for (const ModelRow& row : models())
                   for (const ModelSpec& spec : test::examples_of(row)) {
                     const auto m = bake(material("m", spec).surface, state);
                     m->total({0, 0, 1}, W);
                     faults += !(W[0] >= 0 && W[0] <= 1.001f);
                   }
                 return faults;
               },
               {},
               {}});
  c.push_back({"views",
               "90 deg exactly: every model gives zero and no draw",
               "convention",
               "1",
               0,
               [](const Numerics&, double) {
                 double faults = 0;
                 const SpectralState state = one_state();
                 std::vector<float> w(state.size());
                 for (const ModelRow& row : models())
                   for (const ModelSpec& spec : test::examples_of(row)) {
                     const auto m = bake(material("m", spec).surface, state);
                     m->eval({1, 0, 0}, {0, 0, 1}, w);
                     faults += w[0] != 0 || m->sample({1, 0, 0}, {0.3, 0.6}, 0.5, 0).has_value();
                   }
                 return faults;
               },
               {},
               {}});
}

static void add_trees(std::vector<Case>& c) {
  c.push_back({"SQT",
               "constant 0.5 / pi: total 0.5",
               "closed form",
               "1",
               2e-3,
               [](const Numerics&, double) {
                 return lost_total(*sqt::make_bundle(small_fit(Analytic([](Dir, Dir) { return 0.5 / kPi; })).data),
                                   0.5);
               },
               {},
               {}});
  c.push_back({"SQT",
               "zero scatters nothing",
               "closed form",
               "1",
               0,
               [](const Numerics&, double) {
                 return lost_total(*sqt::make_bundle(small_fit(Analytic([](Dir, Dir) { return 0.0; })).data), 0);
               },
               {},
               {}});
  c.push_back({"SQT",
               "one sample only: its value is kept",
               "the sample",
               "1/sr",
               1e-3,
               [](const Numerics&, double) {
                 sqt::Samples s;
                 s.info.wavelength_um = {0.55};
                 s.out = {{0, 0, 1}};
                 s.in = {dir_from_angles(0.4, 0)};
                 s.value = {0.1};
                 const auto f = sqt::interpolate(s);
                 return std::fabs(sqt::make_bundle(small_fit(*f).data)->value(s.out[0], s.in[0], 0) - 0.1);
               },
               {},
               {}});
  c.push_back({"SQT",
               "cells cut by the horizon: draws against W at 85 deg",
               "identity E[w/pdf] = W",
               "1",
               0.02,
               [](const Numerics&, double theta_deg) {
                 return sqt_draws(*sqt::make_bundle(small_fit(glossy(0.3, 1)).data), theta_deg * kDegree);
               },
               {"view zenith", "deg", 85, 89.9, 1.01},
               {}});
}

static void add_sampled_trees(std::vector<Case>& c) {
  c.push_back({"SQT",
               "lobe of width 0.02 (near a delta): draws against W",
               "identity E[w/pdf] = W",
               "1",
               0.02,
               [](const Numerics&, double width) {
                 sqt::AlignedSource::Options options = small_options();
                 options.base_order = 6;
                 options.max_order = 10;
                 const Analytic f([width](Dir out, Dir in) { return 0.3 * glossy_value(out, in, width); });
                 return sqt_draws(*sqt::make_bundle(sqt::encode_aligned(sqt::AlignedSource(f, options), 0.1).data),
                                  0.6);
               },
               {"width", "1", 0.02, 0.002, 3},
               {}});
}

std::vector<Case> optics_cases() {
  std::vector<Case> c;
  add_phase_and_fresnel(c);
  add_furnaces(c);
  add_grazing(c);
  add_trees(c);
  add_sampled_trees(c);
  return c;
}

}  // namespace suite::extreme
