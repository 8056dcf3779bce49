#include "light/sky_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "math/quick_angle.h"
#include "math/sampling.h"

namespace suite {

namespace {

constexpr size_t kAzimuths = 144;  // around, of nodes
constexpr float kSame = 0.002f;    // of a step of heights

// Draws from the table of a sky, and leaves the radiance to the air.
class AskedSky final : public Light {
 public:
  explicit AskedSky(const SkySpec& density) : sky_(density) {
    nature_.far = nature_.wide = true;
    nature_.drawn = sky_.tabulated();
  }
  std::optional<LightSample> sample(const LightReceiver&, const std::array<double, 4>& u, double) const override {
    const DirectionSample drawn = sky_.draw({u[0], u[1]});
    if (!(drawn.density > 0)) return std::nullopt;
    LightSample sample;
    sample.direction = drawn.direction;
    sample.density = drawn.density;
    sample.scale = 1;
    return sample;
  }
  double density(Dir direction) const { return sky_.density(direction); }
  size_t members() const override { return 0; }
  std::optional<LightSample> sample_member(size_t, double, const LightReceiver&, const std::array<double, 4>&,
                                           double) const override {
    throw Bug("the sky of the air has no members");
  }

 private:
  Sky sky_;
};

template <size_t kRows>
void sum(const float* const* rows, const float* shares, std::span<float> to) {
  float* __restrict const out = to.data();
  for (size_t i = 0; i < to.size(); ++i) {
    float s = 0;
    for (size_t r = 0; r < kRows; ++r) s += shares[r] * rows[r][i];
    out[i] = s;
  }
}

}  // namespace

SkyTable::SkyTable(size_t bins, bool even, std::optional<double> symmetric, double step, Radiance radiance)
    : step_(step),
      bins_(bins),
      columns_(even        ? 1
               : symmetric ? kAzimuths / 2 + 1
                           : kAzimuths),
      symmetric_(symmetric),
      turns_(even ? 0 : kAzimuths / (2 * kPi)),
      radiance_(std::move(radiance)),
      floors_(static_cast<size_t>((kHighest - kLowest) / step) + 1) {}

void SkyTable::fill(size_t index, size_t row) const {
  const double theta = static_cast<double>(row) * (kPi / 2) / (kRows - 1),
               height = kLowest + static_cast<double>(index) * step_;
  for (size_t c = 0; c < columns_; ++c) {
    Dir d = dir_from_angles(theta, symmetric_.value_or(0) + static_cast<double>(c) * 2 * kPi / kAzimuths);
    d.z = std::max(d.z, 0.0);
    radiance_(height, d, {&floors_[index].table[(row * columns_ + c) * bins_], bins_});
  }
}

void SkyTable::make_row(size_t floor, size_t row) const {
  Floor& of = floors_[floor];
  std::call_once(of.once, [&] { of.table.resize(kRows * columns_ * bins_); });
  std::call_once(of.row_once[row], [&] {
    fill(floor, row);
    of.made[row].store(true, std::memory_order_release);
  });
}

inline double SkyTable::column(double azimuth) const {
  if (columns_ == 1) return 0;
  double turn = azimuth - symmetric_.value_or(0);
  turn -= 2 * kPi * std::floor(turn / (2 * kPi));
  if (symmetric_ && turn > kPi) turn = 2 * kPi - turn;
  return turn * turns_;
}

SkyTable::Place SkyTable::place(double height, double polar, double azimuth) const {
  const double row = std::min(polar * ((kRows - 1) / (kPi / 2)), static_cast<double>(kRows - 1)), col = column(azimuth);
  const auto r = std::min(static_cast<size_t>(row), kRows - 2), c = std::min(static_cast<size_t>(col), columns_ - 1);
  const size_t next = c + 1 < columns_ ? c + 1 : symmetric_ || columns_ == 1 ? c : 0;
  const double above = (height - kLowest) / step_;
  const auto low = std::min(static_cast<size_t>(above), floors_.size() - 2);
  return {r,
          c,
          next,
          low,
          static_cast<float>(row - static_cast<double>(r)),
          static_cast<float>(col - static_cast<double>(c)),
          static_cast<float>(above - static_cast<double>(low))};
}

void SkyTable::radiance(double height, Dir d, std::span<float> to) const {
  const auto [r, c, next, low, v, u, rise] = place(height, quick_polar_angle(d), quick_azimuth(d));
  const float weight[4] = {(1 - v) * (1 - u), (1 - v) * u, v * (1 - u), v * u};
  const float* rows[8];
  float share[8];
  const auto take = [&](size_t index, float part, size_t first) {
    const float *upper = row(index, r), *lower = row(index, r + 1);
    const float* const corners[4] = {upper + c * bins_, upper + next * bins_, lower + c * bins_, lower + next * bins_};
    for (size_t i = 0; i < 4; ++i) rows[first + i] = corners[i], share[first + i] = part * weight[i];
  };
  if (rise < kSame || rise > 1 - kSame) {
    take(rise < kSame ? low : low + 1, 1, 0);
    return sum<4>(rows, share, to);
  }
  take(low, 1 - rise, 0);
  take(low + 1, rise, 4);
  sum<8>(rows, share, to);
}

const float* SkyTable::drawn(double height, Dir d) const {
  // What is drawn needs no more than single precision.
  const auto x = static_cast<float>(d.x), y = static_cast<float>(d.y), z = static_cast<float>(d.z);
  const float polar = quick_atan2(std::sqrt(x * x + y * y), z), azimuth = quick_atan2(y, x);
  const auto [r, c, next, low, v, u, rise] = place(height, double{polar}, double{azimuth});
  const uint64_t by_chance =
      hash_of(std::bit_cast<uint64_t>(d.x), std::bit_cast<uint64_t>(d.y) ^ std::rotl(std::bit_cast<uint64_t>(d.z), 32));
  // Three numbers of 21 bits.
  const auto below = [&](int number, float share) {
    constexpr uint64_t kMost = (1u << 21) - 1;
    return static_cast<float>(by_chance >> (21 * number) & kMost) < share * static_cast<float>(kMost + 1);
  };
  const float* const at =
      row(below(0, rise) ? low + 1 : low, below(1, v) ? r + 1 : r) + (below(2, u) ? next : c) * bins_;
  // Read when the light is known to arrive, somewhere in megabytes.
  constexpr size_t kLine = 64 / sizeof(float), kAhead = 16;
  for (size_t i = 0; i < std::min(bins_, kAhead * kLine); i += kLine) __builtin_prefetch(at + i);
  return at;
}

void SkyTable::make_light() {
  std::vector<size_t> all(bins_);
  std::iota(all.begin(), all.end(), size_t{0});
  const SkySpec density = weights(all, [](double) { return 1.0; });
  if (std::all_of(density.table.begin(), density.table.end(), [](double v) { return !(v > 0); })) return;
  auto light = std::make_unique<const AskedSky>(density);
  density_ = [asked = light.get()](Dir d) { return asked->density(d); };
  light_ = std::move(light);
}

const SkyThroughWater& SkyTable::through_water(std::span<const size_t> knots) const {
  std::call_once(water_once_, [&] {
    std::vector<SkySpec> specs;
    // What water lets through; its reflectance at normal incidence is next to nothing. C. Schlick, "An inexpensive BRDF
    // model for physically-based rendering", Computer Graphics Forum 13(3), 1994.
    for (const size_t bin : knots)
      specs.push_back(weights({&bin, 1}, [](double cosine) { return cosine * (1 - std::pow(1 - cosine, 5)); }));
    through_water_ = std::make_unique<const SkyThroughWater>(specs);
  });
  return *through_water_;
}

// Of directions at height 0: the mean of some bins, each of which counts alike, that is divided by its flux, times a
// weight of the zenith angle's cosine.
SkySpec SkyTable::weights(std::span<const size_t> bins, const std::function<double(double)>& weight) const {
  const auto ground = static_cast<size_t>(-kLowest / step_);
  isolated([&] {
    parallel_for(0, kRows, 1, [&](size_t begin, size_t end) {
      for (size_t r = begin; r < end; ++r) row(ground, r);
    });
  });
  const auto at = [&](size_t r, size_t column) { return row(ground, r) + column * bins_; };
  const auto weight_of = [&](size_t row) {
    return weight(std::max(0.0, std::cos(static_cast<double>(row) * kPi / 180)));
  };
  SkySpec spec;
  spec.radiance = Curve::constant(1);
  spec.zeniths = kRows;
  spec.azimuths = columns_ == 1 ? 1 : kAzimuths;
  spec.table.assign(spec.zeniths * spec.azimuths, 0.0);
  std::vector<double> flux(bins.size(), 0.0);
  for (size_t r = 0; r < kRows; ++r)
    for (size_t c = 0; c < columns_; ++c)
      for (size_t i = 0; i < bins.size(); ++i)
        flux[i] += weight_of(r) * std::sin(static_cast<double>(r) * kPi / 180) * double{at(r, c)[bins[i]]};
  for (size_t r = 0; r < kRows; ++r)
    for (size_t c = 0; c < spec.azimuths; ++c) {
      const double phi = static_cast<double>(c) * 2 * kPi / static_cast<double>(spec.azimuths);
      const auto from = std::min(static_cast<size_t>(std::lround(column(phi))), columns_ - 1);
      double mean = 0;
      for (size_t i = 0; i < bins.size(); ++i)
        if (flux[i] > 0) mean += double{at(r, from)[bins[i]]} / flux[i];
      spec.table[r * spec.azimuths + c] = weight_of(r) * mean;
    }
  return spec;
}

}  // namespace suite
