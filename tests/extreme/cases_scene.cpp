// Distances, sizes, nested and scaled instances, degenerate triangles, scenes with nothing in them.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "extreme/case.h"
#include "math/sampling.h"
#include "tests/support/radiometry_kit.h"

namespace suite::extreme {

namespace {

using namespace suite::test;

// Worst of: rays missed and rays falsely shadowed (each counts as infinity), and the 99th percentile of the distance of
// hit points from the line of sight, in units of the bound: 2 ulp of the tile's half size and what double itself
// allows.
double domes(const Numerics& numerics, double distance, Vec3 centre, double width) {
  auto scene = scene_of({dome(width)}, {material("m", lambert(0.5))});
  scene->groups[0].placements[0].to_parent = translation(centre);
  const Tracer tracer(scene);
  const Vec3 camera = centre + normalized(Vec3{0.2, 0.1, 1}) * distance;
  const Dir sun = normalized(Vec3{0.4, -0.3, 0.8});
  constexpr size_t count = 5000;
  std::vector<Ray> rays, sun_rays;
  Pcg32 rng(7);
  for (size_t i = 0; i < count; ++i) {
    const double x = (rng.uniform() - 0.5) * 0.98 * width, y = (rng.uniform() - 0.5) * 0.98 * width;
    rays.push_back({camera, normalized(centre + Vec3{x, y, -(x * x + y * y) / (10 * width)} - camera), 0});
  }
  std::vector<Hit> hits(count);
  TraceStatistics statistics;
  tracer.nearest(rays, hits, true, statistics);
  std::vector<double> errors;
  for (size_t i = 0; i < count; ++i) {
    if (!hits[i].hit()) return INFINITY;
    const Vec3 offset = numerics.hit_point(rays[i], hits[i]) - hits[i].position;
    // Across the ray: where the surface is. Along it: against the point on the triangle, which is exact in its plane.
    const Vec3 from_line = hits[i].position - rays[i].origin;
    errors.push_back(length(offset) + length(from_line - rays[i].direction * dot(from_line, rays[i].direction)));
    sun_rays.push_back({tracer.leave(hits[i], sun), sun, 0});
  }
  std::vector<uint8_t> blocked(count);
  const std::vector<double> far(count, INFINITY);
  tracer.occluded(sun_rays, far, blocked, false, statistics);
  if (std::count(blocked.begin(), blocked.end(), 1)) return INFINITY;
  std::sort(errors.begin(), errors.end());
  const auto half = static_cast<float>(width / 2);
  const double ulp = std::nextafter(half, INFINITY) - half;
  return errors[count * 99 / 100] / (2 * ulp + 4 * DBL_EPSILON * (distance + length(centre)));
}

Case distance_case(const char* name, double distance, double width, double to) {
  return {"distance",
          name,
          "line of sight in double; no false shadow, none missed",
          "2 ulp of the tile",
          1,
          [width](const Numerics& n, double x) { return domes(n, x, {}, width); },
          {"distance", "m", distance, to, 10},
          {}};
}
Case placed_case(const char* name, Vec3 direction, double where, double to) {
  return {"distance",
          name,
          "line of sight in double; no false shadow, none missed",
          "2 ulp of the tile",
          1,
          [direction](const Numerics& n, double x) { return domes(n, 7e5, direction * x, 1000); },
          {"distance from the origin", "m", where, to, 10},
          {}};
}

// Distance of a hit on a nested square from its place by the product of transforms in double, relative to its size.
double nested(int depth, double scale, bool mirrored) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("m", lambert(0.5))};
  scene->meshes = {quad(1, 0, 0)};
  Affine3 product;
  for (int level = 0; level < depth; ++level) {
    Group g;
    Placement p;
    const double s = level % 2 ? scale : 1 / scale;
    p.to_parent = translation({0.3, -0.2, 0.1}) * rotation(normalized(Vec3{1, 2, 3}), 0.3) *
                  scaling({mirrored && level % 8 == 0 ? -s : s, s, s});
    p.kind = level + 1 < depth ? TargetKind::group : TargetKind::mesh;
    p.target = level + 1 < depth ? static_cast<uint32_t>(level) + 1 : 0;
    product = product * p.to_parent;
    g.placements.push_back(p);
    scene->groups.push_back(g);
  }
  check_scene(*scene, "nested");
  const Tracer tracer(scene);
  const double size = std::cbrt(std::fabs(product.determinant()));
  const Vec3 centre = product.point({0.1, 0.2, 0}), normal = normalized(product.normal({0, 0, 1}));
  const Ray ray{centre + normal * (5 * size), -normal, 0};
  Hit hit;
  TraceStatistics statistics;
  tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
  if (!hit.hit()) return INFINITY;
  return std::fmax(length(hit.position - centre) / size, length(hit.normal - normal));
}

// A Lambert floor of `extra` triangles beside the good ones, under a collimated sun: rho E cos z / pi.
double floor_with(const std::vector<Vec3>& extra_vertices, const std::vector<uint32_t>& extra, bool inverted = false) {
  std::vector<Vec3> v{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
  std::vector<uint32_t> f{0, 1, 2, 0, 2, 3};
  if (inverted) f = {0, 2, 1, 0, 3, 2};
  for (const Vec3& p : extra_vertices) v.push_back(p);
  for (const uint32_t i : extra) f.push_back(i);
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.5, 2), 0, Curve::constant(1000)});
  const Dir out = dir_from_angles(0.3, 1);
  const auto run = render(scene_of({mesh_of(v, f, 0)}, {material("m", lambert(0.4))}), sources,
                          std::make_unique<RaySensor>(std::vector<Ray>{{Vec3{0.1, 0.3, 0} + out * 9.0, -out, 0},
                                                                       {Vec3{1, 1, 0} + out * 9.0, -out, 0}},
                                                      one_band(), 4));
  double worst = 0;
  const double expected = 0.4 * 1000 * std::cos(0.5) / kPi;
  for (const double L : run.result.radiance) worst = std::fmax(worst, std::fabs(L / expected - 1));
  return std::isnan(run.result.radiance[0]) ? INFINITY : worst;
}

double plane_under_disk(double half_angle, double zenith) {
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(zenith, 2), half_angle, Curve::constant(1361)});
  const Dir out = dir_from_angles(0.3, 1);
  const auto run = render(scene_of({quad(5, 0, 0)}, {material("m", lambert(0.37))}), sources,
                          std::make_unique<RaySensor>(std::vector<Ray>{{out * 9.0, -out, 0}}, one_band(), 4096));
  return std::fabs(run.result.radiance[0] / (0.37 * 1361 * std::cos(zenith) / kPi) - 1);
}

// What a closed box or nothing shows without sources.
double darkness(const std::shared_ptr<Scene>& scene) {
  const auto run = render(
      scene, {},
      std::make_unique<RaySensor>(std::vector<Ray>{{{0.1, 0, 0.2}, normalized(Vec3{0.1, 0.3, 1}), 0}}, one_band(), 16));
  return std::fabs(run.result.radiance[0]) + std::fabs(run.result.standard_error[0]) +
         static_cast<double>(run.report.statistics.failures);
}

}  // namespace

static void add_distances(std::vector<Case>& c) {
  c.push_back(distance_case("camera 1 m over a scene of 1 mm", 1, 1e-3, 1e4));
  c.push_back(distance_case("camera 1 mm over a scene of 1 mm", 1e-3, 1e-3, 1e4));
  c.push_back(distance_case("camera at 2 km", 2e3, 1000, 2e3));
  c.push_back(distance_case("camera at 700 km", 7e5, 1000, 7e5));
  c.push_back(distance_case("camera at 36 000 km", 3.6e7, 1000, 1e13));
  c.push_back(distance_case("one mesh of 100 km from 700 km", 7e5, 1e5, 7e5));
  c.push_back(placed_case("geometry 1000 km from the origin", normalized(Vec3{1, 0.2, 0}), 1e6, 1e13));
  c.push_back(placed_case("geometry in Earth-centred coordinates", {0.6, 0, 0.8}, 6.378e6, 6.378e6));
}

static void add_instances(std::vector<Case>& c) {
  c.push_back({"instances",
               "64 deep, turned and moved",
               "product in double",
               "of its size",
               1e-6,
               [](const Numerics&, double depth) { return nested(static_cast<int>(depth), 1.25, false); },
               {"depth", "1", 64, 4096, 2},
               {}});
  c.push_back({"instances",
               "64 deep, every eighth mirrored",
               "product in double",
               "of its size",
               1e-6,
               [](const Numerics&, double depth) { return nested(static_cast<int>(depth), 1.25, true); },
               {"depth", "1", 64, 4096, 2},
               {}});
  c.push_back({"instances",
               "scale 1e6",
               "product in double",
               "of its size",
               1e-5,
               [](const Numerics&, double scale) { return nested(1, 1 / scale, false); },
               {"scale", "1", 1e6, 1e12, 10},
               {}});
  c.push_back({"instances",
               "scale 1e-6",
               "product in double",
               "of its size",
               1e-5,
               [](const Numerics&, double scale) { return nested(1, 1 / scale, false); },
               {"scale", "1", 1e-6, 1e-12, 10},
               {}});
}

static void add_triangles(std::vector<Case>& c) {
  c.push_back({"triangles",
               "one of zero area among them",
               "closed form rho E cos z / pi",
               "1",
               1e-5,
               [](const Numerics&, double) {
                 return floor_with({{0, 0, 1}, {1, 1, 1}, {2, 2, 1}}, {4, 5, 6});
               },
               {},
               {}});
  c.push_back({"triangles",
               "one with three equal corners",
               "closed form rho E cos z / pi",
               "1",
               1e-5,
               [](const Numerics&, double) {
                 return floor_with({}, {2, 2, 2});
               },
               {},
               {}});
  c.push_back({"triangles",
               "duplicates in one place",
               "closed form rho E cos z / pi",
               "1",
               1e-5,
               [](const Numerics&, double) {
                 return floor_with({}, {0, 1, 2, 0, 2, 3});
               },
               {},
               {}});
  c.push_back({"triangles",
               "inverted winding under a two-sided model",
               "closed form rho E cos z / pi",
               "1",
               1e-5,
               [](const Numerics&, double) { return floor_with({}, {}, true); },
               {},
               {}});
  c.push_back({"triangles",
               "sliver of aspect ratio 1e6 in the way of nothing",
               "closed form rho E cos z / pi",
               "1",
               1e-5,
               [](const Numerics&, double ratio) {
                 return floor_with({{-4, -4, 0}, {4, -4, 0}, {0, -4 + 8 / ratio, 0}}, {4, 5, 6});
               },
               {"aspect ratio", "1", 1e6, 1e30, 10},
               {}});
}

static void add_sun(std::vector<Case>& c) {
  c.push_back({"sun",
               "disk of 1e-4 rad",
               "closed form rho E cos z / pi",
               "1",
               1e-3,
               [](const Numerics&, double x) { return plane_under_disk(x, 0.8); },
               {"half angle", "rad", 1e-4, 1e-12, 10},
               {}});
  c.push_back({"sun",
               "collimated, 89.9 deg from the zenith",
               "closed form rho E cos z / pi",
               "1",
               1e-5,
               [](const Numerics&, double x) { return plane_under_disk(0, (90 - x) * kDegree); },
               {"elevation", "deg", 0.1, 1e-6, 10},
               {}});
}

static void add_nothing(std::vector<Case>& c) {
  c.push_back({"nothing",
               "empty scene, no sources",
               "closed form 0",
               "W/(m2 sr um)",
               0,
               [](const Numerics&, double) { return darkness(scene_of({}, {})); },
               {},
               {}});
  c.push_back({"nothing",
               "no sources",
               "closed form 0",
               "W/(m2 sr um)",
               0,
               [](const Numerics&, double) { return darkness(scene_of({quad(1, 1, 0)}, {material("m", lambert(1))})); },
               {},
               {}});
  c.push_back({"nothing",
               "closed box of black",
               "closed form 0",
               "W/(m2 sr um)",
               0,
               [](const Numerics&, double) {
                 return darkness(scene_of({box({-1, -1, -1}, {1, 1, 1}, 0, false)}, {material("m", lambert(0))}));
               },
               {},
               {}});
  c.push_back({"nothing",
               "closed box of perfect white: all is cut, and said so",
               "closed form 1",
               "of the throughput",
               1e-6,
               [](const Numerics&, double nodes) {
                 PipelineOptions options;
                 options.max_nodes = static_cast<int>(nodes);
                 options.roulette_after = 1000;
                 const auto run =
                     render(scene_of({box({-1, -1, -1}, {1, 1, 1}, 0, false)}, {material("m", lambert(1))}), {},
                            std::make_unique<RaySensor>(
                                std::vector<Ray>{{{0.1, 0, 0.2}, normalized(Vec3{0.1, 0.3, 1}), 0}}, one_band(), 16),
                            options);
                 return std::fabs(run.report.statistics.truncated / static_cast<double>(run.report.statistics.paths) -
                                  1);
               },
               {"nodes", "1", 16, 64, 2},
               {}});
}

std::vector<Case> scene_cases() {
  std::vector<Case> c;
  add_distances(c);
  add_instances(c);
  add_triangles(c);
  add_sun(c);
  add_nothing(c);
  return c;
}

}  // namespace suite::extreme
