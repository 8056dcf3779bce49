// Rounds on their way from the process that leads a job to the others.
#include <cstring>

#include "base/error.h"
#include "scheduler/executor.h"

namespace suite {

namespace {

template <class T>
void put(std::vector<std::byte>& to, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto* const from = reinterpret_cast<const std::byte*>(&value);
  to.insert(to.end(), from, from + sizeof(T));
}

void put_all(std::vector<std::byte>& to, const std::vector<uint32_t>& values) {
  put(to, uint64_t{values.size()});
  const auto* const from = reinterpret_cast<const std::byte*>(values.data());
  to.insert(to.end(), from, from + values.size() * sizeof(uint32_t));
}

// Takes values off the front.
class Taker {
 public:
  explicit Taker(std::span<const std::byte> bytes) : bytes_(bytes) {}
  bool left() const { return !bytes_.empty(); }
  template <class T>
  T get() {
    T value;
    copy(&value, sizeof(T));
    return value;
  }
  std::vector<uint32_t> get_all() {
    std::vector<uint32_t> values(get<uint64_t>());
    copy(values.data(), values.size() * sizeof(uint32_t));
    return values;
  }

 private:
  void copy(void* to, size_t n) {
    SUITE_CHECK(n <= bytes_.size());
    if (n) std::memcpy(to, bytes_.data(), n);
    bytes_ = bytes_.subspan(n);
  }
  std::span<const std::byte> bytes_;
};

}  // namespace

SentRound sent_round(uint32_t capture, const Round& round) {
  SentRound sent{capture, round.stream, round.shape, {}, {round.to.begin(), round.to.end()}};
  for (const Block& b : round.blocks)
    sent.blocks.push_back(static_cast<uint32_t>(number_of(b, round.capture->columns)));
  return sent;
}

Round round_of(const SentRound& sent, const Pipeline& pipeline, const Sensor& sensor, const Capture& capture) {
  const std::vector<Block> all = blocks_of(capture);
  Round round{&pipeline, &sensor, &capture, sent.stream, {}, sent.to, sent.shape, nullptr, {}};
  for (const uint32_t b : sent.blocks) round.blocks.push_back(all.at(b));
  return round;
}

void exchange(Executor& executor, std::vector<SentRound>& rounds, uint32_t& number) {
  std::vector<std::byte> bytes;
  if (executor.leads()) {
    put(bytes, number);
    for (const SentRound& r : rounds) {
      put(bytes, r.capture), put(bytes, r.stream), put(bytes, r.shape);
      put_all(bytes, r.blocks), put_all(bytes, r.to);
    }
  }
  executor.broadcast(bytes);
  if (executor.leads()) return;
  Taker from(bytes);
  number = from.get<uint32_t>();
  for (rounds.clear(); from.left();) {
    SentRound r;
    r.capture = from.get<uint32_t>(), r.stream = from.get<uint64_t>(), r.shape = from.get<Accumulators::Shape>();
    r.blocks = from.get_all(), r.to = from.get_all();
    rounds.push_back(std::move(r));
  }
}

}  // namespace suite
