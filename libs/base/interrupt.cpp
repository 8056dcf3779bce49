#include "base/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <cstring>
#include <ctime>
#include <string>

namespace suite {

// A list that only grows, of texts that never change: a signal handler may walk it at any moment.
struct Temporary::Slot {
  std::string path;
  std::atomic<bool> there{true};
  Slot* next = nullptr;
};

namespace interrupt {
std::atomic<bool> stop_is_due{false};
}

namespace {

const char* g_name = "";
std::atomic<int> g_signal{0}, g_ordered{0};
std::atomic<double> g_asked_at{0};  // s

// Files that threads are creating now, and whether the program has begun to end.
std::atomic<int> g_creating{0};
std::atomic<bool> g_ending{false};
thread_local int g_finish_first = 0;
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

double now() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void say(const char* text) {
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;  // nobody listens
}

void pause_ms(long ms) {
  const timespec t{0, ms * 1000000};
  ::nanosleep(&t, nullptr);
}

std::atomic<void*> g_slots{nullptr};  // Temporary::Slot

}  // namespace

void end_now(int signal) {
  g_ending = true;
  for (int k = 0; k < 200 && g_creating.load() > 0; ++k) pause_ms(1);
  for (auto* s = static_cast<Temporary::Slot*>(g_slots.load()); s; s = s->next)
    if (s->there) ::unlink(s->path.c_str());
  say(g_name);
  say(signal == SIGINT ? ": interrupted; unfinished files were removed\n"
                       : ": terminated; unfinished files were removed\n");
  ::_exit(128 + signal);
}

extern "C" void suite_on_signal(int signal) {
  int none = 0;
  if (g_ordered.load() > 0 && g_signal.compare_exchange_strong(none, signal)) {
    g_asked_at = now();
    interrupt::stop_is_due = true;
    say("\n");
    say(g_name);
    say(": stopping in good order; once more to end at once\n");
    return;
  }
  end_now(signal);
}

void end_on_signals(const char* name) {
  g_name = name;
  for (const int signal : kSignals) {
    struct sigaction before {};
    if (::sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = suite_on_signal;
    action.sa_flags = SA_RESTART;
    ::sigaction(signal, &action, nullptr);
  }
}

StopInGoodOrder::StopInGoodOrder() { ++g_ordered; }
StopInGoodOrder::~StopInGoodOrder() {
  // What comes afterwards says what there is.
  if (--g_ordered == 0) interrupt::stop_is_due = false;
}
int stop_signal() { return g_signal; }

void interrupt::at_stop_point(double grace_s) {
  if (g_finish_first == 0 && (grace_s <= 0 || now() > g_asked_at + grace_s)) throw Stopped{};
}

FinishFirst::FinishFirst() { ++g_finish_first; }
FinishFirst::~FinishFirst() { --g_finish_first; }
bool FinishFirst::here() { return g_finish_first > 0; }

Temporary::Temporary(const char* path) : slot_(new Slot) {
  slot_->path = path;
  void* head = g_slots.load();
  do slot_->next = static_cast<Slot*>(head);
  while (!g_slots.compare_exchange_weak(head, slot_));
}

Temporary::~Temporary() { slot_->there = false; }

CreatingFile::CreatingFile() {
  sigset_t ours;
  ::sigemptyset(&ours);
  for (const int signal : kSignals) ::sigaddset(&ours, signal);
  ::pthread_sigmask(SIG_BLOCK, &ours, &before_);  // a handler on this thread would wait for itself
  ++g_creating;
  if (!g_ending) return;
  --g_creating;
  for (;;) pause_ms(100);  // the program is ending
}
CreatingFile::~CreatingFile() {
  --g_creating;
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace suite
