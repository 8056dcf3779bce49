// The transforms of nodes.
// Based on: Khronos Group, "glTF 2.0 Specification", 2021, section 3.5.3.
#include "formats/gltf/load.h"

namespace suite::gltf {

namespace {

void check_numbers(const std::vector<double>& numbers, size_t count, const std::string& file,
                   const std::string& pointer) {
  if (!numbers.empty() && numbers.size() != count)
    throw fault(file, pointer, strf("%zu numbers, %zu are needed", numbers.size(), count));
  for (const double v : numbers)
    if (!(std::fabs(v) <= kLargestNumber)) throw fault(file, pointer, "a number larger than 1e30");
}

}  // namespace

std::vector<Local> locals_of(const tinygltf::Model& model, const std::string& file, double unit_m) {
  std::vector<Local> locals;
  for (size_t k = 0; k < model.nodes.size(); ++k) {
    const tinygltf::Node& node = model.nodes[k];
    const std::string at = strf("nodes[%zu]/", k);
    check_numbers(node.matrix, 16, file, at + "matrix");
    check_numbers(node.translation, 3, file, at + "translation");
    check_numbers(node.rotation, 4, file, at + "rotation");
    check_numbers(node.scale, 3, file, at + "scale");
    Local& local = locals.emplace_back();
    if (const auto& m = node.matrix; !m.empty()) {  // column by column
      if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
        throw fault(file, at + "matrix", "the last row is not 0 0 0 1");
      local.at_rest = {{m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]}, Vec3{m[12], m[13], m[14]} * unit_m};
      continue;
    }
    Pose pose;
    if (const auto& t = node.translation; !t.empty()) pose.translation = Vec3{t[0], t[1], t[2]} * unit_m;
    if (const auto& r = node.rotation; !r.empty()) {
      const Quat q{r[3], r[0], r[1], r[2]};
      if (!(dot(q, q) > 1e-12)) throw fault(file, at + "rotation", "a quaternion without length");
      pose.rotation = normalized(q);
    }
    if (const auto& s = node.scale; !s.empty()) local.scale = scaling({s[0], s[1], s[2]});
    local.at_rest = pose.affine() * local.scale;
  }
  return locals;
}

}  // namespace suite::gltf
