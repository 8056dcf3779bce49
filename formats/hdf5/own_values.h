// Whether an object of a file holds its values itself: links, layouts and sizes that lead elsewhere or claim more than
// the file can hold. What both readers look at before they follow or allocate.
#pragma once
#include <string>

#include "formats/hdf5/h5.h"

namespace suite::h5 {

// The first step on the way to `name` that leads into another file, or empty. Also where a step is missing.
std::string external_step(Id file, const std::string& name);
// To open a dataset or group with: no link, of whatever kind, leads into another file.
Handle within_the_file(Id access_class);
// Whether every step on the way is there; false also where it leads into another file.
bool linked(Id file, const std::string& name);
// What is wrong with a dataset that keeps its values elsewhere, or empty; create: its creation properties.
std::string elsewhere(Id create);
// What is wrong with a dataset whose packed values unpack to `bytes` in a file of `file_bytes`, or empty: packing that
// good is that of a claim. Scenes, air and temperatures of this suite pack to a fortieth at best.
std::string overclaim(unsigned long long bytes, unsigned long long file_bytes);

}  // namespace suite::h5
