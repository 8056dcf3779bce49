// What is known of a moment of the simulation: its date, where the sun is, and what light comes down.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "formats/sim_text/sim_text.h"
#include "light/environment.h"
#include "light_above.h"
#include "scene/scene.h"

namespace suite {

class Facts {
 public:
  // When the bins of the sensors are chosen; they must outlive it.
  Facts(const Simulation& sim, std::shared_ptr<const Scene> scene);
  // UTC of a time of the simulation in ISO 8601 with a Z; empty without an `epoch`.
  std::string utc(double seconds) const;
  // The sun at that time, as the text gives it: above the air when there is air. Nothing without one.
  std::optional<FarDisk> sun(double seconds) const;
  bool on_earth() const { return scene_->origin.given; }
  bool sun_moves() const { return sun_.dated(); }
  const LightAbove& light_above() const { return light_above_; }

 private:
  std::optional<Clock> clock_;
  SourceSpecs sun_;
  std::shared_ptr<const Scene> scene_;
  LightAbove light_above_;
};

// Compass azimuth (0 to 360) and elevation of a direction, degrees.
std::array<double, 2> azimuth_elevation_deg(Dir direction);

// Refuses what cannot be had of a capture: a reflectance without a sun above the horizon, places of a scene that
// repeats itself.
void check_wishes(const Simulation& sim, const Facts& facts);

}  // namespace suite
