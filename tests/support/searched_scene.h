// A scene large enough for a search of several pieces, and what is found there.
#pragma once
#include "formats/heat_hdf/operator_hdf.h"
#include "support/heated_scene_kit.h"

namespace suite::test {

struct SearchedScene {
  HeatKit kit;
  HeatSpec spec;
  SunCourse course;

  // moving: the plate stands elsewhere from noon on.
  explicit SearchedScene(size_t budget = 1500, bool moving = false)
      : kit(scene(moving), budget, {0, 86400}, {}, moving ? 600 : 0) {
    spec.span = {0, 86400}, spec.paths = 16, spec.step = 3600;
    course = loads(StillWeather{}).course;
  }
  WeatherLoads loads(StillWeather w) const {
    w.sun = normalized(Vec3{0.3, 0.4, 0.8});
    return still_loads(w, spec.span, 24);
  }
  HeatScene heat_scene() const { return {*kit.tracer, *kit.elements, *kit.faces, kit.optics}; }
  OperatorIdentity identity(const std::string& sun = "the sun") const {
    return {{{"scene", "a wall"}, {"number of paths", "16"}},
            sun,
            kit.faces->ends(),
            path_of(course),
            {1500, true, {{3600, 500, {0, 0, 1}}}, {}, {}, kit.elements->rests()}};
  }
  HeatOperator found(HeatPieces* pieces = nullptr, const std::function<void(size_t)>& progress = {}) const {
    HeatOperator out;
    out.exchange = find_exchange(heat_scene(), path_options(spec), pieces, progress);
    out.sun = find_sunlight(heat_scene(), course, path_options(spec), pieces, progress);
    return out;
  }
  HeatOperator stored(const std::string& path, const OperatorIdentity& of) const {
    const StoredOperator file(path, of);
    HeatOperator out;
    out.exchange = untraced_exchange(*kit.elements, *kit.faces, path_options(spec));
    out.sun = untraced_sunlight(*kit.elements, *kit.faces, course, path_options(spec));
    file.read(out.exchange), file.read(out.sun);
    return out;
  }
  HeatResult solved(HeatOperator&& found, const WeatherLoads& weather) const {
    return solve_heat(heat_scene(), std::move(found), weather, spec);
  }

 private:
  static HeatedScene scene(bool moving) {
    HeatedScene s;
    const TemperatureSpec wall =
        heat({{"thickness_m", 0.1}, {"density_kg_m3", 2000}, {"specific_heat_j_kg_k", 900}, {"conductivity_w_m_k", 1}});
    s.plane(8, 8, s.heated(0.8, wall));
    s.plane(8, 3, s.heated(0.4, wall), with_axes({1, 0, 0}, {0, 0, 1}, {0, 4, 1.5}));
    s.plane(1, 1, s.heated(0.5, heat({}, {{"back", "open"}})), shifted({0, 0, 2}));
    if (moving) s.moves(keyframe_track({{0, {}}, {43200, {}}, {43210, {{}, {2, 0, 0}}}, {86400, {{}, {2, 0, 0}}}}));
    return s;
  }
};

}  // namespace suite::test
