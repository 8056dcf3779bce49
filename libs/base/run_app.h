// The shell of every executable: options, --help, --version, --threads, --quiet; the one catch; the exit codes.
// 0 fine, 1 bad input, 2 bad usage, 3 our bug, 128 + n ended by signal n (130: Ctrl-C, 143: SIGTERM, 129: SIGHUP).
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/version.h"

namespace suite {

// The options of one executable. Values keep what the caller put there when the option is not given.
class Cli {
 public:
  Cli(const std::string& name, const std::string& description);
  ~Cli();
  Cli(const Cli&) = delete;
  Cli& operator=(const Cli&) = delete;

  void flag(const std::string& names, bool& value, const std::string& help);
  void option(const std::string& names, std::string& value, const std::string& help,
              const std::string& metavar = "TEXT");
  void option(const std::string& names, double& value, const std::string& help, const std::string& metavar = "NUMBER");
  void option(const std::string& names, long long& value, const std::string& help, const std::string& metavar = "INT");
  void option(const std::string& names, std::vector<std::string>& values, const std::string& help,
              const std::string& metavar = "TEXT...");
  // The same, each time with as many values as follow it.
  void list(const std::string& names, std::vector<std::string>& values, const std::string& help,
            const std::string& metavar = "TEXT...");
  // Positional arguments are named without dashes.
  void positional(const std::string& name, std::string& value, const std::string& help, bool required = true);
  void positional(const std::string& name, std::vector<std::string>& values, const std::string& help,
                  bool required = true);
  void footer(const std::string& text);       // examples, shown under --help
  bool given(const std::string& name) const;  // was the option on the command line?

  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// Thrown by an app for arguments that contradict each other: printed with a pointer to --help, exit code 2.
class UsageError : public std::exception {
 public:
  explicit UsageError(std::string text) : text_(std::move(text)) {}
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

struct AppInfo {
  std::string name;         // "scene-prep"
  std::string description;  // first lines of --help
  std::string footer;       // examples and conventions at the end of --help
};

// declare() adds options, run() does the work and returns 0, 1 or, stopped in good order by a signal (interrupt.h), 128
// + n. run() is not called for --help and --version.
int run_app(const AppInfo& info, int argc, const char* const* argv, const std::function<void(Cli&)>& declare,
            const std::function<int(Cli&)>& run);

// The command line in canonical form (program name without folder), for the headers of results.
const std::string& command_line();

// Diagnostics to standard error: note = progress of the work (silenced by --quiet), warn = "warning: ..." (never
// silenced: what a result lacks is told).
void note(const std::string& text);
void warn(const std::string& text);
// From then on the program says nothing at all, or speaks again: of processes that run one job together only one is to
// be heard. It does not undo --quiet.
void set_silent(bool silent);

}  // namespace suite
