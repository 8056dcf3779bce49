// An image intensifier in front of a camera: photoelectrons become spots of light on a phosphor.
//
// A photoelectron lands where it was set free, or, when it is scattered back from the plate first, anywhere in a disk
// (halo). Its light is a gamma variate with the mean gain and the excess F^2, spread over the phosphor by a Gaussian
// and in time by an exponential; the camera's electrons are Poisson. Of pixels with fewer than kEvents photoelectrons
// each has a place and a pulse of its own; of brighter ones their sum has.
// Assumes: light outside the frame makes no halo in it; light left over from the read-outs before is that of a scene
// that stood still. Based on: I. P. Csorba, "Image Tubes", 1985 (gain, halo, equivalent background illumination);
// E. J. Bender, "Present image-intensifier tube structures", in L. M. Biberman (ed.), "Electro-Optical Imaging: System
// Performance and Modeling", SPIE Press 2000.
#include <algorithm>
#include <cmath>
#include <vector>

#include "math/variates.h"
#include "sensor/detectors/detectors.h"
#include "sensor/detectors/disk.h"
#include "spectral/photopic.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kEvents = 10;                   // photoelectrons of a pixel that are followed one by one
constexpr double kLeast = 1e-4;                  // share of the light of one read-out that is followed into a later one
constexpr double kLampKelvin = 2856;             // CIE illuminant A, that luminous sensitivities are told for
constexpr double kWidest = 10;                   // pixels, standard deviation of a spot
constexpr double kReach = 5;                     // standard deviations of a spot
constexpr double kElementary = 1.602176634e-19;  // C, SI

struct Tube {
  double background = 0;        // photoelectrons/(s m2)
  double gain = 1;              // camera electrons of one photoelectron, mean
  double excess = 1;            // F^2 of one photoelectron's pulse
  double halo = 0, radius = 0;  // share; m
  double blur = 0, decay = 0;   // m, standard deviation; s, to 1/e
  double most_rate = 0;         // photoelectrons/s of a pixel in the mean over the frame, that gating holds; 0: none
};

// A Gaussian spot's share of the pixels along one axis, by integrals.
class Spot {
 public:
  // sigma: pixels.
  explicit Spot(double sigma) : sigma_(sigma), reach_(static_cast<int>(std::ceil(kReach * sigma + 0.5))) {}
  int reach() const { return sigma_ > 0 ? reach_ : 0; }
  // Of pixels -reach ... reach about the one in which it lies, at a share of its width; adds up to 1.
  void at(double share, std::vector<double>& of) const {
    of.assign(static_cast<size_t>(2 * reach() + 1), 1);
    if (!(sigma_ > 0)) return;
    double sum = 0;
    for (int k = -reach_; k <= reach_; ++k)
      sum += of[static_cast<size_t>(k + reach_)] = below(k + 1 - share) - below(k - share);
    for (double& x : of) x /= sum;
  }
  // The mean of at() over the width of the pixel.
  void even(std::vector<double>& of) const {
    std::vector<double> one;
    constexpr int places = 16;
    for (int i = 0; i < places; ++i) {
      at((i + 0.5) / places, one);
      if (i == 0) of.assign(one.size(), 0);
      for (size_t k = 0; k < one.size(); ++k) of[k] += one[k] / places;
    }
  }

 private:
  double below(double x) const { return 0.5 * std::erfc(-x / (sigma_ * std::sqrt(2.0))); }
  double sigma_;
  int reach_;
};

class Intensifier final : public ArrayDetector {
 public:
  Intensifier(const DetectorSpec& spec, const Tube& tube) : d_(spec), tube_(tube) {}
  bool whole_frames() const override { return true; }
  std::string fault_of(Vec2 pitch) const override {
    const double pixels = tube_.blur / std::min(pitch.x, pitch.y);
    return pixels > kWidest ? strf("spots of %.3g pixels (standard deviation), and %g at most", pixels, kWidest) : "";
  }

  ArrayReading read(const ArrayLight& light) const override {
    const std::vector<double> landing = landed(light);
    std::vector<double> glow(light.size(), 0);  // mean electrons of the camera
    const int before = tube_.decay > 0 ? static_cast<int>(std::min(light.before, kMostBefore)) : 0;
    for (int ago = before; ago >= 0; --ago)
      if (const double share = emitted(light, ago); share > kLeast) add_pulses(light, landing, ago, share, glow);
    ArrayReading out = empty_reading(light.size(), true, false);
    for (size_t i = 0; i < light.size(); ++i) {
      const Character c = character_of(d_, light.sites[i]);
      if (c.hot) out.dn[i] = most_counts(d_);
      if (c.dead || c.hot) continue;
      Pcg32 random(hash_of(d_.seed, kNoiseStream), light.key(i));
      double charge = poisson(collected(d_, c, glow[i], light.exposure), random);
      const bool full = d_.full_well > 0 && charge > d_.full_well;
      if (full) charge = d_.full_well;
      const Converted converted = convert(d_, charge + d_.read_noise * normal(random));
      out.dn[i] = converted.counts;
      out.clipped[i] = full || converted.clipped;
    }
    return out;
  }

  DetectorNoise noise(double exposure, double area) const override {
    const double f2 = tube_.excess, g = tube_.gain, step = d_.gain / g;
    return {f2 * tube_.background * area * exposure +
                (d_.dark_current * exposure + d_.read_noise * d_.read_noise) / (g * g) + step * step / 12,
            f2 + 1 / g};
  }

 private:
  // Mean photoelectrons by where they land.
  std::vector<double> landed(const ArrayLight& light) const {
    std::vector<double> mean = light.electrons;
    const double background = tube_.background * light.pitch.x * light.pitch.y * d_.fill_factor * light.exposure;
    double sum = 0;
    for (double& m : mean) m = std::max(0.0, m) + background, sum += m;
    const double most = tube_.most_rate * light.exposure * static_cast<double>(mean.size());
    if (most > 0 && sum > most)
      for (double& m : mean) m *= most / sum;
    if (tube_.halo > 0)
      mean = over_disk(mean, light.columns, {tube_.radius / light.pitch.x, tube_.radius / light.pitch.y}, tube_.halo);
    return mean;
  }
  // Share of its light that a photoelectron of the read-out `ago` before this one sends during this one, in the mean.
  double emitted(const ArrayLight& light, int ago) const {
    if (!(tube_.decay > 0)) return ago == 0;
    const double x = light.exposure / tube_.decay, mean = -std::expm1(-x) / x;
    if (ago == 0) return 1 - mean;
    // Set free at s in [0, t], seen from ago T to ago T + t: exp(-(ago T - s) / tau) (1 - exp(-t / tau)).
    const double wait = (ago * light.period - light.exposure) / tube_.decay;
    return std::exp(-std::max(0.0, wait)) * mean * -std::expm1(-x);
  }

  void add_pulses(const ArrayLight& light, const std::vector<double>& landing, int ago, double share,
                  std::vector<double>& glow) const {
    const Spot across(tube_.blur / light.pitch.x), down(tube_.blur / light.pitch.y);
    std::vector<double> x, y, even_x, even_y;
    across.even(even_x), down.even(even_y);
    const double spread = tube_.excess - 1;
    const auto pulse = [&](double events, Pcg32& random) {
      return share * (spread > 0 ? gamma_variate(events / spread, tube_.gain * spread, random) : events * tube_.gain);
    };
    for (size_t i = 0; i < light.size(); ++i) {
      Pcg32 random(hash_of(d_.seed, 0x74756265ull), light.key(i, static_cast<uint64_t>(ago)));
      const double events = poisson(landing[i], random);
      if (events >= kEvents || (events > 0 && !(tube_.blur > 0))) {
        put(light, i, even_x, even_y, pulse(events, random), glow);
        continue;
      }
      for (double k = 0; k < events; ++k) {
        across.at(random.uniform(), x), down.at(random.uniform(), y);
        put(light, i, x, y, pulse(1, random), glow);
      }
    }
  }
  static void put(const ArrayLight& light, size_t i, const std::vector<double>& x, const std::vector<double>& y,
                  double electrons, std::vector<double>& glow) {
    const long columns = light.columns, rows = light.rows, reach_x = static_cast<long>(x.size() / 2),
               reach_y = static_cast<long>(y.size() / 2), column = static_cast<long>(i) % columns,
               row = static_cast<long>(i) / columns;
    for (long r = std::max(0L, row - reach_y); r <= std::min(rows - 1, row + reach_y); ++r)
      for (long c = std::max(0L, column - reach_x); c <= std::min(columns - 1, column + reach_x); ++c)
        glow[static_cast<size_t>(r * columns + c)] +=
            electrons * x[static_cast<size_t>(c - column + reach_x)] * y[static_cast<size_t>(r - row + reach_y)];
  }

  DetectorSpec d_;
  Tube tube_;
};

// Photoelectrons per lumen and second of a lamp of 2856 K.
double electrons_per_lumen(const Curve& quantum_efficiency) {
  std::vector<double> um, lamp;
  double electrons = 0;
  constexpr double step = 0.005;
  for (int i = 0; i <= 540; ++i) {  // 0.3 to 3 um
    um.push_back(0.3 + step * i), lamp.push_back(planck_radiance(um.back(), kLampKelvin));
    const double x = um.back();
    const bool known =
        quantum_efficiency.is_constant() || (x >= quantum_efficiency.low_um() && x <= quantum_efficiency.high_um());
    electrons +=
        (known ? quantum_efficiency.at(x) : 0) * lamp.back() * x * 1e-6 / (kPlanckConstant * kSpeedOfLight) * step;
  }
  return electrons / photopic(Curve(um, lamp, Outside::zero));
}

Tube read_tube(const Params& p, const DetectorSpec& d) {
  Tube t;
  const double lux = p.number_in("background_lx", 0, 1, "lx", 0);
  t.background = lux > 0 ? lux * electrons_per_lumen(d.quantum_efficiency) : 0;
  t.gain = p.number_in("gain_e", 1e-3, 1e7, "camera electrons of a photoelectron");
  t.excess = p.number_in("pulse_excess", 1, 100, "(F^2 of one pulse)", 1.6);
  if (const auto halo = p.find("halo")) {
    t.halo = halo->number_in("share", 0, 1, "(of the photoelectrons)");
    t.radius = halo->number_in("radius_um", 1e-3, 1e5, "um") * 1e-6;
  }
  if (const auto phosphor = p.find("phosphor")) {
    t.blur = phosphor->number_in("blur_um", 0, 1e4, "um", 0) * 1e-6;
    t.decay = phosphor->number_in("decay_ms", 0, 1e6, "ms", 0) * 1e-3;
  }
  t.most_rate = p.number_in("auto_gate_e_s", 0, kMostElectrons, "photoelectrons/s of a pixel", 0);
  return t;
}

}  // namespace

ArrayDetectorRow intensifier_row() {
  return {"intensifier", "image intensifier in front of a camera: pulse heights, halo, phosphor (Csorba 1985)", "DN",
          [](const Params& p, DetectorSpec& d) {
            read_pixels(p, "dark_current_e_s", d);
            read_converter(p, kDarkBias, d);
            d.read_noise = p.number_in("read_noise_e", 0, kMostElectrons, "electrons", 0);
            return std::make_shared<Intensifier>(d, read_tube(p, d));
          }};
}

}  // namespace suite
