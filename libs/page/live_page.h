// A page that shows numbers by itself: style, scripts and data in one HTML file, which asks nobody for anything (its
// content security policy forbids it to) and opens from a disk without a server. The scripts stand in libs/page/live.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "base/json.h"
#include "page/packed.h"

namespace suite {

// How the numbers of a block are stored. half: IEEE 754 binary16, times 2^first. log8: one byte, 0 = NaN, 1 = zero,
// otherwise first * second^(byte - 2). u8, u32 and f32: as they are. All little-endian.
enum class LiveKind { half, log8, u8, u32, f32 };

// Written from first to last, so that a page larger than one wants in memory can be made, and a browser can draw before
// it has read all: what stands before begin() is there when the scripts start.
class LivePage {
 public:
  // path: of the HTML file, which appears on commit(). scripts: names in libs/page/live, run in this order after
  // "live.js" and "steps.js". about: what the scripts find as `about`. Error: folder missing or not writable, path an
  // input of the run.
  LivePage(const std::string& path, const std::string& title, const std::vector<std::string>& scripts,
           const Json& about);
  // A block of numbers, as base64. id: letters, digits and dots, each once.
  void data(const std::string& id, LiveKind kind, std::span<const std::byte> bytes, double first = 0,
            double second = 0);
  // The same of codes (packed.h, kind half or log8), in as few bytes as steps.h makes of them. base: the id of a block
  // that stands before, with the codes of it.
  struct Base {
    std::string id;
    std::span<const uint16_t> codes;
  };
  void steps(const std::string& id, LiveKind kind, const Packed& packed, const std::optional<Base>& base);
  // A JSON value, which scripts find by its id.
  void json(const std::string& id, const Json& value);
  // Calls begin() of the last script; a page calls it once.
  void begin();
  // Calls ready() of the last script, when all blocks are there, and ends the page.
  void commit();

 private:
  void block(const std::string& id, const std::string& attributes, std::span<const std::byte> bytes);

  AtomicFile file_;
};

// Bytes of a page without its blocks, and at most of what stands around the numbers of a block.
size_t live_page_size(const std::vector<std::string>& scripts, const Json& about);
inline constexpr size_t kLiveBlock = 160;

// The same bytes as base64 (RFC 4648, section 4), padded.
std::string base64(std::span<const std::byte> bytes);

}  // namespace suite
