// Geiger-mode avalanche photodiodes: framed (one count a gate) or asynchronous (again after a dead time).
#include "base/required.h"
#include "detection/kinds/counting_keys.h"

namespace suite {

namespace {

class GeigerDetector : public LidarDetector {
 public:
  GeigerDetector(const Params& p, const PulseShape& pulse) : pulse_(pulse) {
    framed_ = required(p, "mode", {"framed", "asynchronous"}).as_choice({"framed", "asynchronous"}) == 0;
    rates_.efficiency = p.number_in("detection_efficiency", 0, 1, "counts per photon");
    rates_.dark = p.number_in("dark_rate_hz", 0, 1e12, "counts/s", 0);
    counting_ = read_counting(p, !framed_);
    step_ = read_counting_step(p, pulse);
    check_step(p, step_, pulse.fwhm());
  }
  // Of framed pixels the probability that the first count is in a sample; of others the expected primaries.
  std::string sample_unit() const override { return framed_ ? "probability" : "primary electrons"; }
  bool counts_photons() const override { return true; }
  std::vector<PixelRecord> detect(const PulseLight& light, uint64_t key) const override {
    const SampleGrid grid = samples_for(light, step_);
    std::vector<Expected> expected;
    for (const PixelLight& pixel : light.pixels)
      expected.push_back(expect_electrons(pixel.arrivals, pixel.passive, pulse_, rates_, grid));
    std::vector<PixelRecord> records(expected.size());
    Pcg32 random = stream_of(key, 0, light.pulse);
    add_clicks(records, count_primaries(counting_, expected, light.columns, random), 1);
    for (size_t p = 0; p < records.size(); ++p) tell_ideal(expected[p], records[p]);
    return records;
  }

 private:
  void tell_ideal(const Expected& e, PixelRecord& r) const {
    r.grid = e.grid, r.background_rate = e.background / e.grid.step;
    if (!framed_) {
      r.ideal_samples = e.signal;
      for (double& n : r.ideal_samples) n += e.background;
      return;
    }
    FirstCount first = first_count(e);
    if (first.any > 0) {
      LidarReturn mean;
      mean.time = first.mean, mean.deviation = first.deviation, mean.amplitude = first.any;
      r.ideal_returns.push_back(mean);
    }
    r.ideal_samples = std::move(first.probability);
  }

  PulseShape pulse_;
  ElectronRates rates_;
  CountingSpec counting_;
  bool framed_ = true;
  double step_ = 0;
};

}  // namespace

LidarDetectorRow geiger_detector_row() {
  return {"geiger", "Geiger-mode APD array: first counts of framed pixels, or asynchronous counts with a dead time",
          "1", [](const Params& p, const PulseShape& pulse) { return std::make_unique<GeigerDetector>(p, pulse); }};
}

}  // namespace suite
