#include "flags_report.h"

#include "base/diagnostics.h"
#include "base/run_app.h"

namespace suite {

namespace {

constexpr double kManyClipped = 0.01;  // share of a sensor's pixels

double share(uint64_t part, uint64_t whole) { return static_cast<double>(part) / static_cast<double>(whole); }

// "sensor 'p': 3 of 8 pixels are flagged (38 %): "
std::string flagged_text(const std::string& sensor, uint64_t part, uint64_t whole, const char* what) {
  return strf("sensor '%s': %llu of %llu pixels are %s (%.3g %%): ", sensor.c_str(),
              static_cast<unsigned long long>(part), static_cast<unsigned long long>(whole), what,
              100 * share(part, whole));
}

}  // namespace

void DetectorFlags::take(const Delivery& delivery) {
  depolarised_.take(delivery);
  Count& count = of_[delivery.sensor.name()];
  for (const uint8_t q : delivery.result.quality) {
    if (!(q & quality_clipped)) continue;
    ++count.clipped;
    count.alone += q == quality_clipped;
  }
}

void DetectorFlags::add_to(JobReport& report) const {
  depolarised_.report();
  for (SensorQuality& q : report.quality) {
    const auto found = of_.find(q.sensor);
    if (found == of_.end() || !found->second.clipped) continue;
    q.counts.add(quality_clipped, found->second.clipped, found->second.alone);
    report.share_flagged += share(found->second.alone, report.problems);
  }
}

void report_quality(std::span<const SensorQuality> sensors) {
  QualityCounts all;
  for (const auto& [sensor, counts] : sensors) {
    note(counts.flagged ? flagged_text(sensor, counts.flagged, counts.problems, "flagged") + text_of(counts)
                        : strf("sensor '%s': no pixel is flagged", sensor.c_str()));
    for (size_t i = 0; i < all.of.size(); ++i) all.of[i] += counts.of[i];
    if (const uint64_t n = counts.with(quality_clipped); share(n, counts.problems) > kManyClipped)
      emit({Dr::clipped,
            flagged_text(sensor, n, counts.problems, "clipped") +
                "their counts stand at an end of the converter or their charge at the full well; another integration "
                "time, gain_e_per_dn, bias_dn, bits or full_well_e holds them"});
  }
  for (const QualityBit& b : quality_bits())
    if (all.with(b.bit)) note(b.name + ": " + b.meaning);
}

}  // namespace suite
