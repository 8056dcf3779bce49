// What exact sampling of a fitted material is worth: spheres of it under a sun disk and a strongly non-uniform sky, by
// SQT sampling and by cosine sampling of the very same function, with next-event estimation off and on.
//   build/release/bench/sqt_variance_bench [FILE.bsdf|FILE.sqt ...]      (default: the satin film of tests/data)
//
// The light is direct only (the sphere is convex and stands alone), which is what a path has at each of its nodes. With
// next-event estimation on, the estimator is the renderer's: a sample of the sun's disk, one of the tabulated sky and
// one continuation, combined by the balance heuristic; the cosine variant has the same, with its own density. Samples
// are independent, so that variance falls as 1 / n and "samples for equal error" is the ratio of the mean squared
// errors: the root of their mean over the picture is the error. The reference is the SQT estimator with next-event
// estimation; its own error is printed beside.
#include <cmath>
#include <cstdio>
#include <ctime>
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

constexpr int kAcross = 28;           // pixels across the sphere
constexpr size_t kSamples = 64;       // of one estimate
constexpr size_t kTrials = 96;        // estimates a pixel and method
constexpr size_t kReference = 40000;  // samples of the reference a pixel
enum class Drawn { sqt, cosine };

SpectralState one_bin() {
  SpectralState state;
  state.low_um = 0.5495, state.high_um = 0.5505, state.reference_um = 0.55;
  state.bins = {{0.5495, 0.5505}};
  state.knots = {0};
  return state;
}

// A sun of 1500 W/(m2 um) at 40 deg from the zenith, and a sky whose brightest part (a glow in the west, low) is 60
// times as bright as its darkest.
struct Light {
  Sun sun;
  Sky sky;
};
Light make_light(const SpectralState& state) {
  SunSpec sun;
  sun.direction = dir_from_angles(40 * kDegree, 2.1);
  sun.irradiance = Curve::constant(1500);
  SkySpec sky;
  sky.radiance = Curve::constant(60);
  sky.zeniths = 19, sky.azimuths = 36;
  for (size_t i = 0; i < sky.zeniths; ++i)
    for (size_t j = 0; j < sky.azimuths; ++j) {
      const Dir d = dir_from_angles(static_cast<double>(i) * 5 * kDegree, static_cast<double>(j) * 10 * kDegree);
      const double off = angle_between(d, dir_from_angles(75 * kDegree, 3.4)) / (25 * kDegree);
      sky.table.push_back(0.2 + 12 * std::exp(-off * off));
    }
  return {Sun(sun, state), Sky(sky, state)};
}

class Shader {
 public:
  Shader(const sqt::Bundle& bundle, size_t channel, const Light& light)
      : bundle_(bundle), channel_(channel), light_(light) {}

  // One sample of the radiance that leaves a point of the sphere towards the viewer.
  double sample(const Frame& frame, Dir out, Drawn drawn, bool next_event, Pcg32& random) const {
    double L = 0;
    if (next_event) {
      const DirectionSample to_sun = light_.sun.sample({random.uniform(), random.uniform()}),
                            to_sky = light_.sky.sample({random.uniform(), random.uniform()});
      L += weighed(frame, out, to_sun, light_.sun.spectrum()[0], drawn);
      L += weighed(frame, out, to_sky, sky(to_sky.direction), drawn);
    }
    const Vec2 u{random.uniform(), random.uniform()};
    const double lobe_u = random.uniform();
    const auto in = drawn == Drawn::sqt ? bundle_.sample(out, u, lobe_u, channel_) : cosine_hemisphere(u);
    if (!in || !(in->z > 0)) return L;
    const double p = density(out, *in, drawn);
    if (!(p > 0)) return L;
    const Dir world = frame.to_world(*in);
    const double sun_share = next_event ? p / (p + light_.sun.density()) : 1,
                 sky_share = next_event ? p / (p + light_.sky.density(world)) : 1;
    const double met = (light_.sun.contains(world) ? sun_share * light_.sun.spectrum()[0] : 0) + sky_share * sky(world);
    return L + bundle_.eval(out, *in, channel_) / p * met;
  }

 private:
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

struct Pixel {
  Frame frame;
  Dir out;
  double reference = 0, reference_variance = 0;  // of the mean
};

// Points of a unit sphere seen along -z.
std::vector<Pixel> sphere() {
  std::vector<Pixel> pixels;
  for (int y = 0; y < kAcross; ++y)
    for (int x = 0; x < kAcross; ++x) {
      const double px = (x + 0.5) / kAcross * 2 - 1, py = (y + 0.5) / kAcross * 2 - 1, r2 = px * px + py * py;
      if (r2 > 0.995) continue;
      Pixel p;
      p.frame = Frame::around({px, py, std::sqrt(1 - r2)});
      p.out = p.frame.to_local({0, 0, 1});
      pixels.push_back(p);
    }
  return pixels;
}

struct Error2 {
  double plain = 0, relative = 0;  // mean squared error; the same over the squared reference
  double seconds = 0;              // CPU
};

Error2 squared_error(const Shader& shader, const std::vector<Pixel>& pixels, Drawn drawn, bool next_event) {
  std::vector<Error2> each(pixels.size());
  const std::clock_t start = std::clock();
  parallel_for(0, pixels.size(), 8, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Pixel& p = pixels[i];
      Pcg32 random(11 + (next_event ? 1 : 0) + (drawn == Drawn::sqt ? 2 : 0), i);
      for (size_t t = 0; t < kTrials; ++t) {
        double sum = 0;
        for (size_t n = 0; n < kSamples; ++n) sum += shader.sample(p.frame, p.out, drawn, next_event, random);
        const double e = sum / kSamples - p.reference;
        each[i].plain += e * e / kTrials;
        each[i].relative += p.reference > 0 ? e * e / (p.reference * p.reference) / kTrials : 0;
      }
    }
  });
  Error2 mean;
  for (const Error2& e : each)
    mean.plain += e.plain / static_cast<double>(each.size()),
        mean.relative += e.relative / static_cast<double>(each.size());
  mean.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return mean;
}

void reference_of(const Shader& shader, std::vector<Pixel>& pixels) {
  parallel_for(0, pixels.size(), 8, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      Pixel& p = pixels[i];
      Pcg32 random(5, i);
      double sum = 0, square = 0;
      for (size_t n = 0; n < kReference; ++n) {
        const double L = shader.sample(p.frame, p.out, Drawn::sqt, true, random);
        sum += L, square += L * L;
      }
      p.reference = sum / kReference;
      p.reference_variance = (square / kReference - p.reference * p.reference) / kReference;
    }
  });
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
  const Light light = make_light(state);
  const Shader shader(*bundle, channel, light);
  std::vector<Pixel> pixels = sphere();
  reference_of(shader, pixels);
  double mean = 0, own = 0;
  for (const Pixel& p : pixels)
    mean += p.reference / static_cast<double>(pixels.size()),
        own += p.reference_variance / static_cast<double>(pixels.size());
  std::printf("%s, %g um: %zu pixels, mean radiance %.4g; reference of %zu samples, RMSE %.3g\n",
              bundle->info().function.name.c_str(), bundle->info().function.wavelength_um[channel], pixels.size(), mean,
              kReference, std::sqrt(own));
  for (const bool next_event : {false, true}) {
    const Error2 cosine = squared_error(shader, pixels, Drawn::cosine, next_event),
                 sqt = squared_error(shader, pixels, Drawn::sqt, next_event);
    std::printf(
        "  next-event estimation %-3s  RMSE at %zu samples: cosine %.4g, SQT %.4g: %.1f x fewer samples for equal "
        "RMSE, "
        "%.1f x for equal relative RMSE; %.1f x less time\n",
        next_event ? "on" : "off", kSamples, std::sqrt(cosine.plain), std::sqrt(sqt.plain), cosine.plain / sqt.plain,
        cosine.relative / sqt.relative, cosine.plain * cosine.seconds / (sqt.plain * sqt.seconds));
    if (sqt.plain < 16 * own) std::printf("    (the reference is less than four times better: a lower bound)\n");
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
