// Seeded mutations of a valid input, for any reader: truncate, flip bits, overwrite sizes with huge or odd numbers,
// copy and cut blocks, and for texts splice in words that the grammar gives meaning to. A reader may accept or throw
// suite::Error; anything else (another exception, a signal, a sanitizer report, a slow or memory-hungry parse) fails
// the test.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "math/sampling.h"
#include "support/cpu_clock.h"

namespace suite::test {

using Bytes = std::vector<std::byte>;
inline Bytes bytes_of(std::string_view text) {
  Bytes b(text.size());
  std::memcpy(b.data(), text.data(), text.size());
  return b;
}

// A mutation as a file, for readers of files. A file that is there goes first: one that is replaced, some file systems
// bring to the disk at once, which takes longer than most mutations do.
inline void put_file(const std::string& path, std::span<const std::byte> bytes) {
  std::filesystem::remove(path);
  write_file(path, bytes);
}

class Mutator {
 public:
  // words: spliced in at random places, or put in place of others; none for binary formats.
  explicit Mutator(uint64_t seed, std::vector<std::string> words = {}) : random_(seed), words_(std::move(words)) {}

  Bytes operator()(const Bytes& seed_input) {
    Bytes b = seed_input;
    const size_t steps = 1 + below(3);
    for (size_t s = 0; s < steps && !b.empty(); ++s) step(b);
    return b;
  }

 private:
  size_t below(size_t n) { return n ? static_cast<size_t>(random_.uniform() * static_cast<double>(n)) : 0; }
  // Headers are where the sizes live: half of the positions fall into the first 512 bytes.
  size_t position(size_t size) { return random_.uniform() < 0.5 ? below(std::min<size_t>(size, 512)) : below(size); }

  void step(Bytes& b) {
    const size_t at = position(b.size());
    switch (below(words_.empty() ? 6 : 10)) {
      case 0:
        b.resize(at);
        break;
      case 1:
        b[at] ^= std::byte(1u << below(8));
        break;
      case 2:
        overwrite(b, at);
        break;
      case 3: {
        const Bytes head(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(std::min(b.size(), below(64))));
        b.insert(b.begin() + static_cast<std::ptrdiff_t>(at), head.begin(), head.end());
        break;
      }
      case 4:
        b.erase(b.begin() + static_cast<std::ptrdiff_t>(at),
                b.begin() + static_cast<std::ptrdiff_t>(std::min(b.size(), at + 1 + below(64))));
        break;
      case 5:
        b[at] = std::byte(below(256));
        break;
      default:
        splice(b, at);
        break;
    }
  }
  void splice(Bytes& b, size_t at) {
    const Bytes word = bytes_of(words_[below(words_.size())]);
    const size_t replaced = below(2) ? 0 : std::min(b.size() - at, below(20));
    const auto place = b.begin() + static_cast<std::ptrdiff_t>(at);
    b.insert(b.erase(place, place + static_cast<std::ptrdiff_t>(replaced)), word.begin(), word.end());
  }
  void overwrite(Bytes& b, size_t at) {
    static constexpr uint64_t odd[] = {0,
                                       1,
                                       0x7f,
                                       0x80,
                                       0xff,
                                       0x7fff,
                                       0xffff,
                                       0x7fffffff,
                                       0x80000000,
                                       0xffffffff,
                                       1ull << 32,
                                       1ull << 40,
                                       0x7fffffffffffffff,
                                       0x8000000000000000,
                                       0xffffffffffffffff,
                                       0x7ff0000000000000,
                                       0x7ff8000000000000,
                                       0x7fc00000};
    const uint64_t value = odd[below(std::size(odd))];
    const size_t width = size_t{1} << below(4);
    std::memcpy(b.data() + at, &value, std::min(width, b.size() - at));
  }
  Pcg32 random_;
  std::vector<std::string> words_;
};

// How many mutations of an input are tried: SUITE_FUZZ_COUNT of the environment, else kMutations or fewer where each
// takes long. Always as many and the same ones, however fast the machine is.
inline constexpr size_t kMutations = 1000;
inline size_t mutations(size_t most) {
  const char* asked = std::getenv("SUITE_FUZZ_COUNT");
  return asked ? std::strtoull(asked, nullptr, 10) : std::min(most, kMutations);
}

// Runs `read` on mutations of `input`, `most` or as many as mutations() says. At least one must be refused, and the
// input itself must be accepted.
inline void fuzz(const Bytes& input, const std::function<void(std::span<const std::byte>)>& read, uint64_t seed = 1,
                 size_t most = kMutations, const std::vector<std::string>& words = {}) {
  ASSERT_NO_THROW(read(input));
  const auto start = std::chrono::steady_clock::now();
  auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const size_t count = mutations(most);
  Mutator mutate(seed, words);
  size_t done = 0, refused = 0;
  for (; done < count; ++done) {
    const Bytes b = mutate(input);
    const double before = cpu_seconds();
    try {
      read(b);
    } catch (const Error& e) {
      ++refused;
      ASSERT_FALSE(e.where().file.empty()) << "mutation " << done << ": no place in: " << e.what();
    } catch (const std::exception& e) {
      FAIL() << "mutation " << done << " of seed " << seed << ": " << e.what();
    }
    // Of the processor, for others may keep it from this process; what hangs without it, ctest ends.
    ASSERT_LT(cpu_seconds() - before, 2.0) << "mutation " << done << " of seed " << seed << " took too long";
  }
  ::testing::Test::RecordProperty("mutations", static_cast<int>(done));
  std::printf("%zu mutations, %zu refused, %.1f s\n", done, refused, elapsed());
  EXPECT_GT(refused, size_t{0});
}

}  // namespace suite::test
