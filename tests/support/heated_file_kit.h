// A small scene with temperatures found for it, to be written and read.
#pragma once
#include "formats/heat_hdf/heat_hdf.h"
#include "support/heated_scene_kit.h"

namespace suite::test {

struct HeatedFile {
  HeatKit kit;
  HeatResult result;
  HeatCut cut{6, true, {{3600, 500, {0, 0, 1}}, {7200, 600, {0.6, 0, 0.8}}}, {}, {{0, 0}, {0, 1}}};

  explicit HeatedFile(size_t budget = 6) : kit(scene(), budget) {
    HeatSpec run;
    run.span = {0, 86400}, run.paths = 16, run.step = 3600;
    StillWeather w;
    w.direct = 500, w.longwave = 300;
    result = kit.solve(still_loads(w, run.span, 24), run);
  }
  void write(const std::string& path) const {
    write_heat(path, result, *kit.elements, *kit.faces, {"m0", "m1"}, cut, "a test");
  }

 private:
  static HeatedScene scene() {
    HeatedScene s;
    s.plane(4, 4,
            s.heated(0.9, heat({{"thickness_m", 0.1},
                                {"density_kg_m3", 2000},
                                {"specific_heat_j_kg_k", 900},
                                {"conductivity_w_m_k", 1}})));
    s.plane(1, 1, s.heated(0.5, heat({}, {{"back", "open"}})), shifted({0, 0, 2}));
    return s;
  }
};

}  // namespace suite::test
