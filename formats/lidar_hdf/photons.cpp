// Based on: the groups and names of ICESat-2's ATL03 product (NSIDC DAAC).
#include "formats/lidar_hdf/photons.h"

#include "formats/lidar_hdf/spooled_columns.h"

namespace suite {

struct PhotonWriter::Open {
  Open(const std::string& path, const std::string& made_by) : columns(path, made_by) {}
  SpooledColumns columns;
};

PhotonWriter::PhotonWriter(const std::string& path, const std::string& made_by)
    : open_(std::make_unique<Open>(path, made_by)) {
  open_->columns.writer().attribute("format", "suite photons, names of ATL03");
}
PhotonWriter::~PhotonWriter() = default;

void PhotonWriter::add(size_t track, const PhotonEvent& e) {
  SpooledColumns& c = open_->columns;
  const std::string g = std::string("/") + kTracks.at(track) + "/heights/";
  constexpr uint8_t kHigh = 4, kNoise = 0, kNominal = 0;  // ATL03's words for confidence and quality
  c.add(g + "h_ph", "meters", static_cast<float>(e.place.height_m));
  c.add(g + "lat_ph", "degrees_north", e.place.latitude_deg);
  c.add(g + "lon_ph", "degrees_east", e.place.longitude_deg);
  c.add(g + "delta_time", "seconds", e.delta_time);
  c.add(g + "dist_ph_along", "meters", static_cast<float>(e.along));
  c.add(g + "dist_ph_across", "meters", static_cast<float>(e.across));
  c.add(g + "ph_id_channel", "1", e.pixel);
  c.add(g + "ph_id_pulse", "1", e.pulse);
  c.add(g + "quality_ph", "1", kNominal);
  c.add(g + "signal_conf_ph", "1", e.signal ? kHigh : kNoise);
}

void PhotonWriter::add_pulse(size_t track, double delta_time, double background, double energy) {
  SpooledColumns& c = open_->columns;
  const std::string g = std::string("/") + kTracks.at(track);
  c.add(g + "/bckgrd_atlas/delta_time", "seconds", delta_time);
  c.add(g + "/bckgrd_atlas/bckgrd_rate", "counts/second", static_cast<float>(background));
  c.add(g + "/geolocation/delta_time", "seconds", delta_time);
  c.add(g + "/geolocation/tx_pulse_energy", "Joules", static_cast<float>(energy));
}

void PhotonWriter::finish() { open_->columns.finish(); }

}  // namespace suite
