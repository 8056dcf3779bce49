#include <algorithm>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "formats/brdf_csv/brdf_csv.h"
#include "formats/cornell/cornell.h"
#include "formats/measured/measured.h"
#include "formats/merl/merl.h"
#include "formats/mueller_csv/mueller_csv.h"
#include "formats/pbsdf/pbsdf.h"
#include "formats/rgl/rgl.h"
#include "formats/samples/samples.h"

namespace suite {

namespace {

enum class Kind { unknown, tensor, merl, samples, cornell, csv };

Kind kind_of(std::span<const std::byte> bytes, const std::string& path) {
  auto starts = [&](const char* text, size_t n) {
    return bytes.size() >= n && std::memcmp(bytes.data(), text, n) == 0;
  };
  if (starts("tensor_file", 12)) return Kind::tensor;
  if (starts("RAWBH10A", 8) || starts("RAWBS10A", 8)) return Kind::samples;
  const int32_t ninety[2] = {90, 90};
  if (bytes.size() >= 8 && std::memcmp(bytes.data(), ninety, 8) == 0) return Kind::merl;
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".bsdf" || extension == ".pbsdf") return Kind::tensor;
  if (extension == ".binary") return Kind::merl;
  if (extension == ".brdf") return Kind::cornell;
  if (extension == ".csv") return Kind::csv;
  return Kind::unknown;
}

// Formats that people have and this project does not read, told by their first bytes.
std::string foreign(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), std::min<size_t>(bytes.size(), 4096));
  const auto has = [&](std::string_view what) { return text.find(what) != std::string_view::npos; };
  if (text.starts_with("PK\x03\x04")) return "a zip archive: unpack it and give the file inside";
  if (text.starts_with("\x1f\x8b")) return "packed by gzip: unpack it first";
  if (text.starts_with("\xfd"
                       "7zXZ"))
    return "packed by xz: unpack it first";
  if (text.starts_with("\x89HDF")) return "an HDF5 file: export its samples as .csv";
  if (text.starts_with("SQTbund")) return "an SQT file: it is fitted already; sqt-inspect looks into it";
  if (has("<WindowElement") || (has("<?xml") && has("Window")))
    return "a Radiance/Window XML file of a BSDF, which is not read: export its samples as .csv";
  if (has("#DIM") || has("#PARAM_IN") || has("#VS"))
    return "an ALTA data file, which is not read: export its samples as .csv";
  if (has("<?xml")) return "an XML file, which is not read: export its samples as .csv";
  return {};
}

}  // namespace

Measured read_measured(const std::string& path) {
  const std::vector<std::byte> bytes = read_bytes(path, size_t{1} << 32);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  switch (kind_of(bytes, path)) {
    case Kind::tensor:
      if (is_pbsdf(TensorFile(bytes, path)))
        return std::static_pointer_cast<const sqt::Function>(parse_pbsdf(bytes, path));
      return std::static_pointer_cast<const sqt::Function>(parse_rgl(bytes, path));
    case Kind::merl:
      return std::static_pointer_cast<const sqt::Function>(parse_merl(bytes, path));
    case Kind::samples:
      return parse_samples(text, path);
    case Kind::cornell:
      return parse_cornell(text, path);
    case Kind::csv:
      if (is_mueller_csv(text)) return std::static_pointer_cast<const sqt::Function>(parse_mueller_csv(text, path));
      return parse_brdf_csv(text, path);
    case Kind::unknown:
      break;
  }
  if (const std::string what = foreign(bytes); !what.empty()) throw Error(Where{path, 0, 0, {}, -1}, "this is " + what);
  throw Error(Where{path, 0, 0, {}, -1}, "is no measured scattering file that we know",
              "known formats:\n" + measured_formats());
}

bool looks_measured(const std::string& path) {
  const RandomAccessFile file(path);
  std::vector<std::byte> head(std::min<size_t>(file.size(), 12));
  file.read_at(0, head);
  return kind_of(head, path) != Kind::unknown;
}

std::string measured_formats() {
  return "  .binary   MERL, 90 x 90 x 180 or 360; f = raw x (1, 1.15, 1.66)/1500 per sr, no cosine; values at bin "
         "centres,\n"
         "            nearest bin; a triple with a negative value is invalid\n"
         "  .bsdf     RGL tensor file, rgb or spectral, isotropic or anisotropic; light = theta_i; divided by "
         "cos(out), from\n"
         "            88 deg on by cos 88 deg; negative values count as 0\n"
         "  .pbsdf    Mueller matrices as a tensor file (Baek et al. 2020, Mitsuba), isotropic; m11 is fitted, the "
         "matrices\n"
         "            over it are kept as a table with its error\n"
         "  RAWBH10A, RAWBS10A   raw sample text, per sr without cosine (recognised by its first line)\n"
         "  .brdf     Cornell text, per sr without cosine\n"
         "  .csv      theta_o, phi_o, theta_i, phi_i [rad, or _deg], wavelength_um, value [1/sr, no cosine]\n"
         "  .csv      of Mueller matrices: theta_h_deg, theta_d_deg, phi_d_deg, wavelength_um, m11 to m44 [1/sr], as "
         ".pbsdf\n"
         "Directions below the horizon hold no data.\n";
}

}  // namespace suite
