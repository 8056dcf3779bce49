// The global heaps of a damaged HDF5 file, where texts of variable length lie.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace suite::h5 {

// Where an object of a global heap has a size that leads nowhere, or beyond its heap; nothing where all are whole. The
// HDF5 library (1.10) follows such sizes without end. bytes: of the whole file, with lengths of eight bytes.
// Based on: HDF5 File Format Specification 3.0, section III.E.
std::optional<size_t> broken_global_heap(std::span<const std::byte> bytes);
std::optional<size_t> broken_global_heap(const std::string& path);  // Error as MappedFile

}  // namespace suite::h5
