// Based on: the groups and names of GEDI's L1B product (NASA LP DAAC, GEDI01_B version 2).
#include "formats/lidar_hdf/waveforms.h"

#include <map>

#include "formats/lidar_hdf/spooled_columns.h"

namespace suite {

struct WaveformWriter::Open {
  Open(const std::string& path, const std::string& made_by) : columns(path, made_by) {}
  struct Beam {
    std::string group;
    size_t transmitted = 0;
  };
  SpooledColumns columns;
  std::map<size_t, Beam> beams;
};

WaveformWriter::WaveformWriter(const std::string& path, const std::string& made_by)
    : open_(std::make_unique<Open>(path, made_by)) {
  open_->columns.writer().attribute("format", "suite waveforms, names of GEDI L1B");
}
WaveformWriter::~WaveformWriter() = default;

void WaveformWriter::begin_beam(size_t number, const std::string& name, double sample,
                                std::span<const double> transmitted) {
  SUITE_CHECK(number < 16 && !open_->beams.contains(number));
  std::string group = "/BEAM";
  for (int bit = 3; bit >= 0; --bit) group += number >> bit & 1 ? '1' : '0';
  open_->beams[number] = {group, transmitted.size()};
  SpooledColumns& c = open_->columns;
  for (const double v : transmitted) c.add(group + "/txwaveform", "1", static_cast<float>(v));
  c.add(group + "/sample_spacing", "s", sample);
  c.writer().put_names(group + "/detector", {name});
}

namespace {

void add_place(SpooledColumns& c, const std::string& group, const std::string& end, const Geodetic& g) {
  c.add(group + "/geolocation/latitude_" + end, "degrees", g.latitude_deg);
  c.add(group + "/geolocation/longitude_" + end, "degrees", g.longitude_deg);
  c.add(group + "/geolocation/" + (end == "instrument" ? "altitude_" : "elevation_") + end, "m", g.height_m);
}

void add_samples(SpooledColumns& c, const std::string& name, std::span<const double> samples) {
  for (const double v : samples) c.add(name, "counts", static_cast<float>(v));
}

}  // namespace

void WaveformWriter::add(size_t beam, const WaveformShot& s) {
  SpooledColumns& c = open_->columns;
  const Open::Beam& b = open_->beams.at(beam);
  const std::string& g = b.group;
  const std::string wave = g + "/rxwaveform";
  c.add(g + "/shot_number", "1", s.shot);
  c.add(g + "/pixel", "1", s.pixel);
  c.add(g + "/delta_time", "s", s.delta_time);
  c.add(g + "/rx_sample_start_index", "1", static_cast<uint64_t>(c.size(wave) + 1));
  c.add(g + "/rx_sample_count", "1", static_cast<uint32_t>(s.samples.size()));
  c.add(g + "/rx_start", "s", s.start);
  // All shots have the same transmitted pulse.
  c.add(g + "/tx_sample_start_index", "1", uint64_t{1});
  c.add(g + "/tx_sample_count", "1", static_cast<uint32_t>(b.transmitted));
  c.add(g + "/noise_mean_corrected", "counts", static_cast<float>(s.noise_mean));
  c.add(g + "/noise_stddev_corrected", "counts", static_cast<float>(s.noise_deviation));
  add_samples(c, wave, s.samples);
  add_samples(c, g + "/ideal_rxwaveform", s.ideal);
  add_samples(c, g + "/ideal_rxwaveform_error", s.ideal_error);
  add_place(c, g, "bin0", s.first);
  add_place(c, g, "lastbin", s.last);
  add_place(c, g, "instrument", s.instrument);
}

void WaveformWriter::finish() { open_->columns.finish(); }

}  // namespace suite
