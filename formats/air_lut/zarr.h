// Zarr stores (version 2) in a folder, each array one chunk without compression, with the names of dimensions that
// xarray looks for and consolidated metadata.
//
// Based on: "Zarr storage specification version 2", zarr-specs.readthedocs.io; xarray's "Zarr Encoding Specification"
// (_ARRAY_DIMENSIONS).
#pragma once
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/json.h"

namespace suite {

// Writes into a folder of its own; close() moves it to its place, over another of its name.
class ZarrWriter {
 public:
  using Texts = std::vector<std::pair<std::string, std::string>>;
  // Error when it cannot be made or written, here and below.
  explicit ZarrWriter(std::string path);

  // A dimension with its coordinates.
  void dimension(const std::string& name, std::span<const double> values, const Texts& texts);
  // Values over dimensions, the last one fastest; of none: a scalar. Bug: another number of values.
  void variable(const std::string& name, const std::vector<std::string>& dimensions, std::span<const double> values,
                const Texts& texts);
  void attribute(const std::string& name, const std::string& text) { attributes_.set(name, text); }
  void attribute(const std::string& name, long long value) { attributes_.set(name, value); }
  void close();

 private:
  void array(const std::string& name, const std::vector<std::string>& dimensions, std::span<const double> values,
             const Texts& texts);
  // Writes a text of metadata, and keeps it for all of them together.
  void keep(const std::string& name, Json value);

  std::string path_, folder_;
  std::map<std::string, size_t> sizes_;  // of dimensions
  Json attributes_ = Json::object(), metadata_ = Json::object();
};

}  // namespace suite
