#include "formats/air_lut/zarr.h"

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/outputs.h"

namespace suite {

ZarrWriter::ZarrWriter(std::string path) : path_(std::move(path)), folder_(path_ + ".part") {
  std::filesystem::remove_all(folder_);
  make_folder(folder_);
}

void ZarrWriter::keep(const std::string& name, Json value) {
  write_file(in_folder(folder_, name), std::string_view(value.text()));
  metadata_.set(name, std::move(value));
}

void ZarrWriter::dimension(const std::string& name, std::span<const double> values, const Texts& texts) {
  sizes_[name] = values.size();
  array(name, {name}, values, texts);
}

void ZarrWriter::variable(const std::string& name, const std::vector<std::string>& dimensions,
                          std::span<const double> values, const Texts& texts) {
  array(name, dimensions, values, texts);
}

void ZarrWriter::array(const std::string& name, const std::vector<std::string>& dimensions,
                       std::span<const double> values, const Texts& texts) {
  Json shape = Json::array(), chunks = Json::array(), names = Json::array(), about = Json::object();
  std::string chunk = "0";
  size_t count = 1;
  for (size_t d = 0; d < dimensions.size(); ++d) {
    const size_t size = sizes_.at(dimensions[d]);
    shape.push(size), chunks.push(size), names.push(dimensions[d]);
    count *= size;
    if (d > 0) chunk += ".0";
  }
  SUITE_CHECK_EQ(count, values.size());
  about.set("zarr_format", 2);
  about.set("shape", std::move(shape));
  about.set("chunks", std::move(chunks));
  about.set("dtype", "<f8");
  about.set("compressor", Json(std::nan("")));  // null
  about.set("fill_value", Json(std::nan("")));
  about.set("filters", Json(std::nan("")));
  about.set("order", "C");
  Json attributes = Json::object();
  attributes.set("_ARRAY_DIMENSIONS", std::move(names));
  for (const auto& [key, text] : texts) attributes.set(key, text);
  make_folder(in_folder(folder_, name));
  keep(name + "/.zarray", std::move(about));
  keep(name + "/.zattrs", std::move(attributes));
  write_file(in_folder(folder_, name + "/" + chunk), std::as_bytes(values));
}

void ZarrWriter::close() {
  Json group = Json::object(), all = Json::object();
  group.set("zarr_format", 2);
  keep(".zgroup", std::move(group));
  keep(".zattrs", std::move(attributes_));
  all.set("zarr_consolidated_format", 1);
  all.set("metadata", std::move(metadata_));
  write_file(in_folder(folder_, ".zmetadata"), std::string_view(all.text()));
  std::error_code failed;
  std::filesystem::remove_all(path_, failed);
  std::filesystem::rename(folder_, path_, failed);
  if (failed) throw Error(Where{path_, 0, 0, {}, -1}, "cannot be written: " + failed.message());
}

}  // namespace suite
