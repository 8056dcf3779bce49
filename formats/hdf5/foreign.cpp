#include "formats/hdf5/foreign.h"

#include <hdf5.h>

#include "base/files.h"
#include "formats/hdf5/global_heap.h"
#include "formats/hdf5/own_values.h"
#include "formats/hdf5/silence.h"

namespace suite::h5 {

namespace {

constexpr hsize_t kMostBytes = hsize_t{1} << 30, kForeignRatio = 1040;  // deflate packs no better

bool known_packing(hid_t create) {
  for (int k = 0; k < H5Pget_nfilters(create); ++k) {
    unsigned flags = 0, config = 0;
    size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(create, static_cast<unsigned>(k), &flags, &values, nullptr, 0, nullptr, &config);
    if (filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_DEFLATE) return false;
  }
  return true;
}

}  // namespace

void Foreign::fail(const std::string& what) const { throw Error(Where{path_, 0, 0, {}, -1}, what); }

Foreign::Foreign(const std::string& path) : path_(path) {
  silence();
  input_size(path);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);
  if (H5Fis_hdf5(path.c_str()) <= 0) fail("is not an HDF5 file");
  if (const auto broken = broken_global_heap(path))
    fail(strf("is a damaged HDF5 file: the global heap at byte %zu has an object of an impossible size", *broken));
  file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  if (file_ < 0) fail("is a damaged HDF5 file");
}

bool Foreign::has(const std::string& name) const {
  if (const std::string step = external_step(file_, name); !step.empty())
    fail("'" + step + "' is a link into another file, which is not followed");
  return linked(file_, name);
}

Foreign::Table Foreign::table(const std::string& name) const {
  if (!has(name)) fail("dataset '" + name + "' is missing");
  const Handle dataset(H5Dopen2(file_, name.c_str(), within_the_file(H5P_DATASET_ACCESS)), H5Dclose);
  if (dataset < 0) fail("'" + name + "' is no dataset");
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose),
      create(H5Dget_create_plist(dataset), H5Pclose);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) fail("dataset '" + name + "' holds no numbers");
  hsize_t dims[2] = {0, 0};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank != 1 && rank != 2) fail("dataset '" + name + strf("' has %d dimensions, one or two are read", rank));
  H5Sget_simple_extent_dims(space, dims, nullptr);
  Table t;
  t.rows = rank == 2 ? dims[0] : 1;
  t.columns = rank == 2 ? dims[1] : dims[0];
  if (t.columns && t.rows > kMostBytes / 8 / t.columns) fail("dataset '" + name + "' is larger than 1 GiB");
  const hsize_t bytes = t.rows * t.columns * H5Tget_size(type), there = H5Dget_storage_size(dataset);
  const H5D_layout_t layout = H5Pget_layout(create);
  const bool packed = layout == H5D_CHUNKED;
  if (const std::string wrong = elsewhere(create); !wrong.empty()) fail("dataset '" + name + "' " + wrong);
  if ((layout != H5D_CONTIGUOUS && layout != H5D_COMPACT && !packed) || (packed && !known_packing(create)))
    fail("dataset '" + name + "' has a layout that is not read");
  if (there > file_size(path_) || (packed ? bytes / kForeignRatio > there : bytes > there))
    fail("dataset '" + name + "' is not whole");
  if (const std::string wrong = overclaim(t.rows * t.columns * sizeof(double), file_size(path_)); !wrong.empty())
    fail("dataset '" + name + "' " + wrong);
  t.values.resize(t.rows * t.columns);
  if (!t.values.empty() && H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, t.values.data()) < 0)
    fail("dataset '" + name + "' cannot be read");
  return t;
}

std::vector<std::string> Foreign::children(const std::string& group) const {
  if (!has(group)) fail("group '" + group + "' is missing");
  const Handle g(H5Gopen2(file_, group.c_str(), within_the_file(H5P_GROUP_ACCESS)), H5Gclose);
  H5G_info_t info;
  if (g < 0 || H5Gget_info(g, &info) < 0) fail("'" + group + "' is no group");
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    char name[256] = {};
    if (H5Lget_name_by_idx(g, ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof name, H5P_DEFAULT) < 0)
      fail("group '" + group + "' cannot be read");
    names.push_back(name);
  }
  return names;
}

}  // namespace suite::h5
