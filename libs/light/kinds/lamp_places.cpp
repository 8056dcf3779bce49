// Where lamps stand, for those who look for their light by other ways than straight lines.
#include "light/kinds/lamp_intensity.h"
#include "light/kinds/lamps_core.h"

namespace suite {

using Kind = LampShape::Kind;

// By the tree as if the place looked everywhere, or any: bent light may come from where the tree expects none.
std::optional<LightPlace> Lamps::draw_place(const LightReceiver& at, const std::array<double, 4>& u,
                                            double time) const {
  if (!core_->tree || core_->images) return std::nullopt;
  const LightReceiver all_round{at.position, {}, true};
  const double evenly = 0.5 / static_cast<double>(size());
  uint32_t lamp = 0;
  if (u[0] < 0.5) {
    const auto chosen = core_->tree->sample(all_round, 2 * u[0]);
    if (!chosen) return std::nullopt;
    lamp = chosen->light;
  } else {
    lamp = static_cast<uint32_t>(std::min(size() - 1, static_cast<size_t>((u[0] - 0.5) / evenly)));
  }
  const LampShape& s = core_->shapes[lamp];
  if (!(dimming(core_->specs[s.spec], time) > 0)) return std::nullopt;
  const double chance = 0.5 * core_->tree->probability(all_round, lamp) + evenly;
  if (s.kind != Kind::point) return LightPlace{place_on(s, {u[1], u[2]}), false, chance / s.area, lamp};
  if (s.carrier == kNone) return LightPlace{s.origin, true, chance, lamp};
  const auto carrier = core_->carriers.at(s.carrier, time);
  return carrier ? std::optional(LightPlace{carrier->point(s.origin), true, chance, lamp}) : std::nullopt;
}

bool Lamps::is_point(size_t member) const { return core_->shapes[member].kind == Kind::point; }

std::optional<Vec3> Lamps::point_of(size_t member, double time) const {
  const LampShape& s = core_->shapes[member];
  if (s.kind != Kind::point || !(dimming(core_->specs[s.spec], time) > 0)) return std::nullopt;
  if (s.carrier == kNone) return s.origin;
  const auto carrier = core_->carriers.at(s.carrier, time);
  return carrier ? std::optional(carrier->point(s.origin)) : std::nullopt;
}

}  // namespace suite
