// SUMO's floating car data: all vehicles and persons at every step, as XML.
//
// Assumes: an angle is a compass heading, a place is that of the middle of the front bumper; a slope is that of the
// nose. What misses a step is not there until its next record: it comes back as another thing of the same id.
// Based on: SUMO user documentation, "FCDOutput" (Eclipse SUMO 1.20),
// https://sumo.dlr.de/docs/Simulation/Output/FCDOutput.html
#include <pugixml.hpp>

#include <algorithm>
#include <unordered_map>

#include "formats/motion/fields.h"
#include "formats/motion/track_files.h"

namespace suite {

namespace {

class FcdReader {
 public:
  FcdReader(const std::string& text, const std::string& name, const TrackFileOptions& options)
      : text_(text), name_(name), options_(options) {
    for (size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) ends_.push_back(at);
  }

  std::vector<MovingThing> run() {
    pugi::xml_document document;
    const pugi::xml_parse_result parsed =
        document.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed) throw Error(place(parsed.offset), std::string("this is no XML: ") + parsed.description());
    const pugi::xml_node root = document.child("fcd-export");
    if (!root) throw Error({name_, 0, 0, {}, -1}, "there is no element 'fcd-export'");
    for (const pugi::xml_node step : root.children("timestep")) {
      const double time = options_.begins + number(step, "time");
      if (step_ && !(time > time_))
        throw fault(step, "the times do not ascend", "each timestep later than the one before");
      time_ = time;
      ++step_;
      for (const char* kind : {"vehicle", "person", "container"})
        for (const pugi::xml_node record : step.children(kind)) take(record, kind);
    }
    if (things_.empty()) throw Error({name_, 0, 0, {}, -1}, "nothing moves in it");
    for (size_t i = 0; i < things_.size(); ++i) things_[i].track = keyframe_track(std::move(keys_[i]));
    return std::move(things_);
  }

 private:
  // The latest of an id: its number and the step of its last record.
  struct Latest {
    size_t thing, step;
  };

  Where place(std::ptrdiff_t offset) const {
    if (offset < 0) return {name_, 0, 0, {}, -1};
    const auto at = static_cast<size_t>(offset);
    const auto line = std::lower_bound(ends_.begin(), ends_.end(), at) - ends_.begin();
    const size_t from = line ? ends_[static_cast<size_t>(line) - 1] + 1 : 0;
    const size_t to = static_cast<size_t>(line) < ends_.size() ? ends_[static_cast<size_t>(line)] : text_.size();
    return {name_, static_cast<int>(line) + 1, static_cast<int>(at - from) + 1,
            text_.substr(from, std::min<size_t>(to - from, 200)), -1};
  }
  Error fault(const pugi::xml_node& node, std::string what, std::string hint = {}) const {
    return Error(place(node.offset_debug()), std::move(what), std::move(hint));
  }
  double number(const pugi::xml_node& node, const char* key) const {
    const pugi::xml_attribute a = node.attribute(key);
    const auto value = a ? number_of(a.value()) : std::nullopt;
    if (!value)
      throw fault(node, a ? std::string(key) + "=\"" + a.value() + "\" is no number" : std::string("no ") + key,
                  std::string(node.name()) + " needs a number " + key);
    return *value;
  }

  PoseKey key_of(const pugi::xml_node& node) const {
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
    fields.error = [&](std::string what, std::string hint) { return fault(node, std::move(what), std::move(hint)); };
    return {time_, fields.pose(options_.motion)};
  }

  void take(const pugi::xml_node& node, const char* kind) {
    const std::string id = node.attribute("id").value();
    if (id.empty()) throw fault(node, std::string(kind) + " without an id");
    const std::string type = node.attribute("type") ? node.attribute("type").value() : kind;
    const auto [latest, fresh] = latest_.try_emplace(kind[0] + id, Latest{});
    if (!fresh && latest->second.step == step_)
      throw fault(node, "'" + id + "' is there twice at one time", "one record of each at a time");
    if (fresh || latest->second.step + 1 != step_ || things_[latest->second.thing].type != type) {
      latest->second.thing = things_.size();
      things_.push_back({id, type, place(node.offset_debug()), nullptr});
      keys_.emplace_back();
    }
    latest->second.step = step_;
    keys_[latest->second.thing].push_back(key_of(node));
  }

  const std::string& text_;
  const std::string& name_;
  const TrackFileOptions& options_;
  std::vector<size_t> ends_;  // of lines
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
