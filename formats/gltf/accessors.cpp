// Accessors: numbers within buffers, checked before anything is allocated for them.
// Based on: Khronos Group, "glTF 2.0 Specification", 2021, section 3.6.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "formats/gltf/load.h"

namespace suite::gltf {

namespace {

// Without a buffer view all values are 0, and only the count says how many: it is taken on trust up to here.
constexpr size_t kMostZeros = 10'000'000;

// How components lie in a buffer.
struct Layout {
  const unsigned char* first = nullptr;
  size_t stride = 0;
};

double component(const unsigned char* at, int type, bool normalized) {
  const auto as = [&](auto zero) {
    std::memcpy(&zero, at, sizeof zero);
    return static_cast<double>(zero);
  };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return normalized ? std::max(as(int8_t{}) / 127, -1.0) : as(int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return normalized ? as(uint8_t{}) / 255 : as(uint8_t{});
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return normalized ? std::max(as(int16_t{}) / 32767, -1.0) : as(int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return normalized ? as(uint16_t{}) / 65535 : as(uint16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return as(uint32_t{});
    default:
      return as(float{});
  }
}

size_t component_size(int type, const std::string& file, const std::string& pointer) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      throw fault(file, pointer + "/componentType", strf("%d is no type of numbers", type), "5120 to 5123, 5125, 5126");
  }
}

// count values of `size` bytes from `offset` of a buffer view on; stride 0: one after the other.
Layout layout(const tinygltf::Model& model, const std::string& file, const std::string& pointer, int view_index,
              size_t offset, size_t count, size_t size, bool strided) {
  const tinygltf::BufferView& view =
      item_of(model.bufferViews, view_index, file, pointer + "/bufferView", "buffer view");
  const std::string at = strf("bufferViews[%d]", view_index);
  const tinygltf::Buffer& buffer = item_of(model.buffers, view.buffer, file, at + "/buffer", "buffer");
  if (view.byteOffset > buffer.data.size() || view.byteLength > buffer.data.size() - view.byteOffset)
    throw fault(
        file, at,
        strf("%zu bytes from %zu on, the buffer has %zu", view.byteLength, view.byteOffset, buffer.data.size()));
  const size_t stride = strided && view.byteStride ? view.byteStride : size;
  if (stride < size || stride > 252)
    throw fault(file, at + "/byteStride", strf("%zu bytes from value to value of %zu", stride, size), "at most 252");
  if (offset > view.byteLength ||
      (count > 0 && (view.byteLength - offset < size || (view.byteLength - offset - size) / stride < count - 1)))
    throw fault(file, pointer,
                strf("%zu values of %zu bytes from %zu on, the buffer view has %zu bytes", count, size, offset,
                     view.byteLength));
  return {buffer.data.data() + view.byteOffset + offset, stride};
}

void put_sparse(const tinygltf::Model& model, const std::string& file, const tinygltf::Accessor& accessor,
                const std::string& pointer, size_t width, Values& values) {
  const auto& sparse = accessor.sparse;
  const std::string at = pointer + "/sparse";
  if (sparse.count < 0 || static_cast<size_t>(sparse.count) > values.count)
    throw fault(file, at + "/count", strf("%d of %zu values", static_cast<int>(sparse.count), values.count));
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) throw fault(file, at, "an offset below 0");
  const auto count = static_cast<size_t>(sparse.count);
  const int index_type = sparse.indices.componentType;
  if (index_type == TINYGLTF_COMPONENT_TYPE_FLOAT || index_type == TINYGLTF_COMPONENT_TYPE_BYTE ||
      index_type == TINYGLTF_COMPONENT_TYPE_SHORT)
    throw fault(file, at + "/indices/componentType", strf("%d is no type of indices", index_type));
  const Layout where =
      layout(model, file, at + "/indices", sparse.indices.bufferView, static_cast<size_t>(sparse.indices.byteOffset),
             count, component_size(index_type, file, at + "/indices"), false);
  const size_t size = component_size(accessor.componentType, file, pointer);
  const Layout what = layout(model, file, at + "/values", sparse.values.bufferView,
                             static_cast<size_t>(sparse.values.byteOffset), count, size * width, false);
  for (size_t k = 0; k < count; ++k) {
    const auto index = static_cast<size_t>(component(where.first + k * where.stride, index_type, false));
    if (index >= values.count) throw fault(file, at + "/indices", strf("value %zu of %zu", index, values.count));
    for (size_t c = 0; c < width; ++c)
      values.numbers[index * width + c] =
          component(what.first + k * what.stride + c * size, accessor.componentType, accessor.normalized);
  }
}

}  // namespace

Values values_of(const tinygltf::Model& model, const std::string& file, int index, const std::string& pointer,
                 std::initializer_list<size_t> components) {
  const tinygltf::Accessor& accessor = item_of(model.accessors, index, file, pointer, "accessor");
  const std::string at = strf("accessors[%d]", index);
  const int width = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
  if (width < 1 || std::find(components.begin(), components.end(), static_cast<size_t>(width)) == components.end() ||
      accessor.type > TINYGLTF_TYPE_VEC4 + TINYGLTF_TYPE_SCALAR)
    throw fault(file, at + "/type", strf("values of %d numbers for %s", width, pointer.c_str()));
  Values values;
  values.count = accessor.count, values.components = static_cast<size_t>(width);
  const size_t size = component_size(accessor.componentType, file, at);
  if (accessor.bufferView < 0) {
    if (values.count > kMostZeros)
      throw fault(file, at + "/count", strf("%zu values without a buffer view", values.count),
                  strf("at most %zu", kMostZeros));
    values.numbers.assign(values.count * values.components, 0);
  } else {
    const Layout from =
        layout(model, file, at, accessor.bufferView, accessor.byteOffset, values.count, size * values.components, true);
    values.numbers.resize(values.count * values.components);
    for (size_t k = 0; k < values.count; ++k)
      for (size_t c = 0; c < values.components; ++c)
        values.numbers[k * values.components + c] =
            component(from.first + k * from.stride + c * size, accessor.componentType, accessor.normalized);
  }
  if (accessor.sparse.isSparse) put_sparse(model, file, accessor, at, values.components, values);
  for (size_t k = 0; k < values.numbers.size(); ++k)
    if (!(std::fabs(values.numbers[k]) <= kLargestNumber))
      throw fault(file, at, strf("value %zu is no number, or larger than 1e30", k / values.components));
  return values;
}

}  // namespace suite::gltf
