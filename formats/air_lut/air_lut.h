// Grids of states of the air as text, and tables over them as netCDF, Zarr and CSV. FORMAT.md.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/params.h"
#include "correction/lut.h"
#include "correction/lut_kernel.h"

namespace suite {

// What a text asks for.
struct LutRequest {
  LutAxes axes = lut_axes();
  std::string sensor;  // of the simulation; empty: its only one
  LutFineness fineness;
  bool check = true;                 // one state is solved more finely, and the difference kept
  bool zarr = false;                 // the table as Zarr as well
  std::optional<KernelSpec> kernel;  // adjacency kernels are wanted
  std::array<Where, kLutAxes> where;
  Where text;  // as a whole
};

// Error, located: unknown or missing keys, values out of their ranges or not ascending.
LutRequest read_lut_request(const std::string& path);
LutRequest parse_lut_request(std::string_view text, const std::string& file_name);

// make(), whose faults are the grid's where they have no place of their own.
template <class Make>
auto located_in(const LutRequest& request, Make&& make) {
  try {
    return make();
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;
    throw Error(request.text, e.message(), e.hint());
  }
}

// States in their order; errors: one solution's differences (lut_difference), or empty lists.
struct LutResult {
  std::vector<LutState> states;
  LutValues errors;
  KernelSpec kernel;                            // of the next
  std::vector<std::vector<LutKernel>> kernels;  // [state][height], or empty
};
using LutNotes = std::vector<std::pair<std::string, std::string>>;  // attributes of the file, such as history
// Error: cannot be written.
void write_lut_netcdf(const std::string& path, const LutTable& table, const LutResult& result, const LutNotes& notes);
// The same as a folder of Zarr, version 2.
void write_lut_zarr(const std::string& path, const LutTable& table, const LutResult& result, const LutNotes& notes);
// A row for each state, view and band, under a header with units.
void write_lut_csv(const std::string& path, const LutTable& table, const LutResult& result);

}  // namespace suite
