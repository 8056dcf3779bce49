// Waveforms and photons under the names of public products, read back as any HDF5 file.
#include <gtest/gtest.h>

#include "formats/hdf5/foreign.h"
#include "formats/lidar_hdf/photons.h"
#include "formats/lidar_hdf/waveforms.h"
#include "support/temp_folder.h"

namespace suite::format_lidar_hdf_lidar_hdf_test {
namespace {

std::vector<double> values(const h5::Foreign& file, const std::string& name) { return file.table(name).values; }

TEST(LidarHdf, WaveformsOfManyShots) {
  const TempFolder folder;
  WaveformWriter writer(folder / "w.h5", "a test");
  const std::vector<double> transmitted{0, 0.5, 1, 0.5, 0};
  writer.begin_beam(5, "als", 1e-9, transmitted);
  constexpr size_t kShots = 3000, kSamples = 200;  // beyond what waits in memory
  for (size_t s = 0; s < kShots; ++s) {
    std::vector<double> samples(kSamples + s % 2, static_cast<double>(s));
    WaveformShot shot;
    shot.shot = s, shot.samples = shot.ideal = shot.ideal_error = samples, shot.first = {50, 8, 120},
    shot.delta_time = 0.5;
    writer.add(5, shot);
  }
  writer.finish();
  EXPECT_EQ(folder.entries(), size_t{1});  // nothing waits any longer
  const h5::Foreign file(folder / "w.h5");
  const auto wave = values(file, "/BEAM0101/rxwaveform"), start = values(file, "/BEAM0101/rx_sample_start_index"),
             count = values(file, "/BEAM0101/rx_sample_count");
  ASSERT_EQ(start.size(), kShots);
  for (const size_t s : {size_t{0}, size_t{1}, size_t{2999}}) {
    EXPECT_EQ(count[s], kSamples + s % 2);
    EXPECT_EQ(wave[static_cast<size_t>(start[s]) - 1], s);
    EXPECT_EQ(wave[static_cast<size_t>(start[s] + count[s]) - 2], s);
  }
  EXPECT_EQ(wave.size(), kShots * kSamples + kShots / 2);
  EXPECT_EQ(values(file, "/BEAM0101/txwaveform"), transmitted);
  EXPECT_EQ(values(file, "/BEAM0101/geolocation/elevation_bin0")[7], 120);
}

TEST(LidarHdf, Photons) {
  const TempFolder folder;
  PhotonWriter writer(folder / "p.h5", "a test");
  for (uint32_t k = 0; k < 5; ++k) writer.add(1, {{50, 8, 100.0 + k}, 1.5, 7.0 * k, 0, 3, k, k % 2 == 0});
  writer.add_pulse(1, 1.5, 2e6, 1e-4);
  writer.finish();
  const h5::Foreign file(folder / "p.h5");
  EXPECT_EQ(values(file, "/gt1r/heights/h_ph"), (std::vector<double>{100, 101, 102, 103, 104}));
  EXPECT_EQ(values(file, "/gt1r/heights/signal_conf_ph"), (std::vector<double>{4, 0, 4, 0, 4}));
  EXPECT_EQ(values(file, "/gt1r/heights/dist_ph_along")[4], 28);
  EXPECT_EQ(values(file, "/gt1r/bckgrd_atlas/bckgrd_rate")[0], 2e6);
}

}  // namespace
}  // namespace suite::format_lidar_hdf_lidar_hdf_test
