// SUMO's floating car data: all vehicles and persons at every step, as XML.
//
// Assumes: an angle is a compass heading, a place is that of the middle of the front bumper; a slope is that of the
// nose; times are seconds or, with --human-readable-time, [days:]hours:minutes:seconds. What misses a step is not there
// until its next record: it comes back as another thing of the same id. Based on: SUMO user documentation, "FCDOutput"
// (Eclipse SUMO 1.20), https://sumo.dlr.de/docs/Simulation/Output/FCDOutput.html
#include <cmath>
#include <unordered_map>

#include "formats/motion/fields.h"
#include "formats/motion/track_files.h"
#include "formats/xml/xml.h"

namespace suite {

namespace {

class FcdReader {
 public:
  FcdReader(const std::string& text, const std::string& name, const TrackFileOptions& options)
      : text_(text), name_(name), options_(options) {}

  std::vector<MovingThing> run() {
    const XmlElement root = XmlElement::parse(text_, name_);
    if (root.name() != "fcd-export") throw Error({name_, 0, 0, {}, -1}, "there is no element 'fcd-export'");
    root.each_child("timestep", [&](const XmlElement& step) {
      const double time = options_.begins + time_of(step);
      if (step_ && !(time > time_))
        throw step.fault("the times do not ascend", "each timestep later than the one before");
      time_ = time;
      ++step_;
      for (const char* kind : {"vehicle", "person", "container"})
        step.each_child(kind, [&](const XmlElement& record) { take(record, kind); });
    });
    if (things_.empty()) throw Error({name_, 0, 0, {}, -1}, "nothing moves in it");
    for (size_t i = 0; i < things_.size(); ++i) things_[i].track = keyframe_track(std::move(keys_[i]));
    return std::move(things_);
  }

 private:
  // The latest of an id: its number and the step of its last record.
  struct Latest {
    size_t thing, step;
  };

  double number(const XmlElement& node, const char* key) const {
    const auto a = node.attribute(key);
    const auto value = a ? finite_number(*a) : std::nullopt;
    if (!value)
      throw node.fault(a ? std::string(key) + "=\"" + *a + "\" is no number" : std::string("no ") + key,
                       std::string(node.name()) + " needs a number " + key);
    return *value;
  }

  // Seconds, or [-][days:]hours:minutes:seconds[.part].
  double time_of(const XmlElement& step) const {
    const std::string text = step.attribute("time").value_or("");
    if (text.find(':') == text.npos) return number(step, "time");
    const bool before = text.starts_with('-');
    double parts[4] = {0, 0, 0, 0};
    size_t n = 0;
    for (size_t at = before; n < 4 && at <= text.size(); ++n) {
      const size_t stop = std::min(text.find(':', at), text.size());
      const auto part = finite_number(text.substr(at, stop - at));
      if (!part || !(*part >= 0) || (stop < text.size() && *part != std::floor(*part))) break;
      parts[n] = *part;
      at = stop + 1;
      if (stop < text.size()) continue;
      const double* const hms = parts + (n == 3);  // of four the first are days
      if (n < 2 || !(hms[1] < 60) || !(hms[2] < 60) || (n == 3 && !(hms[0] < 24))) break;
      const double seconds = (((n == 3 ? parts[0] : 0) * 24 + hms[0]) * 60 + hms[1]) * 60 + hms[2];
      return before ? -seconds : seconds;
    }
    throw step.fault("time=\"" + printable(text).substr(0, 40) + "\" is no time",
                     "seconds, hours:minutes:seconds or days:hours:minutes:seconds");
  }

  PoseKey key_of(const XmlElement& node) const {
    using Network = TrackFileOptions::Network;
    const double x = number(node, "x"), y = number(node, "y"), heading = number(node, "angle");
    const double z = options_.height + (node.attribute("z") ? number(node, "z") : 0);
    const double slope = node.attribute("slope") ? number(node, "slope") : 0;
    const char* const names[3][3] = {{"east_m", "north_m", "up_m"},
                                     {"longitude_deg", "latitude_deg", "height_m"},
                                     {"easting_m", "northing_m", "height_m"}};
    const char* const* mine = names[static_cast<size_t>(options_.network)];
    const bool degrees = options_.network == Network::geographic;
    PoseFields fields;
    fields.number = [&](std::string_view name) {
      return name == mine[0]         ? x + (degrees ? 0 : options_.east)
             : name == mine[1]       ? y + (degrees ? 0 : options_.north)
             : name == mine[2]       ? z
             : name == "heading_deg" ? heading
                                     : slope;
    };
    fields.has = [&](std::string_view name) {
      return name == mine[0] || name == mine[1] || name == mine[2] || name == "heading_deg" || name == "pitch_deg" ||
             (name == "utm_zone" && options_.network == Network::utm);
    };
    fields.text = [&](const char*) { return strf("%d%c", options_.zone.zone, options_.zone.north ? 'N' : 'S'); };
    fields.error = [&](std::string what, std::string hint) { return node.fault(std::move(what), std::move(hint)); };
    return {time_, fields.pose(options_.motion)};
  }

  void take(const XmlElement& node, const char* kind) {
    const std::string id = node.attribute("id").value_or("");
    if (id.empty()) throw node.fault(std::string(kind) + " without an id");
    const std::string type = node.attribute("type").value_or(kind);
    const auto [latest, fresh] = latest_.try_emplace(kind[0] + id, Latest{});
    if (!fresh && latest->second.step == step_)
      throw node.fault("'" + id + "' is there twice at one time", "one record of each at a time");
    if (fresh || latest->second.step + 1 != step_ || things_[latest->second.thing].type != type) {
      latest->second.thing = things_.size();
      things_.push_back({id, type, node.where(), nullptr});
      keys_.emplace_back();
    }
    latest->second.step = step_;
    keys_[latest->second.thing].push_back(key_of(node));
  }

  const std::string& text_;
  const std::string& name_;
  const TrackFileOptions& options_;
  std::vector<MovingThing> things_;
  std::vector<std::vector<PoseKey>> keys_;  // of each
  std::unordered_map<std::string, Latest> latest_;
  double time_ = 0;
  size_t step_ = 0;  // counted from 1
};

}  // namespace

TrackFileRow track_file::fcd_row() {
  return {{"fcd", "SUMO's floating car data (XML)", "",
           [](const std::string& text, const std::string& name, const TrackFileOptions& options) {
             return FcdReader(text, name, options).run();
           }},
          [](std::string_view head) { return head.find("<fcd-export") != std::string_view::npos; }};
}

}  // namespace suite
