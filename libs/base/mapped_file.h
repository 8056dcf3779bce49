// Files as memory: a file that is there, and a file without a name for what is too large to be held.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace suite {

// A regular file, mapped for reading: its pages are those of the system's cache, so processes that map the same file
// hold it once, and pages that are let go come back by themselves. The size is that of when it was opened; a file that
// somebody cuts afterwards ends the program (SIGBUS) where its missing end is touched.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path);  // Error as for read_bytes, or when it cannot be mapped
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  const std::byte* data() const { return data_; }
  size_t size() const { return size_; }  // bytes of the file
  // Bytes that may be read: up to the end of the last page, where what is beyond the file reads as zero.
  size_t readable() const { return readable_; }

 private:
  const std::byte* data_ = nullptr;
  size_t size_ = 0, readable_ = 0;
};

// A file without a name: it goes with the last process that has it open, however that ends. Several processes of one
// machine may share it.
class SpillFile {
 public:
  // Takes no room yet. folder: empty = TMPDIR, or /tmp without it. Error when nothing can be written there.
  explicit SpillFile(std::string folder = {});
  // The one that another process of this machine has open; null when this process cannot get at it.
  static std::shared_ptr<SpillFile> open(const std::string& address);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;
  std::string address() const;  // for open()

  // Takes `bytes` of the disk; where they begin: a whole number of pages, and the same in all processes that reserve
  // the same in the same order. What nobody wrote reads as zero. Error when the disk has no room for them.
  size_t reserve(size_t bytes);
  void write_at(size_t offset, std::span<const std::byte> bytes);  // Error; from many threads
  // Reserved bytes as memory; offset: a whole number of pages. What any process writes is seen by all.
  std::shared_ptr<const std::byte> map(size_t offset, size_t bytes) const;
  std::shared_ptr<std::byte> map_writable(size_t offset, size_t bytes) const;

 private:
  SpillFile(int descriptor, std::string folder) : descriptor_(descriptor), folder_(std::move(folder)) {}
  int descriptor_ = -1;
  std::string folder_;  // for messages
  size_t end_ = 0;
};

// Gives the pages around `bytes` bytes of a mapped file back to the system; they come back when they are touched.
void let_go(const void* data, size_t bytes);

}  // namespace suite
