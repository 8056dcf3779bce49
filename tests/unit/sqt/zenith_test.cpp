// Seen along the normal the azimuth means nothing: whatever a file holds, values do not depend on it there and do not
// jump beside it, and the integral over directions stays the total.
//
// Right values: a slice multiplied by 2^(a cos(azimuth)) has the mean over azimuth of the slice itself but for a factor
// (the Bessel function I0(a ln 2)), which the total takes away.
#include <gtest/gtest.h>

#include "math/sampling.h"
#include "sqt/reciprocity.h"
#include "sqt_fit/errors.h"
#include "support/sqt_examples.h"

namespace suite::sqt::zenith_test {
namespace {

using test::Analytic;

constexpr double kOctaves = 0.1;  // of the spoiled slices, either way: 14 % in all

Analytic two_sided() {
  return Analytic(
      [](Dir o, Dir i) {
        i.z = std::fabs(i.z);
        return 0.3 * test::glossy_value(o, i, 0.3);
      },
      1, Domain::sphere);
}
AlignedData aligned(const Analytic& f, std::optional<LobeFrame> frame = {}) {
  AlignedSource::Options options = test::small_options();
  options.frame = frame;
  options.views = 5;
  return encode_aligned(AlignedSource(f, options), 0.1).data;
}
// As files are whose data, cells or coding depend on azimuth: slices at the normal that do.
AlignedData spoiled(AlignedData d) {
  for (AlignedSheet& s : d.sheets)
    for (size_t i = 0; i < s.leaves.size(); ++i)
      for (size_t c = 0; c < d.layout.channels; ++c)
        for (size_t j = 0; j < d.layout.phi_count; ++j) {
          const double turn = 2 * kPi * static_cast<double>(j) / static_cast<double>(d.layout.phi_count);
          int16_t& value = s.plane[(i * d.layout.width() + c * d.layout.views() + j) * AlignedSheet::kStride];
          value = static_cast<int16_t>(value + std::lround(kOctaves * (1 << s.scale.fraction_bits) *
                                                           std::cos(azimuth(center_of(s.leaves[i])) - turn)));
        }
  return d;
}
PaperData spoiled(PaperData d) {
  for (size_t c = 0; c < d.function.wavelength_um.size(); ++c)
    for (PaperLeaf& leaf : d.slices[c])
      leaf.value *= static_cast<float>(std::exp2(kOctaves * std::cos(azimuth(center_of(leaf.id)))));
  return d;
}

struct Case {
  const char* name;
  std::shared_ptr<const Bundle> plain, spoiled;
};
const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    auto make = [](const char* name, const AlignedData& d) {
      return Case{name, make_bundle(d), make_bundle(spoiled(d))};
    };
    const PaperData paper = test::small_paper(test::glossy(0.3));
    return std::vector<Case>{make("half", aligned(test::glossy(0.3, 9))),
                             make("direct", aligned(test::glossy(0.5), LobeFrame::direct)),
                             make("two_sided", aligned(two_sided())),
                             {"paper", make_bundle(paper), make_bundle(spoiled(paper))}};
  }();
  return all;
}

TEST(Zenith, ValuesDoNotDependOnAzimuthAndDoNotJump) {
  for (const Case& c : cases())
    for (const double polar : {5.0, 40.0, 75.0, 140.0}) {
      if (polar > 90 && c.plain->info().function.domain == Domain::hemisphere) continue;
      const size_t channels = c.spoiled->channels();
      std::vector<double> first(channels), f(channels);
      c.spoiled->value({0, 0, 1}, dir_from_angles(polar * kDegree, 0), first);
      for (int k = 0; k < 12; ++k) {
        const Dir in = dir_from_angles(polar * kDegree, 0.1 + 30 * k * kDegree);
        c.spoiled->value({0, 0, 1}, in, f);
        for (size_t n = 0; n < channels; ++n) {
          EXPECT_NEAR(f[n] / first[n], 1, 2e-6) << c.name << ' ' << polar << ' ' << k;
          EXPECT_EQ(c.spoiled->value({0, 0, 1}, in, n), f[n]) << c.name;
        }
        for (const double beside : {1e-9, 1e-6, 1e-4})
          EXPECT_NEAR(c.spoiled->value(dir_from_angles(beside, 50 * k * kDegree), in, 0) / first[0], 1,
                      1e-5 + 20 * beside)
              << c.name << ' ' << polar << ' ' << k << ' ' << beside;
      }
    }
}

TEST(Zenith, ValuesAreTheMeanOverAzimuth) {
  for (const Case& c : cases())
    for (const double polar : {3.0, 20.0, 50.0}) {
      const Dir in = dir_from_angles(polar * kDegree, 0.7);
      EXPECT_NEAR(c.spoiled->value({0, 0, 1}, in, 0) / c.plain->value({0, 0, 1}, in, 0), 1, 4e-3)
          << c.name << ' ' << polar;
    }
}

TEST(Zenith, MeanWeightIsTotal) {
  for (const Case& c : cases())
    for (const double theta : {0.0, 0.02, 0.1}) {
      const Dir out = dir_from_angles(theta, 0.4);
      const SampleStream stream(3, 0, 0);
      const uint32_t n = 1 << 16;
      double sum = 0;
      for (uint32_t i = 0; i < n; ++i) {
        const auto u = stream.draw(i, 0);
        if (const auto in = c.spoiled->sample(out, {u[0], u[1]}, u[2], 0))
          sum += c.spoiled->eval(out, *in, 0) / c.spoiled->pdf(out, *in, 0);
      }
      // Beside the normal the scale was found for the plain slices: second order in what was spoiled, 0.1^2.
      EXPECT_NEAR(sum / n / c.spoiled->total(out, 0), 1, theta > 0 ? 4e-3 : 1.5e-3) << c.name << ' ' << theta;
    }
}

// Measured data depend on azimuth there; a fit holds their mean.
TEST(Zenith, FitsHoldTheMeanOfDataThatDepend) {
  const Analytic f([](Dir o, Dir i) { return 0.2 * (1 + 0.3 * (o.z > 1 - 1e-9 ? i.x * i.x : 0.5 * (1 - i.z * i.z))); });
  const auto bundle = make_bundle(aligned(f));
  const double z = std::cos(0.9);
  EXPECT_NEAR(bundle->value({0, 0, 1}, dir_from_angles(0.9, 1.3), 0), 0.2 * (1 + 0.15 * (1 - z * z)), 1e-3);
  EXPECT_NEAR(make_bundle(test::small_paper(f))->value({0, 0, 1}, dir_from_angles(0.9, 1.3), 0),
              0.2 * (1 + 0.15 * (1 - z * z)), 5e-3);
}

// f = 1 + (cos out - cos in) / 2: the error is half the mean distance of two uniform cosines, L / 6, L = 1 - cos 80
// deg.
TEST(Reciprocity, IsItsClosedFormAndOneNumber) {
  const double L = 1 - std::cos(80 * kDegree);
  const auto found = reciprocity_error(1, [](Dir o, Dir i, std::span<double> f) { f[0] = 1 + 0.5 * (o.z - i.z); });
  EXPECT_NEAR(found[0], L / 6, 0.005 * L / 6);
  EXPECT_EQ(found[0], found[1]);
  const Analytic f([](Dir o, Dir i) { return 0.2 * (1 + 0.5 * (o.z - i.z)); });
  const auto bundle = make_bundle(aligned(f, LobeFrame::direct));
  const Reference reference(f, 2000);
  EXPECT_EQ(reference.findings().reciprocity_error,
            reciprocity_error(1, [&](Dir o, Dir i, std::span<double> v) { f.value(o, i, v); }).back());
  EXPECT_EQ(reference.measure(*bundle).back().reciprocity_error, reciprocity_error(*bundle).back());
  EXPECT_NEAR(reciprocity_error(*bundle).back(), L / 6, 0.02 * L / 6);
}

}  // namespace
}  // namespace suite::sqt::zenith_test
