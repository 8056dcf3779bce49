// What the part `proj` and its only caller share: systems of maps by EPSG codes, as PROJ knows them.
#pragma once
#include <string>

namespace suite {

struct ProjSystem {
  std::string name, heights;  // of the system, and of what its heights count from; empty: it says nothing of heights
  bool geographic = false;    // its coordinates are angles
  bool ellipsoidal = false;   // its heights are above the ellipsoid
};

struct ProjCalls {
  // Null where it cannot be; then `fault` says why.
  void* (*open)(int epsg, ProjSystem& system, std::string& fault);
  // x: easting or longitude, y: northing or latitude, in the system's own units; degrees on WGS84. False: PROJ knows no
  // such place. For one thread at a time.
  bool (*to_wgs84)(void* opened, double x, double y, double& latitude_deg, double& longitude_deg);
  // How the last place was found: name and accuracy of the transformation; empty where there was none.
  void (*describe)(void* opened, std::string& how, double& accuracy_m);
  void (*close)(void* opened);
};

}  // namespace suite
