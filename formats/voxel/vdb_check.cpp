// Based on: the format as OpenVDB 10 reads it (openvdb/io/Archive.cc, GridDescriptor.cc, Compression.h,
// tree/RootNode.h, InternalNode.h, LeafNode.h).
#include "formats/voxel/vdb_check.h"

#include <bit>
#include <cstdint>
#include <map>
#include <set>

#include "base/bytes.h"
#include "base/files.h"

namespace suite {

namespace {

constexpr const char* kFloats = "Tree_float_5_4_3";
constexpr const char* kHalf = "_HalfFloat";

struct Descriptor {
  std::string name, type, parent;
  bool half = false;
  size_t begin = 0, end = 0;
};

class Walk {
 public:
  Walk(std::span<const std::byte> bytes, const std::string& path) : r_(bytes, path) {}

  void run(const std::vector<std::string>& grids) {
    header();
    const auto count = r_.get<int32_t>("the number of grids");
    // A descriptor takes 36 bytes and more.
    if (count < 0 || static_cast<size_t>(count) > r_.left() / 36)
      throw r_.error(strf("%d grids are declared", count), complete());
    for (int32_t i = 0; i < count; ++i) descriptor();
    std::set<std::string> wanted(grids.begin(), grids.end());
    // A grid may share the tree of another.
    for (const auto& [name, d] : all_)
      if (wanted.count(name) && !d.parent.empty()) wanted.insert(d.parent);
    for (const auto& [name, d] : all_)
      if (wanted.count(name)) grid(d);
  }

 private:
  static std::string complete() { return "is it complete, and a .vdb file of version 222 to 224?"; }
  std::string word(const char* what) {
    const auto size = r_.get<uint32_t>(what);
    const auto bytes = r_.take(size, what);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  void header() {
    if (r_.get<uint64_t>("the signature") != 0x56444220) throw r_.error("is no OpenVDB file", complete());
    if (const auto version = r_.get<uint32_t>("the version"); version < 222 || version > 224)
      throw r_.error(strf("has version %u of the format", version), "222 (OpenVDB 2.0) to 224 are read");
    r_.take(8, "the version of the library");
    if (r_.get<uint8_t>("the flag of offsets") != 1) throw r_.error("has no offsets of grids", complete());
    r_.take(36, "the identifier");
    metadata();
  }

  // Returns whether the values of the grid are stored as halves.
  bool metadata() {
    static const std::map<std::string, uint32_t> sizes{{"bool", 1},   {"float", 4},  {"double", 8}, {"int32", 4},
                                                       {"int64", 8},  {"vec2i", 8},  {"vec2s", 8},  {"vec2d", 16},
                                                       {"vec3i", 12}, {"vec3s", 12}, {"vec3d", 24}, {"vec4i", 16},
                                                       {"vec4s", 16}, {"vec4d", 32}, {"mat4s", 64}, {"mat4d", 128}};
    bool half = false;
    for (auto left = r_.get<uint32_t>("the number of metadata"); left > 0; --left) {
      const std::string name = word("a name of metadata"), type = word("a type of metadata");
      const auto size = r_.get<uint32_t>("a size of metadata");
      if (const auto known = sizes.find(type); known != sizes.end() && known->second != size)
        throw r_.error(strf("metadata of type %s take %u bytes", type.c_str(), size), complete());
      const auto value = r_.take(size, "metadata");
      if (name == "is_saved_as_half_float" && type == "bool") half = value[0] != std::byte{0};
      if (type == "__delayedload") delayed(value);
    }
    return half;
  }

  // What is known of each leaf: a byte and a size, each packed, as they are (0 bytes) or missing (-1). The library
  // follows these sizes, whatever the size of the whole.
  void delayed(std::span<const std::byte> value) {
    if (value.empty()) return;
    ByteReader inner(value, r_.file());
    const auto leaves = inner.get<uint32_t>("the number of leaves");
    if (leaves > r_.size() / 64) throw r_.error(strf("metadata of %u leaves", leaves), complete());
    for (const size_t width : {size_t{1}, size_t{8}}) {
      const auto packed = inner.get<uint32_t>("the size of packed metadata");
      if (packed == UINT32_MAX) continue;
      inner.take(packed ? packed : width * leaves, "packed metadata");
    }
    if (inner.left()) throw r_.error("metadata of leaves are of another size", complete());
  }

  void descriptor() {
    Descriptor d;
    d.name = word("the name of a grid"), d.type = word("the type of a grid");
    if (d.type.ends_with(kHalf)) d.half = true, d.type.resize(d.type.size() - std::strlen(kHalf));
    d.parent = word("the parent of a grid");
    const auto begin = r_.get<int64_t>("the place of a grid"), block = r_.get<int64_t>("the place of a grid"),
               end = r_.get<int64_t>("the end of a grid");
    if (begin < static_cast<int64_t>(r_.offset()) || block < begin || end < block ||
        end > static_cast<int64_t>(r_.size()))
      throw r_.error(strf("grid '%s' lies from byte %lld to %lld of %zu", d.name.c_str(), static_cast<long long>(begin),
                          static_cast<long long>(end), r_.size()),
                     complete());
    d.begin = static_cast<size_t>(begin), d.end = static_cast<size_t>(end);
    // Names that are not unique carry a number behind a control character, which does not count.
    all_.emplace(d.name.substr(0, d.name.find('\x1e')), d);
    r_.seek(d.end, "the next grid");
  }

  void grid(const Descriptor& d) {
    r_.seek(d.begin, "a grid");
    compression_ = r_.get<uint32_t>("the compression");
    if (compression_ & ~7u) throw r_.error(strf("compression %u is not known", compression_), complete());
    half_ = metadata();
    if (half_ != d.half) throw r_.error("the grid is and is not one of halves", complete());
    if (d.type != kFloats) return;  // its type and metadata are asked for, no more
    transform();
    if (!d.parent.empty()) return;
    if (r_.get<int32_t>("the number of buffers") != 1) throw r_.error("a tree of several buffers", complete());
    root();
    for (const Mask<8>& leaf : leaves_) {
      r_.take(64, "a leaf");
      values(512, leaf.on, 64);
    }
    leaves_.clear();
  }

  void transform() {
    static const std::map<std::string, size_t> sizes{{"AffineMap", 128},         {"UnitaryMap", 128},
                                                     {"ScaleMap", 120},          {"UniformScaleMap", 120},
                                                     {"ScaleTranslateMap", 144}, {"UniformScaleTranslateMap", 144},
                                                     {"TranslationMap", 24}};
    const std::string type = word("the transform");
    const auto known = sizes.find(type);
    if (known == sizes.end()) throw r_.error("a transform of type '" + type + "' is no box of equal cells", complete());
    r_.take(known->second, "the transform");
  }

  void root() {
    r_.take(4, "the background");
    const auto tiles = r_.get<uint32_t>("the number of tiles"), children = r_.get<uint32_t>("the number of nodes");
    r_.take(size_t{17} * tiles, "the tiles");
    for (uint32_t i = 0; i < children; ++i) {
      r_.take(12, "the place of a node");
      node<32768, 4096>();
    }
  }

  // The bits of a mask, and how many are set.
  template <size_t Words>
  struct Mask {
    explicit Mask(std::span<const std::byte> bytes) {
      for (size_t i = 0; i < Words; ++i) {
        uint64_t w;
        std::memcpy(&w, bytes.data() + 8 * i, 8);
        on += static_cast<size_t>(std::popcount(w));
      }
    }
    size_t on = 0;
  };

  // A node of N places, whose children have C places each; 512: leaves.
  template <size_t N, size_t C>
  void node() {
    const Mask<N / 64> children(r_.take(N / 8, "a node")), active(r_.take(N / 8, "a node"));
    values(N, active.on, N / 8);
    for (size_t i = 0; i < children.on; ++i) {
      if constexpr (C == 512)
        leaves_.emplace_back(r_.take(64, "a leaf"));
      else
        node<C, 512>();
    }
  }

  // The values of a node: what of them is left out says the first byte.
  void values(size_t count, size_t active, size_t mask_bytes) {
    const auto left_out = r_.get<uint8_t>("values");
    if (left_out > 6) throw r_.error(strf("values are left out in the way %u", left_out), complete());
    if (left_out == 2 || left_out == 4) r_.take(4, "an inactive value");
    if (left_out == 5) r_.take(8, "inactive values");
    if (left_out >= 3 && left_out <= 5) r_.take(mask_bytes, "a mask of inactive values");
    const size_t bytes = ((compression_ & 2) && left_out != 6 ? active : count) * (half_ ? 2 : 4);
    if (half_ && bytes == 0) return;  // of no halves not even the size is stored
    if (!(compression_ & 5)) {
      r_.take(bytes, "values");
      return;
    }
    const auto packed = r_.get<int64_t>("the size of packed values");
    if (packed <= 0 ? static_cast<uint64_t>(-(packed + 1)) + 1 != bytes && !(packed == 0 && bytes == 0)
                    : static_cast<uint64_t>(packed) > r_.left())
      throw r_.error(strf("%zu bytes of values are packed into %lld", bytes, static_cast<long long>(packed)),
                     complete());
    r_.take(packed <= 0 ? bytes : static_cast<size_t>(packed), "packed values");
  }

  ByteReader r_;
  std::multimap<std::string, Descriptor> all_;  // by name, which several may have
  std::vector<Mask<8>> leaves_;
  uint32_t compression_ = 0;
  bool half_ = false;
};

}  // namespace

void check_vdb(const std::string& path, const std::vector<std::string>& grids) {
  const std::vector<std::byte> bytes = read_bytes(path);
  Walk(bytes, path).run(grids);
}

}  // namespace suite
