// Single photons through several pixels behind each spot, as ICESat-2 counts them (16 for a strong beam, 4 for a weak
// one, some 3 ns of dead time each).
#include "detection/kinds/counting_keys.h"

namespace suite {

namespace {

class PhotonCounting : public LidarDetector {
 public:
  PhotonCounting(const Params& p, const PulseShape& pulse) : pulse_(pulse) {
    rates_.efficiency = p.number_in("detection_efficiency", 0, 1, "counts per photon");
    rates_.dark = p.number_in("dark_rate_hz", 0, 1e12, "counts/s", 0);  // of all pixels of a spot together
    pixels_ = static_cast<uint32_t>(p.integer("pixels_per_spot", 1, 4096));
    counting_ = read_counting(p, true);
    step_ = read_counting_step(p, pulse);
    check_step(p, step_, pulse.fwhm());
  }
  std::string sample_unit() const override { return "primary electrons"; }
  bool counts_photons() const override { return true; }
  std::vector<PixelRecord> detect(const PulseLight& light, uint64_t key) const override {
    const SampleGrid grid = samples_for(light, step_, pixels_);
    std::vector<PixelRecord> records(light.pixels.size());
    for (size_t spot = 0; spot < records.size(); ++spot) {
      const PixelLight& pixel = light.pixels[spot];
      Expected whole = expect_electrons(pixel.arrivals, pixel.passive, pulse_, rates_, grid), part = whole;
      for (double& n : part.signal) n /= pixels_;
      part.background /= pixels_;
      const std::vector<Expected> shared(pixels_, part);
      Pcg32 random = stream_of(key, 0, light.pulse, spot);
      PixelRecord& r = records[spot];
      add_clicks({&r, 1}, count_primaries(counting_, shared, pixels_, random), pixels_);
      r.grid = grid, r.level = whole.background, r.background_rate = whole.background / grid.step;
      r.ideal_samples = std::move(whole.signal);
      for (double& n : r.ideal_samples) n += whole.background;
    }
    return records;
  }

 private:
  PulseShape pulse_;
  ElectronRates rates_;
  CountingSpec counting_;
  uint32_t pixels_ = 1;
  double step_ = 0;
};

}  // namespace

LidarDetectorRow photon_counting_detector_row() {
  return {"photon_counting", "single photons through several pixels behind each spot, with a dead time (as ICESat-2)",
          "1", [](const Params& p, const PulseShape& pulse) { return std::make_unique<PhotonCounting>(p, pulse); }};
}

}  // namespace suite
