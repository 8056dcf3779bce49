#include "transport/channels.h"

namespace suite {

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
       {{"path_radiance", "what the air of the simulation adds along the ways of light", "W/(m2 sr um)",
         when([](const Contribution& c) { return c.light == kFromAir; })}}});
  return table;
}

ChannelPlan::ChannelPlan(std::span<const std::string> names) {
  for (const std::string& name : names) rows_.push_back(&channel_rows().find(name));
  SUITE_CHECK(!rows_.empty() && rows_.front() == &*channel_rows().begin());
}

ChannelPlan::ChannelPlan(std::vector<const ChannelRow*> rows) : rows_(std::move(rows)) { SUITE_CHECK(!rows_.empty()); }

}  // namespace suite
