// Imports of DIRSIG's files for tests.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include "base/params.h"
#include "formats/dirsig/dirsig.h"

namespace suite {

inline const std::string kDirsigData = SUITE_TEST_DATA "/dirsig/";

inline dirsig::SimulationHelp dirsig_help() {
  dirsig::SimulationHelp help;
  help.prepared = [](const std::string& scene, const dirsig::SceneMade&) {
    return std::filesystem::path(scene).replace_extension("h5").string();
  };
  help.deck = [](const std::string&) { return dirsig::DeckAir{"tropical", "urban", 5}; };
  help.weather = [](const dirsig::WeatherAsked& asked) {
    if (asked.path.ends_with("winter.wth")) throw Error(Where{asked.path, 9, 1, {}, -1}, "the sun shines at night");
    return 172800.0;
  };
  return help;
}

// Every element and key has exactly one fate.
inline void expect_accounted(dirsig::Ledger& ledger) {
  ledger.close();
  const auto counts = ledger.counts();
  EXPECT_GT(ledger.items(), size_t{0});
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), size_t{0}), ledger.items());
  EXPECT_EQ(ledger.entries().size(), ledger.items());
}

// The fate of the first entry whose path ends so; "" where there is none.
inline std::string fate_of(const dirsig::Ledger& ledger, const std::string& end) {
  for (const dirsig::Entry& e : ledger.entries())
    if (e.path.ends_with(end)) return dirsig::to_text(e.fate);
  return "";
}

inline Params params_of(const dirsig::MadeText& text, const std::string& file) {
  return Params::parse_made(text.yaml, file, text.origins);
}

}  // namespace suite
