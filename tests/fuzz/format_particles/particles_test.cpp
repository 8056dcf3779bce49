#include "formats/particles/particles.h"
#include "support/fuzz.h"

namespace suite::format_particles_particles_test {

namespace {
// What is accepted can be asked.
void check(std::span<const std::byte> b) {
  const ReadParticles r = parse_particles({reinterpret_cast<const char*>(b.data()), b.size()}, "p.txt");
  const std::vector<double> ends{r.data.wavelengths_um.front(), r.data.wavelengths_um.back()};
  const ParticleOptics optics = r.data.optics(ends);
  for (size_t i = 0; i < optics.size(); ++i)
    for (const float p : optics.phase(i))
      if (!(p >= 0)) throw std::runtime_error("a phase function that is none");
}
const std::vector<std::string> kWords{"nan",           "1e30",           "-1",     "0",         "180", "\n",
                                      "share_2",       "wavelength_um ", "moment", "asymmetry", ",",   "#",
                                      "phase_relative"};
}  // namespace

TEST(FuzzParticles, Angles) {
  test::fuzz(test::bytes_of("wavelength_um, extinction_relative, albedo\n0.4,1.2,0.9\n0.55,1,0.95\n0.9,0.7,0.96\n"
                            "wavelength_um, angle_deg, phase_per_sr\n0.5, 0, 0.1193662\n0.5, 60, 0.0994718\n"
                            "0.5, 180, 0.0397887\n0.8, 0, 0.0795775\n0.8, 180, 0.0795775\n"),
             check, 31, test::kMutations, kWords);
}

TEST(FuzzParticles, Moments) {
  test::fuzz(test::bytes_of("wavelength_um, extinction_m2_g, albedo\n0.4,1.2,0.9\n0.9,0.7,0.96\n"
                            "wavelength_um order moment\n0.5 0 1\n0.5 1 0.2\n0.5 2 0.05\n0.8 0 1\n"),
             check, 32, test::kMutations, kWords);
}

TEST(FuzzParticles, Asymmetries) {
  test::fuzz(
      test::bytes_of("wavelength_um extinction_m2_g albedo asymmetry asymmetry_2 share_2\n0.4 1.2 0.9 0.7 -0.2 0.1\n"
                     "0.9 0.7 0.96 0.7 -0.1 0.2\n"),
      check, 33, test::kMutations, kWords);
}

}  // namespace suite::format_particles_particles_test
