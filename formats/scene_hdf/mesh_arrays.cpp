#include "formats/scene_hdf/mesh_arrays.h"

#include <unistd.h>

#include <atomic>

#include "base/memory.h"

namespace suite {

using h5::Reader;

MeshArrays::MeshArrays(Reader& r, const std::string& file, bool held)
    : path(file),
      raw(file),
      p(r, "/geometry/positions", "m", held),
      uv(r, "/geometry/uvs", "1", held),
      i(r, "/geometry/indices", "1", held),
      nrm(r, "/geometry/normals", "1", held) {}

void MeshArrays::read(Reader& r, const Start& s, Mesh& mesh) const {
  each(s, mesh, [&]<class T>(SharedArray<T>& array, const StoredArray<T>& from, uint64_t first, size_t n, size_t room) {
    std::vector<T> values(room);
    from.read(r, raw, first, std::span(values.data(), n));
    array = std::move(values);
  });
}

bool map_plain(const MeshArrays& arrays, std::vector<Mesh>& meshes) {
  const auto file = std::make_shared<const MappedFile>(arrays.path);
  // Behind the last vertex there is a float to be read, too.
  if (!arrays.p.usable(*file, 1) || !arrays.i.usable(*file, 0) || !arrays.nrm.usable(*file, 0) ||
      !arrays.uv.usable(*file, 0))
    return false;
  for (size_t k = 0; k < meshes.size(); ++k)
    arrays.each(arrays.starts[k], meshes[k],
                [&]<class T>(SharedArray<T>& array, const StoredArray<T>& from, uint64_t first, size_t, size_t room) {
                  array = from.in(file, first, room);
                });
  return true;
}

namespace {

// What the processes that share a spill file tell each other of a mesh. A process that dies while it fills one ends the
// job of all.
enum State : uint32_t { kUntouched, kBeingFilled, kThere };

// The part of a spill file that holds a scene: the scene's mark, a state for each mesh, and the arrays.
class Unpacking {
 public:
  Unpacking(const MeshArrays& arrays, std::shared_ptr<SpillFile> spill, std::vector<Mesh>& meshes)
      : arrays_(arrays), spill_(std::move(spill)) {
    size_t bytes = 0;
    for (size_t k = 0; k < meshes.size(); ++k) {
      begins_.push_back(bytes);
      each(meshes, k, [&]<class T>(SharedArray<T>&, const StoredArray<T>&, uint64_t, size_t, size_t room) {
        bytes += room_of<T>(room);
      });
    }
    const size_t states = sizeof(uint64_t) + sizeof(uint32_t) * meshes.size();
    states_at_ = spill_->reserve(states);
    arrays_at_ = spill_->reserve(bytes + kLine);  // so that it is never empty
    states_ = spill_->map_writable(states_at_, states);
    memory_ = spill_->map(arrays_at_, bytes + kLine);
    for (size_t k = 0; k < meshes.size(); ++k) {
      size_t at = begins_[k];
      each(meshes, k, [&]<class T>(SharedArray<T>& array, const StoredArray<T>&, uint64_t, size_t, size_t room) {
        if (room) array = SharedArray<T>(reinterpret_cast<const T*>(memory_.get() + at), room, memory_);
        at += room_of<T>(room);
      });
    }
  }

  // False when another scene, or another part of it, stands there already.
  bool mine(uint64_t mark) const {
    const std::atomic_ref there(*reinterpret_cast<uint64_t*>(states_.get()));
    uint64_t none = 0;
    return there.compare_exchange_strong(none, mark) || none == mark;
  }

  // Fills a mesh unless another process has begun to; whether it is there now.
  bool fill(Reader& r, std::vector<Mesh>& meshes, size_t k, const std::function<void(const Mesh&)>& unpacked) {
    const std::atomic_ref state(reinterpret_cast<uint32_t*>(states_.get() + sizeof(uint64_t))[k]);
    uint32_t found = kUntouched;
    if (!state.compare_exchange_strong(found, kBeingFilled, std::memory_order_acquire)) return found == kThere;
    try {
      size_t at = arrays_at_ + begins_[k];
      each(meshes, k, [&]<class T>(SharedArray<T>&, const StoredArray<T>& from, uint64_t first, size_t n, size_t room) {
        std::vector<T> values(n);
        from.read(r, arrays_.raw, first, values);
        spill_->write_at(at, std::as_bytes(std::span<const T>(values)));
        at += room_of<T>(room);
      });
      unpacked(meshes[k]);
    } catch (...) {  // the others shall find the fault themselves
      state.store(kUntouched, std::memory_order_release);
      throw;
    }
    state.store(kThere, std::memory_order_release);
    return true;
  }

 private:
  static constexpr size_t kLine = 64;  // bytes: arrays begin at whole cache lines
  template <class T>
  static size_t room_of(size_t values) {
    return (values * sizeof(T) + kLine - 1) / kLine * kLine;
  }
  template <class Part>
  void each(std::vector<Mesh>& meshes, size_t k, const Part& part) const {
    arrays_.each(arrays_.starts[k], meshes[k], part);
  }
  const MeshArrays& arrays_;
  std::shared_ptr<SpillFile> spill_;
  std::vector<size_t> begins_;
  size_t states_at_ = 0, arrays_at_ = 0;
  std::shared_ptr<std::byte> states_;
  std::shared_ptr<const std::byte> memory_;
};

// Of what is read of the file, never 0.
uint64_t mark_of(const MeshArrays& arrays) {
  uint64_t mark = 14695981039346656037u;  // FNV-1a
  const auto add = [&](uint64_t value) { mark = (mark ^ value) * 1099511628211u; };
  for (const char c : arrays.path) add(static_cast<unsigned char>(c));
  add(arrays.raw.size());
  for (const MeshArrays::Start& s : arrays.starts) add(s.vertices), add(s.triangles), add(s.normals), add(s.uvs);
  return mark ? mark : 1;
}

}  // namespace

void unpack(Reader& r, const MeshArrays& arrays, std::shared_ptr<SpillFile> spill, std::vector<Mesh>& meshes,
            const std::function<void(const Mesh&)>& unpacked) {
  std::optional<Unpacking> here;
  if (spill) here.emplace(arrays, spill, meshes);
  if (!here || !here->mine(mark_of(arrays))) here.emplace(arrays, std::make_shared<SpillFile>(), meshes);
  // Those that others are filling are waited for after all else has been begun.
  std::vector<size_t> waiting;
  for (size_t k = 0; k < meshes.size(); ++k)
    if (!here->fill(r, meshes, k, unpacked)) waiting.push_back(k);
  constexpr useconds_t kNap = 500;  // us
  for (const size_t k : waiting)
    while (!here->fill(r, meshes, k, unpacked)) ::usleep(kNap);
}

}  // namespace suite
