// Damaged responses: read, or one Error.
#include "base/files.h"
#include "formats/response/response_file.h"
#include "support/fuzz.h"
#include "support/response_kit.h"
#include "support/temp_folder.h"

namespace suite::format_response_response_test {

TEST(FuzzResponse, File) {
  const TempFolder folder;
  const std::string path = folder / "r.h5";
  const ResponseHead head = test::response_head(2, 1);
  ResponseWriter writer(path, head, "a test", 8);
  for (uint64_t p = 0; p < 4; p += 2) writer.take(test::response_block(head, p, 2));
  writer.finish();
  test::fuzz(read_bytes(path), [&](std::span<const std::byte> mutated) {
    test::put_file(path, mutated);
    const ResponseReader reader(path);
    reader.for_each_block([&](const ResponseBlock& b) {
      for (size_t row = 0; row < b.row_count(); ++row) ResponseRow(reader.head(), b, row).known(501);
    });
  });
}

}  // namespace suite::format_response_response_test
