#include "base/run_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/interrupt.h"
#include "base/outputs.h"
#include "base/run_app.h"

namespace suite {

struct RunLock::Held {
  ~Held() {
    // First the name, then the lock: who has opened the file meanwhile sees that it has gone.
    if (ours) ::unlink(path.c_str());
    if (descriptor >= 0) ::close(descriptor);
    if (!made.empty()) ::rmdir(made.c_str());  // only when it is empty
  }
  std::string path, made;
  std::optional<Temporary> ours;  // once the lock is held
  int descriptor = -1;
};

namespace {

std::string host_name() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 && *name ? name : "unknown";
}

constexpr const char* kMagic = "suite.run-lock/1";

// What stands in a lock file: four lines.
struct Holder {
  std::string magic, host, process, command;
};

Holder holder_in(int descriptor) {
  char text[4096];
  const ssize_t n = ::pread(descriptor, text, sizeof text, 0);
  std::string rest(text, static_cast<size_t>(std::max<ssize_t>(n, 0)));
  Holder h;
  for (std::string* line : {&h.magic, &h.host, &h.process, &h.command}) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    *line = printable(rest.substr(0, end));
    rest.erase(0, end + 1);
  }
  return h;
}

bool may_run(const Holder& h) {
  const long process = std::atol(h.process.c_str());
  if (h.host != host_name()) return !h.host.empty();
  return process > 0 && (::kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM);
}

[[noreturn]] void refuse(const std::string& place, const std::string& path, const Holder& h) {
  const std::string who =
      h.process.empty() ? "" : ": process " + h.process + " on host " + h.host + " (" + h.command.substr(0, 200) + ")";
  throw Error(Where{place, 0, 0, {}, -1}, "another run writes here" + who,
              "wait for its end, or write elsewhere with -o; if that run has ended, remove " + path);
}

bool same_file(int descriptor, const std::string& path) {
  struct stat opened {
  }, there{};
  return ::fstat(descriptor, &opened) == 0 && ::stat(path.c_str(), &there) == 0 && opened.st_dev == there.st_dev &&
         opened.st_ino == there.st_ino;
}

void write_holder(int descriptor, const std::string& path) {
  const std::string text = std::string(kMagic) + "\n" + host_name() + "\n" + strf("%d", static_cast<int>(::getpid())) +
                           "\n" + command_line() + "\n";
  if (::ftruncate(descriptor, 0) != 0)
    throw Error(Where{path, 0, 0, {}, -1}, strf("cannot be written: %s", std::strerror(errno)));
  write_all_at(descriptor, 0, std::as_bytes(std::span(text.data(), text.size())), path);
}

}  // namespace

RunLock::RunLock(const std::string& path, const std::string& place, std::string made) {
  auto held = std::make_unique<Held>();
  held->path = path, held->made = std::move(made);
  while (!held->ours) {
    const CreatingFile creating;
    if (held->descriptor >= 0) ::close(held->descriptor);
    held->descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (held->descriptor < 0)
      throw Error(Where{path, 0, 0, {}, -1}, strf("cannot be written: %s", std::strerror(errno)),
                  "the folder must be writable");
    const bool free = ::flock(held->descriptor, LOCK_EX | LOCK_NB) == 0, locked = !free && errno == EWOULDBLOCK;
    const Holder holder = holder_in(held->descriptor);
    if (!holder.magic.empty() && holder.magic != kMagic)
      throw Error(Where{path, 0, 0, {}, -1}, "is no lock file, and stands where a run puts one",
                  "move it, or write elsewhere with -o");
    if (locked || (!free && may_run(holder))) refuse(place, path, holder);
    if (same_file(held->descriptor, path)) held->ours.emplace(path.c_str());  // else its holder has just ended
  }
  write_holder(held->descriptor, path);
  held_ = held.release();
}

RunLock RunLock::of_folder(const std::string& folder) {
  const std::string place = folder.empty() ? "." : folder;
  const bool there = ::access(place.c_str(), F_OK) == 0;
  make_folder(place);
  return {in_folder(place, "run.lock"), place, there ? std::string() : place};
}
RunLock RunLock::of_file(const std::string& file) { return {file + ".lock", file}; }

RunLock::RunLock(RunLock&& other) noexcept : held_(std::exchange(other.held_, nullptr)) {}
RunLock& RunLock::operator=(RunLock&& other) noexcept {
  std::swap(held_, other.held_);
  return *this;
}
RunLock::~RunLock() { delete held_; }

}  // namespace suite
