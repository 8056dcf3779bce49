// Whether states are the parts of one run, each once.
#include <map>

#include "formats/render_state/internal.h"

namespace suite {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what, const std::string& hint) {
  throw Error(Where{path, 0, 0, {}, -1}, what, hint);
}

std::string missing_parts(uint32_t parts, const std::map<uint32_t, std::string>& there) {
  constexpr size_t most = 8;
  std::string list;
  size_t named = 0;
  for (uint32_t p = 0; p < parts; ++p) {
    if (there.contains(p)) continue;
    if (named == most) return list + " ...";
    list += (named++ ? ", " : "") + strf("%u", p + 1);
  }
  return list;
}

}  // namespace

Budget check_parts(const std::vector<std::string>& paths, const StateIdentity& identity) {
  std::map<uint32_t, std::string> there;  // path by part
  StateHead first;
  for (const std::string& path : paths) {
    const StateHead head = read_state_head(path, identity);
    if (!head.part)
      refuse(path, "is the state of a whole run, not of a part",
             "--merge joins what --part left, all parts of one run");
    const Share& share = head.part->share;
    if (there.empty()) first = head;
    const std::string& one = there.empty() ? path : there.begin()->second;
    if (share.parts != first.part->share.parts)
      refuse(path, "is " + share.text() + ", and " + one + " is " + first.part->share.text(),
             "join the parts of one run");
    if (const auto [twin, fresh] = there.try_emplace(share.part, path); !fresh)
      refuse(path, "is " + share.text() + ", and so is " + twin->second, "give each part once");
    if (!(head.budget == first.budget))
      refuse(path, "was run with another budget (--paths, --target-error, --more) than " + one,
             "run all parts with the same options");
    if (head.part->planned != first.part->planned)
      refuse(head.part->planned ? one : path, "has run its share of the pilot only, others that of the plan",
             "run it again with --plan, too");
    if (!head.part->finished)
      refuse(path, share.text() + " is not finished", "let it finish, with --resume when it was interrupted");
  }
  const uint32_t parts = first.part ? first.part->share.parts : 0;
  if (there.size() < parts)
    refuse(paths.front(), strf("is one of %u parts; missing: ", parts) + missing_parts(parts, there),
           "--merge wants the folders of all parts");
  return first.budget;
}

}  // namespace suite
