#include "formats/assimp/apart.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "base/error.h"

namespace suite {

namespace {

// The address space of this process now, which the child has as well.
rlim_t mapped_now() {
  unsigned long pages = 0;
  if (FILE* f = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(f, "%lu", &pages) != 1) pages = 0;
    std::fclose(f);
  }
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

[[noreturn]] void run_child(int out, rlim_t most_bytes, const std::function<std::string()>& work) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
  const rlimit none{0, 0}, memory{most_bytes, most_bytes}, seconds{600, 600};
  ::setrlimit(RLIMIT_CORE, &none), ::setrlimit(RLIMIT_AS, &memory), ::setrlimit(RLIMIT_CPU, &seconds);
  int status = 1;
  try {
    const std::string made = work();
    size_t done = 0;
    while (done < made.size()) {
      const ssize_t n = ::write(out, made.data() + done, made.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) ::_exit(2);
      done += static_cast<size_t>(n);
    }
    status = 0;
  } catch (...) {  // out of memory, mostly
  }
  ::_exit(status);
}

}  // namespace

std::string apart(const std::string& file, size_t input_bytes, const std::function<std::string()>& work) {
  const Where where{file, 0, 0, {}, -1};
  int ends[2];
  if (::pipe(ends) != 0) throw Error(where, std::string("no pipe: ") + std::strerror(errno));
  const rlim_t most = mapped_now() + (rlim_t{1} << 30) + 200 * static_cast<rlim_t>(input_bytes);
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    run_child(ends[1], most, work);
  }
  ::close(ends[1]);
  std::string made;
  char piece[1 << 16];
  for (ssize_t n = 1; child > 0 && n != 0;) {
    n = ::read(ends[0], piece, sizeof piece);
    if (n < 0 && errno != EINTR) break;
    if (n > 0) made.append(piece, static_cast<size_t>(n));
  }
  ::close(ends[0]);
  int status = 0;
  if (child > 0)
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
  if (child < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(where,
                child > 0 && WIFSIGNALED(status)
                    ? strf("the library that reads it (assimp) broke down: signal %d", WTERMSIG(status))
                    : std::string("the library that reads it (assimp) ran out of memory or broke down"),
                "the file is damaged, or of a kind that it cannot read; write it again, or as glTF");
  return made;
}

}  // namespace suite
