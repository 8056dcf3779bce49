// Meshes are checked side by side. Libraries that set themselves up at their first use do so once for a process, so
// each try is a process of its own.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <thread>
#include <vector>

#include "mesh/check.h"

namespace suite::threads_test {
namespace {

constexpr int kTries = 120, kThreads = 4;

// A child in which some threads count the loop around one triangle at the same moment. 0 = all of them found one.
int first_use_at_once() {
  std::atomic<int> waiting = 0, wrong = 0;
  std::vector<std::thread> threads;
  for (int k = 0; k < kThreads; ++k)
    threads.emplace_back([&] {
      const uint32_t corners[3] = {0, 1, 2};
      ++waiting;
      while (waiting < kThreads) {
      }
      wrong += topology(corners, 3).boundary_loops != 1;
    });
  for (std::thread& t : threads) t.join();
  return wrong;
}

// Without the lock in quiet.cpp some of these tries end by a signal.
TEST(Threads, FirstUseInSeveralThreads) {
  for (int k = 0; k < kTries; ++k) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) _exit(first_use_at_once());
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status) << " in try " << k;
    ASSERT_EQ(WEXITSTATUS(status), 0) << "in try " << k;
  }
}

}  // namespace
}  // namespace suite::threads_test
