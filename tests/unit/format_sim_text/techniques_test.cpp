// `techniques` of a simulation text: each name switches its technique off, others are refused with the names there are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/files.h"
#include "formats/sim_text/sim_text.h"
#include "support/message_of.h"
#include "support/temp_folder.h"
#include "transport/technique_switches.h"

namespace suite::format_sim_text_techniques_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

PipelineOptions read(const std::string& techniques) {
  const TempFolder folder;
  write_file(folder / "sim.yaml",
             "scene: s.h5\n" + techniques +
                 "\nsensors:\n  - {kind: frame_camera, columns: 4, rows: 3, pitch_um: 5, focal_length_mm: 9, "
                 "position_m: [0, 0, 60], look_at_m: [0, 0, 0], bands: [{name: p, center_um: 10, fwhm_um: 1}]}\n");
  return read_simulation(folder / "sim.yaml", {}).pipeline;
}
// Which are on.
std::vector<bool> on(const PipelineOptions& o) {
  return {o.explicit_sources, o.refracted_sources, o.volume_chains, o.side_flights, o.equiangular, o.gloss_photons > 0};
}

TEST(Techniques, EachNameSwitchesItsOwnOff) {
  const std::vector<bool> all(6, true);
  EXPECT_EQ(on(read("")), all);
  const auto named = named_techniques();
  ASSERT_EQ(std::ranges::count_if(named, [](const NamedTechnique& t) { return t.off != nullptr; }), 6);
  for (size_t i = 0; i < all.size(); ++i) {
    const std::string name = named[i].name;
    std::vector<bool> others = all;
    others[i] = false;
    EXPECT_EQ(on(read("techniques: {" + name + ": off}")), others) << name;
    EXPECT_EQ(on(read("techniques: {" + name + ": on}")), all) << name;
  }
  EXPECT_EQ(on(read("techniques: {manifold: off, side_vertex: false}")),
            (std::vector<bool>{true, false, true, false, true, true}));
}

TEST(Techniques, OthersAreRefusedWithTheirPlace) {
  EXPECT_THAT(message_of([] { read("techniques: {manifolds: off}"); }),
              AllOf(HasSubstr("sim.yaml:2"), HasSubstr("there is no technique 'manifolds'"),
                    HasSubstr("one of: light_sampling, manifold, volume_chains, side_vertex, "
                              "equiangular, caustic_guide")));
  EXPECT_THAT(message_of([] { read("techniques: {manifold: 3}"); }), HasSubstr("sim.yaml:2"));
  // Without it light would be missing, which no other technique brings.
  EXPECT_THAT(message_of([] { read("techniques: {adjacency: off}"); }),
              AllOf(HasSubstr("sim.yaml:2"), HasSubstr("'adjacency' has no switch here"),
                    HasSubstr("atmosphere: {adjacency: false}")));
}

}  // namespace
}  // namespace suite::format_sim_text_techniques_test
