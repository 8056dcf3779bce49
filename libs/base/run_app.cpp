#include "base/run_app.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <filesystem>
#include <new>

#include "base/error.h"
#include "base/inputs.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/renamed.h"

namespace suite {

struct Cli::Impl {
  explicit Impl(const std::string& description, const std::string& name) : app(description, name) {}
  CLI::App app;
};

Cli::Cli(const std::string& name, const std::string& description) : impl_(new Impl(description, name)) {
  impl_->app.get_formatter()->column_width(34);
}
Cli::~Cli() = default;

void Cli::flag(const std::string& names, bool& value, const std::string& help) {
  impl_->app.add_flag(names, value, help);
}
void Cli::option(const std::string& names, std::string& value, const std::string& help, const std::string& metavar) {
  impl_->app.add_option(names, value, help)->type_name(metavar)->capture_default_str();
}
void Cli::option(const std::string& names, double& value, const std::string& help, const std::string& metavar) {
  CLI::Option* option = impl_->app.add_option(names, value, help)->type_name(metavar);
  if (value >= 0) option->capture_default_str();  // below 0: not given, which is no value to show
}
void Cli::option(const std::string& names, long long& value, const std::string& help, const std::string& metavar) {
  CLI::Option* option = impl_->app.add_option(names, value, help)->type_name(metavar);
  if (value >= 0) option->capture_default_str();  // below 0: not given, which is no value to show
}
void Cli::option(const std::string& names, std::vector<std::string>& values, const std::string& help,
                 const std::string& metavar) {
  impl_->app.add_option(names, values, help)->type_name(metavar)->allow_extra_args(false)->take_all();
}
void Cli::list(const std::string& names, std::vector<std::string>& values, const std::string& help,
               const std::string& metavar) {
  impl_->app.add_option(names, values, help)->type_name(metavar)->take_all();
}
void Cli::positional(const std::string& name, std::string& value, const std::string& help, bool required) {
  impl_->app.add_option(name, value, help)->type_name("")->required(required);
}
void Cli::positional(const std::string& name, std::vector<std::string>& values, const std::string& help,
                     bool required) {
  impl_->app.add_option(name, values, help)->type_name("")->required(required);
}
void Cli::footer(const std::string& text) { impl_->app.footer(text); }
bool Cli::given(const std::string& name) const { return impl_->app.count(name) > 0; }

namespace {

std::string g_command_line;
bool g_run_app_silent = false;

void say(const std::string& text) {
  if (!g_run_app_silent) std::fputs(text.c_str(), stderr);
}

std::shared_ptr<spdlog::logger> logger() {
  static const auto log = [] {
    auto made = std::make_shared<spdlog::logger>("suite", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_pattern("%v");
    return made;
  }();
  return log;
}

void remember_command_line(const std::string& name, std::span<const std::string> arguments) {
  g_command_line = name;
  for (const std::string& argument : arguments) {
    const std::string a = printable(argument);  // headers of results are lines of UTF-8
    const bool plain =
        !a.empty() && a.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=./,:+%") ==
                          std::string::npos;
    g_command_line += ' ';
    if (plain) {
      g_command_line += a;
      continue;
    }
    g_command_line += '\'';
    for (const char c : a) g_command_line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    g_command_line += '\'';
  }
}

// CLI11 says "The following argument was not expected: --x"; we add the nearest name.
int usage_error(const AppInfo& info, CLI::App& app, const std::string& text, const std::vector<std::string>& extras) {
  std::string message = text;
  if (!extras.empty()) {
    std::vector<std::string> known;
    for (const CLI::Option* option : app.get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    const std::string given = extras.front().substr(0, extras.front().find('='));
    message = given.rfind('-', 0) == 0 ? "unknown option '" + given + "'" : "unexpected argument '" + given + "'";
    if (const std::string near = nearest_name(given, known); !near.empty()) message += "; did you mean '" + near + "'?";
  }
  say(info.name + ": usage: " + printable_lines(message) + "\n" + info.name + ": see '" + info.name + " --help'\n");
  return 2;
}

}  // namespace

const std::string& command_line() { return g_command_line; }

void note(const std::string& text) {
  if (!g_run_app_silent) logger()->info("{}", printable_lines(text));
}
void warn(const std::string& text) {
  if (!g_run_app_silent) logger()->warn("warning: {}", printable_lines(text));
}
void set_silent(bool silent) {
  g_run_app_silent = silent;
  Progress::set_silent(silent);
}

int run_app(const AppInfo& info, int argc, const char* const* argv, const std::function<void(Cli&)>& declare,
            const std::function<int(Cli&)>& run) {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit is a failed write, which is told
  end_on_signals(info.name.c_str());
  track_inputs();
  Cli cli(info.name, info.description);
  CLI::App& app = cli.impl().app;
  std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  remember_command_line(info.name, arguments);
  bool quiet = false;
  long long thread_count = 0;
  try {
    arguments = with_new_options(info.name, std::move(arguments));
    remember_command_line(info.name, arguments);
    app.set_version_flag("--version", info.name + " " + version_text());
    declare(cli);
    app.add_flag("-q,--quiet", quiet, "print errors, warnings and results, no progress");
    app.add_option("-j,--threads", thread_count, "worker threads; 0 = one per core; the results do not depend on it")
        ->type_name("N")
        ->check(CLI::Range(0, 4096));
    if (!info.footer.empty()) app.footer(info.footer);
    std::vector<std::string> backwards(arguments.rbegin(), arguments.rend());  // as CLI11 takes them
    app.parse(backwards);
  } catch (const UsageError& e) {
    return usage_error(info, app, e.what(), {});
  } catch (const CLI::Success& e) {
    return g_run_app_silent ? e.get_exit_code() : app.exit(e);
  } catch (const CLI::ExtrasError&) {
    return usage_error(info, app, "", app.remaining());
  } catch (const CLI::ParseError& e) {
    return usage_error(info, app, e.what(), app.remaining());
  }
  Progress::set_quiet(quiet);
  logger()->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  set_threads(static_cast<int>(thread_count));
  try {
    return run(cli);
  } catch (const UsageError& e) {
    return usage_error(info, app, e.what(), {});
  } catch (const Error& e) {
    say(std::string(e.what()) + "\n");
    return 1;
  } catch (const Stopped&) {
    say(info.name + ": stopped by signal\n");
    return 128 + stop_signal();
  } catch (const std::bad_alloc&) {
    say(info.name + ": error: out of memory\n");
    return 1;
  } catch (const std::exception& e) {
    say(info.name + ": bug: " + printable_lines(e.what()) +
        "\nplease report it with this command line: " + printable(g_command_line) + "\n");
    return 3;
  }
}

}  // namespace suite
