#include "detect_output.h"

#include <algorithm>

#include "formats/las_write/las_write.h"

namespace suite {

DetectMap::DetectMap(const ResponseHead& head, int epsg, const Where& where) {
  if (!head.origin) {
    if (epsg) throw Error(where, "the response has no place on the Earth", "leave out epsg");
    wkt_ = wkt_of_local_scene();
    return;
  }
  frame_.emplace(*head.origin);
  int code = epsg ? epsg : head.epsg;
  if (code == 0 || code == 4326 || code == 4258) {  // places are metres: the zone of the origin
    const UtmZone zone = standard_utm_zone(*head.origin);
    code = (zone.north ? 32600 : 32700) + zone.zone;
  }
  const std::optional<UtmZone> zone = utm_zone_of_epsg(code);
  if (!zone) throw Error(where, strf("EPSG:%d is no UTM zone on WGS84 or ETRS89", code), "las: {epsg: 32632}");
  zone_ = *zone, wkt_ = wkt_of_epsg(code);
}

Vec3 DetectMap::place(Vec3 enu) const {
  if (!frame_) return enu;
  const UtmPoint p = frame_->utm_from_enu(enu, zone_);
  return {p.easting, p.northing, p.height_m};
}

double time_of_pulse(const ResponseHead& head, double time) {
  return head.epoch ? adjusted_gps_time(Clock(*head.epoch).at(time)) : time;
}

std::vector<std::unique_ptr<DetectOutput>> read_outputs(const Params& params, const DetectContext& c) {
  const std::vector<std::string> kinds{"las", "waveforms_h5", "photons_h5", "dirsig_bin", "csv"};
  std::vector<size_t> asked{0};
  if (const auto list = params.find("output")) {
    asked.clear();
    for (const Params& item : list->items()) asked.push_back(item.as_choice(kinds));
    std::sort(asked.begin(), asked.end());
    asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
    const bool on_earth = std::any_of(asked.begin(), asked.end(), [](size_t k) { return k == 1 || k == 2; });
    if (on_earth && !c.head.origin)
      throw list->error("waveforms_h5 and photons_h5 hold latitudes, and the response has no place on the Earth",
                        "output: [las, csv]");
    const auto keeps = [&](bool counts) {
      return std::any_of(c.spec.detectors.begin(), c.spec.detectors.end(),
                         [&](const auto& d) { return counts ? d->counts_photons() : d->sample_unit() == "counts"; });
    };
    for (const size_t k : asked)
      if ((k == 1 && !keeps(false)) || (k == 2 && !keeps(true)))
        throw list->error(kinds[k] + ": no detector has any",
                          k == 1 ? "a detector of kind waveform" : "a detector of kind geiger or photon_counting");
  }
  std::vector<std::unique_ptr<DetectOutput>> outputs;
  for (const size_t k : asked) {
    if (k == 0) outputs.push_back(las_output(params, c));
    if (k == 1) outputs.push_back(waveform_output(c));
    if (k == 2) outputs.push_back(photon_output(c));
    if (k == 3) outputs.push_back(dirsig_bin_output(c));
    if (k == 4) outputs.push_back(csv_output(params, c));
  }
  return outputs;
}

}  // namespace suite
