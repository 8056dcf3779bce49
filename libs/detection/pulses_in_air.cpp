#include "detection/pulses_in_air.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

double FoldedRows::listening(const ResponsePulse& pulse, double next) const {
  return how_ == PulsesInAir::fold ? next - pulse.time : std::numeric_limits<double>::infinity();
}

std::vector<PhotonArrival> FoldedRows::arrivals(const ResponseRow& row, double next) {
  const ResponsePulse& pulse = row.pulse();
  if (!(next > pulse.time))
    throw Error(strf("pulse %llu is emitted at %.12g s, not before the one behind it",
                     static_cast<unsigned long long>(row.pulse_number()), pulse.time),
                "pulses in the order of their emission");
  if (late_.size() < head_.pixel_count()) late_.resize(head_.pixel_count());
  const double interval = next - pulse.time;
  std::vector<PhotonArrival> all;
  std::deque<Late>& late = late_[row.pixel()];
  // What earlier pulses left for this one.
  std::deque<Late> still;
  for (const Late& l : late) {
    const double after = l.time - pulse.time;
    if (after < interval)
      all.push_back({after, l.photons, l.variance});
    else
      still.push_back(l);
  }
  late = std::move(still);
  for (size_t k = 0; k < row.size(); ++k) {
    if (row.bin(k) == 0) continue;
    const PhotonArrival a{arrival_of_bin(head_, pulse, row.bin(k)), row.photons(k), row.photon_variance(k)};
    if (how_ == PulsesInAir::unfold || a.time < interval) {
      all.push_back(a);
    } else if (how_ == PulsesInAir::fold) {
      late.push_back({pulse.time + a.time, a.photons, a.variance});
    } else if (a.photons > 0) {
      throw Error(
          strf("pulse %llu: light arrives %.9g s after its emission, the next pulse leaves after %.9g s "
               "(ranges beyond %.6g m are ambiguous)",
               static_cast<unsigned long long>(row.pulse_number()), a.time, interval, interval * kSpeedOfLight / 2),
          "say pulses_in_air: fold (as a receiver sees it) or unfold (as if it knew the pulse)");
    }
  }
  std::sort(all.begin(), all.end(), [](const PhotonArrival& a, const PhotonArrival& b) { return a.time < b.time; });
  return all;
}

}  // namespace suite
