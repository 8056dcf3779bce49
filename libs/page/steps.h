// Codes of pixels (packed.h) in as few bits as the steps between neighbours take, without loss: what a page of many
// bands is made of. Any 64 of them can be read without the others.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace suite {

// Blocks of 64 codes (the last one filled up), all numbers little-endian and modulo 2^16. First a head of three bytes
// for each block: bits 0 to 15 a code, 16 to 20 the width w of its steps in bits (0 to 16), 21 whether the codes of
// `base` are taken off (r = code - base, else r = code), 22 whether steps are counted from the first of the block or
// from the one before. Then the steps of each block, 8 w bytes: 64 numbers of w bits, lowest bits first, step s as 2 s
// or -2 s - 1; the code of the head is r of the block's first, whose step is 0. The writer takes what is shortest for
// each block. Based on: differential coding and binary packing by blocks (D. Lemire & L. Boytsov, "Decoding billions of
// integers per second through vectorization", Software: Practice and Experience 45, 2015, section 2). base: codes of a
// similar picture, as many as `codes`, or none.
std::vector<std::byte> in_steps(std::span<const uint16_t> codes, std::span<const uint16_t> base = {});

}  // namespace suite
