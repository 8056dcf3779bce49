// The large arrays of all meshes of a prepared scene, one behind the other in four datasets, and the three ways to get
// them: read into memory; as the mapped file itself; unpacked into a file that is mapped. Internal.
#pragma once
#include "base/files.h"
#include "base/mapped_file.h"
#include "formats/scene_hdf/internal.h"
#include "scene/scene.h"

namespace suite {

// One of the datasets. A plain one is contiguous and little-endian, as this machine is, and may be read past the HDF5
// library, which knows one thread only.
template <class T>
class StoredArray {
 public:
  // held: what is packed in it is going to be held in memory, which must have room for it.
  StoredArray(h5::Reader& r, const std::string& name, const char* units, bool held)
      : name_(name), opened_(r.open(name, h5::native<T>(), units, 1, -1, held)) {
    if (!opened_.packed) offset_ = r.file_offset(name, opened_);
  }
  // Sets aside the next n values; where they start.
  uint64_t take(h5::Reader& r, uint64_t n) {
    if (n > opened_.count - at_) r.fail("dataset '" + name_ + "' is shorter than its table says");
    at_ += n;
    return at_ - n;
  }
  void finish(h5::Reader& r) const {
    if (at_ != opened_.count) r.fail("dataset '" + name_ + "' is longer than its table says");
  }
  const std::string& name() const { return name_; }
  bool packed() const { return opened_.packed; }
  // Whether the values, and `beyond` more behind them, can be used where they lie in a mapped file.
  bool usable(const MappedFile& file, size_t beyond) const {
    const size_t values = opened_.count ? opened_.count + beyond : 0;
    return !opened_.packed && offset_ % alignof(T) == 0 && offset_ <= file.readable() &&
           values <= (file.readable() - offset_) / sizeof(T);
  }
  SharedArray<T> in(const std::shared_ptr<const MappedFile>& file, uint64_t first, size_t n) const {
    if (n == 0) return {};
    return {reinterpret_cast<const T*>(file->data() + offset_) + first, n, file};
  }
  // From one thread when it is packed, else from any.
  void read(h5::Reader& r, const RandomAccessFile& file, uint64_t first, std::span<T> out) const {
    if (opened_.packed)
      r.read(name_, opened_, h5::native<T>(), out.data(), first, out.size());
    else
      file.read_at(offset_ + first * sizeof(T), std::as_writable_bytes(out));
  }

 private:
  std::string name_;
  h5::Reader::Opened opened_;
  uint64_t offset_ = 0, at_ = 0;
};

struct MeshArrays {
  MeshArrays(h5::Reader& r, const std::string& file, bool held);
  // Where those of a mesh start, how many there are, and what is wanted of them.
  struct Start {
    uint64_t p, i, n, uv;
    uint64_t vertices, triangles;
    bool normals, uvs;
    uint64_t bytes() const {
      return 12 * vertices + 12 * triangles + (normals ? 4 : 0) * vertices + (uvs ? 8 : 0) * vertices;
    }
  };
  bool packed() const { return p.packed() || uv.packed() || i.packed() || nrm.packed(); }
  // Into memory of the mesh's own.
  void read(h5::Reader& r, const Start& s, Mesh& mesh) const;
  // Calls part(array of the mesh, the dataset, first value, count, values of room) for each array that is wanted.
  template <class Part>
  void each(const Start& s, Mesh& mesh, const Part& part) const {
    part(mesh.positions, p, s.p, 3 * s.vertices, 3 * s.vertices + (s.vertices ? 1 : 0));
    part(mesh.indices, i, s.i, 3 * s.triangles, 3 * s.triangles);
    if (s.normals) part(mesh.normals, nrm, s.n, s.vertices, s.vertices);
    if (s.uvs) part(mesh.uvs, uv, s.uv, 2 * s.vertices, 2 * s.vertices);
  }

  std::string path;
  RandomAccessFile raw;
  StoredArray<float> p, uv;
  StoredArray<uint32_t> i, nrm;
  std::vector<Start> starts;  // one a mesh
};

// Lets the arrays of the meshes be the file itself; false, with nothing done, when some cannot be used as they lie.
bool map_plain(const MeshArrays& arrays, std::vector<Mesh>& meshes);

// Unpacks all meshes into a file that they are mapped from. spill: shared with other processes that read the same
// scene, each mesh being unpacked by the first that comes; null = one of this process alone. Calls unpacked(mesh) for
// those that this process has unpacked, which checks them.
void unpack(h5::Reader& r, const MeshArrays& arrays, std::shared_ptr<SpillFile> spill, std::vector<Mesh>& meshes,
            const std::function<void(const Mesh&)>& unpacked);

}  // namespace suite
