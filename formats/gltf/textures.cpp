// Images of base colours: packed as they are in the file, the container or a data URI.
// Based on: Khronos Group, "glTF 2.0 Specification", 2021, sections 3.8 and 3.9.2.
#include "base/files.h"
#include "formats/gltf/load.h"

namespace suite::gltf {

namespace {

constexpr size_t kMostBytes = size_t{1} << 30;  // of one image

// %20 and the like (RFC 3986), which names of files in a glTF may have.
std::string plain_name(const std::string& uri) {
  std::string name;
  const auto digit = [](char c) -> int {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  for (size_t i = 0; i < uri.size(); ++i) {
    const bool escaped = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
    name += escaped ? static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
    if (escaped) i += 2;
  }
  return name;
}

std::vector<std::byte> bytes_of(const tinygltf::Model& model, const std::string& file, int index, const std::string& at,
                                const Resolve& resolve) {
  const tinygltf::Image& image = item_of(model.images, index, file, at, "image");
  const std::string pointer = strf("images[%d]", index);
  if (image.bufferView < 0 && !image.uri.empty()) return read_bytes(resolve(plain_name(image.uri)), kMostBytes);
  if (image.bufferView < 0) {
    const std::byte* first = reinterpret_cast<const std::byte*>(image.image.data());
    return {first, first + image.image.size()};
  }
  const tinygltf::BufferView& view =
      item_of(model.bufferViews, image.bufferView, file, pointer + "/bufferView", "buffer view");
  const auto& data = item_of(model.buffers, view.buffer, file, pointer + "/bufferView", "buffer").data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
    throw fault(file, pointer,
                strf("%zu bytes from %zu on, the buffer has %zu", view.byteLength, view.byteOffset, data.size()));
  const std::byte* first = reinterpret_cast<const std::byte*>(data.data()) + view.byteOffset;
  return {first, first + view.byteLength};
}

// How the image goes on beyond its edges. Mirrors are no rule here.
SourceTexture::Extend extend_of(const tinygltf::Sampler& sampler, const std::string& file, const std::string& pointer,
                                Report& report) {
  if (sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT || sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT)
    report.add("SP707", file, {Where{file, 0, 0, {}, -1}, pointer + ": is repeated, not mirrored"});
  else if (sampler.wrapS != sampler.wrapT)
    report.add("SP707", file, {Where{file, 0, 0, {}, -1}, pointer + ": goes on in v as it does in u"});
  return sampler.wrapS == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE ? SourceTexture::Extend::clamp
                                                              : SourceTexture::Extend::repeat;
}

}  // namespace

std::shared_ptr<const SourceTexture> texture_of(const tinygltf::Model& model, const std::string& file, size_t material,
                                                const Resolve& resolve, Report& report) {
  const tinygltf::TextureInfo& info = model.materials[material].pbrMetallicRoughness.baseColorTexture;
  if (info.index < 0) return nullptr;
  const std::string at = strf("materials[%zu]/pbrMetallicRoughness/baseColorTexture", material);
  const tinygltf::Texture& texture = item_of(model.textures, info.index, file, at + "/index", "texture");
  const std::string pointer = strf("textures[%d]", info.index);
  if (texture.source < 0)
    throw fault(file, pointer + "/source", "the image is in a format of an extension", "write it as PNG or JPEG");
  if (info.texCoord != 0)
    report.add("SP707", file,
               {Where{file, 0, 0, {}, -1}, at + ": is laid out by the first texture coordinates, not its own"});
  auto made = std::make_shared<SourceTexture>();
  made->name = file + ": " + pointer;
  made->bytes = bytes_of(model, file, texture.source, pointer + "/source", resolve);
  if (texture.sampler < 0) return made;
  const tinygltf::Sampler& sampler = item_of(model.samplers, texture.sampler, file, pointer + "/sampler", "sampler");
  made->extend = extend_of(sampler, file, pointer, report);
  made->smooth = sampler.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
  return made;
}

}  // namespace suite::gltf
