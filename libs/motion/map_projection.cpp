#include "motion/map_projection.h"

#include <mutex>

#include "base/error.h"
#include "base/late_part.h"
#include "motion/proj_part.h"

namespace suite {

namespace {

const ProjCalls& calls() {
  try {
    static const auto* const table = static_cast<const ProjCalls*>(late_symbol("proj", "suite_proj_calls"));
    return *table;
  } catch (const Error& e) {
    throw Error("PROJ is not there: " + e.message(),
                "install the package libproj25 (Debian, Ubuntu), or libproj-dev before the suite is built");
  }
}

}  // namespace

struct MapProjection::Opened {
  Opened(int epsg) : proj(calls()) {
    std::string fault;
    of = proj.open(epsg, system, fault);
    if (!of) throw Error(strf("PROJ does not know EPSG:%d as a map: ", epsg) + printable(fault).substr(0, 200));
  }
  ~Opened() { proj.close(of); }
  Opened(const Opened&) = delete;
  const ProjCalls& proj;
  ProjSystem system;
  void* of = nullptr;
  std::mutex one;
};

MapProjection::MapProjection(int epsg) : opened_(std::make_shared<Opened>(epsg)) {}

bool MapProjection::geographic() const { return opened_->system.geographic; }
const std::string& MapProjection::name() const { return opened_->system.name; }
const std::string& MapProjection::heights_name() const { return opened_->system.heights; }

MapSystem::Heights MapProjection::heights() const {
  using enum MapSystem::Heights;
  return !opened_->system.heights.empty() ? geoid : opened_->system.ellipsoidal ? ellipsoid : unknown;
}

Geodetic MapProjection::place(double x, double y, double height_m) const {
  Geodetic g{0, 0, height_m};
  const std::lock_guard lock(opened_->one);
  if (!opened_->proj.to_wgs84(opened_->of, x, y, g.latitude_deg, g.longitude_deg))
    throw Error(strf("PROJ finds no place on the Earth at (%.9g, %.9g) of ", x, y) + name());
  return g;
}

std::string MapProjection::description() const {
  std::string how;
  double accuracy = -1;
  const std::lock_guard lock(opened_->one);
  opened_->proj.describe(opened_->of, how, accuracy);
  if (how.empty()) return "by PROJ";
  return "by PROJ (" + printable(how) + (accuracy >= 0 ? strf(", within %g m", accuracy) : std::string()) + ")";
}

}  // namespace suite
