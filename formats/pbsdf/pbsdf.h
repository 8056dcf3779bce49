// .pbsdf: measured polarised BRDFs of isotropic surfaces as tensor files (FORMAT.md).
// Based on: S. Baek, T. Zeltner, H. Ku, I. Hwang, X. Tong, W. Jakob, M. Kim, "Image-based acquisition and modeling of
// polarimetric reflectance", ACM TOG 39(4), 2020; the fields and frames as Mitsuba 3's `measured_polarized` reads them.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/tensor_file/tensor_file.h"
#include "sqt_fit/mueller_brdf.h"

namespace suite {

// Whether a tensor file holds Mueller matrices rather than an RGL BRDF.
inline bool is_pbsdf(const TensorFile& file) { return file.has("M"); }

// Error: fields missing or of the wrong type or shape, axes that do not ascend, no data.
std::shared_ptr<const sqt::MuellerBrdf> parse_pbsdf(std::span<const std::byte> bytes, const std::string& file_name);

}  // namespace suite
