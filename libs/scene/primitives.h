// The table of exact surfaces: names, parameters and extents. Each lives in its own local frame, m.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "scene/scene.h"

namespace suite {

struct PrimitiveParameter {
  std::string name, unit, summary;
  double low, high;                 // valid range
  std::optional<double> otherwise;  // value when not given; none = required
};

struct PrimitiveRow {
  std::string name;  // "sphere"
  PrimitiveKind kind;
  std::string summary;                         // where it stands in its local frame, and what its UVs are
  std::vector<PrimitiveParameter> parameters;  // in the order of Primitive::parameters
};

// One row per PrimitiveKind, in its order. A sinusoid has, after the listed ones, four more parameters per term:
// amplitude m, kx 1/m, ky 1/m, phase rad.
std::span<const PrimitiveRow> primitive_rows();

// Is the box of these parameters a layer without end, from z0 to z1?
bool is_layer(std::span<const double> box_parameters);

// Extent in the local frame; empty when infinite. Error when parameters are missing or out of range (files are not
// trusted).
Box3 primitive_box(const Primitive& primitive);
void check_primitive(const Primitive& primitive, const Where& where);

}  // namespace suite
