// Every placed mesh, flattened, in scene ENU.
#include "base/files.h"
#include "formats/obj/obj.h"
#include "scene/leaves.h"

namespace suite {

namespace {

class ObjWriter {
 public:
  ObjWriter(const Scene& scene, const std::string& path) : scene_(scene), file_(path) {}

  void run(double time) {
    text_ = "# " + scene_.name + ", scene coordinates east, north, up in metres\n";
    const Leaves leaves(scene_);
    for (uint64_t k = 0; k < leaves.count(); ++k) {
      const std::optional<Leaf> leaf = leaves.at(k, time);
      if (!leaf) continue;
      if (leaf->kind == TargetKind::mesh)
        mesh(scene_.meshes[leaf->target], leaf->place, leaf->material_override);
      else
        ++left_out_;
    }
    flush();
    file_.commit();
  }
  size_t left_out() const { return left_out_; }

 private:
  void flush() {
    file_.write(text_);
    text_.clear();
  }
  void mesh(const Mesh& m, const Affine3& to_world, uint32_t over) {
    const bool mirrored = to_world.determinant() < 0;
    text_ += strf("o %s.%zu\n", m.name.c_str(), ++count_);
    for (size_t i = 0; i < m.vertex_count(); ++i) {
      const Vec3 p =
          to_world.point(m.origin + Vec3{m.positions[3 * i], m.positions[3 * i + 1], m.positions[3 * i + 2]});
      text_ += strf("v %.6f %.6f %.6f\n", p.x, p.y, p.z);
    }
    for (size_t i = 0; i < m.uvs.size(); i += 2) text_ += strf("vt %.9g %.9g\n", m.uvs[i], m.uvs[i + 1]);
    for (const uint32_t code : m.normals) {
      const Vec3 n = normalized(to_world.normal(oct_decode(code)));
      text_ += strf("vn %.5f %.5f %.5f\n", mirrored ? -n.x : n.x, mirrored ? -n.y : n.y, mirrored ? -n.z : n.z);
    }
    for (const Part& part : m.parts) {
      const uint32_t id = over != kNone ? over : part.material;
      if (!part.name.empty()) text_ += "g " + part.name + "\n";
      if (id != kNone) text_ += "usemtl " + scene_.materials[id].id + "\n";
      for (size_t t = part.first_triangle; t < size_t{part.first_triangle} + part.triangle_count; ++t) {
        text_ += 'f';
        for (const size_t k : {size_t{0}, size_t{mirrored ? 2u : 1u}, size_t{mirrored ? 1u : 2u}})
          corner(m, m.indices[3 * t + k]);
        text_ += '\n';
        if (text_.size() > (1 << 20)) flush();
      }
    }
    vertices_ += m.vertex_count(), uvs_ += m.uvs.size() / 2, normals_ += m.normals.size();
  }
  void corner(const Mesh& m, size_t v) {
    text_ += strf(" %zu", vertices_ + v + 1);
    if (!m.uvs.empty() || !m.normals.empty()) text_ += '/';
    if (!m.uvs.empty()) text_ += strf("%zu", uvs_ + v + 1);
    if (!m.normals.empty()) text_ += strf("/%zu", normals_ + v + 1);
  }

  const Scene& scene_;
  AtomicFile file_;
  std::string text_;
  size_t vertices_ = 0, uvs_ = 0, normals_ = 0, count_ = 0, left_out_ = 0;
};

}  // namespace

size_t write_obj(const Scene& scene, double time, const std::string& path) {
  ObjWriter writer(scene, path);
  writer.run(time);
  return writer.left_out();
}

}  // namespace suite
