// The aligned method against the best point of the paper method's own threshold curve (order 6, 24 views), material by
// material: bytes at equal error, error at equal bytes. Every material twice: as it is, and tabulated in the MERL
// layout.
//   build/release/bench/sqt_compare FILE.bsdf ... [--direct]
// Every point of the paper's curve is answered by what sqt-fit does when asked for its error or for its bytes; headers
// without provenance on both sides.
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <vector>

#include "formats/measured/measured.h"
#include "formats/merl/merl.h"
#include "formats/sqt/sqt.h"
#include "formats/sqt/sqt_write.h"
#include "sqt_fit/fit.h"

namespace suite {
namespace {

struct Point {
  double knob;
  size_t bytes;
  double l1, cos_rmse;
};

std::vector<Point> paper_curve(const sqt::Function& function, const sqt::Reference& reference) {
  std::vector<Point> curve;
  for (const double threshold : {0.0, 0.03, 0.06, 0.12, 0.25, 0.5, 1.0}) {
    sqt::PaperOptions options;
    options.threshold = threshold;
    options.samples_per_cell_side = 2;
    const sqt::PaperData data = sqt::fit_paper(function, options);
    const sqt::Reference::Brief e = reference.brief(*sqt::make_bundle(data));
    curve.push_back({threshold, pack_sqt(data, {}, {}).size(), e.l1, e.cos_rmse});
  }
  return curve;
}

// The aligned method held to a target, as sqt-fit does it.
Point aligned(const sqt::Function& function, const sqt::Reference& reference, const sqt::FitTarget& target) {
  const sqt::FitResult r = sqt::fit_to(function, reference, {}, target, [](const sqt::AlignedSource& source) {
    const sqt::AlignedFit first = sqt::encode_aligned(source, 1.0);
    return pack_sqt(first, {}, {}).size() - first.sheets_bytes.size() - first.totals_bytes.size();
  });
  const sqt::Reference::Brief e = reference.brief(*sqt::make_bundle(r.fit.data));
  return {r.fit.data.layout.quality, r.error_met && r.bytes_met ? pack_sqt(r.fit, {}, {}).size() : 0, e.l1, e.cos_rmse};
}

void compare(const char* kind, const std::string& name, const sqt::Function& function) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  const sqt::Reference reference(function, 150000);
  const Point plain = aligned(function, reference, {});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double busy = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf(
      "%s %s\n  aligned at default quality: %zu bytes  l1 %.2f %%  cos_rmse %.2f %%  fit %.1f s (cpu %.1f s), peak "
      "%.0f MiB so far\n",
      kind, name.c_str(), plain.bytes, 100 * plain.l1, 100 * plain.cos_rmse, seconds, busy,
      static_cast<double>(usage.ru_maxrss) / 1024);
  std::printf("  %-34s | %-30s | %s\n", "paper: threshold bytes l1 cos_rmse", "aligned at equal l1: bytes ratio",
              "aligned at equal bytes: l1 ratio, cos_rmse ratio");
  for (const Point& p : paper_curve(function, reference)) {
    std::printf("  %5.2f %9zu %6.2f %% %6.2f %%   | ", p.knob, p.bytes, 100 * p.l1, 100 * p.cos_rmse);
    const Point small = aligned(function, reference, {p.l1, 0}), good = aligned(function, reference, {0, p.bytes});
    if (small.bytes)
      std::printf("%9zu  1/%-18.1f | ", small.bytes, static_cast<double>(p.bytes) / static_cast<double>(small.bytes));
    else
      std::printf("%-30s | ", "not reached");
    if (good.bytes)
      std::printf("%6.2f %%  1/%.1f  1/%.1f\n", 100 * good.l1, p.l1 / good.l1, p.cos_rmse / good.cos_rmse);
    else
      std::printf("none so small\n");
    std::fflush(stdout);
  }
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
