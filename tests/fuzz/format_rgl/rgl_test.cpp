#include "formats/rgl/rgl.h"
#include "support/fuzz.h"
#include "support/tensor_file.h"

namespace suite::format_rgl_rgl_test {

namespace {
void parse_and_ask(std::span<const std::byte> bytes) {
  const auto brdf = parse_rgl(bytes, "x.bsdf");
  std::vector<double> f(brdf->info().wavelength_um.size());
  for (const double theta : {0.0, 0.4, 1.2, 1.57}) {
    brdf->value(dir_from_angles(theta, 0.1), dir_from_angles(1.5 - theta / 2, -2), f);
    for (const double x : f)
      if (!(x >= 0)) throw std::runtime_error("a value that is negative or not a number came out");
  }
}
}  // namespace

TEST(FuzzRgl, Isotropic) { test::fuzz(test::small_rgl({0.0f}, 0).build(), parse_and_ask, 1); }
TEST(FuzzRgl, AnisotropicSpectral) {
  test::fuzz(test::small_rgl({-3.14159265f, 0.0f, 3.14159265f}, 4).build(), parse_and_ask, 2);
}

}  // namespace suite::format_rgl_rgl_test
