// Images of base colours: packed as they are in the file, the container or a data URI.
// Based on: Khronos Group, "glTF 2.0 Specification", 2021, sections 3.8 and 3.9.2.
#include <cmath>

#include "base/files.h"
#include "formats/gltf/load.h"

namespace suite::gltf {

namespace {

constexpr size_t kMostTextureBytes = size_t{1} << 30;  // of one image

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
  if (image.bufferView < 0 && !image.uri.empty()) return read_bytes(resolve(plain_name(image.uri)), kMostTextureBytes);
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

// Some numbers of an extension's object. Error: fault(); fewer or more, or none at all.
std::vector<double> numbers_of(const tinygltf::Value& object, const char* key, size_t count, double otherwise,
                               const std::string& file, const std::string& pointer) {
  if (!object.Has(key)) return std::vector<double>(count, otherwise);
  const tinygltf::Value& given = object.Get(key);
  std::vector<double> numbers;
  if (count == 1 && given.IsNumber()) numbers.push_back(given.GetNumberAsDouble());
  for (size_t k = 0; given.IsArray() && k < given.ArrayLen(); ++k)
    numbers.push_back(given.Get(k).IsNumber() ? given.Get(k).GetNumberAsDouble() : NAN);
  for (const double v : numbers)
    if (!(std::fabs(v) <= 1e6)) numbers.clear();
  if (numbers.size() != count)
    throw fault(file, pointer + "/" + key, strf("%zu numbers between -1e6 and 1e6 are expected", count));
  return numbers;
}

}  // namespace

// Khronos Group, "KHR_texture_transform", 2018: scaled, turned and moved, in this order. Its text and its example (the
// lower left quarter of the image by an offset of (0, 1), a quarter turn and a scale of a half) agree on which way it
// turns, its lines of GLSL turn the other way.
UvRule uv_rule_of(const tinygltf::Model& model, const std::string& file, int material) {
  UvRule rule;
  if (material < 0) return rule;
  const tinygltf::TextureInfo& info =
      model.materials[static_cast<size_t>(material)].pbrMetallicRoughness.baseColorTexture;
  if (info.index < 0) return rule;
  rule.set = info.texCoord;
  const std::string at = strf("materials[%d]/pbrMetallicRoughness/baseColorTexture", material);
  if (const auto found = info.extensions.find("KHR_texture_transform"); found != info.extensions.end()) {
    const std::string pointer = at + "/extensions/KHR_texture_transform";
    const std::vector<double> offset = numbers_of(found->second, "offset", 2, 0, file, pointer),
                              scale = numbers_of(found->second, "scale", 2, 1, file, pointer),
                              turn = numbers_of(found->second, "rotation", 1, 0, file, pointer),
                              set = numbers_of(found->second, "texCoord", 1, rule.set, file, pointer);
    const double c = std::cos(turn[0]), s = std::sin(turn[0]);
    rule.transform = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
    rule.set = static_cast<int>(set[0]);
  }
  if (rule.set < 0) throw fault(file, at, strf("texture coordinates of the number %d", rule.set), "they count from 0");
  return rule;
}

std::shared_ptr<const SourceTexture> texture_of(const tinygltf::Model& model, const std::string& file, size_t material,
                                                const Resolve& resolve, Report& report) {
  const tinygltf::TextureInfo& info = model.materials[material].pbrMetallicRoughness.baseColorTexture;
  if (info.index < 0) return nullptr;
  const std::string at = strf("materials[%zu]/pbrMetallicRoughness/baseColorTexture", material);
  const tinygltf::Texture& texture = item_of(model.textures, info.index, file, at + "/index", "texture");
  const std::string pointer = strf("textures[%d]", info.index);
  if (texture.source < 0)
    throw fault(file, pointer + "/source", "the image is in a format of an extension", "write it as PNG or JPEG");
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
