#include "base/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "base/error.h"
#include "base/files.h"
#include "base/progress.h"

namespace suite {

namespace {

size_t page() {
  static const auto bytes = static_cast<size_t>(::sysconf(_SC_PAGESIZE));
  return bytes;
}
size_t whole_pages(size_t bytes) { return (bytes + page() - 1) / page() * page(); }

[[noreturn]] void fail_mapping(const std::string& path, const std::string& what, const std::string& hint = {}) {
  throw Error(Where{path, 0, 0, {}, -1}, what, hint);
}

std::byte* mapped(int descriptor, size_t offset, size_t bytes, int protection, const std::string& path) {
  void* at = ::mmap(nullptr, bytes, protection, MAP_SHARED, descriptor, static_cast<off_t>(offset));
  if (at == MAP_FAILED) fail_mapping(path, strf("cannot be mapped: %s", std::strerror(errno)));
  return static_cast<std::byte*>(at);
}

std::string temporary_folder() {
  const char* named = std::getenv("TMPDIR");
  return named && *named ? named : "/tmp";
}

// Without a name from the beginning; where the file system has no such files, without one a moment later.
int nameless(const std::string& folder) {
  if (const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600); fd >= 0) return fd;
  std::string name = folder + "/suite-spill-XXXXXX";
  const int fd = ::mkostemp(name.data(), O_CLOEXEC);
  if (fd < 0)
    fail_mapping(folder, strf("no file can be made there: %s", std::strerror(errno)),
                 "set TMPDIR to a folder with room");
  ::unlink(name.c_str());
  return fd;
}

}  // namespace

MappedFile::MappedFile(const std::string& path) {
  const RandomAccessFile file(path);
  size_ = file.size();
  if (size_ == 0) return;
  readable_ = whole_pages(size_);
  data_ = mapped(file.descriptor(), 0, size_, PROT_READ, path);
}

MappedFile::~MappedFile() {
  if (data_) ::munmap(const_cast<std::byte*>(data_), readable_);
}

SpillFile::SpillFile(std::string folder) : folder_(folder.empty() ? temporary_folder() : std::move(folder)) {
  descriptor_ = nameless(folder_);
}

// Through the other process's table of open files, for the file has no name. Where processes are numbered apart,
// another one may have that number, so the file itself is told, too.
std::string SpillFile::address() const {
  struct stat info {};
  if (::fstat(descriptor_, &info) != 0) fail_mapping(folder_, strf("cannot be examined: %s", std::strerror(errno)));
  return strf("%llx.%llx /proc/%d/fd/%d", static_cast<unsigned long long>(info.st_dev),
              static_cast<unsigned long long>(info.st_ino), static_cast<int>(::getpid()), descriptor_);
}

std::shared_ptr<SpillFile> SpillFile::open(const std::string& address) {
  const size_t space = address.find(' ');
  if (space == std::string::npos) return nullptr;
  const int fd = ::open(address.c_str() + space + 1, O_RDWR | O_CLOEXEC);
  if (fd < 0) return nullptr;
  auto file = std::shared_ptr<SpillFile>(new SpillFile(fd, temporary_folder()));
  const std::string here = file->address();
  if (here.compare(0, here.find(' '), address, 0, space) != 0) return nullptr;
  return file;
}

SpillFile::~SpillFile() { ::close(descriptor_); }

size_t SpillFile::reserve(size_t bytes) {
  const size_t begin = end_, room = free_bytes(folder_);
  const auto none = [&](const char* why) {
    fail_mapping(folder_,
                 human_bytes(static_cast<double>(bytes)) + " are needed there, and " +
                     human_bytes(static_cast<double>(room)) + " are free" + why,
                 "set TMPDIR to a folder with room");
  };
  struct stat info {};
  if (::fstat(descriptor_, &info) != 0) fail_mapping(folder_, strf("cannot be examined: %s", std::strerror(errno)));
  end_ += whole_pages(bytes);
  // Another process may have taken it already.
  if (static_cast<size_t>(info.st_size) >= end_) return begin;
  if (bytes > room) none("");
  int code = 0;
  do {
    code = ::fallocate(descriptor_, 0, static_cast<off_t>(begin), static_cast<off_t>(end_ - begin)) == 0 ? 0 : errno;
  } while (code == EINTR);
  if (code == EOPNOTSUPP && ::ftruncate(descriptor_, static_cast<off_t>(end_)) == 0) code = 0;
  if (code) none(strf(": %s", std::strerror(code)).c_str());
  return begin;
}

void SpillFile::write_at(size_t offset, std::span<const std::byte> bytes) {
  write_all_at(descriptor_, offset, bytes, folder_);
}

std::shared_ptr<const std::byte> SpillFile::map(size_t offset, size_t bytes) const {
  std::byte* at = mapped(descriptor_, offset, bytes, PROT_READ, folder_);
  return {at, [bytes](const std::byte* p) { ::munmap(const_cast<std::byte*>(p), bytes); }};
}

std::shared_ptr<std::byte> SpillFile::map_writable(size_t offset, size_t bytes) const {
  std::byte* at = mapped(descriptor_, offset, bytes, PROT_READ | PROT_WRITE, folder_);
  return {at, [bytes](std::byte* p) { ::munmap(p, bytes); }};
}

void let_go(const void* data, size_t bytes) {
  if (bytes == 0) return;
  const uintptr_t begin = reinterpret_cast<uintptr_t>(data) / page() * page();
  // Advice: pages that stay cost memory and nothing else.
  (void)::madvise(reinterpret_cast<void*>(begin), whole_pages(reinterpret_cast<uintptr_t>(data) + bytes - begin),
                  MADV_DONTNEED);
}

}  // namespace suite
