// Whole files in and out. Reading checks what the path is before it allocates; writing goes to a sibling that is
// renamed when complete, so that a file is there whole or not at all.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace suite {

class Temporary;

// Bytes of a regular file. Error: missing, a directory, unreadable, or larger than max_bytes.
std::vector<std::byte> read_bytes(const std::string& path, size_t max_bytes = size_t{8} << 30);
// The same as text, without the byte order mark of UTF-8 that some editors and spreadsheets begin a file with.
std::string read_text(const std::string& path, size_t max_bytes = size_t{1} << 30);
size_t file_size(const std::string& path);  // same Errors
// The size of a file that another library opens next; notes it as an input (inputs.h). Same Errors.
size_t input_size(const std::string& path);
bool file_exists(const std::string& path);

// A regular file opened for reading in pieces; for files larger than what one wants in memory.
class RandomAccessFile {
 public:
  explicit RandomAccessFile(std::string path);  // Error as for read_bytes
  ~RandomAccessFile();
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;
  size_t size() const { return size_; }                           // bytes, when it was opened
  void read_at(size_t offset, std::span<std::byte> bytes) const;  // Error past the end; callable from many threads
  int descriptor() const { return descriptor_; }                  // for what needs the system's own calls

 private:
  std::string path_;
  int descriptor_ = -1;
  size_t size_ = 0;
};

// Reserves `path`: data goes to a temporary sibling until commit(). Destroyed without commit, it leaves nothing behind.
class AtomicFile {
 public:
  // Error when the folder is missing or not writable, path is a directory or an input of this run (inputs.h).
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  const std::string& temporary() const { return temporary_; }  // write here (any library), then commit()
  // Takes `bytes` bytes of the disk for what will be written from `offset` on. Error when they are not there.
  void reserve(size_t bytes, size_t offset = 0);
  void write(std::span<const std::byte> bytes);  // append
  void write(std::string_view text);
  void write_at(size_t offset,
                std::span<const std::byte> bytes);  // anywhere; gaps read as zero; leaves the end of write() alone
  void close();                                     // flush without renaming; Error when the disk is full
  void commit();                                    // close(), rename

 private:
  std::string path_, temporary_;
  std::unique_ptr<Temporary> guard_;  // it vanishes also when a signal ends the program
  int descriptor_ = -1;
  bool done_ = false;
};

void write_file(const std::string& path, std::span<const std::byte> bytes);
// All of the bytes at a place of an open file; Error naming `path`. From many threads.
void write_all_at(int descriptor, size_t offset, std::span<const std::byte> bytes, const std::string& path);
void write_file(const std::string& path, std::string_view text);

// Bytes that may still be written to the file system of `folder`; the largest number when it does not tell.
size_t free_bytes(const std::string& folder);

// Creates a folder (and parents). Error when that fails or a file stands there.
void make_folder(const std::string& path);

// `name` as written in the file `from`: absolute names stay, others are relative to the folder of `from`.
std::string resolve_path(const std::string& from, const std::string& name);

// SHA-256 in lower-case hexadecimal.
std::string sha256(std::span<const std::byte> bytes);
std::string sha256(std::string_view text);

}  // namespace suite
