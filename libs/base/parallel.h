// Work stealing over index ranges. Results must not depend on the order of the calls.
#pragma once
#include <cstddef>
#include <functional>

namespace suite {

// 0 = one per core. Takes effect for later calls; run_app's --threads calls it.
void set_threads(int count);
int threads();

// Who looks for the signal that ends the work (interrupt.h): parallel_for before each piece, or the body alone.
enum class StopPoints { between_pieces, in_body };

// body(begin, end) over disjoint subranges of [begin, end) of at most `grain` indices each, in parallel.
// The first exception thrown by a body is rethrown here.
void parallel_for(size_t begin, size_t end, size_t grain, const std::function<void(size_t, size_t)>& body,
                  StopPoints stop = StopPoints::between_pieces);

// body() on so many threads of their own, which may wait for each other; the first exception is rethrown here when all
// have ended.
void on_threads(int count, const std::function<void()>& body);

// Runs work whose parallel parts, while they wait, take up nothing but their own pieces. For constructions that other
// work of the same thread might be waiting for.
void isolated(const std::function<void()>& work);

}  // namespace suite
