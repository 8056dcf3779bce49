// What detectors make of radiance: electrons and digital counts beside it.
#include <algorithm>
#include <cmath>

#include "sensor/kinds/platform.h"
#include "spectral/thermometer.h"

namespace suite {

namespace {

// Keeps the first `keep` bands of every [problem][...][band] array.
void keep_bands(CaptureResult& r, size_t keep) {
  auto cut = [&](std::vector<double>& v) {
    const size_t groups = v.size() / r.bands;
    for (size_t g = 0; g < groups; ++g)
      std::copy_n(v.begin() + static_cast<long>(g * r.bands), keep, v.begin() + static_cast<long>(g * keep));
    v.resize(groups * keep);
  };
  cut(r.radiance);
  cut(r.standard_error);
  cut(r.error_correlation);  // its first rows are the ones to keep
  r.error_correlation.resize(keep * keep);
  r.bands = keep;
}

// Drops the truth of the photon bands, which are the computation's own affair.
void drop_truth_of(CaptureResult& r, const std::vector<Band>& bands, size_t keep) {
  std::vector<size_t> kept;
  for (size_t i = 0; i < r.truth_names.size(); ++i) {
    const bool theirs = std::any_of(bands.begin() + static_cast<long>(keep), bands.end(),
                                    [&](const Band& b) { return r.truth_names[i] == "reflectance " + b.name; });
    if (!theirs) kept.push_back(i);
  }
  if (kept.size() == r.truth_names.size()) return;
  std::vector<std::string> names;
  std::vector<double> values;
  for (const size_t i : kept) names.push_back(r.truth_names[i]);
  for (size_t p = 0; p < r.problems(); ++p)
    for (const size_t i : kept) values.push_back(r.truth[p * r.truth_names.size() + i]);
  r.truth_names = std::move(names);
  r.truth = std::move(values);
}

// Signal electrons on the axis for 1 W/(m2 sr um) in a photon band that counts one electron for each.
double electrons_per_radiance(const PlatformSpec& spec, const FocalArray& array) {
  const Lens& lens = spec.instruments[array.instrument].lens;
  return array.pitch.x * array.pitch.y * array.detector->fill_factor /
         g_number(lens.f_number(), lens.throughput, lens.obscuration) * array.readout.exposure();
}

}  // namespace

NoiseAtBackground noise_of(const PlatformSpec& spec, const Segment& segment, size_t band) {
  const FocalArray& array = spec.arrays[segment.array];
  const DetectorSpec& d = *array.detector;
  const BandThermometer thermometer(segment.bands[segment.radiance_bands + band]);
  const double L = thermometer.radiance(d.background),
               factor = electrons_per_radiance(spec, array) * segment.electrons[band];
  return noise_at_background(d, factor * L, factor / thermometer.read(L).slope, array.readout.exposure());
}

std::string noise_text(const PlatformSpec& spec, const Segment& segment) {
  const auto& detector = spec.arrays[segment.array].detector;
  if (!detector || !(detector->background > 0)) return {};
  std::string out = strf("; NETD at %g K:", detector->background);
  for (size_t b = 0; b < segment.radiance_bands; ++b) {
    const NoiseAtBackground n = noise_of(spec, segment, b);
    out += strf(" %s %.4g K (%.4g K of it shot noise, read noise and quantisation)", segment.bands[b].name.c_str(),
                n.netd(), n.own / n.slope);
  }
  return out;
}

std::vector<Product> detect(const PlatformSpec& spec, const Segment& segment, CaptureResult& result,
                            uint64_t read_out) {
  const FocalArray& array = spec.arrays[segment.array];
  if (!array.detector) return {};
  const Lens& lens = spec.instruments[array.instrument].lens;
  const Detector detector(*array.detector);
  const DetectorSpec& d = detector.spec();
  const size_t bands = segment.radiance_bands, n = result.problems();
  const double axis = electrons_per_radiance(spec, array), exposure = array.readout.exposure();
  Product electrons{"electrons", "electrons", false, {}, std::vector<double>(n * bands)};
  Product counts{"dn", "DN", true, {}, std::vector<double>(n * bands)};
  Product kelvin{"apparent_temperature", "K", false, {}, std::vector<double>(d.background > 0 ? n * bands : 0)};
  std::vector<double> more(bands, 0.0);
  std::vector<BandThermometer> thermometers;
  for (size_t b = 0; b < bands; ++b) {
    electrons.bands.push_back(segment.bands[b].name);
    if (!(d.background > 0)) continue;
    more[b] = noise_of(spec, segment, b).more;
    thermometers.emplace_back(segment.bands[bands + b]);
  }
  kelvin.bands = counts.bands = electrons.bands;
  if (!d.counts()) counts.values.clear();
  const Capture& capture = spec.tasks[result.task].captures[result.capture];
  for (size_t i = 0; i < n; ++i) {
    const Exposed from = exposed(spec, capture, i);
    const DetectorPlace place = place_of(array, from.column, from.row, 0.5, 0.5);
    const double cosine = lens.cos4 ? -lens.look(place.place).z : 1;
    const double factor = axis * place.chip->gain * cosine * cosine * cosine * cosine;
    const bool bad =
        std::find(d.bad.begin(), d.bad.end(), std::array<uint32_t, 2>{from.column, from.row}) != d.bad.end();
    for (size_t b = 0; b < bands; ++b) {
      // The photon bands follow the listed ones; every band has detectors of its own.
      double signal = 0;
      for (size_t t = 0; t < result.bins; ++t)
        signal += result.radiance[(i * result.channels * result.bins + t) * result.bands + bands + b] /
                  static_cast<double>(result.bins);
      signal *= factor * segment.electrons[b];
      electrons.values[i * bands + b] = signal;
      if (!d.counts()) continue;
      const uint64_t own = hash_of(segment.array, b, uint64_t{from.row} * 0x100000000ull + from.column);
      Detector::Character character = detector.character(own);
      character.dead = character.dead || bad;
      const Detector::Reading read = detector.read(signal, exposure, character, hash_of(own, read_out, i), more[b]);
      if (read.clipped) result.quality[i] |= quality_clipped;
      counts.values[i * bands + b] = read.counts;
      if (!thermometers.empty())
        kelvin.values[i * bands + b] =
            thermometers[b].read(detector.signal_of(read.counts, exposure) / (factor * segment.electrons[b])).kelvin;
    }
  }
  drop_truth_of(result, segment.bands, bands);
  keep_bands(result, bands);
  std::vector<Product> out;
  out.push_back(std::move(electrons));
  if (d.counts()) out.push_back(std::move(counts));
  if (!thermometers.empty()) out.push_back(std::move(kelvin));
  return out;
}

}  // namespace suite
