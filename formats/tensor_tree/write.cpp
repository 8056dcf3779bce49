#include "base/error.h"
#include "formats/tensor_tree/tensor_tree.h"

namespace suite {

// A node whose branches all are leaves is a grid of two cells along each coordinate.
void TensorTree::put(const Node& node, std::string& text) const {
  const size_t branches = size_t{1} << rank_;
  auto value = [&text](const Node& leaf) { text += strf("%.5g", static_cast<double>(leaf.value)); };
  text += '{';
  bool grid = node.branches;
  for (size_t b = 0; grid && b < branches; ++b) grid = !nodes_[node.branches + b].branches;
  if (!node.branches) value(node);
  for (size_t k = 0; node.branches && k < branches; ++k) {
    if (!grid) {
      put(nodes_[node.branches + k], text);
      continue;
    }
    size_t branch = 0;  // the first coordinate of grids changes slowest, bit 0 of branches fastest
    for (size_t i = 0; i < rank_; ++i) branch |= (k >> (rank_ - 1 - i) & 1) << i;
    if (k) text += ' ';
    value(nodes_[node.branches + branch]);
  }
  text += "}\n";
}

std::string TensorTree::xml(const std::string& comment) const {
  auto safe = [](std::string text) {
    std::string out;
    for (const char c : text)
      if (c == '&')
        out += "&amp;";
      else if (c == '<')
        out += "&lt;";
      else if (c == '-' && !out.empty() && out.back() == '-')
        out += " -";  // two hyphens end a comment
      else
        out += c;
    return out;
  };
  std::string tree;
  put(nodes_[0], tree);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- " + safe(comment) +
         " -->\n<WindowElement xmlns=\"http://windows.lbl.gov\">\n<WindowElementType>System</WindowElementType>\n"
         "<Optical>\n<Layer>\n<Material><Name>" +
         safe(info_.name) +
         "</Name><Manufacturer>none</Manufacturer><DeviceType>Other</DeviceType></Material>\n"
         "<DataDefinition><IncidentDataStructure>TensorTree" +
         strf("%zu", rank_) +
         "</IncidentDataStructure></DataDefinition>\n<WavelengthData>\n<LayerNumber>System</LayerNumber>\n"
         "<Wavelength unit=\"Integral\">Visible</Wavelength>\n<WavelengthDataBlock>\n"
         "<WavelengthDataDirection>Reflection Back</WavelengthDataDirection>\n"
         "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n<ScatteringDataType>BRDF</ScatteringDataType>\n"
         "<ScatteringData>\n" +
         tree +
         "</ScatteringData>\n</WavelengthDataBlock>\n</WavelengthData>\n</Layer>\n</Optical>\n</WindowElement>\n";
}

}  // namespace suite
