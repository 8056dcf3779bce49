#include "formats/hdf5/netcdf.h"

#include <hdf5.h>

#include "base/files.h"
#include "formats/hdf5/silence.h"

namespace suite::h5 {

namespace {

// One that ends with a zero byte, as the dimension scales' specification wants it.
bool put(hid_t object, const char* name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Tset_size(type, text.size() + 1);
  const Handle a(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return a >= 0 && H5Awrite(a, type, text.c_str()) >= 0;
}

bool put(hid_t object, const char* name, long long value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle a(H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return a >= 0 && H5Awrite(a, H5T_NATIVE_LLONG, &value) >= 0;
}

}  // namespace

void NetcdfWriter::fail(const std::string& what) const {
  throw Error(Where{path_, 0, 0, {}, -1}, "cannot be written: " + what, "is the disk full?");
}

NetcdfWriter::NetcdfWriter(const std::string& temporary, std::string path) : path_(std::move(path)) {
  silence();
  const Handle create(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(create, false);
  // netCDF lists dimensions and variables in the order in which they were made.
  H5Pset_link_creation_order(create, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_attr_creation_order(create, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  file_ = Handle(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, create, H5P_DEFAULT), H5Fclose);
  if (file_ < 0) fail("HDF5 refuses to create it");
}

NetcdfWriter::~NetcdfWriter() = default;

Handle NetcdfWriter::make(const std::string& name, std::span<const unsigned long long> extent,
                          std::span<const double> values, const NetcdfTexts& texts) {
  const Handle space(extent.empty() ? H5Screate(H5S_SCALAR)
                                    : H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr),
                     H5Sclose);
  const Handle create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(create, false);
  H5Pset_attr_creation_order(create, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  Handle made(H5Dcreate2(file_, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, create, H5P_DEFAULT), H5Dclose);
  if (made < 0 || H5Dwrite(made, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail("dataset '" + name + "'");
  for (const auto& [key, text] : texts)
    if (!put(made, key.c_str(), text)) fail("attribute '" + key + "' of '" + name + "'");
  return made;
}

void NetcdfWriter::dimension(const std::string& name, std::span<const double> values, const NetcdfTexts& texts) {
  SUITE_CHECK(!values.empty() && !dimensions_.contains(name));
  const unsigned long long size = values.size();
  Dimension d{make(name, {&size, 1}, values, texts), values.size(), {}};
  const auto number = static_cast<long long>(dimensions_.size());
  if (!put(d.scale, "CLASS", "DIMENSION_SCALE") || !put(d.scale, "NAME", name) ||
      !put(d.scale, "_Netcdf4Dimid", number))
    fail("dimension '" + name + "'");
  dimensions_.emplace(name, std::move(d));
}

void NetcdfWriter::variable(const std::string& name, const std::vector<std::string>& dimensions,
                            std::span<const double> values, const NetcdfTexts& texts) {
  std::vector<unsigned long long> extent;
  size_t count = 1;
  for (const std::string& d : dimensions) {
    extent.push_back(dimensions_.at(d).size);
    count *= dimensions_.at(d).size;
  }
  SUITE_CHECK_EQ(values.size(), count);
  const Handle made = make(name, extent, values, texts);
  if (dimensions.empty()) return;
  std::vector<hobj_ref_t> scales(dimensions.size());
  std::vector<hvl_t> lists;
  for (size_t i = 0; i < dimensions.size(); ++i) {
    if (H5Rcreate(&scales[i], file_, dimensions[i].c_str(), H5R_OBJECT, -1) < 0) fail("a reference of '" + name + "'");
    lists.push_back({1, &scales[i]});
    hobj_ref_t own{};
    if (H5Rcreate(&own, file_, name.c_str(), H5R_OBJECT, -1) < 0) fail("a reference to '" + name + "'");
    dimensions_.at(dimensions[i]).users.emplace_back(static_cast<Id>(own), static_cast<unsigned>(i));
  }
  const Handle type(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose);
  const hsize_t rank = dimensions.size();
  const Handle space(H5Screate_simple(1, &rank, nullptr), H5Sclose);
  const Handle a(H5Acreate2(made, "DIMENSION_LIST", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (a < 0 || H5Awrite(a, type, lists.data()) < 0) fail("dimensions of '" + name + "'");
}

void NetcdfWriter::attribute(const std::string& name, const std::string& text) {
  if (!put(file_, name.c_str(), text)) fail("attribute '" + name + "'");
}
void NetcdfWriter::attribute(const std::string& name, long long value) {
  if (!put(file_, name.c_str(), value)) fail("attribute '" + name + "'");
}

void NetcdfWriter::close() {
  struct User {
    hobj_ref_t variable;
    unsigned dimension;
  };
  const Handle type(H5Tcreate(H5T_COMPOUND, sizeof(User)), H5Tclose);
  H5Tinsert(type, "dataset", HOFFSET(User, variable), H5T_STD_REF_OBJ);
  H5Tinsert(type, "dimension", HOFFSET(User, dimension), H5T_NATIVE_UINT);
  for (auto& [name, d] : dimensions_) {
    if (d.users.empty()) continue;
    std::vector<User> users;
    for (const auto& [at, as] : d.users) users.push_back({static_cast<hobj_ref_t>(at), as});
    const hsize_t n = users.size();
    const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose);
    const Handle a(H5Acreate2(d.scale, "REFERENCE_LIST", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (a < 0 || H5Awrite(a, type, users.data()) < 0) fail("users of dimension '" + name + "'");
  }
  dimensions_.clear();
  if (H5Fflush(file_, H5F_SCOPE_LOCAL) < 0) fail("its last part");
  file_ = Handle();
}

}  // namespace suite::h5
