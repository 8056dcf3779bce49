// Media: from hardly there to opaque, many scatterings, peaks straight on and straight back, cameras inside.
#include <array>
#include <cmath>

#include "extreme/case.h"
#include "spectral/planck.h"
#include "tests/support/media_kit.h"

namespace suite::extreme {

namespace {

using namespace suite::test;

double seen(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, const Ray& ray, uint32_t paths,
            PipelineOptions options = {}, double* cut = nullptr) {
  const auto run =
      render(scene, sources, std::make_unique<RaySensor>(std::vector<Ray>(16, ray), one_band(), paths), options);
  double mean = 0;
  for (const double L : run.result.radiance) mean += L / 16;
  if (cut) *cut = run.report.statistics.truncated / static_cast<double>(run.report.statistics.paths);
  return run.report.statistics.failures ? std::nan("") : mean;
}
SourceSpecs field(double radiance, bool full) {
  SourceSpecs sources;
  sources.add(uniform_sky(radiance, full));
  return sources;
}
const Ray kDown{{0.1, 0.2, 3}, {0, 0, -1}, 0};

// What a warm gas of this optical depth shows before nothing, relative to (1 - exp(-tau)) B(T).
double glow(double tau) {
  Medium gas = medium(Curve::constant(tau), Curve::constant(0));
  gas.temperature_k = 300;
  const auto run = render(
      slab_scene(gas, 1), {},
      std::make_unique<RaySensor>(std::vector<Ray>{kDown}, std::vector<Band>{Band::rectangular("b", 10, 1)}, 2, 0.1));
  return std::fabs(run.result.radiance[0] / (-std::expm1(-tau) * planck_band_radiance(9.5, 10.5, 300)) - 1);
}
double behind(double tau) {
  return std::fabs(seen(slab_scene(medium(Curve::constant(tau), Curve::constant(0)), 1), field(1, true), kDown, 2) -
                   std::exp(-tau));
}

// Radiance seen at a cosine in a slab of isotropic scattering under a uniform hemisphere of radiance 1: its albedo for
// a beam from there. Doubling of layers with matrices over the 24 cosines of two Gauss rules; starts at depth / 2^40
// with single scattering. Based on: H. C. van de Hulst, "Multiple light scattering", 1980, chapter 4.
struct Doubling {
  static constexpr int n = 24;
  using Matrix = std::array<double, n * n>;
  std::array<double, n> mu, weight;

  Doubling() {  // Gauss-Legendre on (0, 1) by Newton's method
    for (int i = 0; i < n; ++i) {
      double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 0;
      for (int k = 0; k < 50; ++k) {
        double p0 = 1, p1 = x;
        for (int j = 2; j <= n; ++j) {
          const double p2 = ((2 * j - 1) * x * p1 - (j - 1) * p0) / j;
          p0 = p1, p1 = p2;
        }
        slope = n * (x * p1 - p0) / (x * x - 1);
        x -= p1 / slope;
      }
      mu[static_cast<size_t>(i)] = 0.5 * (1 + x);
      weight[static_cast<size_t>(i)] = 1 / ((1 - x * x) * slope * slope);
    }
  }
  static Matrix times(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (size_t i = 0; i < n; ++i)
      for (size_t k = 0; k < n; ++k)
        for (size_t j = 0; j < n; ++j) c[i * n + j] += a[i * n + k] * b[k * n + j];
    return c;
  }
  // (1 - A)^-1 B by elimination with pivots on the diagonal (A has a spectral radius below 1).
  static Matrix solve(Matrix a, Matrix b) {
    for (size_t i = 0; i < n * n; ++i) a[i] = (i % (n + 1) == 0 ? 1.0 : 0.0) - a[i];
    for (size_t k = 0; k < n; ++k)
      for (size_t i = 0; i < n; ++i) {
        if (i == k) continue;
        const double f = a[i * n + k] / a[k * n + k];
        for (size_t j = k; j < n; ++j) a[i * n + j] -= f * a[k * n + j];
        for (size_t j = 0; j < n; ++j) b[i * n + j] -= f * b[k * n + j];
      }
    for (size_t i = 0; i < n; ++i)
      for (size_t j = 0; j < n; ++j) b[i * n + j] /= a[i * n + i];
    return b;
  }
  // Operators act on radiances at the cosines. Albedos of the beams at all of them.
  std::array<double, n> albedos(double depth, double w) const {
    constexpr int doublings = 40;
    const double d = std::ldexp(depth, -doublings);
    Matrix R{}, T{};
    for (size_t i = 0; i < n; ++i)
      for (size_t j = 0; j < n; ++j) R[i * n + j] = T[i * n + j] = 0.5 * w * d / mu[i] * weight[j];
    for (size_t i = 0; i < n; ++i) T[i * n + i] += 1 - d / mu[i];
    for (int k = 0; k < doublings; ++k) {
      const Matrix inner = solve(times(R, R), T);  // between the two layers, downwards
      const Matrix back = times(T, times(R, inner)), through = times(T, inner);
      for (size_t i = 0; i < n * n; ++i) R[i] += back[i];
      T = through;
    }
    std::array<double, n> a{};
    for (size_t i = 0; i < n; ++i)
      for (size_t j = 0; j < n; ++j) a[i] += R[i * n + j];
    return a;
  }
};

double against_doubling(double depth) {
  const double lost = 1e-7;
  const Doubling doubling;
  const size_t i = Doubling::n / 3;
  const double mu = doubling.mu[i], expected = doubling.albedos(depth, 1 - lost)[i];
  PipelineOptions options;
  options.max_scatterings = 1000000;
  const double got = seen(slab_scene(medium(Curve::constant(lost * depth), Curve::constant((1 - lost) * depth)), 1),
                          field(1, false), {{0, 0, 2}, {std::sqrt(1 - mu * mu), 0, -mu}, 0}, 1 << 11, options);
  return std::fabs(got - expected);
}

// What is missing of a uniform field behind a conservative ball of optical radius 5, cut paths accounted for.
double white_ball(double g) {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0), Curve::constant(5), hg(g))};
  scene->materials = {boundary(0)};
  place(*scene, PrimitiveKind::sphere, {1}, 0);
  check_scene(*scene, "ball");
  double cut = 0;
  const double L = seen(scene, field(1, true), kDown, 64, {}, &cut);
  return std::fabs(L + cut - 1);
}

// From inside an absorbing sphere, so many optical depths from its side.
double inside(double tau) {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(tau), Curve::constant(0))};
  scene->materials = {boundary(0)};
  place(*scene, PrimitiveKind::sphere, {1}, 0);
  check_scene(*scene, "ball");
  return std::fabs(seen(scene, field(1, true), {{0, 0, 0}, {0.6, 0, 0.8}, 0}, 2) / std::exp(-tau) - 1);
}

// A ray through 1 m of gas in cells of this thickness.
double thin_cells(double thickness) {
  const auto count = static_cast<uint32_t>(std::lround(1 / thickness));
  const Affine3 cells = translation({-5, -5, 0}) * scaling({10, 10, 1.0 / count});
  const auto scene = scene_with(medium(Curve::constant(1), Curve::constant(0)),
                                grid_of({1, 1, count}, cells, [](auto...) { return 1; }));
  return std::fabs(seen(scene, field(1, true), kDown, 2) / std::exp(-1.0) - 1);
}

}  // namespace

static std::vector<Case> layers() {
  using N = const Numerics&;
  return {
      {"medium",
       "glow of a gas of optical depth 1e-6",
       "closed form 1 - exp(-tau)",
       "1",
       1e-5,
       [](N, double x) { return glow(x); },
       {"optical depth", "1", 1e-6, 1e-30, 100},
       {}},
      {"medium",
       "transmittance at optical depth 1",
       "closed form exp(-tau)",
       "1",
       1e-6,
       [](N, double x) { return behind(x); },
       {"optical depth", "1", 1, 1e-12, 100},
       {}},
      {"medium",
       "transmittance at optical depth 1e6",
       "closed form 0",
       "1",
       1e-37,
       [](N, double x) { return behind(x); },
       {"optical depth", "1", 1e6, 1e30, 1e4},
       {}},
      {"medium",
       "multiple scattering, depth 64, albedo 1 - 1e-7",
       "doubling of layers, 24 streams",
       "1",
       2e-3,
       [](N, double x) { return against_doubling(x); },
       {"optical depth", "1", 64, 1024, 4},
       {}},
  };
}

static std::vector<Case> bodies() {
  using N = const Numerics&;
  return {
      {"medium",
       "conservative ball, g = 0.9999",
       "closed form 1",
       "1",
       1e-4,
       [](N, double x) { return white_ball(1 - x); },
       {"1 - g", "1", 1e-4, 1e-4, 10},
       {}},
      {"medium",
       "conservative ball, g = -0.9999",
       "closed form 1",
       "1",
       1e-4,
       [](N, double x) { return white_ball(x - 1); },
       {"1 + g", "1", 1e-4, 1e-4, 10},
       {}},
      {"medium",
       "camera inside a medium",
       "closed form exp(-tau)",
       "1",
       1e-5,
       [](N, double x) { return inside(x); },
       {"optical depth", "1", 2, 64, 2},
       {}},
      {"medium",
       "voxels of 1 mm, 10 m wide",
       "closed form exp(-1)",
       "1",
       1e-5,
       [](N, double x) { return thin_cells(x); },
       {"thickness", "m", 1e-3, 1e-6, 10},
       {}},
  };
}

std::vector<Case> media_cases() {
  std::vector<Case> all = layers();
  for (Case& c : bodies()) all.push_back(std::move(c));
  return all;
}

}  // namespace suite::extreme
