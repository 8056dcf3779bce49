// The night street with few pixels and paths: generated, prepared, rendered; lit streets, dark roofs, the same bytes
// for any number of threads; lists of sources.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/run_command.h"

using namespace suite;
using testing::HasSubstr;

namespace {
const std::string kBin = SUITE_BIN_DIR "/";
}

TEST(NightStreet, LampsLightTheStreets) {
  const TempFolder folder;
  const auto run = [&](const std::string& command) { return run_command("cd " + folder.path() + " && " + command); };
  const CommandResult made = run("python3 " SUITE_SOURCE_DIR "/sample_scenes/night_street/make_scene.py . 96 54");
  ASSERT_EQ(made.code, 0) << made.err;
  ASSERT_EQ(run(kBin + "scene-prep scene.yaml -o scene.h5 -q").code, 0);
  const CommandResult one = run(kBin + "dirsig-render sim.yaml -o one --paths 16 -q -j 1");
  ASSERT_EQ(one.code, 0) << one.err;
  ASSERT_EQ(run(kBin + "dirsig-render sim.yaml -o two --paths 16 -q -j 2").code, 0);
  EXPECT_EQ(sha256(read_text(folder / "one/night.img")), sha256(read_text(folder / "two/night.img")));
  const EnviImage radiance(folder / "one/night.img"), truth(folder / "one/night_truth.img");
  const std::vector<double> l = radiance.read_all(), t = truth.read_all();
  const size_t bands = radiance.header().bands, columns = truth.header().bands;
  // Median radiance of asphalt and of grass in green: lamps hang over the streets, and light the lawns beside them a
  // little.
  auto median_of = [&](const std::string& name) {
    const std::string& text = truth.header().description;
    const size_t at = text.find("=" + name);
    const double id = std::atof(text.substr(text.rfind(' ', at)).c_str());
    std::vector<double> v;
    for (size_t p = 0; p < t.size() / columns; ++p)
      if (t[p * columns] == id) v.push_back(l[p * bands + 1]);
    EXPECT_GT(v.size(), 100u) << name;
    std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  const double street = median_of("asphalt"), lawn = median_of("grass");
  EXPECT_GT(street, 0.005);
  EXPECT_GT(street, 2 * lawn);
  for (const double v : l) ASSERT_TRUE(std::isfinite(v) && v >= 0);
}

TEST(NightStreet, ListsTheKindsOfSources) {
  const CommandResult r = run_command(kBin + "dirsig-render --list-sources");
  EXPECT_EQ(r.code, 0);
  for (const char* kind : {"clear", "thermal", "image", "spot", "moon"}) EXPECT_THAT(r.out, HasSubstr(kind));
}
