// The container is checked here before tinygltf sees it: its own check of a GLB's second chunk is 8 bytes short, and
// it follows nested JSON by recursion.
// Based on: Khronos Group, "glTF 2.0 Specification", 2021, section 4.4 (GLB).
#include "formats/gltf/load.h"

#include <algorithm>
#include <cstring>

#include "base/files.h"
#include "base/run_app.h"

namespace tinygltf {
std::string base64_decode(std::string const& text);  // declared beside its body only
}

namespace suite::gltf {

namespace {

constexpr size_t kDeepest = 200;  // levels of JSON
constexpr size_t kMostBytes = size_t{4} << 30;

Error fault_at(const std::string& file, size_t offset, const std::string& what, const std::string& hint = {}) {
  return {Where{file, 0, 0, {}, static_cast<long long>(offset)}, what, hint};
}

uint32_t word(std::span<const std::byte> bytes, size_t at) {
  uint32_t w;
  std::memcpy(&w, bytes.data() + at, sizeof w);
  return w;
}

// Compressed geometry, named before the library says less: meshes by Draco, buffers by meshopt.
void refuse_compression(std::string_view json, const std::string& file) {
  for (const auto& [name, what] : {std::pair{"KHR_draco_mesh_compression", "Draco"},
                                   {"EXT_meshopt_compression", "meshopt"},
                                   {"KHR_meshopt_compression", "meshopt"}})
    if (json.find("\"" + std::string(name) + "\"") != json.npos)
      throw Error(Where{file, 0, 0, {}, -1},
                  strf("its geometry is compressed by %s (%s), which is not read", what, name),
                  "write it without: 'gltf-transform copy IN.glb OUT.glb', or export it uncompressed");
}

// Chunks of a GLB begin at multiples of 4 bytes (section 4.4.3.1), the JSON is padded by blanks to that; some writers
// do not. A copy that does is made of such a file.
std::vector<std::byte> aligned(std::span<const std::byte> bytes) {
  std::vector<std::byte> made(bytes.begin(), bytes.begin() + 12);
  const size_t length = word(bytes, 8);
  for (size_t at = 12; at < length;) {
    const size_t size = word(bytes, at), padded = (size + 3) / 4 * 4;
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    made.insert(made.end(), from, from + static_cast<std::ptrdiff_t>(8 + size));
    const auto size_now = static_cast<uint32_t>(padded);
    std::memcpy(made.data() + made.size() - size - 8, &size_now, sizeof size_now);
    made.insert(made.end(), padded - size, static_cast<std::byte>(at == 12 ? ' ' : '\0'));
    at += 8 + size;
  }
  const auto length_now = static_cast<uint32_t>(made.size());
  std::memcpy(made.data() + 8, &length_now, sizeof length_now);
  return made;
}

bool is_aligned(std::span<const std::byte> bytes) {
  for (size_t at = 12, length = word(bytes, 8); at < length; at += 8 + word(bytes, at))
    if (word(bytes, at) % 4) return false;
  return true;
}

// The JSON of a GLB, whose chunks must lie within it.
std::string_view json_of_container(std::span<const std::byte> bytes, const std::string& file) {
  constexpr uint32_t kJson = 0x4E4F534A;
  if (bytes.size() < 20) throw fault_at(file, bytes.size(), "ends within the header of a GLB");
  if (const uint32_t version = word(bytes, 4); version != 2)
    throw fault_at(file, 4, strf("GLB of version %u", version), "version 2 is read; convert it");
  const size_t length = word(bytes, 8);
  if (length > bytes.size() || length < 20)
    throw fault_at(file, 8, strf("declares %zu bytes and has %zu", length, bytes.size()));
  for (size_t at = 12, chunk = 0; at < length; ++chunk) {
    if (length - at < 8) throw fault_at(file, at, "ends within the header of a chunk");
    const size_t size = word(bytes, at);
    if (size > length - at - 8)
      throw fault_at(file, at, strf("a chunk of %zu bytes, %zu are left", size, length - at - 8));
    if (chunk == 0 && word(bytes, at + 4) != kJson) throw fault_at(file, at + 4, "the first chunk is no JSON");
    at += 8 + size;
  }
  return {reinterpret_cast<const char*>(bytes.data()) + 20, word(bytes, 12)};
}

void check_nesting(std::string_view json, const std::string& file, size_t offset) {
  size_t depth = 0;
  bool quoted = false;
  for (size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted) {
      if (c == '\\') ++i;
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepest) throw fault_at(file, offset + i, strf("JSON of more than %zu levels", kDeepest));
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
}

// tinygltf asks for the buffers that a file names; what goes wrong is kept, for it passes on no exceptions.
struct Files {
  const Resolve& resolve;
  Where file;  // that names them
  std::optional<Error> fault;
};

// Data URIs (RFC 2397) whose media type tinygltf does not know are names of files to it; so each '+' is a blank here.
std::string bytes_of_data_uri(std::string uri, const Where& file) {
  const size_t comma = uri.find(',');
  if (comma == uri.npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
    throw Error(file, "a buffer's data URI begins '" + printable(uri.substr(0, 40)) + "'",
                "data:application/octet-stream;base64, or another type in base64");
  std::replace(uri.begin(), uri.end(), ' ', '+');
  return tinygltf::base64_decode(uri.substr(comma + 1));
}

tinygltf::FsCallbacks callbacks(Files& files) {
  tinygltf::FsCallbacks call{};
  call.user_data = &files;
  call.FileExists = [](const std::string&, void*) { return true; };
  call.ExpandFilePath = [](const std::string& path, void*) { return path; };
  call.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& name, void* user) {
    Files& from = *static_cast<Files*>(user);
    try {
      if (name.starts_with("data:")) {
        const std::string bytes = bytes_of_data_uri(name, from.file);
        out->assign(bytes.begin(), bytes.end());
        return true;
      }
      const std::vector<std::byte> bytes = read_bytes(from.resolve(name), kMostBytes);
      const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
      out->assign(first, first + bytes.size());
      return true;
    } catch (const Error& e) {
      from.fault = e;
      return false;
    }
  };
  return call;
}

// tinygltf wants a property of skins that glTF leaves to the writer (section 5.28: the identity where it is not given).
std::string without_skins(std::string errors) {
  const std::string_view wanted = "'inverseBindMatrices' property is missing in Skin.\n";
  for (size_t at; (at = errors.find(wanted)) != errors.npos;) errors.erase(at, wanted.size());
  return errors;
}

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (char& c : text)
    if (c == '\n') c = ';';
  return text.substr(0, 300);
}

// Images stay packed. Those of buffer views lie there; those of data URIs are nowhere else.
bool keep_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

}  // namespace

Error fault(const std::string& file, const std::string& pointer, const std::string& what, const std::string& hint) {
  return {Where{file, 0, 0, {}, -1}, pointer + ": " + what, hint};
}

tinygltf::Model load(std::span<const std::byte> bytes, const std::string& file, const Resolve& resolve) {
  if (bytes.size() > kMostBytes - 1) throw Error(Where{file, 0, 0, {}, -1}, "has more than 4 GiB");
  const bool binary = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
  const std::string_view json = binary ? json_of_container(bytes, file)
                                       : std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  check_nesting(json, file, binary ? 20 : 0);
  std::vector<std::byte> copy;
  if (binary && !is_aligned(bytes)) {
    warn(file + ": the chunks of this GLB are not aligned to 4 bytes, as they are to be; it is read nonetheless");
    copy = aligned(bytes);
    bytes = copy;
  }
  tinygltf::Model model;
  tinygltf::TinyGLTF reader;
  Files files{resolve, Where{file, 0, 0, {}, -1}, {}};
  reader.SetFsCallbacks(callbacks(files));
  reader.SetImageLoader(keep_image, nullptr);
  std::string errors, warnings;
  bool whole = false;
  try {
    const auto size = static_cast<unsigned>(bytes.size());
    whole = binary ? reader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                                 reinterpret_cast<const unsigned char*>(bytes.data()), size, "")
                   : reader.LoadASCIIFromString(&model, &errors, &warnings, json.data(), size, "");
  } catch (const std::exception& e) {
    errors = e.what();
  }
  if (files.fault) throw *files.fault;
  errors = without_skins(std::move(errors));
  if (!whole || !errors.empty()) refuse_compression(json, file);
  if (!whole || !errors.empty())
    throw Error(Where{file, 0, 0, {}, -1}, "cannot be read as glTF: " + one_line(printable(one_line(errors))));
  if (!model.asset.version.empty() && model.asset.version.substr(0, 2) != "2.")
    throw fault(file, "asset/version", "glTF " + printable(model.asset.version), "version 2 is read; convert it");
  return model;
}

}  // namespace suite::gltf
