// Numbers in texts that the library would read wrongly. Internal to formats/assimp.
#pragma once
#include <span>
#include <string>

namespace suite {

// Error, located, at the first number of a text FBX or a Collada file that the library reads as another one: of more
// than 31 characters in FBX (0), of whole parts beyond 64 bits (the rest of a division), of digits behind the 15th
// decimal that an exponent makes count.
void check_long_numbers(std::span<const std::byte> bytes, const std::string& file, const std::string& extension);

}  // namespace suite
