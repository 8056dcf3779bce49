// Polarised light at interfaces and in frames: near Brewster's angle, at grazing incidence, between media that hardly
// differ, on metals, after many reflections, near the zenith, straight back, towards the sun.
#include <algorithm>
#include <cmath>
#include <complex>

#include "extreme/case.h"
#include "optics/fresnel_mueller.h"
#include "tests/support/conformance.h"
#include "tests/support/stokes_kit.h"

namespace suite::extreme {

namespace {

using Long = long double;
using Amplitude = std::complex<Long>;

struct Amplitudes {
  Amplitude s, p;
};

// Fresnel's amplitudes with 64 bits of mantissa; the cosine as it is stored.
Amplitudes reflected(double cos_incident, std::complex<double> index) {
  const Long c = cos_incident;
  const Amplitude n2 = Amplitude(index) * Amplitude(index);
  Amplitude q = std::sqrt(n2 - (1 - c * c));
  if (q.imag() < 0) q = -q;
  return {(c - q) / (c + q), (n2 * c - q) / (n2 * c + q)};
}

// Near Brewster's angle hardly any light of the plane of incidence is reflected: its share of that across, off the
// share by amplitudes, over the reflectance across. The difference of both is what a matrix holds.
double off_brewster(double away) {
  const double index = 1.5, c = std::cos(std::atan(index) + away);
  const PlaneBlocks m = fresnel_reflection(c, index);
  const Amplitudes exact = reflected(c, index);
  return static_cast<double>(std::fabs((m.a + m.b) - std::norm(exact.p)) / std::norm(exact.s));
}

// What passes at grazing incidence, as a share of itself.
double off_grazing(double c) {
  const double index = 1.5;
  const PlaneBlocks m = fresnel_transmission(c, index);
  const Long n2 = Long(index) * index, q = std::sqrt(n2 - 1 + Long(c) * c);
  const Long s = 4 * c * q / ((c + q) * (c + q)), p = 4 * n2 * c * q / ((n2 * c + q) * (n2 * c + q));
  return static_cast<double>(std::max(std::fabs((m.a - m.b) / s - 1), std::fabs((m.a + m.b) / p - 1)));
}

// Reflectance across the plane at 45 degrees between media that hardly differ, as a share of itself.
double off_no_step(double step) {
  const double c = std::sqrt(0.5), index = 1 + step;
  const PlaneBlocks m = fresnel_reflection(c, index);
  return static_cast<double>(std::fabs((m.a - m.b) / std::norm(reflected(c, index).s) - 1));
}

// What an interface of index 1 reflects.
double off_no_interface(double c) { return fresnel_reflection(c, 1).a; }

// All elements of a metal's matrix at 70 degrees; they are at most 1.
double off_metal(double k) {
  const double c = std::cos(70 * kDegree);
  const std::complex<double> index(0.5, k);
  const PlaneBlocks m = fresnel_reflection(c, index);
  const Amplitudes e = reflected(c, index);
  const Amplitude x = e.p * std::conj(e.s);
  const Long found[] = {m.a - (std::norm(e.p) + std::norm(e.s)) / 2, m.b - (std::norm(e.p) - std::norm(e.s)) / 2,
                        m.c - x.real(), m.d - x.imag()};
  Long worst = 0;
  for (const Long v : found) worst = std::max(worst, std::fabs(v));
  return static_cast<double>(worst);
}

// Light at 45 degrees after n total reflections in one plane: its V against the sum of the phases.
double off_rhombs(double n) {
  const double index = 1 / 1.51, c = std::cos(54.6 * kDegree);
  const Mueller one = fresnel_reflection(c, index).matrix();
  Stokes light{1, 0, 1, 0};
  for (int i = 0; i < static_cast<int>(n); ++i) light = one * light;
  const Amplitudes e = reflected(c, index);
  const Long phase = std::arg(e.p * std::conj(e.s)) * std::floor(Long(n));
  return static_cast<double>(
      std::max(std::fabs(std::fabs(light[3]) - std::fabs(std::sin(phase))), std::fabs(light[2] - std::cos(phase))));
}

// Two polarizers across each other pass their leak, however small.
double off_crossed(double leak) {
  const Mueller both = polarizer(0.3 + kPi / 2, leak) * polarizer(0.3, leak);
  return std::fabs(both(0, 0) / leak - 1);
}

// A frame near the zenith: at right angles to the light, of unit length, right-handed.
double off_frame(double from_zenith) {
  const Dir k(std::sin(from_zenith) * std::cos(1.1), std::sin(from_zenith) * std::sin(1.1), std::cos(from_zenith));
  const PolarFrame f = meridian_frame(k);
  const Vec3 third = cross(f.e1, f.e2);
  return std::max({std::fabs(dot(f.e1, k)), std::fabs(dot(f.e2, k)), std::fabs(dot(f.e1, f.e2)),
                   std::fabs(length(f.e1) - 1), std::fabs(dot(third, k) - 1)});
}

// Frames of two directions that are nearly one, turned there and back.
double off_turned_back(double apart) {
  const Dir k(std::sin(0.7 + apart), 0, std::cos(0.7 + apart));
  const PolarFrame a = meridian_frame(k);
  const Vec3 aside = a.e1 * std::cos(apart) + a.e2 * std::sin(apart);
  const PolarFrame b{aside, cross(Vec3(k.x, k.y, k.z), aside)};
  const Mueller m = frame_rotation(b, a.e1) * frame_rotation(a, b.e1);
  double worst = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) worst = std::max(worst, std::fabs(m(i, j) - (i == j ? 1 : 0)));
  return worst;
}

// Q/I of what a metal emits at 85 degrees: 1 - R is small there.
double off_emission(double k) {
  const double c = std::cos(85 * kDegree);
  const std::complex<double> index(25.3, k);
  const PlaneBlocks m = fresnel_reflection(c, index);
  const Amplitudes e = reflected(c, index);
  const Long s = std::norm(e.s), p = std::norm(e.p), exact = (s - p) / 2 / (1 - (s + p) / 2);
  return static_cast<double>(std::fabs(-m.b / (1 - m.a) / exact - 1));
}

// The same of water and of metals in bands of the visible and the infrared (tests/data/polarisation). Aluminium at 10
// um: 0.984.
double off_emission_of_bands(double) {
  const std::complex<double> water(1.218, 0.0508), gold(0.18377, 3.4313), aluminium(1.391, 7.65), infrared(25.3, 90);
  const double c = std::cos(85 * kDegree);
  double worst = 0;
  for (const auto& index : {water, gold, aluminium, infrared}) {
    const PlaneBlocks m = fresnel_reflection(c, index);
    const Amplitudes e = reflected(c, index);
    const Long s = std::norm(e.s), p = std::norm(e.p), exact = (s - p) / (2 - s - p);
    worst = std::max(worst, static_cast<double>(std::fabs(-m.b / (1 - m.a) / exact - 1)));
    if (index == infrared && std::fabs(exact - 0.984) > 5e-4) return NAN;
  }
  return worst;
}

// Facets whose index straddles Brewster's angle over the bands: U changes its sign there, and each band has its own.
double off_bands_about_brewster(double) {
  const SpectralState state = test::test_state(1);
  const Curve index({0.4, 2}, {1.2, 2.6}, Outside::hold);
  const ModelSpec spec{"priest_germer",
                       {{"sigma", 0.2}},
                       {{"index", index}, {"absorption", Curve::constant(0)}, {"diffuse", Curve::constant(0)}},
                       {},
                       nullptr};
  const auto model = bake(spec, state);
  std::vector<Mueller> m(state.size());
  const double angle = 58 * kDegree;
  if (model->mueller(dir_from_angles(angle, 0), dir_from_angles(angle, kPi), m).grey) return NAN;
  double worst = 0, least = 1, most = -1;
  const std::vector<float> n = state.sample(index);
  for (size_t b = 0; b < m.size(); ++b) {
    const Amplitudes e = reflected(std::cos(angle), double{n[b]});
    const Long I = (std::norm(e.p) + std::norm(e.s)) / 2, U = (e.p * std::conj(e.s)).real() / I;
    worst = std::max(worst, static_cast<double>(std::fabs(m[b](2, 2) / m[b](0, 0) - U)));
    least = std::min(least, m[b](2, 2)), most = std::max(most, m[b](2, 2));
  }
  return least < 0 && most > 0 ? worst : NAN;
}

// The matrix of a facet that sends light nearly back where it came from: beyond four times the angle off its limit,
// which is a mirror's at normal incidence.
double off_retro(double angle) {
  const Dir out = dir_from_angles(40 * kDegree, 0.3), in = dir_from_angles(40 * kDegree + angle, 0.3 + 0.4 * angle);
  const PlaneBlocks b = fresnel_reflection(std::clamp(dot(out, normalized(out + in)), 0.0, 1.0), {1.5, 2});
  const Mueller m = ScatteringPlane(out, in).matrix(b * (1 / b.a));
  double worst = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) worst = std::max(worst, std::fabs(m(i, j) - (i != j ? 0 : i < 2 ? 1 : -1)));
  return std::isfinite(worst) ? std::max(0.0, worst - 4 * angle) : worst;
}

// Exactly up, exactly down, exactly back.
double off_upright(double) { return std::max({off_frame(0), off_frame(kPi), off_retro(0)}); }

// What a matte surface sends on of light of a degree of polarisation: its own degree.
double off_matte(double degree) {
  const SpectralState state = test::test_state(1);
  ModelSpec spec = test::lambert(0.4);
  check_model(spec);
  const auto model = bake(spec, state);
  std::vector<Mueller> m(state.size());
  model->mueller(dir_from_angles(0.3, 0), dir_from_angles(1.1, 2), m);
  const Stokes seen = m[0] * Stokes{1, degree * std::cos(1.3), degree * std::sin(1.3), 0};
  return std::hypot(seen[1], seen[2], seen[3]);
}

std::vector<test::StokesSeen> below_molecules(double depth, const Ray& ray, uint32_t paths, size_t rays,
                                              StokesFrame frame) {
  const ModelSpec rayleigh{"rayleigh", {{"depolarisation", 0.0279}}, {}, {}, nullptr};
  const auto scene = test::slab_scene(test::medium(Curve::constant(0), Curve::constant(depth), rayleigh), 1);
  SourceSpecs sources;
  sources.add(SunSpec{{dir_from_angles(60 * kDegree, 0.6), 0, Curve::constant(1)}});
  Polarimetry how;
  how.frame = frame;
  return test::see_stokes(scene, sources, std::vector<Ray>(rays, ray), paths, how);
}
// The degree in the frame of the plane of the sun beside that in the meridian frame, near the sun.
double off_in_the_plane_of_the_sun(double away) {
  const Ray up{{0.1, 0.2, -1}, dir_from_angles(60 * kDegree + away, 0.6), 0};
  const auto one = below_molecules(0.5, up, 64, 1, StokesFrame::scattering_plane),
             other = below_molecules(0.5, up, 64, 1, StokesFrame::meridian);
  return std::fabs(one[0].dolp() - other[0].dolp());
}

// Straight up below a cloud of molecules, where many scatterings leave no direction but the vertical: Q and U are 0,
// and the rays tell how they scatter beside the errors that are reported. The larger of Q and U over its error.
constexpr size_t kCloudRays = 16;
std::vector<test::StokesSeen> below_cloud(double depth) {
  return below_molecules(depth, {{0.1, 0.2, -1}, Dir(0, 0, 1), 0}, 128, kCloudRays, StokesFrame::meridian);
}
double off_below_cloud(double depth) {
  double worst = 0;
  const auto seen = below_cloud(depth);
  for (const size_t k : {1, 2}) {
    double sum = 0, variance = 0;
    for (const auto& one : seen) sum += one.S[k], variance += one.error[k] * one.error[k];
    worst = std::max(worst, std::fabs(sum) / std::sqrt(variance));
  }
  return worst;
}
// Spread of Q and U over the rays beside the reported errors: off 1 as a share.
double off_errors_below_cloud(double depth) {
  double spread = 0, told = 0;
  for (const auto& one : below_cloud(depth))
    for (const size_t k : {1, 2}) spread += one.S[k] * one.S[k], told += one.error[k] * one.error[k];
  return std::fabs(std::sqrt(spread / told) - 1);
}

Case row(std::string name, std::string reference, double bound, double (*error)(double), Sweep sweep) {
  return {"polarisation",
          std::move(name),
          std::move(reference),
          "1",
          bound,
          [error](const Numerics&, double x) { return error(x); },
          std::move(sweep),
          {}};
}

}  // namespace

std::vector<Case> polarisation_cases() {
  const std::string exact = "Fresnel's amplitudes in long double";
  return {
      row("light in the plane of incidence near Brewster's angle, over that across", exact, 1e-15, off_brewster,
          {"angle from Brewster's", "rad", 0.1, 1e-9, 10}),
      row("light that passes at grazing incidence", exact, 1e-12, off_grazing,
          {"cosine of incidence", "1", 0.1, 1e-12, 10}),
      row("reflectance of an interface that hardly refracts", exact, 1e-4, off_no_step,
          {"index - 1", "1", 0.1, 1e-10, 10}),
      row("reflectance of an interface of index 1", "0", 1e-12, off_no_interface,
          {"cosine of incidence", "1", 0.1, 1e-12, 10}),
      row("matrix of a metal at 70 deg", exact, 1e-13, off_metal, {"absorption index k", "1", 1, 1e6, 10}),
      row("V after many total reflections", exact, 1e-10, off_rhombs, {"reflections", "1", 1, 65536, 4}),
      row("crossed polarizers", "their leak", 1e-6, off_crossed, {"leak", "1", 0.1, 1e-9, 10}),
      row("meridian frame near the zenith", "its definition", 1e-12, off_frame,
          {"angle from the zenith", "rad", 0.1, 1e-16, 10}),
      row("frames turned there and back", "the identity", 1e-12, off_turned_back,
          {"angle between them", "rad", 0.1, 1e-12, 10}),
      row("Q/I that a metal emits at 85 deg", exact, 1e-9, off_emission, {"absorption index k", "1", 90, 1e6, 10}),
      row("Q/I that water and metals emit at 85 deg, band by band", exact, 1e-9, off_emission_of_bands, {}),
      row("U by facets in bands about Brewster's angle", exact, 1e-6, off_bands_about_brewster, {}),
      row("frames exactly up, down and straight back", "their definition, a mirror's matrix", 1e-12, off_upright, {}),
      row("a facet that sends light back", "a mirror's matrix, 4 times the angle off", 1e-12, off_retro,
          {"angle from straight back", "rad", 0.1, 1e-16, 10}),
      row("polarised light on a matte surface", "0", 0, off_matte, {"degree of polarisation", "1", 1e-3, 1, 10}),
      row("Q and U straight up below a cloud of molecules, over their errors", "0, by symmetry", 4.5, off_below_cloud,
          {"optical depth", "1", 10, 100, 10}),
      row("errors of Q and U below a cloud of molecules", "the spread of 16 rays", 0.5, off_errors_below_cloud,
          {"optical depth", "1", 10, 100, 10}),
      row("degree in the plane of a sun near the view", "that in the meridian frame", 1e-6, off_in_the_plane_of_the_sun,
          {"angle from the sun", "rad", 0.1, 1e-16, 10}),
  };
}

}  // namespace suite::extreme
