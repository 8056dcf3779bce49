// The aligned method against the best point of the paper method's own threshold curve (order 6, 24 views), material by
// material: bytes at equal error, error at equal bytes. Every material twice: as it is, and tabulated in the MERL
// layout.
//   build/release/bench/sqt_compare FILE.bsdf ... [--direct]
// The best point of the paper's curve is the one of least l1; ties go to fewer bytes. "At equal l1" searches the
// aligned quality whose l1 does not exceed it; "at equal bytes" the one that needs no more bytes.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>

#include "base/files.h"
#include "formats/measured/measured.h"
#include "formats/merl/merl.h"
#include "formats/sqt/sqt.h"
#include "sqt/fit.h"

namespace suite {
namespace {

struct Point {
  size_t bytes = 0;
  double l1 = 1e9, cos_rmse = 0, threshold = 0;
};

Point paper_best(const sqt::Function& function, const sqt::Reference& reference) {
  Point best;
  for (const double threshold : {0.0, 0.05, 0.1, 0.2, 0.4, 0.8}) {
    sqt::PaperOptions options;
    options.threshold = threshold;
    const sqt::PaperData data = sqt::fit_paper(function, options);
    const sqt::ErrorFigures e = reference.measure(*sqt::make_bundle(data)).back();
    const size_t bytes = pack_sqt(data, {}, {}).size();
    std::printf("    paper threshold %.2f: %8zu bytes  l1 %6.2f %%  cos_rmse %6.2f %%\n", threshold, bytes, 100 * e.l1,
                100 * e.cos_rmse);
    // The knee: the smallest file whose error is within 2 % of the least.
    if (e.l1 < best.l1 * 0.98 || (e.l1 < best.l1 * 1.02 && bytes < best.bytes))
      best = {bytes, e.l1, e.cos_rmse, threshold};
  }
  return best;
}

void compare(const char* kind, const std::string& name, const sqt::Function& function) {
  const auto start = std::chrono::steady_clock::now();
  auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const sqt::Reference reference(function, 200000);
  const sqt::AlignedSource source(function, {});
  const sqt::FitResult plain = sqt::fit_to(source, reference, {});
  const double fit_seconds = seconds();
  const size_t plain_bytes = pack_sqt(plain.fit, {}, {}).size();
  const sqt::ErrorFigures e = reference.measure(*sqt::make_bundle(plain.fit.data)).back();
  std::printf(
      "%s %s\n  aligned, default quality: %zu bytes  l1 %.2f %%  cos_rmse %.2f %%  total_error %.2f %%  max_weight "
      "%.1f  %.1f s\n",
      kind, name.c_str(), plain_bytes, 100 * e.l1, 100 * e.cos_rmse, 100 * e.total_error, e.max_weight, fit_seconds);
  const Point paper = paper_best(function, reference);
  const sqt::FitResult equal_error = sqt::fit_to(source, reference, {paper.l1, 0, 0});
  const size_t bytes = pack_sqt(equal_error.fit, {}, {}).size();
  const sqt::FitResult equal_bytes = sqt::fit_to(source, reference, {0, paper.bytes, 1200});
  std::printf("  paper best: %zu bytes, l1 %.2f %% (threshold %.2f)\n", paper.bytes, 100 * paper.l1, paper.threshold);
  std::printf("  at equal l1:    %8zu bytes, l1 %.2f %%: 1/%.1f of the bytes%s\n", bytes, 100 * equal_error.l1,
              static_cast<double>(paper.bytes) / static_cast<double>(bytes),
              equal_error.error_met ? "" : " (error not met)");
  std::printf("  at equal bytes: %8zu bytes, l1 %.2f %%: 1/%.1f of the error\n",
              pack_sqt(equal_bytes.fit, {}, {}).size(), 100 * equal_bytes.l1, paper.l1 / equal_bytes.l1);
  std::fflush(stdout);
}

}  // namespace
}  // namespace suite

int main(int argc, char** argv) {
  using namespace suite;
  bool direct_only = false;
  for (int i = 1; i < argc; ++i) direct_only |= std::strcmp(argv[i], "--direct") == 0;
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] == '-') continue;
    const std::string path = argv[i], name = path.substr(path.find_last_of('/') + 1);
    const auto function = std::get<0>(read_measured(path));
    compare("bsdf", name, *function);
    if (direct_only || function->info().wavelength_um.size() != 3) continue;
    const MerlTable table(name, 180, merl_raw(*function));
    compare("merl", name, table);
  }
  return 0;
}
