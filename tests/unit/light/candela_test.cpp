// A lamp of a photometric file: its spectrum counts on whatever scale, the file's candela say how much light it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "light/kinds/lamp_intensity.h"
#include "light/light_rows.h"
#include "spectral/photopic.h"
#include "support/conformance.h"
#include "support/message_of.h"

namespace suite::candela_test {
namespace {

LightSpecPtr lamp(const std::string& intensity, const Curve& spectrum) {
  static std::vector<AskedCurve> asked;
  LightContext context;
  context.curve = [&](const Params& p) {
    p.as_text();
    return spectrum;
  };
  context.candela = [](const Params& p) {
    EXPECT_EQ(p.as_text(), "street.ies");
    return IntensityTable{{100, 50, 0}, 3, 1, nullptr};
  };
  context.asked = &asked;
  const Params text = Params::parse_text(
      "kind: point\nposition_m: [0, 0, 3]\nintensity: " + intensity + "\ndistribution: {ies: street.ies}\n",
      "sim.yaml");
  for (const LightRow* key : light_keys())
    if (key->key() == "lamps") return make_light(*key, text, context);
  return nullptr;
}

TEST(Candela, ScaleTheSpectrumToOne) {
  const SpectralState state = test::test_state(1);
  for (const double scale : {1.0, 7.0}) {
    const LightSpecPtr light = lamp("7", Curve::constant(scale));
    std::vector<LightSpectra> spectra;
    light->add_spectra(spectra);
    ASSERT_EQ(spectra.size(), 1u);
    EXPECT_NEAR(spectra[0].over(state)[0][0], 1 / (683.002 * 0.106857), 1e-6) << scale;
  }
}

TEST(Candela, TheTableIsTheFiles) {
  LampSpec spec;
  spec.table = std::make_shared<IntensityTable>(IntensityTable{{100, 50, 0}, 3, 1, nullptr});
  EXPECT_DOUBLE_EQ(relative_intensity(spec, {0, 0, 1}), 100);
  EXPECT_NEAR(relative_intensity(spec, normalized(Dir{1, 0, 1})), 75, 1e-9);
}

TEST(Candela, WantASpectrumThatTheEyeSees) {
  EXPECT_THAT(message_of([] {
                lamp("3", Curve({0.5, 0.6}, {1, 1}, Outside::error));
              }),
              testing::AllOf(testing::HasSubstr("sim.yaml:3"), testing::HasSubstr("0.38 to 0.78 um")));
  EXPECT_THAT(message_of([] {
                lamp("3", Curve({8, 12}, {1, 1}, Outside::zero));
              }),
              testing::HasSubstr("no light that the eye sees"));
}

}  // namespace
}  // namespace suite::candela_test
