// Impulse responses of laser pulses in a file (HDF5): written and read block by block. See FORMAT.md.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "detection/response.h"

namespace suite {

class ResponseWriter : public ResponseSink {
 public:
  // made_by: the command line. block_entries: entries kept in memory before they are written. Error: not writable.
  ResponseWriter(const std::string& path, const ResponseHead& head, const std::string& made_by,
                 size_t block_entries = size_t{1} << 20);
  ~ResponseWriter() override;
  // The pulses that follow those before. Error: not writable, the disk is full.
  void take(ResponseBlock&& block) override;
  void finish();  // the file is there from now on, whole
  // In place of finish(): what was taken so far is left under another name. identity: of what was asked for, to be
  // known again (ResponseReader::unfinished).
  void leave(const std::string& path, const std::string& identity);

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

class ResponseReader {
 public:
  // Error, naming the file: none, damaged, of another kind or version.
  explicit ResponseReader(const std::string& path);
  ~ResponseReader();
  const ResponseHead& head() const;
  uint64_t pulses() const;
  size_t blocks() const;
  // Of a file that leave() has written: the identity that it was given. Nothing: it is whole.
  std::optional<std::string> unfinished() const;
  // Error: damaged, or values that cannot be (named with pulse and pixel).
  ResponseBlock block(size_t number) const;
  void for_each_block(const std::function<void(const ResponseBlock&)>& visit) const;

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace suite
