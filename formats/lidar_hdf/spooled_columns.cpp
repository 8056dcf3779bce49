#include "formats/lidar_hdf/spooled_columns.h"

#include <algorithm>

namespace suite {

namespace {
constexpr size_t kPiece = 1 << 20;  // bytes, a multiple of every type
}

struct SpooledColumns::Column {
  std::string units;
  h5::Id type = -1;
  size_t value_bytes = 1, count = 0;
  std::vector<std::byte> waiting;
  std::string path;
  std::unique_ptr<AtomicFile> spool;  // once there is more than fits in memory
};

SpooledColumns::SpooledColumns(const std::string& path, const std::string& made_by)
    : path_(path), file_(path), writer_(file_.temporary(), path, [](const std::string&) { return 1; }) {
  writer_.attribute("arguments", made_by);
}
SpooledColumns::~SpooledColumns() = default;

size_t SpooledColumns::size(const std::string& name) const {
  const auto found = columns_.find(name);
  return found == columns_.end() ? 0 : found->second->count;
}

void SpooledColumns::put(const std::string& name, const char* units, h5::Id type, const void* data, size_t count,
                         size_t bytes) {
  std::unique_ptr<Column>& column = columns_[name];
  if (!column) {
    column = std::make_unique<Column>();
    column->units = units, column->type = type, column->value_bytes = bytes;
    column->path = path_ + strf(".column%zu", columns_.size());
  }
  SUITE_CHECK(column->type == type);
  const auto* first = static_cast<const std::byte*>(data);
  column->waiting.insert(column->waiting.end(), first, first + count * bytes);
  column->count += count;
  if (column->waiting.size() < kPiece) return;
  if (!column->spool) column->spool = std::make_unique<AtomicFile>(column->path);
  column->spool->write(column->waiting);
  column->waiting.clear();
}

void SpooledColumns::finish() {
  for (auto& [name, c] : columns_) {
    h5::Writer::Column to = writer_.column(name, c->type, c->count, c->units.c_str());
    const auto copy = [&](std::span<const std::byte> bytes) {
      to.append_raw(c->type, bytes.data(), bytes.size() / c->value_bytes);
    };
    if (c->spool) {
      c->spool->close();
      const RandomAccessFile from(c->spool->temporary());
      std::vector<std::byte> piece;
      for (size_t at = 0; at < from.size(); at += piece.size()) {
        piece.resize(std::min(from.size() - at, kPiece));
        from.read_at(at, piece);
        copy(piece);
      }
      c->spool.reset();
    }
    copy(c->waiting);
  }
  columns_.clear();
  writer_.close();
  file_.commit();
}

}  // namespace suite
