#include "detection/response.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

BinKnown ResponseRow::known(uint32_t bin) const {
  const auto first = block_->bin.begin() + static_cast<std::ptrdiff_t>(block_->begin[row_]),
             last = first + static_cast<std::ptrdiff_t>(size());
  const auto found = std::lower_bound(first, last, bin);
  if (found == last || *found != bin) return {false, 0, 0, bound(), {0, bound()}};
  const auto k = static_cast<size_t>(found - first);
  return {true, photons(k), std::sqrt(photon_variance(k)), 0, photon_interval(k)};
}

BinInterval ResponseRow::interval(size_t k, size_t channel, double confidence) const {
  constexpr int kMany = 1 << 20;  // scrambles: as good as normal
  const double skewness = block_->skewness.empty() ? 0 : double{block_->skewness[at(k) * channels_ + channel]};
  return bin_interval(value(k, channel), std::sqrt(variance(k, channel)), skewness, scrambles_ ? scrambles_ : kMany,
                      confidence);
}

BinInterval ResponseRow::photon_interval(size_t k, double confidence) const {
  return interval_of_sum({value(k, kSingle), interval(k, kSingle, confidence)},
                         {value(k, kMultiple), interval(k, kMultiple, confidence)});
}

std::string fault_of(const ResponseHead& h) {
  if (!(h.bin >= 1e-13 && h.bin <= 1e-6)) return strf("bins of %g s, 1e-13 to 1e-6 are known", h.bin);
  if (h.bins < 1 || h.bins > 100000000) return strf("%u range bins, 1 to 1e8 are known", h.bins);
  if (h.channels.size() < 2 || h.channels[kSingle] != "single" || h.channels[kMultiple] != "multiple")
    return "channels that do not begin with 'single' and 'multiple'";
  if (h.channels.size() > 4096) return strf("%zu channels, at most 4096 are known", h.channels.size());
  if (h.scrambles != 0 && !(h.scrambles >= 2 && h.scrambles <= 64))
    return strf("errors of %d scrambles, 2 to 64 are known", h.scrambles);
  if (h.pixels.empty() || uint64_t{h.columns} * h.rows != h.pixels.size())
    return strf("%zu directions of pixels for %u x %u", h.pixels.size(), h.columns, h.rows);
  for (const Dir& d : h.pixels)
    if (!(std::fabs(length(d) - 1) < 1e-6)) return "a direction of a pixel that is no unit vector";
  if (!(h.group_index >= 1 && h.group_index <= 2)) return strf("a group index of %g, 1 to 2 are known", h.group_index);
  if (h.epsg < 0 || h.epsg > 999999) return strf("the EPSG code %d", h.epsg);
  return {};
}

namespace {

std::string fault_of(const ResponsePulse& p) {
  if (!(std::fabs(p.time) <= 1e12)) return strf("is emitted at %g s", p.time);
  if (!(p.wavelength_um > 0.1 && p.wavelength_um < 100)) return strf("has a wavelength of %g um", p.wavelength_um);
  if (!(p.energy >= 0 && p.energy <= 1e6)) return strf("has an energy of %g J", p.energy);
  if (!(p.start >= 0 && p.start <= 1e4)) return strf("has bins from %g s on", p.start);
  for (const Pose* pose : {&p.emission, &p.reception})
    if (!finite(pose->translation) || !(std::fabs(dot(pose->rotation, pose->rotation) - 1) < 1e-6))
      return "has a pose that is none";
  return {};
}

std::string fault_of_row(const ResponseHead& h, const ResponseBlock& b, size_t row) {
  if (!(b.bound[row] >= 0 || std::isnan(b.bound[row]))) return strf("has a bound of %g", b.bound[row]);
  for (uint64_t e = b.begin[row]; e < b.begin[row + 1]; ++e) {
    if (b.bin[e] > h.bins) return strf("has bin %u of %u", b.bin[e], h.bins);
    if (e > b.begin[row] && b.bin[e] <= b.bin[e - 1]) return strf("has bin %u behind bin %u", b.bin[e], b.bin[e - 1]);
    for (size_t c = 0; c < h.channels.size(); ++c) {
      const double v = b.value[e * h.channels.size() + c], s = b.variance[e * h.channels.size() + c];
      if (!(v >= 0 && v <= 1e30 && s >= 0 && s <= 1e60)) return strf("has %g photons with a variance of %g", v, s);
      if (!b.skewness.empty() && !std::isfinite(b.skewness[e * h.channels.size() + c]))
        return strf("has a skewness of %g", double{b.skewness[e * h.channels.size() + c]});
    }
  }
  return {};
}

}  // namespace

std::string fault_of(const ResponseHead& h, const ResponseBlock& b) {
  const size_t rows = b.pulses.size() * h.pixel_count(), entries = b.entries(), all = entries * h.channels.size();
  if (b.begin.size() != rows + 1 || b.bound.size() != rows || b.paths.size() != rows)
    return strf("%zu pulses of %zu pixels have other numbers of rows", b.pulses.size(), h.pixel_count());
  if (b.begin.front() != 0 || b.begin.back() != entries || !std::is_sorted(b.begin.begin(), b.begin.end()))
    return "rows do not follow each other";
  if (b.contributions.size() != entries || b.value.size() != all || b.variance.size() != all ||
      (!b.skewness.empty() && b.skewness.size() != all))
    return "entries have other numbers of values";
  for (size_t p = 0; p < b.pulses.size(); ++p)
    if (const std::string wrong = fault_of(b.pulses[p]); !wrong.empty())
      return strf("pulse %llu ", static_cast<unsigned long long>(b.first_pulse + p)) + wrong;
  for (size_t row = 0; row < rows; ++row)
    if (const std::string wrong = fault_of_row(h, b, row); !wrong.empty())
      return strf("pixel %zu of pulse %llu ", row % h.pixel_count(),
                  static_cast<unsigned long long>(b.first_pulse + row / h.pixel_count())) +
             wrong;
  return {};
}

// With P = A + r d from either end A, and B the vector to the other end: |P - B| = s - r gives
// r = (s^2 - B^2) / (2 (s - d.B)).
std::optional<Vec3> place_of_return(const ResponseHead& h, const ResponsePulse& p, size_t pixel, double arrival) {
  const bool beam = h.along == PlacesAlong::beam;
  const Vec3 from = beam ? p.emission.translation : p.reception.translation,
             other = (beam ? p.reception.translation : p.emission.translation) - from;
  const Dir d = beam ? p.emission.vector({0, 0, -1}) : p.reception.vector(h.pixels[pixel]);
  const double s = kSpeedOfLight * arrival / h.group_index;
  if (!(s > length(other))) return std::nullopt;
  return from + d * ((s * s - dot(other, other)) / (2 * (s - dot(d, other))));
}

}  // namespace suite
