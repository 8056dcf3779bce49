// What OpenImageIO is asked for. It pulls in some 250 libraries, which take longer to load than a small job to run, so
// its calls are a part of their own (images_part.cpp), loaded at the first image. Internal to formats/raster.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace suite {

struct ImageFacts {
  int width = 0, height = 0, depth = 0, channels = 0;  // as declared
  size_t sample_bytes = 0;                             // of one stored number
  bool plain = false;                                  // stored without compression
  bool integer = false;
  double scale = 0;  // what a stored number that is read as 1 stands for; 0: of a type that cannot be read
  std::string type;
};

struct ImageRead {
  bool opened = false;
  std::string problem;  // empty = none
};

struct ImageAttribute {
  std::string name;
  std::variant<std::string, float> value;
};

// An image of floats to be written.
struct ImageToWrite {
  const char* format;  // of OpenImageIO
  int width = 0, height = 0;
  std::vector<std::string> channels;  // names
  std::vector<ImageAttribute> attributes;
};

// What the part `images` exports as suite_image_calls.
struct ImageCalls {
  // packed: the file's bytes, whose format the path's extension says; empty: they are in the file. room: called with
  // the facts filled in, tells where the values (row-major, channels together) go; may throw.
  ImageRead (*read)(const std::string& path, std::span<const std::byte> packed, ImageFacts& facts,
                    const std::function<float*()>& room);
  // row: the values of a row, valid until the next call. bytes: the file. Returns what went wrong; empty = nothing.
  std::string (*write)(const ImageToWrite& image, const std::function<const float*(int)>& row,
                       std::vector<unsigned char>& bytes);
};

// Error: as late_symbol.
const ImageCalls& image_calls();

}  // namespace suite
