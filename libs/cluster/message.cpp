#include "cluster/message.h"

#include <cstring>
#include <type_traits>

#include "base/error.h"

namespace suite::cluster {

static_assert(std::is_trivially_copyable_v<Head>);

namespace {

// visit(row, width) of each row, column by column.
template <class Byte, class Visit>
void for_rows(const std::array<Accumulators::Column<Byte>, Accumulators::kColumns>& columns, int scrambles,
              size_t problems, Scrambles of, const Visit& visit) {
  for (const auto& column : columns)
    for (size_t i = 0; column.width && i < problems; ++i)
      for (int s = 0; s < scrambles; ++s)
        if (of >> s & 1)
          visit(column.data + (i * static_cast<size_t>(scrambles) + static_cast<size_t>(s)) * column.width,
                column.width);
}

}  // namespace

std::vector<std::byte> pack(const Head& head, const Accumulators& sums, size_t problems, Scrambles scrambles) {
  size_t size = sizeof(Head);
  for_rows(sums.columns(), sums.scrambles(), problems, scrambles, [&](const std::byte*, size_t n) { size += n; });
  std::vector<std::byte> bytes(size);
  std::memcpy(bytes.data(), &head, sizeof(Head));
  std::byte* to = bytes.data() + sizeof(Head);
  for_rows(sums.columns(), sums.scrambles(), problems, scrambles, [&](const std::byte* row, size_t n) {
    std::memcpy(to, row, n);
    to += n;
  });
  return bytes;
}

Head head_of(std::span<const std::byte> bytes) {
  SUITE_CHECK(bytes.size() >= sizeof(Head));
  Head head;
  std::memcpy(&head, bytes.data(), sizeof(Head));
  return head;
}

void unpack(std::span<const std::byte> bytes, size_t problems, Scrambles scrambles, Accumulators& sums) {
  bytes = bytes.subspan(sizeof(Head));
  for_rows(sums.columns(), sums.scrambles(), problems, scrambles, [&](std::byte* row, size_t n) {
    SUITE_CHECK(n <= bytes.size());
    std::memcpy(row, bytes.data(), n);
    bytes = bytes.subspan(n);
  });
  SUITE_CHECK(bytes.empty());
}

}  // namespace suite::cluster
