// Texts of files that other programs wrote: attributes, and datasets of names as netCDF-4 keeps them (strings, or a row
// of characters a name).
#include <hdf5.h>

#include <cstring>

#include "formats/hdf5/foreign.h"
#include "formats/hdf5/own_values.h"

namespace suite::h5 {

namespace {

constexpr size_t kLongest = 4096, kMostNames = 65536;  // bytes of a text; names of a dataset

std::string trimmed(std::string text) {
  text.resize(strnlen(text.data(), text.size()));
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

// Values of a text type, by `read` into memory of the type that it is given; empty: too long, or not read.
template <class Read>
std::vector<std::string> texts_of(hid_t stored, size_t count, const Read& read) {
  std::vector<std::string> out;
  const Handle type(H5Tcopy(stored), H5Tclose);
  if (H5Tis_variable_str(stored) > 0) {
    std::vector<char*> text(count, nullptr);
    if (read(type, text.data()) < 0) return {};
    for (char* t : text) {
      if (t)
        out.push_back(trimmed(std::string(t, strnlen(t, kLongest))));
      else
        out.emplace_back();
      H5free_memory(t);
    }
    return out;
  }
  const size_t size = H5Tget_size(stored);
  if (size == 0 || size > kLongest) return {};
  std::string text(size * count, '\0');
  if (read(type, text.data()) < 0) return {};
  for (size_t k = 0; k < count; ++k) out.push_back(trimmed(text.substr(k * size, size)));
  return out;
}

}  // namespace

std::string Foreign::text(const std::string& name, const std::string& attribute) const {
  if (!has(name)) fail("dataset '" + name + "' is missing");
  const Handle dataset(H5Dopen2(file_, name.c_str(), within_the_file(H5P_DATASET_ACCESS)), H5Dclose);
  if (dataset < 0 || H5Aexists(dataset, attribute.c_str()) <= 0) return {};
  const Handle a(H5Aopen(dataset, attribute.c_str(), H5P_DEFAULT), H5Aclose);
  if (a < 0) return {};
  const Handle type(H5Aget_type(a), H5Tclose), space(H5Aget_space(a), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) return {};
  const auto texts = texts_of(type, 1, [&](hid_t t, void* to) { return H5Aread(a, t, to); });
  return texts.empty() ? "" : texts[0];
}

std::optional<double> Foreign::number(const std::string& name, const std::string& attribute) const {
  if (!has(name)) fail("dataset '" + name + "' is missing");
  const Handle dataset(H5Dopen2(file_, name.c_str(), within_the_file(H5P_DATASET_ACCESS)), H5Dclose);
  if (dataset < 0 || H5Aexists(dataset, attribute.c_str()) <= 0) return std::nullopt;
  const Handle a(H5Aopen(dataset, attribute.c_str(), H5P_DEFAULT), H5Aclose);
  if (a < 0) return std::nullopt;
  const Handle type(H5Aget_type(a), H5Tclose), space(H5Aget_space(a), H5Sclose);
  const H5T_class_t kind = H5Tget_class(type);
  double value = 0;
  if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || H5Sget_simple_extent_npoints(space) != 1 ||
      H5Aread(a, H5T_NATIVE_DOUBLE, &value) < 0)
    return std::nullopt;
  return value;
}

std::vector<std::string> Foreign::names(const std::string& name) const {
  if (!has(name)) fail("dataset '" + name + "' is missing");
  const Handle dataset(H5Dopen2(file_, name.c_str(), within_the_file(H5P_DATASET_ACCESS)), H5Dclose);
  if (dataset < 0) return {};
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose),
      create(H5Dget_create_plist(dataset), H5Pclose);
  hsize_t dims[2] = {0, 0};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (H5Tget_class(type) != H5T_STRING || rank < 1 || rank > 2 || !elsewhere(create).empty()) return {};
  H5Sget_simple_extent_dims(space, dims, nullptr);
  const hsize_t length = rank == 2 ? dims[1] : 1;
  if (dims[0] > kMostNames || length > kLongest || (rank == 2 && H5Tget_size(type) != 1)) return {};
  const auto parts = texts_of(type, dims[0] * length, [&](hid_t t, void* to) {
    return H5Dread(dataset, t, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
  });
  if (rank == 1) return parts;
  std::vector<std::string> joined(parts.empty() ? 0 : dims[0]);
  for (size_t k = 0; k < parts.size(); ++k) joined[k / length] += parts[k].empty() ? " " : parts[k];
  for (std::string& text : joined) text = trimmed(std::move(text));
  return joined;
}

Foreign::Kind Foreign::kind(const std::string& name) const {
  if (!has(name)) return {};
  const Handle object(H5Oopen(file_, name.c_str(), H5P_DEFAULT), H5Oclose);
  if (object < 0 || H5Iget_type(object) != H5I_DATASET) return {};
  const Handle type(H5Dget_type(object), H5Tclose), space(H5Dget_space(object), H5Sclose);
  const H5T_class_t of = H5Tget_class(type);
  Kind made;
  made.dimensions = std::max(0, H5Sget_simple_extent_ndims(space));
  if (hsize_t dims[2] = {0, 0}; made.dimensions == 1 || made.dimensions == 2) {
    H5Sget_simple_extent_dims(space, dims, nullptr);
    if (made.dimensions == 2) made.rows = dims[0];
    made.columns = dims[made.dimensions - 1];
  }
  made.numbers = of == H5T_FLOAT || of == H5T_INTEGER;
  made.texts = of == H5T_STRING;
  return made;
}

}  // namespace suite::h5
