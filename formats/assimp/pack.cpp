#include "formats/assimp/pack.h"

#include <cstring>
#include <type_traits>

namespace suite {

namespace {

// One description of the fields serves both ways.
class Archive {
 public:
  explicit Archive(std::string& out) : out_(&out) {}
  explicit Archive(std::string_view in) : in_(in) {}
  bool sound() const { return sound_; }

  template <class T>
  void one(T& value) {
    if constexpr (std::is_same_v<T, std::string>) {
      many(value);
    } else if constexpr (std::is_trivially_copyable_v<T>) {
      raw(&value, sizeof value);
    } else {
      fields(value);
    }
  }
  template <class List>
  void many(List& list) {
    uint64_t size = list.size();
    one(size);
    using T = typename List::value_type;
    if constexpr (std::is_trivially_copyable_v<T>) {
      if (!out_ && size > in_.size() / sizeof(T)) sound_ = false, size = 0;
      if (!out_) list.resize(size);
      raw(list.data(), size * sizeof(T));
    } else {
      if (!out_ && size > in_.size()) sound_ = false, size = 0;  // each takes bytes
      if (!out_) list.resize(size);
      for (T& item : list) one(item);
    }
  }
  void fields(AssimpMesh& m) {
    one(m.name), one(m.material), many(m.positions), many(m.normals), many(m.uvs), many(m.indices);
  }
  void fields(AssimpNode& n) { one(n.name), one(n.parent), one(n.to_parent), many(n.meshes), one(n.inherits); }
  void fields(AssimpMaterial& m) { one(m.name), one(m.rgb); }
  void fields(AssimpModel& m) {
    one(m.fault), many(m.meshes), many(m.nodes), many(m.materials), one(m.unit_cm), one(m.axes);
    for (uint64_t* count : {&m.animations, &m.cameras, &m.lights, &m.textures, &m.bones, &m.morphs, &m.colours,
                            &m.lines, &m.see_through, &m.shining, &m.bumps, &m.gloss})
      one(*count);
  }

 private:
  void raw(void* at, size_t size) {
    if (out_) {
      out_->append(static_cast<const char*>(at), size);
    } else if (size > in_.size()) {
      sound_ = false;
    } else if (size) {
      std::memcpy(at, in_.data(), size);
      in_.remove_prefix(size);
    }
  }
  std::string* out_ = nullptr;
  std::string_view in_;
  bool sound_ = true;
};

}  // namespace

std::string packed(const AssimpModel& model) {
  std::string out;
  AssimpModel copy = model;  // the fields are read only, but serve both ways
  Archive(out).fields(copy);
  return out;
}

bool unpack(std::string_view bytes, AssimpModel& model) {
  Archive archive(bytes);
  archive.fields(model);
  return archive.sound();
}

}  // namespace suite
