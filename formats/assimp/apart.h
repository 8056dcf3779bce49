// Work in a process of its own, whose end is not the end of this one: for libraries that break down over damaged files.
#pragma once
#include <functional>
#include <string>

namespace suite {

// What `work` returns there. Error at `where_file`: it was ended by a signal, by the limits (memory: 1 GiB and 200
// bytes for each byte of the input; 10 minutes of the processor), or without a result.
std::string apart(const std::string& where_file, size_t input_bytes, const std::function<std::string()>& work);

}  // namespace suite
