// ENVI images: a raw cube `name.img` beside a text header `name.img.hdr`. Grammar, units and an example: FORMAT.md.
//
// Values pass as double in the order [line][sample][band], whatever the type and interleave of the file, so that a
// caller never sees either. Headers of others are read as they are; what is written is always little-endian.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace suite {

// Numbers as the header's "data type" has them. Complex types (6, 9) are refused.
enum class EnviType {
  uint8 = 1,
  int16 = 2,
  int32 = 3,
  float32 = 4,
  float64 = 5,
  uint16 = 12,
  uint32 = 13,
  int64 = 14,
  uint64 = 15
};
size_t size_of(EnviType type);  // bytes of one value
enum class Interleave { bsq, bil, bip };

// What a whole number of a classification means, and the colour it is shown in.
struct EnviClass {
  std::string name;
  std::array<uint8_t, 3> rgb{};
  bool operator==(const EnviClass&) const = default;
};

struct EnviHeader {
  size_t samples = 0, lines = 0, bands = 0;  // each 1 .. 2^31 - 1
  EnviType type = EnviType::float32;
  Interleave interleave = Interleave::bsq;
  bool big_endian = false;                                 // as read; writing is little-endian
  size_t header_offset = 0;                                // bytes before the data, as read; writing has none
  std::string description;                                 // free text
  std::vector<std::string> band_names;                     // empty or one per band
  std::vector<double> wavelength_um, fwhm_um;              // empty or one per band, micron
  std::string data_units;                                  // "W/(m2 sr um)"; empty = the header does not say
  std::vector<std::string> map_info;                       // the list of "map info", as written
  std::string coordinate_system;                           // WKT
  std::optional<double> ignore_value;                      // marks "no data"
  std::vector<int> default_bands;                          // 1-based, one or three
  std::vector<EnviClass> classes;                          // of the values 0, 1, ...; not empty = "ENVI Classification"
  std::string acquisition_time;                            // UTC, ISO 8601 with a Z when written here
  std::optional<double> sun_azimuth_deg;                   // compass: clockwise from north
  std::optional<double> sun_elevation_deg;                 // above the horizon
  std::vector<std::pair<std::string, std::string>> extra;  // any other key and its text, in file order

  size_t values() const { return samples * lines * bands; }
};

// Header of an image. path: the image (its header is `path.hdr` or path with its extension replaced by .hdr) or the
// header itself. Error, with file:line:column where there is one: missing file, not ENVI, missing, duplicate or
// malformed key, list of a wrong length, unknown type, interleave or wavelength unit, sizes beyond 2^31 - 1.
EnviHeader read_envi_header(const std::string& path);
// The same from text; file_name is for messages.
EnviHeader parse_envi_header(std::string_view text, const std::string& file_name);

// What the stored numbers stand for, as keys among the others say: stored * gain + offset, and whether a band is any
// good ("data gain values", "data offset values", "reflectance scale factor", "bbl").
struct EnviNumbers {
  std::vector<double> gain, offset;  // empty or one per band
  std::vector<bool> bad;             // empty or one per band
};
// file: for messages. Error: lists of a wrong length, not numbers, a gain of 0, both gains and a factor.
EnviNumbers numbers_of(const EnviHeader& header, const std::string& file);

// An image opened for reading. The constructor checks that the file has exactly
// header_offset + samples * lines * bands * size_of(type) bytes; Error otherwise.
class EnviImage {
 public:
  explicit EnviImage(const std::string& path);
  ~EnviImage();
  const EnviHeader& header() const { return header_; }
  // Error unless "data units" is exactly `units`: a missing or foreign unit is never guessed.
  void require_units(const std::string& units) const;
  // Values [line][sample][band] of lines first .. first + count - 1; the range must lie inside the image.
  std::vector<double> read_lines(size_t first, size_t count) const;
  std::vector<double> read_all() const { return read_lines(0, header_.lines); }

 private:
  struct Impl;
  EnviHeader header_;
  std::unique_ptr<Impl> impl_;
};

// Writes the pair `path`, `path.hdr` line by line; both appear on commit(), or neither does. An image of that name that
// was there before is replaced; at no moment does a header stand beside an image it does not describe.
// Error: header inconsistent (list lengths, sizes), folder missing or not writable, disk full.
// The description gets the version of the suite and the command line of this process appended.
class EnviWriter {
 public:
  EnviWriter(const std::string& path, EnviHeader header);
  ~EnviWriter();
  // rows: [line][sample][band], a whole number of lines that follow those written so far. Error when a value does not
  // fit an integer type; floating types take everything, NaN included.
  void append(std::span<const double> rows);
  // What is told by the header alone may be completed until commit(); sizes, type and interleave stay as they are.
  EnviHeader& header();
  void commit();  // Error unless all lines were appended

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The whole cube at once; values: [line][sample][band].
void write_envi(const std::string& path, const EnviHeader& header, std::span<const double> values);

}  // namespace suite
