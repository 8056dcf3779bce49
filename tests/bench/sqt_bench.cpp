// Speed of the verbs of a fitted bundle and of making it ready, on one thread, one channel. Run by hand:
//   build/release/bench/sqt_bench [--file=X.bsdf|X.sqt]      (default: the satin film of tests/data)
#include <benchmark/benchmark.h>

#include <cstring>

#include "base/files.h"
#include "base/parallel.h"
#include "formats/measured/measured.h"
#include "formats/sqt/sqt.h"
#include "formats/sqt/sqt_write.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "sqt_fit/fit.h"

namespace suite {
namespace {

std::string g_file = SUITE_TEST_DATA "/brdf/satin_purple_rgb.bsdf";

struct Fitted {
  std::vector<std::byte> file;
  std::shared_ptr<const sqt::Bundle> bundle;
  std::vector<Dir> out, in;
  std::vector<Vec2> u;
  std::vector<double> lobe;
};
const Fitted& fitted() {
  static const Fitted f = [] {
    Fitted made;
    if (g_file.ends_with(".sqt")) {
      made.file = read_bytes(g_file);
    } else {
      const auto function = std::get<0>(read_measured(g_file));
      const sqt::AlignedSource source(*function, {});
      made.file = pack_sqt(sqt::encode_aligned(source, sqt::kDefaultQuality), {}, {});
    }
    made.bundle = parse_sqt(made.file, g_file).bundle;
    Pcg32 random(3);
    for (int i = 0; i < 65536; ++i) {
      made.out.push_back(uniform_sphere({0.5 * random.uniform(), random.uniform()}));
      made.u.push_back({random.uniform(), random.uniform()});
      made.lobe.push_back(random.uniform());
      // Half uniform, half as a renderer meets them: drawn from the lobe.
      const auto drawn = made.bundle->sample(made.out.back(), made.u.back(), made.lobe.back(), 1);
      made.in.push_back(drawn && i % 2 ? *drawn : uniform_sphere({0.5 * random.uniform(), random.uniform()}));
    }
    return made;
  }();
  return f;
}

void eval(benchmark::State& state) {
  const Fitted& f = fitted();
  size_t i = 0;
  double sum = 0;
  for (auto _ : state) {
    sum += f.bundle->eval(f.out[i], f.in[i], 1);
    i = (i + 1) & 65535;
  }
  benchmark::DoNotOptimize(sum);
}
void sample_and_pdf(benchmark::State& state) {
  const Fitted& f = fitted();
  size_t i = 0;
  double sum = 0;
  for (auto _ : state) {
    const auto in = f.bundle->sample(f.out[i], f.u[i], f.lobe[i], 1);
    if (in) sum += f.bundle->pdf(f.out[i], *in, 1);
    i = (i + 1) & 65535;
  }
  benchmark::DoNotOptimize(sum);
}
void total(benchmark::State& state) {
  const Fitted& f = fitted();
  size_t i = 0;
  double sum = 0;
  for (auto _ : state) {
    sum += f.bundle->total(f.out[i], 1);
    i = (i + 1) & 65535;
  }
  benchmark::DoNotOptimize(sum);
}
void load(benchmark::State& state) {
  const Fitted& f = fitted();
  set_threads(1);
  for (auto _ : state) benchmark::DoNotOptimize(parse_sqt(f.file, "satin.sqt").bundle);
  state.counters["per_100kB"] =
      benchmark::Counter(static_cast<double>(f.file.size()) / 100e3,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["bytes"] = static_cast<double>(f.file.size());
}

BENCHMARK(eval);
BENCHMARK(sample_and_pdf);
BENCHMARK(total);
BENCHMARK(load)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace suite

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (int i = 1; i < argc; ++i)
    if (std::strncmp(argv[i], "--file=", 7) == 0) suite::g_file = argv[i] + 7;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
