// Based on: ISO/IEC 15948, Portable Network Graphics (PNG), 2004: chunks sRGB and tEXt ("Description").
#include <png.h>

#include "base/error.h"
#include "base/files.h"
#include "formats/picture/picture.h"

namespace suite {

namespace {

void keep_problem(png_structp png, png_const_charp text) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = text;
  png_longjmp(png, 1);
}
void ignore(png_structp, png_const_charp) {}
void append(png_structp png, png_bytep bytes, size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}
void nothing(png_structp) {}

// Whether all was written. libpng comes back by a jump where it fails, so nothing in here may have a destructor.
bool write_rows(png_structp png, png_infop info, std::string& file, uint32_t width, uint32_t height, const uint8_t* rgb,
                png_text* comment) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, &file, append, nothing);
  png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_ABSOLUTE);
  png_set_text(png, info, comment, 1);
  png_write_info(png, info);
  for (const uint8_t* row = rgb; row < rgb + size_t{3} * width * height; row += size_t{3} * width)
    png_write_row(png, row);
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

void write_png(const std::string& path, int width, int height, std::span<const uint8_t> rgb,
               const std::string& comment) {
  SUITE_CHECK_EQ(rgb.size(), size_t{3} * static_cast<size_t>(width) * static_cast<size_t>(height));
  std::string file, problem, key = "Description", text = comment;
  png_text described{};
  described.compression = PNG_TEXT_COMPRESSION_NONE;
  described.key = key.data();
  described.text = text.data();
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &problem, keep_problem, ignore);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  const bool fine = info && write_rows(png, info, file, static_cast<uint32_t>(width), static_cast<uint32_t>(height),
                                       rgb.data(), &described);
  png_destroy_write_struct(&png, &info);
  if (!fine) throw Error(Where{path, 0, 0, {}, -1}, "picture cannot be written: " + problem);
  write_file(path, file);
}

void write_png(const std::string& path, const Canvas& canvas, const std::string& comment) {
  static_assert(sizeof(Rgb) == 3);
  write_png(path, canvas.width(), canvas.height(),
            {reinterpret_cast<const uint8_t*>(canvas.pixels().data()), canvas.pixels().size() * 3}, comment);
}

}  // namespace suite
