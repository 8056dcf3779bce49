#include "formats/hdf5/own_values.h"

#include <hdf5.h>

#include "base/progress.h"

namespace suite::h5 {

namespace {

constexpr unsigned long long kSmallValues = 256ull << 20, kMostTimes = 256;

herr_t refuse(const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) { return -1; }

}  // namespace

std::string external_step(Id file, const std::string& name) {
  for (size_t at = name.find('/', 1);; at = name.find('/', at + 1)) {
    const std::string step = name.substr(0, at);
    H5L_info_t info;
    if (H5Lexists(file, step.c_str(), H5P_DEFAULT) <= 0 || H5Lget_info(file, step.c_str(), &info, H5P_DEFAULT) < 0)
      return {};
    if (info.type != H5L_TYPE_HARD && info.type != H5L_TYPE_SOFT) return step;
    if (at == std::string::npos) return {};
  }
}

Handle within_the_file(Id access_class) {
  Handle access(H5Pcreate(access_class), H5Pclose);
  H5Pset_elink_cb(access, refuse, nullptr);
  return access;
}

bool linked(Id file, const std::string& name) {
  // Every link on the way must exist, or the library reports an error.
  const Handle access = within_the_file(H5P_LINK_ACCESS);
  for (size_t at = name.find('/', 1); at != std::string::npos; at = name.find('/', at + 1))
    if (H5Lexists(file, name.substr(0, at).c_str(), access) <= 0) return false;
  return H5Lexists(file, name.c_str(), access) > 0;
}

std::string elsewhere(Id create) {
  if (H5Pget_external_count(create) > 0) return "keeps its values in another file (external storage)";
  if (H5Pget_layout(create) == H5D_VIRTUAL) return "is put together from other datasets (a virtual dataset)";
  return {};
}

std::string overclaim(unsigned long long bytes, unsigned long long file_bytes) {
  if (bytes <= kSmallValues || bytes / kMostTimes <= file_bytes) return {};
  return "unpacks to " + human_bytes(static_cast<double>(bytes)) + ", more than " + std::to_string(kMostTimes) +
         " times the " + human_bytes(static_cast<double>(file_bytes)) + " of the whole file";
}

}  // namespace suite::h5
