#include "formats/preset/day_night_band.h"

#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "math/vec.h"

namespace suite {

namespace {

constexpr const char* kDnb = "viirs_dnb_like";

// Aggregation of the VIIRS day/night band, the same to both sides: samples of a zone, and how many subpixels of the
// CCD along the scan make one.
struct Zone {
  int samples, subpixels;
};
constexpr std::array kZones{
    Zone{184, 66}, Zone{72, 64}, Zone{88, 62}, Zone{72, 59}, Zone{80, 55}, Zone{72, 52}, Zone{64, 49}, Zone{64, 46},
    Zone{64, 43},  Zone{64, 40}, Zone{64, 38}, Zone{80, 35}, Zone{56, 33}, Zone{80, 30}, Zone{72, 28}, Zone{72, 26},
    Zone{72, 24},  Zone{32, 23}, Zone{48, 22}, Zone{32, 21}, Zone{48, 20}, Zone{40, 19}, Zone{56, 18}, Zone{40, 17},
    Zone{72, 16},  Zone{24, 15}, Zone{32, 15}, Zone{64, 14}, Zone{64, 13}, Zone{64, 12}, Zone{16, 12}, Zone{80, 11}};
constexpr double kHalfScan = 56.06 * kDegree;  // rad, to each side
constexpr double kPeriod = 1.786, kHeight = 833e3;

double subpixel() {  // rad along the scan
  int sum = 0;
  for (const Zone& z : kZones) sum += z.samples * z.subpixels;
  return kHalfScan / sum;
}

// From the satellite to the ground of a spherical Earth, m.
double range_at(double from_nadir) {
  constexpr double kRadius = 6371e3;
  const double incidence = std::asin((kRadius + kHeight) / kRadius * std::sin(from_nadir));
  return from_nadir > 0 ? kRadius * std::sin(incidence - from_nadir) / std::sin(from_nadir) : kHeight;
}

struct Stage {
  const char* name;
  double exposures;  // stages of TDI, over those that an attenuator leaves
  int bits;
  double top;  // W/(m2 sr) in the band, at the end of the converter
};
constexpr std::array kStages{Stage{"high", 250, 14, 5e-3}, Stage{"mid", 3, 14, 1}, Stage{"low", 1.0 / 35, 13, 200}};

// Electrons of a sample for 1 W/(m2 sr) in the band, at its middle wavelength.
double electrons(const Stage& stage, double across, double along, double dwell) {
  constexpr double kAperture = 0.191, kThroughput = 0.5, kEfficiency = 0.6, kPhoton = 1.98644586e-25 / 0.7e-6;
  return kPi / 4 * kAperture * kAperture * across * along * kThroughput * kEfficiency * dwell * stage.exposures /
         kPhoton;
}

// along: rad, of a detector along the track.
std::string array_text(const Stage& stage, const Zone& zone, int samples, double along) {
  constexpr double kFocal = 1141;  // mm
  constexpr double kSubpixelAlong = 742 / kHeight / 42;
  const double rate = 2 * kPi / kPeriod, across = zone.subpixels * subpixel(), tick = subpixel() / rate,
               per_dn = electrons(stage, across, along, tick) * stage.top / std::exp2(stage.bits),
               noise = 1.6 * std::sqrt(zone.subpixels * along / kSubpixelAlong);
  return strf(
      "        - {name: %s, chips: [{columns: 1, offset_mm: [0, 0], gain: %.6g}], rows: 16, pitch_um: [%.5f, %.5f],\n"
      "           integration_time_s: %.6g, paths: 64, bands: [{name: dnb, center_um: 0.7, fwhm_um: 0.4, shape: "
      "rectangular}],\n"
      "           readout: {kind: whisk, scan_rate_hz: %.9g, samples: %d, sample_rate_hz: %.9g, lines_per_capture: "
      "1},\n"
      "           detector: {quantum_efficiency: 0.6, gain_e_per_dn: %.6g, read_noise_e: %.4g, bits: %d, bias_dn: "
      "100}}\n",
      stage.name, stage.exposures, 1e3 * kFocal * across, 1e3 * kFocal * along, tick, 1 / kPeriod, samples,
      1 / (zone.subpixels * tick), per_dn, noise, stage.bits);
}

// Both sides of zone 1 as one, each side of the others.
std::string day_night_band(size_t number) {
  const Zone& zone = kZones[number - 1];
  int before = 0;
  for (size_t i = 0; i + 1 < number; ++i) before += kZones[i].samples * kZones[i].subpixels;
  const double rate = 360 / kPeriod, first = before * subpixel() / kDegree,
               last = first + zone.samples * zone.subpixels * subpixel() / kDegree,
               along = 742 / range_at(number == 1 ? 0 : 0.5 * (first + last) * kDegree),
               half = 0.5 * zone.subpixels * subpixel() / kDegree;
  std::string text = strf(
      "# Source: samples and subpixels of the zones: SatDump, plugins/jpss (github.com/SatDump/SatDump); 0.5 to 0.9 "
      "um, "
      "from 3e-9 W/(cm2 sr):\n"
      "# L. B. Liao et al., J. Geophys. Res. Atmos. 118, 2013; three gain stages, to 0.02 W/(cm2 sr): abstracts of the "
      "calibrations of JPSS-1 and\n"
      "# JPSS-2 (IEEE Trans. Geosci. Remote Sens.); +-56.06 degrees, 16 detectors along the track: Remote Sens. 8, "
      "2016, "
      "141; a turn in 1.786 s:\n"
      "# ieeexplore.ieee.org/document/1294674. All zones together fill the scan: a subpixel of 13.5 urad, 66 of which "
      "are "
      "742 m from 833 km.\n"
      "# Typical: aperture, focal length, throughput, efficiency; 250, 3 and 1 stages of TDI; an attenuator of 35 "
      "before "
      "the low gain; read noise\n"
      "# (1.6 e a subpixel), bits, the top of the stages (5e-7, 1e-4, 0.02 W/(cm2 sr)). TDI counts as `gain`, without "
      "its "
      "blur.\n"
      "# Aggregation zone %zu of 32: %d samples a side of %d subpixels, %.4g to %.4g degrees from nadir. Others: "
      "--preset "
      "%s_1 to _32.\n"
      "- kind: platform\n"
      "  name: %s\n"
      "  motion: {kind: straight, position_m: [0, -6000, %g], heading_deg: 0, speed_m_s: 6647, follow_earth: false}  # "
      "of the point below; better: kind: orbit\n"
      "  tasks: [{start: 0, stop: 1.9}]\n"
      "  instruments:\n",
      number, zone.samples, zone.subpixels, first, last, kDnb, kDnb, kHeight);
  const auto instrument = [&](const char* name, double from, int samples) {
    text += strf(
        "    - name: %s\n"
        "      focal_length_mm: 1141\n"
        "      aperture_mm: 191\n"
        "      throughput: 0.5\n"
        "      mount: {kind: line_scan, axis: across, start_deg: %.6f, rate_deg_s: %.6f, period_s: %g}\n"
        "      arrays:\n",
        name, from + half, rate, kPeriod);
    for (const Stage& stage : kStages) text += array_text(stage, zone, samples, along);
  };
  if (number == 1) {
    instrument("nadir", -last, 2 * zone.samples);
  } else {
    instrument("right", -last, zone.samples);
    instrument("left", first, zone.samples);
  }
  return text;
}

}  // namespace

std::string list_day_night_band() {
  return strf("%-14s %s\n", kDnb,
              "space, day/night band in three gains, 742 m: zone 1 of 32 (nadir); _2 to _32: the others");
}

std::optional<std::string> find_day_night_band(const std::string& name) {
  if (name == kDnb) return day_night_band(1);
  for (size_t i = 1; i <= kZones.size(); ++i)
    if (name == strf("%s_%zu", kDnb, i)) return day_night_band(i);
  return std::nullopt;
}

}  // namespace suite
