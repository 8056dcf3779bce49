// Sensors that were built outside the tree, against sdk/suite_sensor.h alone.
#pragma once
#include <string>

namespace suite {

// Loads a shared library and adds its kind to the table of sensor kinds; it stays loaded. Returns the name of the kind.
// Error, naming the file: cannot be loaded, exports no entry point, was built for another version of the interface,
// gives no kind or one that exists already.
std::string load_plugin(const std::string& path);

}  // namespace suite
