// OpenVDB volumes as dense voxel grids. The only place that knows OpenVDB.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <cmath>

#include "base/files.h"
#include "formats/voxel/vdb_check.h"
#include "formats/voxel/voxel.h"

namespace suite {

namespace {

constexpr double kMostVdbCells = 268435456.0;  // 2^28: 1 GiB of values once spread out

openvdb::FloatGrid::Ptr float_grid(openvdb::io::File& file, const std::string& name, const Where& where) {
  std::string known;
  bool there = false;
  for (auto at = file.beginName(); at != file.endName(); ++at) {
    known += (known.empty() ? "" : ", ") + at.gridName();
    there = there || at.gridName() == name;
  }
  if (!there) throw Error(where, "has no grid '" + name + "'", "it has: " + (known.empty() ? "none" : known));
  // What is not of floats has not been looked at and is not read.
  const auto head = file.readGridMetadata(name);
  auto grid = head && head->type() == openvdb::FloatGrid::gridType()
                  ? openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name))
                  : nullptr;
  if (!grid) throw Error(where, "grid '" + name + "' is not one of floats", "fog volumes of floats are read");
  if (grid->getGridClass() == openvdb::GRID_LEVEL_SET)
    throw Error(where, "grid '" + name + "' is a level set",
                "fog volumes are read; convert it, or export its surface as OBJ");
  if (!grid->transform().isLinear()) throw Error(where, "grid '" + name + "' is not a box of equal cells");
  return grid;
}

std::vector<float> spread(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& box) {
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box);
  openvdb::tools::copyToDense(grid, dense);
  return std::vector<float>(dense.data(), dense.data() + dense.valueCount());
}

void check_values(const std::vector<float>& values, double high, const std::string& name, const Where& where) {
  for (const float v : values)
    if (!(v >= 0 && v <= high))
      throw Error(where, strf("grid '%s' has a value of %g", name.c_str(), v), strf("0 to %g", high));
}

// OpenVDB puts the value of a voxel at whole indices; here a cell reaches from one whole index to the next.
Affine3 to_local(const openvdb::math::Transform& transform, const openvdb::Coord& low) {
  const openvdb::Mat4d m = transform.baseMap()->getAffineMap()->getMat4();  // for row vectors
  Affine3 map;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) map.a[static_cast<size_t>(3 * r + c)] = m(c, r);
    map.b[r] = m(3, r);
  }
  return map * translation({low.x() - 0.5, low.y() - 0.5, low.z() - 0.5});
}

}  // namespace

bool reads_vdb() { return true; }

VoxelData read_vdb(const std::string& path, const std::string& density, const std::string& temperature) {
  const Where where{path, 0, 0, {}, -1};
  check_vdb(path, {density, temperature});
  try {
    openvdb::initialize();
    openvdb::io::File file(path);
    file.open(false);
    const auto fog = float_grid(file, density, where);
    const openvdb::CoordBBox box = fog->evalActiveVoxelBoundingBox();
    if (box.empty()) throw Error(where, "grid '" + density + "' is empty");
    const double cells = double(box.dim().x()) * box.dim().y() * box.dim().z();
    if (!(cells <= kMostVdbCells))
      throw Error(where, strf("grid '%s' covers %g cells", density.c_str(), cells), "at most 2^28");
    // A small file whose few voxels stand in a huge box has a node in a wrong place, and would take much memory.
    const auto bytes = static_cast<double>(file_size(path)), active = static_cast<double>(fog->activeVoxelCount());
    if (cells > 1.6e7 + 100 * bytes && cells > 8 * active)
      throw Error(where, strf("grid '%s': %g active voxels stand in a box of %g cells", density.c_str(), active, cells),
                  "at least one in 8, or a box of at most 1.6e7 cells and 100 for each byte of the file");
    VoxelData data;
    data.cells = {static_cast<uint32_t>(box.dim().x()), static_cast<uint32_t>(box.dim().y()),
                  static_cast<uint32_t>(box.dim().z())};
    data.to_local = to_local(fog->transform(), box.min());
    data.density = spread(*fog, box);
    check_values(data.density, 3e38, density, where);
    if (!temperature.empty()) {
      const auto heat = float_grid(file, temperature, where);
      if (!(heat->transform() == fog->transform()))
        throw Error(where, "grids '" + density + "' and '" + temperature + "' have different cells");
      data.temperature = spread(*heat, box);
      check_values(data.temperature, 1e5, temperature, where);
    }
    return data;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {  // what OpenVDB throws
    throw Error(where, std::string("cannot be read as OpenVDB: ") + e.what(),
                "is it a .vdb file of version 3 or later?");
  }
}

}  // namespace suite
