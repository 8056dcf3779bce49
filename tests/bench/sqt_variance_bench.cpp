// What exact sampling of a fitted material is worth: two spheres, one of satin and one of chrome, under a sun disk and
// a strongly non-uniform sky, by SQT sampling and by cosine sampling of the very same functions, with next-event
// estimation off and on.
//   build/release/bench/sqt_variance_bench [FILE.bsdf|FILE.sqt ...]    (default: the satin and the chrome of
//   tests/data)
//
// The light is direct only (the spheres do not see each other), which is what a path has at each of its nodes. Three
// estimators: the continuation alone; with a sample of the sun's disk (the paper's next-event estimation: the sky is
// met by the continuation); and with one of the tabulated sky too (the renderer's default). They share as the renderer
// does (transport/shares.h): the sun by the power heuristic, the sky by the balance heuristic; the cosine variant has the
// same, with its own density. The error is the RMSE of the picture of both spheres, and of each alone.
//
// Next-event estimation off: hardly any sample meets the sun (one in 30,000 of the cosine's), and a plain mean of
// squares would be decided by a few of them: the second moment of independent samples is integrated, over directions
// drawn towards sun, sky and lobe. What exact sampling of the function itself would reach stands beside it. On:
// pictures are rendered with the renderer's own points (scrambled Sobol, the same dimensions) at 1, 4, ... 256 paths
// and four scrambles, whose differences are the error. "x fewer": how many paths less SQT sampling needs for the error
// that cosine sampling has at 256. Half of the points of a picture lie around the mirror image of the sun, and count
// less.
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "formats/measured/measured.h"
#include "formats/sqt/sqt.h"
#include "light/kinds/sky.h"
#include "light/kinds/sun.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "sqt_fit/fit.h"
#include "sqt_fit/scattered.h"
#include "transport/dimensions.h"
#include "transport/shares.h"

namespace suite {
namespace {

constexpr size_t kPoints = 20000, kSamples = 48;    // of a sphere's picture, and of each, without next-event estimation
constexpr size_t kRendered = 1500, kScrambles = 4;  // points with it
constexpr size_t kLevels = 5;                       // 1, 4, ... 256 paths
constexpr size_t kMost = size_t{1} << 2 * (kLevels - 1);
enum class Drawn { sqt, cosine };
enum class NextEvent { off, sun, sun_and_sky };

SpectralState one_bin() {
  SpectralState state;
  state.low_um = 0.5495, state.high_um = 0.5505, state.reference_um = 0.55;
  state.bins = {{0.5495, 0.5505}};
  state.knots = {0};
  return state;
}

// The viewer stands 72 deg from the zenith. A sun of 1500 W/(m2 um) stands 50 deg from it at an azimuth from the
// viewer's, and around it, lower, the sky glows: its brightest part is 60 times as bright as its darkest.
const Dir kViewer = dir_from_angles(72 * kDegree, 0);
struct Lighting {
  Sun sun;
  Sky sky;
};
Lighting make_light(const SpectralState& state, double sun_azimuth) {
  SunSpec sun;
  sun.direction = dir_from_angles(65 * kDegree, sun_azimuth);
  sun.irradiance = Curve::constant(1500);
  SkySpec sky;
  sky.radiance = Curve::constant(60);
  sky.zeniths = 19, sky.azimuths = 36;
  for (size_t i = 0; i < sky.zeniths; ++i)
    for (size_t j = 0; j < sky.azimuths; ++j) {
      const Dir d = dir_from_angles(static_cast<double>(i) * 5 * kDegree, static_cast<double>(j) * 10 * kDegree);
      const double off = angle_between(d, dir_from_angles(75 * kDegree, sun_azimuth + 0.6)) / (25 * kDegree);
      sky.table.push_back(0.2 + 12 * std::exp(-off * off));
    }
  return {Sun(sun, state), Sky(sky, state)};
}

// The numbers of one path: independent, or the renderer's points in the renderer's dimensions (transport/dimensions.h).
struct Numbers {
  Vec2 turn, sun, sky;
  double lobe;
};
Numbers independent(Pcg32& random) {
  auto two = [&] { return Vec2{random.uniform(), random.uniform()}; };
  return {two(), two(), two(), random.uniform()};
}
Numbers scrambled(const SampleStream& stream, uint32_t n) {
  const auto a = stream.draw(n, dimensions::kScatter.first), b = stream.draw(n, dimensions::kSecond.first);
  return {{a[0], a[1]}, {a[2], a[3]}, {b[2], b[3]}, b[0]};
}

class Shader {
 public:
  Shader(const sqt::Bundle& bundle, size_t channel, const Lighting& light)
      : bundle_(bundle), channel_(channel), light_(light) {}

  // One sample of the radiance that leaves a point of the sphere towards the viewer.
  double sample(const Frame& frame, Dir out, Drawn drawn, NextEvent next_event, const Numbers& u) const {
    const bool asks_sun = next_event != NextEvent::off, asks_sky = next_event == NextEvent::sun_and_sky;
    double L = 0;
    if (asks_sun) {
      const DirectionSample to_sun = light_.sun.draw(u.sun);
      L += explicit_light(frame, out, to_sun, light_.sun.spectrum()[0], drawn, true);
    }
    if (asks_sky) {
      const DirectionSample to_sky = light_.sky.draw(u.sky);
      L += explicit_light(frame, out, to_sky, sky(to_sky.direction), drawn, false);
    }
    const auto in = draw(out, drawn, u);
    if (!in || !(in->z > 0)) return L;
    const double p = density(out, *in, drawn);
    if (!(p > 0)) return L;
    const Dir world = frame.to_world(*in);
    const double w = bundle_.eval(out, *in, channel_);
    return L + w * sun(world) / shared_density(p, asks_sun ? light_.sun.density() : 0, true) +
           w * sky(world) / shared_density(p, asks_sky ? light_.sky.density(world) : 0, false);
  }

  // Estimates of the first and second moment of the continuation without next-event estimation, for both densities,
  // from one direction towards the sun, the sky or the lobe.
  struct Moments {
    double mean = 0, square_sqt = 0, square_cosine = 0, square_ideal = 0;
  };
  Moments moments(const Frame& frame, Dir out, Pcg32& random) const {
    const double which = 3 * random.uniform();
    std::optional<Dir> in;
    if (which < 1)
      in = frame.to_local(light_.sun.draw({random.uniform(), random.uniform()}).direction);
    else if (which < 2)
      in = frame.to_local(light_.sky.draw({random.uniform(), random.uniform()}).direction);
    else
      in = draw(out, Drawn::sqt, independent(random));
    if (!in || !(in->z > 0)) return {};
    const Dir world = frame.to_world(*in);
    const double p = density(out, *in, Drawn::sqt), sunny = light_.sun.contains(world) ? light_.sun.density() : 0;
    const double q = (sunny + light_.sky.density(world) + p) / 3;
    const double w = bundle_.eval(out, *in, channel_), c = w * (sun(world) + sky(world));
    if (!(p > 0) || !(q > 0)) return {};
    // The ideal density is w / W: the function itself, without error.
    return {c / q, c * c / (p * q), c * c / (density(out, *in, Drawn::cosine) * q),
            w > 0 ? c * c / (w / bundle_.total(out, channel_) * q) : 0};
  }

 private:
  double sun(Dir world) const { return light_.sun.contains(world) ? light_.sun.spectrum()[0] : 0; }
  std::optional<Dir> draw(Dir out, Drawn drawn, const Numbers& u) const {
    return drawn == Drawn::sqt ? bundle_.sample(out, u.turn, u.lobe, channel_) : cosine_hemisphere(u.turn);
  }
  double sky(Dir world) const { return light_.sky.relative(world) * light_.sky.spectrum()[0]; }
  double density(Dir out, Dir in, Drawn drawn) const {
    return drawn == Drawn::sqt ? bundle_.pdf(out, in, channel_) : cosine_hemisphere_pdf(in.z);
  }
  double explicit_light(const Frame& frame, Dir out, const DirectionSample& to, double radiance, Drawn drawn,
                        bool disk) const {
    const Dir in = frame.to_local(to.direction);
    if (!(in.z > 0) || !(to.density > 0)) return 0;
    return bundle_.eval(out, in, channel_) * radiance / shared_density(to.density, density(out, in, drawn), disk);
  }
  const sqt::Bundle& bundle_;
  size_t channel_;
  const Lighting& light_;
};

// A point of the picture of a unit sphere, and by how much it counts: half of the points anywhere, the others around
// the mirror image of the sun.
struct Point {
  Frame frame;
  double weight = 0;
};
Point picture_point(const Lighting& light, Pcg32& random) {
  const Frame picture = Frame::around(kViewer);
  const Dir glint = picture.to_local(normalized(kViewer + light.sun.direction()));
  constexpr double radius[3] = {0.999, 0.1, 0.03}, chance[3] = {0.5, 0.25, 0.25};
  const double choice = random.uniform();
  const int k = choice < chance[0] ? 0 : choice < chance[0] + chance[1] ? 1 : 2;
  const double r = radius[k] * std::sqrt(random.uniform()), phi = 2 * kPi * random.uniform();
  const double x = (k ? glint.x : 0) + r * std::cos(phi), y = (k ? glint.y : 0) + r * std::sin(phi), r2 = x * x + y * y;
  if (r2 >= radius[0] * radius[0]) return {};
  double density = chance[0];
  for (int i = 1; i < 3; ++i)
    if (std::hypot(x - glint.x, y - glint.y) < radius[i]) density += chance[i] * std::pow(radius[0] / radius[i], 2);
  return {Frame::around(picture.to_world({x, y, std::sqrt(1 - r2)})), 1 / density};
}

// Means over a picture: of the radiance, and of the squared error of one independent sample (next-event estimation
// off), or of the pictures of 1, 4, ... paths.
struct Errors {
  double mean = 0, ideal = 0;
  std::array<double, kLevels> sqt{}, cosine{};
  void add(const Errors& o, double weight) {
    mean += weight * o.mean, ideal += weight * o.ideal;
    for (size_t l = 0; l < kLevels; ++l) sqt[l] += weight * o.sqt[l], cosine[l] += weight * o.cosine[l];
  }
};

Errors without(const Shader& shader, const Point& point, Pcg32& random) {
  const Dir out = point.frame.to_local(kViewer);
  Shader::Moments sum;
  double square = 0;
  for (size_t n = 0; n < kSamples; ++n) {
    const Shader::Moments m = shader.moments(point.frame, out, random);
    sum.mean += m.mean, square += m.mean * m.mean;
    sum.square_sqt += m.square_sqt, sum.square_cosine += m.square_cosine, sum.square_ideal += m.square_ideal;
  }
  const double mean2 = (sum.mean * sum.mean - square) / (kSamples * (kSamples - 1.0));  // unbiased
  Errors e;
  e.mean = sum.mean / kSamples, e.ideal = sum.square_ideal / kSamples - mean2;
  e.sqt[0] = sum.square_sqt / kSamples - mean2, e.cosine[0] = sum.square_cosine / kSamples - mean2;
  return e;
}
Errors rendered(const Shader& shader, const Point& point, size_t problem, NextEvent next_event) {
  const Dir out = point.frame.to_local(kViewer);
  Errors e;
  for (const Drawn drawn : {Drawn::cosine, Drawn::sqt}) {
    double level[kScrambles][kLevels];
    for (size_t s = 0; s < kScrambles; ++s) {
      const SampleStream stream(17 + s, 0, static_cast<uint32_t>(problem));
      double sum = 0;
      size_t n = 0;
      for (size_t l = 0; l < kLevels; ++l) {
        for (; n < size_t{1} << 2 * l; ++n)
          sum += shader.sample(point.frame, out, drawn, next_event, scrambled(stream, static_cast<uint32_t>(n)));
        level[s][l] = sum / static_cast<double>(n);
      }
    }
    for (size_t l = 0; l < kLevels; ++l) {
      double mean = 0, square = 0;
      for (const auto& one : level) mean += one[l] / kScrambles;
      for (const auto& one : level) square += (one[l] - mean) * (one[l] - mean) / (kScrambles - 1);
      (drawn == Drawn::sqt ? e.sqt : e.cosine)[l] = square;
      e.mean = mean;
    }
  }
  return e;
}

Errors picture(const Shader& shader, const Lighting& light, NextEvent next_event) {
  const size_t count = next_event == NextEvent::off ? kPoints : kRendered;
  std::vector<Errors> points(count);
  std::vector<double> weight(count);
  parallel_for(0, count, 20, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      Pcg32 random(11, i);
      const Point point = picture_point(light, random);
      weight[i] = point.weight / static_cast<double>(count);
      if (point.weight > 0)
        points[i] =
            next_event == NextEvent::off ? without(shader, point, random) : rendered(shader, point, i, next_event);
    }
  });
  Errors all;
  for (size_t i = 0; i < count; ++i) all.add(points[i], weight[i]);
  return all;
}

// How many times fewer paths SQT sampling needs for the squared error that cosine sampling has at the last level.
double fewer(const Errors& e) {
  const double wanted = std::log(e.cosine[kLevels - 1]);
  size_t l = 1;
  while (l + 1 < kLevels && std::log(e.sqt[l]) > wanted) ++l;
  const double a = std::log(e.sqt[l - 1]), b = std::log(e.sqt[l]);
  const double paths = std::exp2(2 * (static_cast<double>(l - 1) + (wanted - a) / (b - a)));
  return static_cast<double>(kMost) / std::max(1.0, paths);
}

void print(const std::string& name, NextEvent next_event, const Errors& e) {
  if (next_event == NextEvent::off) {
    std::printf("    %-18s off          %9.1f x fewer (sampling w exactly: %.1f x)\n", name.c_str(),
                e.cosine[0] / e.sqt[0], e.cosine[0] / e.ideal);
    return;
  }
  std::printf("    %-18s %-12s %9.1f x fewer; RMSE, %% of the mean, at", name.c_str(),
              next_event == NextEvent::sun ? "sun" : "sun and sky", fewer(e));
  for (size_t l = 1; l < kLevels; ++l)
    std::printf("%s %d paths: %.3g cosine, %.3g SQT", l > 1 ? ";" : "", 1 << 2 * l,
                100 * std::sqrt(e.cosine[l]) / e.mean, 100 * std::sqrt(e.sqt[l]) / e.mean);
  std::printf("\n");
}

std::shared_ptr<const sqt::Bundle> load(const std::string& path) {
  if (path.ends_with(".sqt")) return read_sqt(path).bundle;
  const Measured data = read_measured(path);
  const auto function = data.index() == 0 ? std::get<0>(data) : sqt::interpolate(std::get<1>(data));
  const sqt::AlignedSource source(*function, {});
  return sqt::make_bundle(sqt::encode_aligned(source, sqt::kDefaultQuality).data);
}

struct Material {
  std::shared_ptr<const sqt::Bundle> bundle;
  size_t channel = 0;
  std::string name;
};
Material material(const std::string& path) {
  Material m;
  m.bundle = load(path);
  if (m.bundle->info().has_delta() || !m.bundle->cosine_weighted())
    throw suite::Error(Where{path, 0, 0, {}, -1}, "cosine sampling cannot be compared on it",
                       "give a surface without a Dirac lobe");
  const std::vector<double>& um = m.bundle->info().function.wavelength_um;
  for (size_t c = 1; c < um.size(); ++c)
    if (std::fabs(um[c] - 0.55) < std::fabs(um[m.channel] - 0.55)) m.channel = c;
  m.name = m.bundle->info().function.name;
  return m;
}

void run(const std::vector<std::string>& paths) {
  std::vector<Material> materials;
  for (const std::string& path : paths) materials.push_back(material(path));
  for (const double azimuth : {0.0, 90.0, 180.0}) {
    const Lighting light = make_light(one_bin(), azimuth * kDegree);
    std::printf("sun %.0f deg from the viewer; next-event estimation:\n",
                angle_between(kViewer, light.sun.direction()) / kDegree);
    for (const NextEvent next_event : {NextEvent::off, NextEvent::sun, NextEvent::sun_and_sky}) {
      Errors all;
      for (const Material& m : materials) {
        const Errors e = picture(Shader(*m.bundle, m.channel, light), light, next_event);
        all.add(e, 1 / static_cast<double>(materials.size()));
        print(m.name, next_event, e);
      }
      if (materials.size() > 1) print("all in one picture", next_event, all);
    }
  }
}

}  // namespace
}  // namespace suite

int main(int argc, char** argv) {
  try {
    std::vector<std::string> paths(argv + 1, argv + argc);
    if (paths.empty())
      paths = {SUITE_TEST_DATA "/brdf/satin_purple_rgb.bsdf", SUITE_TEST_DATA "/brdf/chm_mint_rgb.bsdf"};
    suite::run(paths);
  } catch (const suite::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
