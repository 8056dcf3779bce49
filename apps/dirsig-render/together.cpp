#include "together.h"

#include <cstdio>
#include <cstring>
#include <sstream>

#include "base/diagnostics.h"
#include "base/run_app.h"

namespace suite {

namespace {

// Says which rank a fault is of, where it is not that of the one that speaks.
[[noreturn]] void rethrow_of(const Ranks& ranks) {
  set_silent(false);
  if (ranks.leads()) throw;
  try {
    throw;
  } catch (const Error& e) {
    const std::string who = strf("this is rank %d on host %s", ranks.rank(), ranks.host().c_str());
    throw Error(e.where(), e.message(), e.hint().empty() ? who : e.hint() + "; " + who, e.code());
  }
}

}  // namespace

Together::Together() {
  try {
    ranks_ = join_ranks();
  } catch (...) {
    refused_ = std::current_exception();
  }
  if (!ranks_ || ranks_->leads()) return;
  set_silent(true);
  if (!std::freopen("/dev/null", "w", stdout)) std::fclose(stdout);
}

int Together::run(const std::function<int()>& body) {
  begun_ = true;
  try {
    if (refused_) std::rethrow_exception(refused_);
    const int code = body();
    if (ranks_) ranks_->meet();
    return code;
  } catch (const EndedElsewhere&) {
    return ranks_ ? 0 : 1;
  } catch (...) {
    if (!ranks_) throw;
    if (!ranks_->fail()) return 0;
    rethrow_of(*ranks_);
  }
}

int Together::conclude(int code) {
  if (!ranks_) return code;
  // Others may understand their command lines and wait.
  if (code != 0 && !begun_ && ranks_->fail() && !ranks_->leads()) {
    set_silent(false);
    emit({Dr::rank_options,
          strf("rank %d on host %s was started with options that cannot be: ", ranks_->rank(), ranks_->host().c_str()) +
              command_line()});
  }
  return ranks_->conclude(code);
}

void check_ranks_usage(const Cli& cli, const RenderOptions& o) {
  for (const char* option : {"--part", "--plan", "--merge", "--study", "--dry-run"})
    if (cli.given(option))
      throw UsageError(std::string(option) + " is for one process: start it without mpirun, or leave it out");
  if (o.stop == "change" || o.method == "paper")
    throw UsageError("--stop change and --method paper watch their samples in one order: start without mpirun");
}

void check_alike(Ranks& ranks, const StateIdentity& identity) {
  std::string mine = ranks.host() + "\n" + "command line " + command_line() + "\n";
  for (const auto& [key, value] : identity) mine += key + " " + value + "\n";
  const std::vector<std::string> all = ranks.gather(mine);
  std::string first_host;
  for (size_t rank = 0; rank < all.size(); ++rank) {
    std::istringstream here(all[rank]), first(all.front());
    std::string host, a, b;
    std::getline(here, host), std::getline(first, first_host);
    while (std::getline(here, a) && std::getline(first, b))
      if (a != b)
        throw Error(
            strf("ranks differ: rank %zu on host %s has ", rank, host.c_str()) + a.substr(0, 100) +
                ", rank 0 on host " + first_host + " has " + b.substr(0, 100),
            "give all ranks the same command, program and files; results of unlike processors may not be mixed");
  }
}

std::shared_ptr<SpillFile> spill_file(Ranks& ranks) {
  std::shared_ptr<SpillFile> mine;
  try {
    mine = std::make_shared<SpillFile>();
  } catch (const Error&) {
    // Whoever has something to unpack will be told.
  }
  const std::string own = mine ? mine->address() : std::string(), first = ranks.of_first_here(own);
  if (first != own) mine = SpillFile::open(first);
  ranks.meet();  // the first one's file is open until all have opened it
  return mine;
}

void broadcast_budget(Ranks& ranks, Budget& budget) {
  static_assert(std::is_trivially_copyable_v<Budget>);
  const auto own = std::as_bytes(std::span<const Budget>(&budget, 1));
  std::vector<std::byte> bytes(own.begin(), own.end());
  ranks.executor().broadcast(bytes);
  std::memcpy(&budget, bytes.data(), sizeof(Budget));
}

}  // namespace suite
