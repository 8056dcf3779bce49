// What exact sampling of a fitted material is worth: spheres of it under a sun disk and a strongly non-uniform sky, by
// SQT sampling and by cosine sampling of the very same function, with next-event estimation off and on.
//   build/release/bench/sqt_variance_bench [FILE.bsdf|FILE.sqt ...]      (default: the satin film of tests/data)
//
// The light is direct only (the sphere is convex and stands alone), which is what a path has at each of its nodes.
// Three estimators: the continuation alone; with a sample of the sun's disk (the paper's next-event estimation: the sky
// is met by the continuation); and with one of the tabulated sky too (the renderer's default). They are combined by the
// balance heuristic, and the cosine variant has the same, with its own density. Samples are independent, so that
// variance falls as 1 / n and "samples for equal error" is the ratio of the variances of one sample at a point, meaned
// over the picture: as they are, where the sun's glint decides, and relative to the squared radiance of the point.
// Without next-event estimation hardly any sample meets the sun (one in 30,000 of the cosine's), and a plain mean of
// squares would be decided by a few of them: the second moment is integrated instead, over directions drawn towards
// sun, sky and lobe. What exact sampling of the function itself would reach stands beside it.
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "formats/measured/measured.h"
#include "formats/sqt/sqt.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "radiometry/sources/source.h"
#include "sqt/fit.h"
#include "sqt/scattered.h"

namespace suite {
namespace {

constexpr size_t kPoints = 20000;  // of the sphere's picture
constexpr size_t kSamples = 48;    // a point
constexpr size_t kQuoted = 64;     // samples of the error that is printed
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
struct Light {
  Sun sun;
  Sky sky;
};
Light make_light(const SpectralState& state, double sun_azimuth) {
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

class Shader {
 public:
  Shader(const sqt::Bundle& bundle, size_t channel, const Light& light)
      : bundle_(bundle), channel_(channel), light_(light) {}

  // One sample of the radiance that leaves a point of the sphere towards the viewer.
  double sample(const Frame& frame, Dir out, Drawn drawn, NextEvent next_event, Pcg32& random) const {
    double L = 0;
    if (next_event != NextEvent::off) {
      const DirectionSample to_sun = light_.sun.sample({random.uniform(), random.uniform()});
      L += weighed(frame, out, to_sun, light_.sun.spectrum()[0], drawn);
    }
    if (next_event == NextEvent::sun_and_sky) {
      const DirectionSample to_sky = light_.sky.sample({random.uniform(), random.uniform()});
      L += weighed(frame, out, to_sky, sky(to_sky.direction), drawn);
    }
    const auto in = draw(out, drawn, random);
    if (!in || !(in->z > 0)) return L;
    const double p = density(out, *in, drawn);
    if (!(p > 0)) return L;
    const Dir world = frame.to_world(*in);
    const double sun_share = next_event != NextEvent::off ? p / (p + light_.sun.density()) : 1,
                 sky_share = next_event == NextEvent::sun_and_sky ? p / (p + light_.sky.density(world)) : 1;
    return L + bundle_.eval(out, *in, channel_) / p * (sun_share * sun(world) + sky_share * sky(world));
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
      in = frame.to_local(light_.sun.sample({random.uniform(), random.uniform()}).direction);
    else if (which < 2)
      in = frame.to_local(light_.sky.sample({random.uniform(), random.uniform()}).direction);
    else
      in = draw(out, Drawn::sqt, random);
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
  std::optional<Dir> draw(Dir out, Drawn drawn, Pcg32& random) const {
    const Vec2 u{random.uniform(), random.uniform()};
    const double lobe_u = random.uniform();
    return drawn == Drawn::sqt ? bundle_.sample(out, u, lobe_u, channel_) : cosine_hemisphere(u);
  }
  double sky(Dir world) const { return light_.sky.relative(world) * light_.sky.spectrum()[0]; }
  double density(Dir out, Dir in, Drawn drawn) const {
    return drawn == Drawn::sqt ? bundle_.pdf(out, in, channel_) : cosine_hemisphere_pdf(in.z);
  }
  double weighed(const Frame& frame, Dir out, const DirectionSample& to, double radiance, Drawn drawn) const {
    const Dir in = frame.to_local(to.direction);
    if (!(in.z > 0) || !(to.density > 0)) return 0;
    return bundle_.eval(out, in, channel_) * radiance / (to.density + density(out, in, drawn));
  }
  const sqt::Bundle& bundle_;
  size_t channel_;
  const Light& light_;
};

// The surface at a random point of the picture of a unit sphere.
Frame surface(Pcg32& random) {
  const double r2 = 0.998 * random.uniform(), r = std::sqrt(r2), phi = 2 * kPi * random.uniform();
  return Frame::around(Frame::around(kViewer).to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r2)}));
}

// At a point: the mean and the variance of one sample by each density, unbiased.
struct Variance {
  double mean = 0, sqt = 0, cosine = 0, ideal = 0;
};
// Over the picture: means of those, and of the variances over the squared mean (what is darker than a hundredth of the
// picture's mean counts as that).
struct Picture {
  Variance plain, relative;
};
// Unbiased square of the mean of n numbers.
double mean_square(double sum, double square) { return (sum * sum - square) / (kSamples * (kSamples - 1.0)); }

Variance without(const Shader& shader, const Frame& frame, Dir out, Pcg32& random) {
  Shader::Moments sum;
  double square = 0;
  for (size_t n = 0; n < kSamples; ++n) {
    const Shader::Moments m = shader.moments(frame, out, random);
    sum.mean += m.mean, square += m.mean * m.mean;
    sum.square_sqt += m.square_sqt, sum.square_cosine += m.square_cosine, sum.square_ideal += m.square_ideal;
  }
  const double mean2 = mean_square(sum.mean, square);
  return {sum.mean / kSamples, sum.square_sqt / kSamples - mean2, sum.square_cosine / kSamples - mean2,
          sum.square_ideal / kSamples - mean2};
}
Variance with(const Shader& shader, const Frame& frame, Dir out, NextEvent next_event, Pcg32& random) {
  double sum[2] = {}, square[2] = {};
  for (size_t n = 0; n < kSamples; ++n)
    for (const Drawn drawn : {Drawn::sqt, Drawn::cosine}) {
      const double L = shader.sample(frame, out, drawn, next_event, random);
      sum[drawn == Drawn::cosine] += L, square[drawn == Drawn::cosine] += L * L;
    }
  return {sum[0] / kSamples, square[0] / kSamples - mean_square(sum[0], square[0]),
          square[1] / kSamples - mean_square(sum[1], square[1]), 0};
}

Picture picture(const Shader& shader, NextEvent next_event) {
  std::vector<Variance> points(kPoints);
  parallel_for(0, kPoints, 200, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      Pcg32 random(11, i);
      const Frame frame = surface(random);
      const Dir out = frame.to_local(kViewer);
      points[i] = next_event == NextEvent::off ? without(shader, frame, out, random)
                                               : with(shader, frame, out, next_event, random);
    }
  });
  Picture all;
  for (const Variance& v : points) all.plain.mean += v.mean / kPoints;
  for (const Variance& v : points) {
    const double level = kPoints * std::pow(std::max(v.mean, 0.01 * all.plain.mean), 2);
    all.plain.sqt += v.sqt / kPoints, all.plain.cosine += v.cosine / kPoints, all.plain.ideal += v.ideal / kPoints;
    all.relative.sqt += v.sqt / level, all.relative.cosine += v.cosine / level, all.relative.ideal += v.ideal / level;
  }
  return all;
}

std::shared_ptr<const sqt::Bundle> load(const std::string& path) {
  if (path.ends_with(".sqt")) return read_sqt(path).bundle;
  const Measured data = read_measured(path);
  const auto function = data.index() == 0 ? std::get<0>(data) : sqt::interpolate(std::get<1>(data));
  const sqt::AlignedSource source(*function, {});
  return sqt::make_bundle(sqt::encode_aligned(source, sqt::kDefaultQuality).data);
}

void run(const std::string& path) {
  const auto bundle = load(path);
  if (bundle->info().has_delta() || !bundle->cosine_weighted())
    throw suite::Error(Where{path, 0, 0, {}, -1}, "cosine sampling cannot be compared on it",
                       "give a surface without a Dirac lobe");
  size_t channel = 0;
  for (size_t c = 1; c < bundle->channels(); ++c)
    if (std::fabs(bundle->info().function.wavelength_um[c] - 0.55) <
        std::fabs(bundle->info().function.wavelength_um[channel] - 0.55))
      channel = c;
  const SpectralState state = one_bin();
  std::printf("%s, %g um\n", bundle->info().function.name.c_str(), bundle->info().function.wavelength_um[channel]);
  const std::pair<NextEvent, const char*> kinds[] = {
      {NextEvent::off, "off"}, {NextEvent::sun, "sun"}, {NextEvent::sun_and_sky, "sun and sky"}};
  for (const double azimuth : {0.0, 90.0, 180.0}) {
    const Light light = make_light(state, azimuth * kDegree);
    const Shader shader(*bundle, channel, light);
    std::printf("  sun %.0f deg from the viewer\n", angle_between(kViewer, light.sun.direction()) / kDegree);
    for (const auto& [next_event, name] : kinds) {
      const Picture p = picture(shader, next_event);
      const Variance &v = p.plain, &r = p.relative;
      std::printf(
          "    next-event estimation %-11s  RMSE of %zu samples: cosine %9.2f %%, SQT %7.2f %% of the mean; SQT "
          "needs %6.1f x fewer samples for equal RMSE, %6.1f x for equal relative RMSE",
          name, kQuoted, 100 * std::sqrt(v.cosine / kQuoted) / v.mean, 100 * std::sqrt(v.sqt / kQuoted) / v.mean,
          v.cosine / v.sqt, r.cosine / r.sqt);
      if (next_event == NextEvent::off)
        std::printf(" (sampling w exactly: %.1f x, %.1f x)", v.cosine / v.ideal, r.cosine / r.ideal);
      std::printf("\n");
    }
  }
}

}  // namespace
}  // namespace suite

int main(int argc, char** argv) {
  try {
    for (int i = 1; i < argc; ++i) suite::run(argv[i]);
    if (argc < 2) suite::run(SUITE_TEST_DATA "/brdf/satin_purple_rgb.bsdf");
  } catch (const suite::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
