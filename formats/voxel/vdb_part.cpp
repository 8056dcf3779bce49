// The part `vdb`: all calls of OpenVDB.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <cstdio>
#include <filesystem>

#include "base/late_part.h"
#include "formats/voxel/vdb_grids.h"

namespace suite {

namespace {

constexpr double kMostVdbCells = 268435456.0;  // 2^28: 1 GiB of values once spread out

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", v);
  return text;
}

openvdb::FloatGrid::Ptr float_grid(openvdb::io::File& file, const std::string& name) {
  std::string known;
  bool there = false;
  for (auto at = file.beginName(); at != file.endName(); ++at) {
    known += (known.empty() ? "" : ", ") + at.gridName();
    there = there || at.gridName() == name;
  }
  if (!there) throw VdbFault{"has no grid '" + name + "'", "it has: " + (known.empty() ? "none" : known)};
  // What is not of floats has not been looked at and is not read.
  const auto head = file.readGridMetadata(name);
  auto grid = head && head->type() == openvdb::FloatGrid::gridType()
                  ? openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name))
                  : nullptr;
  if (!grid) throw VdbFault{"grid '" + name + "' is not one of floats", "fog volumes of floats are read"};
  if (grid->getGridClass() == openvdb::GRID_LEVEL_SET)
    throw VdbFault{"grid '" + name + "' is a level set",
                   "fog volumes are read; convert it, or export its surface as OBJ"};
  if (!grid->transform().isLinear()) throw VdbFault{"grid '" + name + "' is not a box of equal cells", ""};
  return grid;
}

std::vector<float> spread(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& box) {
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box);
  openvdb::tools::copyToDense(grid, dense);
  return std::vector<float>(dense.data(), dense.data() + dense.valueCount());
}

// OpenVDB puts the value of a voxel at whole indices; here a cell reaches from one whole index to the next.
std::array<std::array<double, 4>, 3> to_local(const openvdb::math::Transform& transform, const openvdb::Coord& low) {
  const openvdb::Mat4d m = transform.baseMap()->getAffineMap()->getMat4();  // for row vectors
  const std::array<double, 3> corner{low.x() - 0.5, low.y() - 0.5, low.z() - 0.5};
  std::array<std::array<double, 4>, 3> map{};
  for (int r = 0; r < 3; ++r) {
    auto& row = map[static_cast<size_t>(r)];
    for (int c = 0; c < 3; ++c) row[static_cast<size_t>(c)] = m(c, r);
    row[3] = row[0] * corner[0] + row[1] * corner[1] + row[2] * corner[2] + m(3, r);
  }
  return map;
}

openvdb::CoordBBox box_of(const openvdb::FloatGrid& fog, const std::string& name, const std::string& path) {
  const openvdb::CoordBBox box = fog.evalActiveVoxelBoundingBox();
  if (box.empty()) throw VdbFault{"grid '" + name + "' is empty", ""};
  const double cells = double(box.dim().x()) * box.dim().y() * box.dim().z();
  if (!(cells <= kMostVdbCells))
    throw VdbFault{"grid '" + name + "' covers " + number(cells) + " cells", "at most 2^28"};
  // A small file whose few voxels stand in a huge box has a node in a wrong place, and would take much memory.
  const auto bytes = static_cast<double>(std::filesystem::file_size(path)),
             active = static_cast<double>(fog.activeVoxelCount());
  if (cells > 1.6e7 + 100 * bytes && cells > 8 * active)
    throw VdbFault{
        "grid '" + name + "': " + number(active) + " active voxels stand in a box of " + number(cells) + " cells",
        "at least one in 8, or a box of at most 1.6e7 cells and 100 for each byte of the file"};
  return box;
}

std::optional<VdbFault> read(const std::string& path, const std::string& density, const std::string& temperature,
                             VdbGrids& grids) try {
  openvdb::initialize();
  openvdb::io::File file(path);
  file.open(false);
  const auto fog = float_grid(file, density);
  const openvdb::CoordBBox box = box_of(*fog, density, path);
  grids.cells = {static_cast<uint32_t>(box.dim().x()), static_cast<uint32_t>(box.dim().y()),
                 static_cast<uint32_t>(box.dim().z())};
  grids.index_to_local = to_local(fog->transform(), box.min());
  grids.density = spread(*fog, box);
  if (!temperature.empty()) {
    const auto heat = float_grid(file, temperature);
    if (!(heat->transform() == fog->transform()))
      throw VdbFault{"grids '" + density + "' and '" + temperature + "' have different cells", ""};
    grids.temperature = spread(*heat, box);
  }
  return {};
} catch (const VdbFault& fault) {
  return fault;
} catch (const std::exception& e) {  // what OpenVDB throws
  return VdbFault{std::string("cannot be read as OpenVDB: ") + e.what(), "is it a .vdb file of version 3 or later?"};
}

}  // namespace

SUITE_PART_VERSION;
extern "C" {
extern const VdbCalls suite_vdb_calls;
const VdbCalls suite_vdb_calls{read};
}

}  // namespace suite
