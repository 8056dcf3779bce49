#include "base/progress.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "base/error.h"

namespace suite {

namespace {
std::atomic<bool> g_quiet{false}, g_silent{false};

bool heard() { return !g_quiet && !g_silent; }

// "1 path", "960 paths", "2 spectra", "100 %".
std::string counted(double count, const std::string& unit) {
  std::string text = human_count(count) + " " + unit;
  if (count == 1 || unit == "%") return text;
  return unit.ends_with("um") ? text.replace(text.size() - 2, 2, "a") : text + "s";
}
}  // namespace

void Progress::set_quiet(bool quiet) { g_quiet = quiet; }
void Progress::set_silent(bool silent) { g_silent = silent; }

Progress::Progress(std::string label, double total, std::string unit, TimeLeft::Bounds bounds)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      left_(total, bounds),
      start_(std::chrono::steady_clock::now()),
      next_(start_),
      terminal_(::isatty(2) != 0) {}

Progress::~Progress() { finish(); }

double Progress::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::add(double amount) {
  done_.fetch_add(amount);
  if (!heard()) return;
  if (const std::unique_lock lock(mutex_, std::try_to_lock); lock.owns_lock()) draw(false);
}

void Progress::finish() {
  const std::lock_guard lock(mutex_);
  if (finished_) return;
  finished_ = true;
  if (heard()) draw(true);
}

void Progress::draw(bool last) {
  const auto now = std::chrono::steady_clock::now();
  const double done = done_, share = total_ > 0 ? std::min(1.0, done / total_) : 1, seconds = this->seconds();
  const double rate = seconds > 0 ? done / seconds : 0;
  if (last) {
    const std::string end = terminal_ ? "\033[K" : "";
    std::fprintf(stderr, "%s%s: ", terminal_ ? "\r" : "", label_.c_str());
    if (unit_.empty())
      std::fprintf(stderr, "%s%s\n", human_seconds(seconds).c_str(), end.c_str());
    else
      std::fprintf(stderr, "%s in %s (%s %s/s)%s\n", counted(done, unit_).c_str(), human_seconds(seconds).c_str(),
                   human_count(rate).c_str(), unit_.c_str(), end.c_str());
    return;
  }
  if (unit_.empty()) return;
  left_.tell(seconds, done);
  if (terminal_) {
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(200);
    std::string bar(30, '.');
    for (int i = 0; i < static_cast<int>(30 * share); ++i) bar[i] = '#';
    std::fprintf(stderr, "\r%s [%s] %3.0f %%  %s %s/s  %s\033[K", label_.c_str(), bar.c_str(), 100 * share,
                 human_count(rate).c_str(), unit_.c_str(), left_.text().c_str());
    std::fflush(stderr);
  } else if (const int decile = static_cast<int>(10 * share); decile > last_decile_ && decile < 10) {
    if (now < next_) return;  // short work prints one closing line only
    next_ = now + std::chrono::seconds(5);
    if (last_decile_ == 0 && seconds < 2) return;
    last_decile_ = decile;
    std::fprintf(stderr, "%s: %d %% (%s %s/s, %s)\n", label_.c_str(), 10 * decile, human_count(rate).c_str(),
                 unit_.c_str(), left_.text().c_str());
  }
}

std::string human_seconds(double s) {
  if (!(s < 1e9)) return "?";
  if (s < 1e-3) return strf("%.0f us", s * 1e6);
  if (s < 1) return strf("%.0f ms", s * 1e3);
  if (s < 100) return strf("%.1f s", s);
  if (s < 6000) return strf("%d min %02d s", static_cast<int>(s) / 60, static_cast<int>(s) % 60);
  return strf("%d h %02d min", static_cast<int>(s / 3600), static_cast<int>(s / 60) % 60);
}
std::string human_count(double c) {
  if (c < 1000) return strf("%.4g", c);
  if (c < 1e6) return strf("%.3g k", c / 1e3);
  if (c < 1e9) return strf("%.3g M", c / 1e6);
  return strf("%.3g G", c / 1e9);
}
std::string human_bytes(double b) {
  if (b < 1000) return strf("%.0f B", b);
  if (b < 1e6) return strf("%.3g kB", b / 1e3);
  if (b < 1e9) return strf("%.3g MB", b / 1e6);
  return strf("%.3g GB", b / 1e9);
}

}  // namespace suite
