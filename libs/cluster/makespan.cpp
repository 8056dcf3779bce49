#include "cluster/makespan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>

#include "base/error.h"

namespace suite::cluster {

namespace {

// What happens at a time: a thread is free, its question for sums arrives, or its result does.
struct Event {
  enum class Kind : uint8_t { free, asked, result };
  double time = 0;  // s
  Kind kind = Kind::free;
  int rank = 0;
  uint32_t piece = 0;
  bool operator>(const Event& o) const { return time > o.time; }
};

class Play {
 public:
  Play(std::span<const TimedPiece> pieces, int ranks, int threads, const LinkCosts& link)
      : pieces_(pieces), link_(link) {
    for (int t = 0; t < threads; ++t)
      for (int r = 0; r < ranks; ++r) events_.push({0, Event::Kind::free, r, 0});
  }
  double end() {
    while (!events_.empty()) {
      const Event e = events_.top();
      events_.pop();
      last_ = std::max(last_, e.time);
      switch (e.kind) {
        case Event::Kind::free:
          if (next_ < pieces_.size()) fetch(e);
          break;
        case Event::Kind::asked:
          work(taken(e) + travel(e.piece), e.rank, e.piece);
          break;
        case Event::Kind::result:
          last_ = std::max(last_, taken(e));
          break;
      }
    }
    return last_;
  }

 private:
  double travel(uint32_t piece) const { return link_.message + pieces_[piece].bytes / link_.rate; }
  // The first rank handles one message after the other.
  double taken(const Event& e) { return taker_ = std::max(taker_, e.time) + pieces_[e.piece].bytes / link_.take; }
  void fetch(const Event& e) {
    const uint32_t piece = next_++;
    if (e.rank == 0) return events_.push({e.time + pieces_[piece].seconds, Event::Kind::free, 0, piece});
    const double fetched = e.time + link_.fetch;
    if (!pieces_[piece].continues) return work(fetched, e.rank, piece);
    events_.push({fetched + link_.message, Event::Kind::asked, e.rank, piece});
  }
  void work(double from, int rank, uint32_t piece) {
    const double done = from + pieces_[piece].seconds;
    events_.push({done, Event::Kind::free, rank, piece});
    events_.push({done + travel(piece), Event::Kind::result, rank, piece});
  }

  std::span<const TimedPiece> pieces_;
  const LinkCosts& link_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  uint32_t next_ = 0;
  double taker_ = 0, last_ = 0;
};

}  // namespace

Makespan makespan_of(std::span<const TimedPiece> pieces, int ranks, int threads, const LinkCosts& link) {
  SUITE_CHECK(ranks >= 1 && threads >= 1);
  Makespan m;
  for (const TimedPiece& piece : pieces) m.busy += piece.seconds;
  constexpr double free = std::numeric_limits<double>::infinity();
  m.trace = Play(pieces, ranks, threads, {0, 0, free, free}).end();
  m.whole = std::max(m.trace, Play(pieces, ranks, threads, link).end());
  return m;
}

double broadcast_seconds(double bytes, int ranks, const LinkCosts& link) {
  return ranks < 2 ? 0 : std::ceil(std::log2(ranks)) * (link.message + bytes / link.rate);
}

}  // namespace suite::cluster
