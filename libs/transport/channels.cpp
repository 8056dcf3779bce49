#include "transport/channels.h"

#include <algorithm>

namespace suite {

namespace {

// A component of Stokes vectors; 0: the part of the intensity of which no polarisation is known.
ChannelRow stokes(const char* name, const char* about, int component) {
  return {{name, about, "W/(m2 sr um)", [component](const Contribution& c) { return component ? 0.0f : c.unknown; }},
          component > 0,
          false,
          component,
          true};
}

}  // namespace

const Registry<ChannelRow>& channel_rows() {
  const auto when = [](bool (*taken)(const Contribution&)) {
    return [taken](const Contribution& c) { return taken(c) ? 1.0f : 0.0f; };
  };
  static const Registry<ChannelRow> table(
      "channel", "",
      {{{"radiance", "all light", "W/(m2 sr um)", when([](const Contribution&) { return true; })}},
       {{"unscattered", "what comes straight from where it was sent out: lights in view, emission", "W/(m2 sr um)",
         when([](const Contribution& c) { return c.order == 0; })}},
       {{"single_scattering", "what was scattered once, or never", "W/(m2 sr um)",
         when([](const Contribution& c) { return c.order <= 1; })}},
       {{"multiple_scattering", "what was scattered more than once", "W/(m2 sr um)",
         when([](const Contribution& c) { return c.order > 1; })}},
       {{"emitted", "what warm surfaces and media sent out, scattered or not", "W/(m2 sr um)",
         when([](const Contribution& c) { return c.light == kFromMatter; })}},
       {{"direct", "what the sun's and the moon's beams bring that a surface has scattered once", "W/(m2 sr um)",
         when([](const Contribution& c) { return c.beam && c.order == 1 && !(c.events & by_medium); })}},
       {{"diffuse", "what surfaces scatter beside that: light of the sky, of lamps, of other surfaces", "W/(m2 sr um)",
         when([](const Contribution& c) {
           return c.order > 0 && !(c.events & by_medium) && !(c.beam && c.order == 1);
         })}},
       {{"path_radiance", "what the air of the simulation adds on the line of sight, over an even ground",
         "W/(m2 sr um)", when([](const Contribution& c) { return c.light == kFromAir && c.order == 0; })}},
       {{"adjacency",
         "what media scatter on the way; with real air: the difference that the scene makes to the field over an even "
         "ground, light of single places and shadows, which may be negative",
         "W/(m2 sr um)", when([](const Contribution& c) { return (c.events & by_medium) != 0; })}},
       {{"water_leaving", "what comes out of water through its surface, whatever it met there", "W/(m2 sr um)",
         when([](const Contribution& c) { return c.water == WaterSeen::entered; })},
        false,
        true},
       {{"glint", "sun and moon that surfaces of water reflect", "W/(m2 sr um)",
         when([](const Contribution& c) { return c.water == WaterSeen::mirrored && c.beam; })},
        false,
        true},
       {{"sky_reflection", "sky, its clouds and its air that surfaces of water reflect", "W/(m2 sr um)",
         when([](const Contribution& c) {
           return c.water == WaterSeen::air || (c.water == WaterSeen::mirrored && !c.beam);
         })},
        false,
        true},
       stokes("stokes_q", "Q of the light, in the frame of the sensor: along its first axis over across", 1),
       stokes("stokes_u", "U of the light: half-way from the first axis to the second over across", 2),
       stokes("stokes_v", "V of the light: turning counter-clockwise as the receiver sees it over clockwise", 3),
       stokes("depolarised", "what has passed a model without Mueller matrices, and counts as depolarised there", 0)});
  return table;
}

namespace {

std::vector<const ChannelRow*> rows_of(std::span<const std::string> names) {
  std::vector<const ChannelRow*> rows;
  for (const std::string& name : names) rows.push_back(&channel_rows().find(name));
  SUITE_CHECK(!rows.empty() && rows.front() == &*channel_rows().begin());
  return rows;
}

}  // namespace

ChannelPlan::ChannelPlan(std::span<const std::string> names) : ChannelPlan(rows_of(names)) {}

ChannelPlan::ChannelPlan(std::vector<const ChannelRow*> rows) : rows_(std::move(rows)) {
  SUITE_CHECK(!rows_.empty());
  for (const ChannelRow* row : rows_) {
    of_water_ = of_water_ || row->of_water;
    of_stokes_ = of_stokes_ || row->of_stokes;
  }
}

StokesParts ChannelPlan::parts() const {
  const bool v = std::any_of(rows_.begin(), rows_.end(), [](const ChannelRow* row) { return row->component == 3; });
  return v ? StokesParts::all : StokesParts::linear;
}

}  // namespace suite
