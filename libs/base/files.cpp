#include "base/files.h"

#include <fcntl.h>
#include <openssl/sha.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "base/inputs.h"
#include "base/interrupt.h"
#include "base/progress.h"

namespace suite {

namespace {

struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

[[noreturn]] void fail(const std::string& path, const std::string& what, const std::string& hint = {}) {
  throw Error(Where{path, 0, 0, {}, -1}, what, hint);
}

// What was read must not be replaced, under whichever name.
void refuse_input(const std::string& path) {
  if (const std::string input = input_at(path); !input.empty())
    fail(path, "would replace an input of this run" + (input == path ? std::string() : ", read as '" + input + "'"),
         "give the output another name");
}

size_t checked_size(int fd, const std::string& path) {
  struct stat info {};
  if (::fstat(fd, &info) != 0) fail(path, strf("cannot be examined: %s", std::strerror(errno)));
  if (S_ISDIR(info.st_mode)) fail(path, "is a directory", "name a file");
  if (!S_ISREG(info.st_mode)) fail(path, "is not a regular file", "name a file");
  return static_cast<size_t>(info.st_size);
}

int open_checked(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0 && errno == ENOENT)
    fail(path, "no such file", "check the name; a name in a text is relative to the folder of that text");
  if (fd < 0) fail(path, strf("cannot be opened: %s", std::strerror(errno)));
  return fd;
}

template <class Container>
Container read_all(const std::string& path, size_t max_bytes) {
  const Descriptor d{open_checked(path)};
  const size_t size = checked_size(d.fd, path);
  note_input(path);
  if (size > max_bytes) fail(path, strf("has %zu bytes, at most %zu are accepted here", size, max_bytes));
  Container data;
  data.resize(size);
  size_t got = 0;
  while (got < size) {
    const ssize_t n = ::read(d.fd, data.data() + got, size - got);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, strf("cannot be read: %s", std::strerror(errno)));
    if (n == 0) fail(path, "became shorter while it was read");
    got += static_cast<size_t>(n);
  }
  return data;
}

}  // namespace

std::vector<std::byte> read_bytes(const std::string& path, size_t max_bytes) {
  return read_all<std::vector<std::byte>>(path, max_bytes);
}
std::string read_text(const std::string& path, size_t max_bytes) {
  std::string text = read_all<std::string>(path, max_bytes);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

size_t file_size(const std::string& path) {
  const Descriptor d{open_checked(path)};
  return checked_size(d.fd, path);
}

size_t input_size(const std::string& path) {
  const size_t bytes = file_size(path);
  note_input(path);
  return bytes;
}

bool file_exists(const std::string& path) {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode);
}

RandomAccessFile::RandomAccessFile(std::string path) : path_(std::move(path)) {
  Descriptor d{open_checked(path_)};
  size_ = checked_size(d.fd, path_);
  note_input(path_);
  std::swap(descriptor_, d.fd);
}

RandomAccessFile::~RandomAccessFile() { ::close(descriptor_); }

void RandomAccessFile::read_at(size_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t n = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path_, strf("cannot be read: %s", std::strerror(errno)));
    if (n == 0)
      throw Error(Where{path_, 0, 0, {}, static_cast<long long>(offset)},
                  strf("ends %zu bytes too early", bytes.size()));
    offset += static_cast<size_t>(n);
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  static std::atomic<unsigned> counter{0};
  struct stat info {};
  if (::stat(path_.c_str(), &info) == 0 && S_ISDIR(info.st_mode)) fail(path_, "is a directory", "name an output file");
  refuse_input(path_);
  temporary_ = path_ + strf(".part-%d-%u", static_cast<int>(::getpid()), counter++);
  guard_ = std::make_unique<Temporary>(temporary_.c_str());
  const CreatingFile creating;
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    fail(path_, strf("cannot be written: %s", std::strerror(errno)), "the folder must exist and be writable");
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!done_) ::unlink(temporary_.c_str());
}

void AtomicFile::reserve(size_t bytes, size_t offset) {
  int status;
  do status = ::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(offset), static_cast<off_t>(bytes));
  while (status != 0 && errno == EINTR);
  if (status != 0 && (errno == ENOSPC || errno == EFBIG || errno == EDQUOT))
    fail(path_,
         strf("cannot be written: %s: it takes %s", std::strerror(errno),
              human_bytes(static_cast<double>(bytes)).c_str()),
         "make room, or write elsewhere");
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path_, strf("cannot be written: %s", std::strerror(errno)));
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
}
void AtomicFile::write(std::string_view text) { write(std::as_bytes(std::span(text.data(), text.size()))); }

void AtomicFile::write_at(size_t offset, std::span<const std::byte> bytes) {
  write_all_at(descriptor_, offset, bytes, path_);
}

void AtomicFile::close() {
  if (descriptor_ < 0) return;
  const int fd = descriptor_;
  descriptor_ = -1;
  if (::close(fd) != 0) fail(path_, strf("cannot be written: %s", std::strerror(errno)));
}

void AtomicFile::commit() {
  close();
  refuse_input(path_);  // it may have been read since
  if (::rename(temporary_.c_str(), path_.c_str()) != 0)
    fail(path_, strf("cannot be replaced: %s", std::strerror(errno)));
  done_ = true;
}

void write_all_at(int descriptor, size_t offset, std::span<const std::byte> bytes, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, strf("cannot be written: %s", std::strerror(errno)));
    offset += static_cast<size_t>(n);
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
}

void write_file(const std::string& path, std::span<const std::byte> bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}
void write_file(const std::string& path, std::string_view text) {
  write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

size_t free_bytes(const std::string& folder) {
  struct statvfs info {};
  if (::statvfs(folder.c_str(), &info) != 0 || info.f_blocks == 0) return std::numeric_limits<size_t>::max();
  return static_cast<size_t>(info.f_bavail) * info.f_frsize;
}

void make_folder(const std::string& path) {
  std::error_code code;
  std::filesystem::create_directories(path, code);
  if (code || !std::filesystem::is_directory(path, code))
    fail(path, "folder cannot be made" + (code ? ": " + code.message() : std::string()), "name a writable place");
  if (::access(path.c_str(), W_OK | X_OK) != 0) fail(path, "folder is not writable", "name a writable place");
}

std::string resolve_path(const std::string& from, const std::string& name) {
  const std::filesystem::path p(name);
  if (p.is_absolute()) return name;
  return (std::filesystem::path(from).parent_path() / p).lexically_normal().string();
}

std::string sha256(std::span<const std::byte> bytes) {
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest);
  std::string hex;
  for (unsigned char c : digest) hex += strf("%02x", c);
  return hex;
}
std::string sha256(std::string_view text) { return sha256(std::as_bytes(std::span(text.data(), text.size()))); }

}  // namespace suite
