// How long ranks take for the pieces of a run: the hand-out of executor.cpp, played through with clocks instead of
// work.
#pragma once
#include <span>
#include <vector>

namespace suite {

// What ranks pay for talking to each other.
struct LinkCosts {
  double fetch = 2e-6;    // s, of the next piece's number by a thread of another rank than the first
  double message = 1e-5;  // s, of a message, beside its bytes
  double rate = 1e9;      // bytes/s, of messages
  double take = 2e9;      // bytes/s, at which the first rank puts results where they belong, one after the other
};

namespace cluster {

// A piece as threads meet it.
struct TimedPiece {
  double seconds = 0;      // of one thread
  double bytes = 0;        // of its result
  bool continues = false;  // another rank has to ask for the sums so far, which are as many bytes
};

struct Makespan {
  double busy = 0;   // s, of all threads at the pieces themselves
  double trace = 0;  // s, to the end of the last piece if talking took no time
  double whole = 0;  // s, until the first rank has all results
};

// Pieces are fetched in their order. ranks, threads (of each): at least 1.
Makespan makespan_of(std::span<const TimedPiece> pieces, int ranks, int threads, const LinkCosts& link);
// Bytes that all ranks are told by the first.
double broadcast_seconds(double bytes, int ranks, const LinkCosts& link);

}  // namespace cluster
}  // namespace suite
