// Point clouds: ground as a surface, leaves as voxels.
#include "scene/point_voxels.h"

#include "formats/las/las.h"
#include "formats/scene_text/reader.h"

namespace suite::scene_text {

namespace {

// Which of the points are of the classes that are listed.
std::vector<bool> chosen(const Params& p, const PointCloud& cloud, std::vector<uint8_t> classes) {
  std::vector<bool> of(256, false);
  if (const auto list = p.find("classes")) {
    classes.clear();
    for (const Params& one : list->items()) classes.push_back(static_cast<uint8_t>(one.as_integer(0, 255)));
  }
  for (const uint8_t c : classes) of[c] = true;
  std::vector<bool> taken(cloud.kind.size());
  for (size_t k = 0; k < taken.size(); ++k) taken[k] = of[cloud.kind[k]];
  return taken;
}

}  // namespace

void Reader::read_points(const Params& p, DraftGeometry& g) {
  read_mesh_rules(p, g);
  if (!g.material.given()) throw p.error("ground '" + g.name + "' needs a 'material'");
  const Params file = p.at("points");
  TinRule rule;
  rule.error_m = p.number_in("error_m", 0, 1e6, "m", 0);
  rule.longest_m = p.number_in("max_edge_m", 0, 1e9, "m", 0);
  const std::string path = input(file);
  const PointCloud cloud = of_file([&] { return read_las(path, report_); });
  const std::vector<bool> ground = chosen(p, cloud, {2});
  const auto place = map_place(p, cloud.system, file, true);
  for (size_t k = 0; k < ground.size(); ++k)
    if (ground[k]) g.mesh.positions.push_back(place(cloud.places[k]));
  if (g.mesh.positions.empty())
    throw file.error(strf("none of %zu points is of these classes", ground.size()), "'classes' lists them; 2 is ground",
                     "SP204");
  g.mesh.file = path;
  g.mesh.runs.push_back({"", "", 0, 0});
  g.tin = rule;
}

VoxelData Reader::read_point_voxels(const Params& p, const Params& file) {
  const double cell = p.number_in("cell_m", 1e-3, 1e6, "m");
  const bool leaf_area = p.at("density").as_choice({"leaf_area", "counts"}) == 0;
  const double projection = p.number_in("projection", 0.01, 1, "m2 of shadow of a m2 of leaves", 0.5);
  const std::string path = input(file);
  const PointCloud cloud = of_file([&] { return read_las(path, report_); });
  const std::vector<bool> leaf = chosen(p, cloud, {3, 4, 5});
  const auto place = map_place(p, cloud.system, file, true);
  std::vector<Vec3> places;
  for (const Vec3& v : cloud.places) places.push_back(place(v));
  PointVoxels made;
  try {
    made = point_voxels(places, leaf, cell, leaf_area ? PointRule::leaf_area : PointRule::counts, projection);
  } catch (const Error& e) {
    throw file.error(e.message(), e.hint(), "SP601");
  }
  const Where whole{path, 0, 0, {}, -1};
  if (leaf_area)
    report_.add(
        "SP707", path,
        {whole, strf("leaf area by contact frequency: every point is taken for a beam from straight above, leaves "
                     "throw shadows of %g of their area; in %zu cells no beam came through, half a one is taken",
                     projection, made.opaque)});
  else
    report_.add("SP707", path, {whole, "densities are points in a cubic metre: 'density_scale' makes them leaf area"});
  VoxelData data;
  data.cells = made.cells, data.to_local = made.to_local, data.density = std::move(made.density);
  return data;
}

}  // namespace suite::scene_text
