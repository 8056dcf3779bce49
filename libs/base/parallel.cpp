#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "base/interrupt.h"

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void*);  // of GCC's library of the sanitizer
extern "C" void __tsan_release(void*);
#endif

namespace suite {

namespace {
// What one thread did before is seen by another afterwards: told to the thread sanitizer, which does not see how TBB's
// library, built without it, hands pieces from thread to thread.
class HandedOver {
 public:
#if defined(__SANITIZE_THREAD__)
  void release() { __tsan_release(this); }
  void acquire() { __tsan_acquire(this); }
#else
  void release() {}
  void acquire() {}
#endif
};

std::mutex g_mutex;
int g_threads = 0;
std::unique_ptr<tbb::global_control> g_control;
std::shared_ptr<tbb::task_arena> g_arena;

std::shared_ptr<tbb::task_arena> arena() {
  const std::lock_guard lock(g_mutex);
  if (!g_arena) {
    const int n = g_threads > 0 ? g_threads : tbb::info::default_concurrency();
    // More threads than cores are allowed: the bits must not depend on it, and tests prove that.
    g_control =
        std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(n));
    g_arena = std::make_shared<tbb::task_arena>(n);
  }
  return g_arena;
}
}  // namespace

void set_threads(int count) {
  const std::lock_guard lock(g_mutex);
  g_threads = count;
  g_arena.reset();
  g_control.reset();
}

int threads() { return g_threads > 0 ? g_threads : tbb::info::default_concurrency(); }

void parallel_for(size_t begin, size_t end, size_t grain, const std::function<void(size_t, size_t)>& body,
                  StopPoints stop) {
  if (begin >= end) return;
  if (grain < 1) grain = 1;
  const size_t blocks = (end - begin + grain - 1) / grain;
  const bool finish = FinishFirst::here();
  HandedOver begun, done;
  const auto piece = [&](size_t b) {
    begun.acquire();
    std::optional<FinishFirst> first;
    if (finish) first.emplace();
    if (stop == StopPoints::between_pieces) stop_point();
    body(begin + b * grain, std::min(end, begin + (b + 1) * grain));
    done.release();
  };
  const std::shared_ptr<tbb::task_arena> here = arena();  // another thread may set another number of threads meanwhile
  begun.release();
  here->execute([&] { tbb::parallel_for(size_t{0}, blocks, piece, tbb::simple_partitioner()); });
  done.acquire();
}

void on_threads(int count, const std::function<void()>& body) {
  std::exception_ptr first;
  std::mutex mutex;
  const auto guarded = [&] {
    try {
      body();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!first) first = std::current_exception();
    }
  };
  std::vector<std::jthread> others;
  for (int k = 1; k < count; ++k) others.emplace_back(guarded);
  guarded();
  others.clear();  // waits for them
  if (first) std::rethrow_exception(first);
}

void isolated(const std::function<void()>& work) {
  tbb::this_task_arena::isolate([&] { work(); });
}

}  // namespace suite
