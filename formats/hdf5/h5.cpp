#include "formats/hdf5/h5.h"

#include <hdf5.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/files.h"
#include "base/interrupt.h"
#include "base/memory.h"
#include "base/progress.h"
#include "formats/hdf5/own_values.h"
#include "formats/hdf5/silence.h"

namespace suite::h5 {

static_assert(std::is_same_v<Id, hid_t> && std::is_same_v<int, herr_t>);

template <>
Id native<uint8_t>() {
  return H5T_STD_U8LE;
}
template <>
Id native<std::byte>() {
  return H5T_STD_U8LE;
}
template <>
Id native<uint16_t>() {
  return H5T_STD_U16LE;
}
template <>
Id native<uint32_t>() {
  return H5T_STD_U32LE;
}
template <>
Id native<uint64_t>() {
  return H5T_STD_U64LE;
}
template <>
Id native<float>() {
  return H5T_IEEE_F32LE;
}
template <>
Id native<double>() {
  return H5T_IEEE_F64LE;
}

void silence() {
  static const herr_t no_work_at_exit = H5dont_atexit();  // before anything else of the library
  (void)no_work_at_exit;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  // Lists of free pieces by size would hold some MiB in programs that open thousands of files; what is free goes back.
  H5set_free_list_limits(0, 0, 0, 0, 0, 0);
}

namespace {

constexpr size_t kMaxText = 1 << 20;
constexpr size_t kChunkBytes = 512 << 10;  // packed in one piece: fits the library's cache, large enough to pack well
constexpr size_t kSmall = 4096;            // below this packing gains nothing
constexpr hsize_t kBestRatio = 1040;       // deflate packs no better

Handle file_access() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // The newest layout of 1.10 puts a checksum on every piece of metadata, so damage is noticed and not followed.
  H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
  H5Pset_file_locking(access, false, true);
  // Plain values can be used where they lie when the file is mapped.
  constexpr hsize_t kAll = 1, kWidest = 8;  // bytes
  H5Pset_alignment(access, kAll, kWidest);
  return access;
}

Handle text_type(size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, length ? length : 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

bool put_text(hid_t object, const std::string& name, const std::string& text) {
  const Handle type = text_type(text.size()), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle a(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const std::string padded = text.empty() ? std::string(1, '\0') : text;
  return a >= 0 && H5Awrite(a, type, padded.data()) >= 0;
}

bool get_text(hid_t object, const std::string& name, std::string& text) {
  if (H5Aexists(object, name.c_str()) <= 0) return false;
  const Handle a(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (a < 0) return false;
  const Handle type(H5Aget_type(a), H5Tclose), space(H5Aget_space(a), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0 || H5Sget_simple_extent_npoints(space) != 1)
    return false;
  const size_t size = H5Tget_size(type);
  if (size == 0 || size > kMaxText) return false;
  text.assign(size, '\0');
  if (H5Aread(a, text_type(size), text.data()) < 0) return false;
  text.resize(strnlen(text.data(), size));
  return true;
}

}  // namespace

// --- Writer ---------------------------------------------------------------------------------------------------------

// What the library still holds back it writes when the file is closed, and keeps the file when that is refused. So the
// rest goes to a file in memory, which nobody sees.
void Writer::give_up() const {
  void* descriptor = nullptr;
  if (file_ < 0 || H5Fget_vfd_handle(file_, H5P_DEFAULT, &descriptor) < 0 || !descriptor) return;
  const int nowhere = ::memfd_create("given up", MFD_CLOEXEC);
  if (nowhere < 0) return;
  ::dup2(nowhere, *static_cast<int*>(descriptor));
  ::close(nowhere);
}

void Writer::fail(const std::string& what) const {
  const int cause = errno;
  give_up();
  const size_t slash = path_.rfind('/'),
               room = free_bytes(slash == std::string::npos ? "." : path_.substr(0, slash + 1));
  const bool by_system = cause == ENOSPC || cause == EFBIG || cause == EDQUOT || cause == EIO;
  throw Error(Where{path_, 0, 0, {}, -1},
              "cannot be written: " + what + (by_system ? strf(": %s", std::strerror(cause)) : ""),
              "is the disk full? " + human_bytes(static_cast<double>(room)) + " are free there");
}

Writer::Writer(const std::string& temporary, const std::string& path, PackLevel level)
    : path_(path), level_(std::move(level)) {
  silence();
  const Handle create(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(create, false);
  const CreatingFile creating;
  file_ = Handle(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, create, file_access()), H5Fclose);
  if (file_ < 0) fail("HDF5 refuses to create it");
}

// Groups made on the way by the library would carry times.
void Writer::make_groups(const std::string& name) {
  const Handle create(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(create, false);
  for (size_t at = name.find('/', 1); at != std::string::npos; at = name.find('/', at + 1)) {
    const std::string group = name.substr(0, at);
    if (H5Lexists(file_, group.c_str(), H5P_DEFAULT) > 0) continue;
    const Handle made(H5Gcreate2(file_, group.c_str(), H5P_DEFAULT, create, H5P_DEFAULT), H5Gclose);
    if (made < 0) fail("group '" + group + "'");
  }
}

Handle Writer::make(const std::string& name, hid_t type, size_t count, size_t width, const char* units) {
  make_groups(name);
  const Handle create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(create, false);
  const hsize_t dims[2] = {count / width, width};
  const size_t row = width * H5Tget_size(type);
  if (const int level = level_ ? level_(name) : 0; level > 0 && dims[0] * row >= kSmall) {
    const hsize_t chunk[2] = {std::clamp<hsize_t>(kChunkBytes / row, 1, dims[0]), width};
    H5Pset_chunk(create, width == 1 ? 1 : 2, chunk);
    H5Pset_shuffle(create);
    H5Pset_deflate(create, static_cast<unsigned>(level));
    H5Pset_fill_time(create, H5D_FILL_TIME_ALLOC);  // what the last chunk holds beyond the end would be chance
  } else {
    H5Pset_alloc_time(create, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(create, H5D_FILL_TIME_NEVER);
  }
  const Handle space(H5Screate_simple(width == 1 ? 1 : 2, dims, nullptr), H5Sclose);
  Handle dataset(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, create, H5P_DEFAULT), H5Dclose);
  if (dataset < 0 || !put_text(dataset, "units", units)) fail("dataset '" + name + "'");
  return dataset;
}

void Writer::write(const std::string& name, hid_t type, const void* data, size_t count, size_t width,
                   const char* units) {
  const Handle dataset = make(name, type, count, width, units);
  if (count && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) fail("dataset '" + name + "'");
}

void Writer::put_names(const std::string& name, const std::vector<std::string>& names) {
  // Null-terminated, the longest too: netCDF's library reads on until a zero byte.
  size_t longest = 1;
  for (const std::string& n : names) longest = std::max(longest, n.size() + 1);
  std::string all(longest * names.size(), '\0');
  for (size_t i = 0; i < names.size(); ++i)
    std::copy(names[i].begin(), names[i].end(), all.begin() + static_cast<std::ptrdiff_t>(i * longest));
  const Handle type = text_type(longest);
  write(name, type, all.data(), names.size(), 1, "");
}

Writer::Column Writer::column(const std::string& name, hid_t type, size_t total, const char* units) {
  Column c;
  c.writer_ = this;
  c.dataset_ = make(name, type, total, 1, units);
  c.space_ = Handle(H5Dget_space(c.dataset_), H5Sclose);
  return c;
}

void Writer::Column::write(hid_t type, const void* data, size_t count) {
  if (!count) return;
  const hsize_t n = count, start = at_;
  const Handle memory(H5Screate_simple(1, &n, nullptr), H5Sclose);
  if (H5Sselect_hyperslab(space_, H5S_SELECT_SET, &start, nullptr, &n, nullptr) < 0 ||
      H5Dwrite(dataset_, type, memory, space_, H5P_DEFAULT, data) < 0)
    writer_->fail("a dataset");
  at_ += n;
}

void Writer::attribute(const std::string& name, const std::string& text) {
  if (!put_text(file_, name, text)) fail("attribute '" + name + "'");
}
void Writer::attribute(const std::string& name, std::span<const double> values) {
  const hsize_t n = values.size();
  const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose);
  const Handle a(H5Acreate2(file_, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (a < 0 || H5Awrite(a, H5T_IEEE_F64LE, values.data()) < 0) fail("attribute '" + name + "'");
}
void Writer::close() {
  if (H5Fflush(file_, H5F_SCOPE_LOCAL) < 0) fail("its last part");
  file_ = Handle();
}

// --- Reader ---------------------------------------------------------------------------------------------------------

void Reader::fail(const std::string& what) const { throw Error(Where{path_, 0, 0, {}, -1}, what, hint_); }

Reader::Reader(const std::string& path, std::string hint) : path_(path), hint_(std::move(hint)) {
  silence();
  input_size(path);
  // The signature and a checksummed superblock (version 3) are looked at here; older layouts are followed unchecked by
  // the library and none of ours.
  char head[9] = {};
  std::ifstream(path, std::ios::binary).read(head, sizeof head);
  static const unsigned char signature[9] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n', 3};
  if (std::memcmp(head, signature, 8) != 0) fail("is not an HDF5 file");
  if (std::memcmp(head, signature, 9) != 0) fail("is an HDF5 file of another kind");
  file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, file_access()), H5Fclose);
  if (file_ < 0) fail("is a damaged HDF5 file");
}

namespace {
// Shuffle and deflate in pieces of a size that is safe to ask memory for.
bool known_packing(hid_t create, int rank, size_t value_bytes) {
  hsize_t chunk[2] = {1, 1};
  if (H5Pget_chunk(create, rank, chunk) != rank || chunk[0] == 0 || chunk[1] == 0 || chunk[0] > 1 << 30 ||
      chunk[1] > 1 << 30 || chunk[0] * chunk[1] * value_bytes > (hsize_t{64} << 20) || H5Pget_nfilters(create) != 2)
    return false;
  constexpr H5Z_filter_t known[2] = {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE};
  for (unsigned k = 0; k < 2; ++k) {
    unsigned flags = 0, config = 0;
    size_t values = 0;
    if (H5Pget_filter2(create, k, &flags, &values, nullptr, 0, nullptr, &config) != known[k]) return false;
  }
  return true;
}
}  // namespace

bool Reader::has(const std::string& name) const {
  if (const std::string step = external_step(file_, name); !step.empty())
    fail("'" + step + "' is a link into another file, which is not followed");
  return linked(file_, name);
}

Reader::Opened Reader::open(const std::string& name, hid_t type, const char* units, size_t width, long long rows,
                            bool held) {
  if (!has(name)) fail("dataset '" + name + "' is missing");
  Opened d{Handle(H5Dopen2(file_, name.c_str(), within_the_file(H5P_DATASET_ACCESS)), H5Dclose), 0, false};
  if (d.dataset < 0) fail("dataset '" + name + "' cannot be opened");
  std::string unit;
  if (!get_text(d.dataset, "units", unit)) fail("dataset '" + name + "' has no units");
  if (unit != units) fail("dataset '" + name + "' is in '" + unit + "'");
  const Handle stored(H5Dget_type(d.dataset), H5Tclose), space(H5Dget_space(d.dataset), H5Sclose),
      create(H5Dget_create_plist(d.dataset), H5Pclose);
  if (type >= 0 && H5Tequal(stored, type) <= 0) fail("dataset '" + name + "' has another type");
  hsize_t dims[2] = {0, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank != (width == 1 ? 1 : 2)) fail("dataset '" + name + "' has another rank");
  H5Sget_simple_extent_dims(space, dims, nullptr);
  if (dims[1] != width || dims[0] > (hsize_t{1} << 40)) fail("dataset '" + name + "' has another shape");
  if (rows >= 0 && dims[0] != static_cast<hsize_t>(rows))
    fail("dataset '" + name +
         strf("' has %llu rows, %lld are declared", static_cast<unsigned long long>(dims[0]), rows));
  // What is declared must be there before memory is asked for.
  const hsize_t bytes = dims[0] * width * H5Tget_size(stored);
  d.packed = H5Pget_layout(create) == H5D_CHUNKED;
  if (const std::string wrong = elsewhere(create); !wrong.empty()) fail("dataset '" + name + "' " + wrong);
  if (d.packed && !known_packing(create, rank, H5Tget_size(stored))) fail("dataset '" + name + "' has another layout");
  const hsize_t there = H5Dget_storage_size(d.dataset), limit = file_size(path_);
  if (d.packed ? there > limit || bytes / kBestRatio > there : there != bytes || bytes > limit)
    fail("dataset '" + name + "' is not whole");
  if (const std::string wrong = d.packed ? overclaim(bytes, limit) : ""; !wrong.empty())
    fail("dataset '" + name + "' " + wrong);
  if (const double memory = available_memory(); held && d.packed && static_cast<double>(bytes) > 0.9 * memory)
    fail("dataset '" + name + "' unpacks to " + human_bytes(static_cast<double>(bytes)) + ", and " +
         human_bytes(memory) + " of memory are available");
  d.count = dims[0] * width;
  return d;
}

void Reader::read(const std::string& name, const Opened& d, hid_t type, void* out, size_t first, size_t count) {
  if (!count) return;
  note_read(name);
  herr_t status;
  if (first == 0 && count == d.count) {
    status = H5Dread(d.dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
  } else {
    const hsize_t start = first, n = count;
    const Handle space(H5Dget_space(d.dataset), H5Sclose), memory(H5Screate_simple(1, &n, nullptr), H5Sclose);
    status = H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, nullptr, &n, nullptr);
    if (status >= 0) status = H5Dread(d.dataset, type, memory, space, H5P_DEFAULT, out);
  }
  if (status < 0) fail("dataset '" + name + "' cannot be read");
}

void Reader::read_strided(const std::string& name, const Opened& d, hid_t type, void* out, size_t first, size_t blocks,
                          size_t stride, size_t run) {
  if (!blocks || !run) return;
  SUITE_CHECK(run <= stride && first + (blocks - 1) * stride + run <= d.count);
  note_read(name);
  const hsize_t start = first, step = stride, count = blocks, block = run, all = blocks * run;
  const Handle space(H5Dget_space(d.dataset), H5Sclose), memory(H5Screate_simple(1, &all, nullptr), H5Sclose);
  if (H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, &step, &count, &block) < 0 ||
      H5Dread(d.dataset, type, memory, space, H5P_DEFAULT, out) < 0)
    fail("dataset '" + name + "' cannot be read");
}

uint64_t Reader::file_offset(const std::string& name, const Opened& d) const {
  if (d.count == 0) return 0;
  if (d.packed) fail("dataset '" + name + "' is packed");
  const haddr_t at = H5Dget_offset(d.dataset);
  if (at == HADDR_UNDEF || at > file_size(path_) || H5Dget_storage_size(d.dataset) > file_size(path_) - at)
    fail("dataset '" + name + "' is not whole");
  return at;
}

std::vector<std::string> Reader::get_names(const std::string& name, long long rows) {
  const Opened d = open(name, -1, "", 1, rows);
  const Handle type(H5Dget_type(d.dataset), H5Tclose);
  const size_t size = H5Tget_size(type);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0 || size == 0 || size > kMaxText + 1)
    fail("dataset '" + name + "' holds no names");
  std::string all(size * d.count, '\0');
  read(name, d, text_type(size), all.data(), 0, d.count);
  std::vector<std::string> names;
  for (size_t i = 0; i < d.count; ++i) names.emplace_back(all.data() + i * size, strnlen(all.data() + i * size, size));
  return names;
}

std::string Reader::text(const std::string& attribute) const {
  std::string value;
  if (!get_text(file_, attribute, value)) fail("attribute '" + attribute + "' is missing");
  return value;
}

std::vector<double> Reader::numbers(const std::string& attribute, size_t count) const {
  std::vector<double> values(count);
  if (H5Aexists(file_, attribute.c_str()) <= 0) fail("attribute '" + attribute + "' is missing");
  const Handle a(H5Aopen(file_, attribute.c_str(), H5P_DEFAULT), H5Aclose),
      space(a >= 0 ? H5Aget_space(a) : -1, H5Sclose);
  if (a < 0 || H5Sget_simple_extent_npoints(space) != static_cast<hssize_t>(count) ||
      H5Aread(a, H5T_NATIVE_DOUBLE, values.data()) < 0)
    fail("attribute '" + attribute + "' cannot be read");
  return values;
}

}  // namespace suite::h5
