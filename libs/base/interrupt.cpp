#include "base/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <string>

namespace suite {

// A list that only grows, of texts that never change: a signal handler may walk it at any moment.
struct Temporary::Slot {
  std::string path;
  std::atomic<bool> there{true};
  Slot* next = nullptr;
};

namespace {

const char* g_name = "";
std::atomic<int> g_signal{0}, g_ordered{0};

void say(const char* text) {
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;  // nobody listens
}

std::atomic<void*> g_slots{nullptr};  // Temporary::Slot

}  // namespace

void end_now(int signal) {
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
    say("\n");
    say(g_name);
    say(": stopping in good order; once more to end at once\n");
    return;
  }
  end_now(signal);
}

void end_on_signals(const char* name) {
  g_name = name;
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    if (::sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = suite_on_signal;
    action.sa_flags = SA_RESTART;
    ::sigaction(signal, &action, nullptr);
  }
}

StopInGoodOrder::StopInGoodOrder() { ++g_ordered; }
StopInGoodOrder::~StopInGoodOrder() { --g_ordered; }
int stop_signal() { return g_signal; }

Temporary::Temporary(const char* path) : slot_(new Slot) {
  slot_->path = path;
  void* head = g_slots.load();
  do slot_->next = static_cast<Slot*>(head);
  while (!g_slots.compare_exchange_weak(head, slot_));
}

Temporary::~Temporary() { slot_->there = false; }

}  // namespace suite
