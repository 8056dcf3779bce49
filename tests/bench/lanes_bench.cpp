// Whether the loop that weighs continuations (PathKernel::weigh(), roulette and the division by it) would gain from
// arrays over the paths of a wave in place of lanes: the same numbers, the same order of operations, the same bits.
// The best case for arrays: every path of the wave goes on, nothing has to be gathered or moved up.
//
//   lanes_bench             prints CPU time of a path and event, the least of 200 runs
//   lanes_bench lanes|arrays ONE|EIGHT EVENTS   runs one of the loops so often, for counts under valgrind
#include <ctime>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "transport/lane.h"
#include "transport/shares.h"

namespace suite {
namespace {

constexpr size_t kWidth = 64;  // of a wave
constexpr size_t kBins = 32;

// What the continuations of a stage bring, path by path.
template <int K>
struct Drawn {
  float density[K];
  float scale;
  const float* spectrum;
  double number;  // of roulette
};

template <int K>
struct Stage {
  std::vector<Drawn<K>> drawn;
  std::vector<float> spectra;
  size_t bins[K];  // of the hero wavelengths
  double P[K];

  Stage() : drawn(kWidth), spectra(kWidth * kBins) {
    Pcg32 numbers(1);
    const auto number = [&] { return numbers.uniform(); };
    for (float& s : spectra) s = static_cast<float>(0.2 + 0.6 * number());
    for (int k = 0; k < K; ++k) bins[k] = static_cast<size_t>(3 * k + 1), P[k] = 1.0 / K;
    for (size_t p = 0; p < kWidth; ++p) {
      Drawn<K>& d = drawn[p];
      for (float& x : d.density) x = static_cast<float>(0.1 + number());
      d.scale = d.density[0], d.spectrum = &spectra[p * kBins], d.number = number();
    }
  }
};

template <int K>
class Lanes {
 public:
  Lanes() : lanes_(kWidth) {
    for (Lane<K>& lane : lanes_) lane.begin(K);
  }
  void weigh(const Stage<K>& stage);
  double throughput(size_t p, size_t k) const { return lanes_[p].throughput[k]; }
  double relative(size_t p, size_t k) const { return lanes_[p].relative[k]; }

 private:
  std::vector<Lane<K>> lanes_;
};

// As the kernel does it, one path after the other. Paths that roulette would end start again.
template <int K>
void Lanes<K>::weigh(const Stage<K>& stage) {
  const std::span<const double> P(stage.P);
  for (size_t p = 0; p < kWidth; ++p) {
    Lane<K>& path = lanes_[p];
    const Drawn<K>& on = stage.drawn[p];
    const double own = on.density[0];
    for (size_t k = 0; k < K; ++k) path.throughput[k] *= double{on.scale} * double{on.spectrum[stage.bins[k]]} / own;
    double brightest = K == 1 ? path.throughput[0] : 0, shares = 1;
    if constexpr (K > 1) {
      path.relative.take(K, on.density, own);
      shares = path.relative.mean(P);
      path.relative.divide(K, shares);
      for (size_t k = 0; k < K; ++k) {
        path.throughput[k] /= shares;
        if (!(path.throughput[k] <= brightest)) brightest = path.throughput[k];
      }
    }
    const double alive = survival(brightest, 8, 5);
    if (on.number >= alive) {
      path.begin(K);
      continue;
    }
    if (alive < 1)
      for (size_t k = 0; k < K; ++k) path.throughput[k] /= alive;
    path.before = 1 / shares;
  }
}

template <int K>
class Arrays {
 public:
  Arrays() {
    for (size_t k = 0; k < K; ++k) std::fill_n(t_[k], kWidth, 1.0), std::fill_n(r_[k], kWidth, 1.0);
  }
  void weigh(const Stage<K>& stage);
  double throughput(size_t p, size_t k) const { return t_[k][p]; }
  double relative(size_t p, size_t k) const { return r_[k][p]; }

 private:
  alignas(32) double t_[K][kWidth], r_[K][kWidth], before_[kWidth];
  // Of the stage.
  alignas(32) double w_[K][kWidth], d_[K][kWidth], own_[kWidth], scale_[kWidth], shares_[kWidth], bright_[kWidth];
  alignas(32) double alive_[kWidth];
};

// The same over arrays: what continuations bring is put into arrays first, since models draw one path at a time.
template <int K>
void Arrays<K>::weigh(const Stage<K>& stage) {
  for (size_t p = 0; p < kWidth; ++p) {
    const Drawn<K>& on = stage.drawn[p];
    own_[p] = on.density[0], scale_[p] = on.scale;
    for (size_t k = 0; k < K; ++k) w_[k][p] = double{on.spectrum[stage.bins[k]]}, d_[k][p] = double{on.density[k]};
  }
  for (size_t k = 0; k < K; ++k)
    for (size_t p = 0; p < kWidth; ++p) t_[k][p] *= scale_[p] * w_[k][p] / own_[p];
  if constexpr (K == 1) {
    std::copy_n(t_[0], kWidth, bright_);
    std::fill_n(shares_, kWidth, 1.0);
  } else {
    std::fill_n(shares_, kWidth, 0.0);
    std::fill_n(bright_, kWidth, 0.0);
    for (size_t k = 0; k < K; ++k)
      for (size_t p = 0; p < kWidth; ++p) {
        r_[k][p] *= d_[k][p] / own_[p];
        shares_[p] += stage.P[k] * r_[k][p];
      }
    for (size_t k = 0; k < K; ++k)
      for (size_t p = 0; p < kWidth; ++p) {
        r_[k][p] /= shares_[p];
        t_[k][p] /= shares_[p];
        bright_[p] = t_[k][p] <= bright_[p] ? bright_[p] : t_[k][p];
      }
  }
  for (size_t p = 0; p < kWidth; ++p) alive_[p] = survival(bright_[p], 8, 5);
  for (size_t k = 0; k < K; ++k)
    for (size_t p = 0; p < kWidth; ++p) t_[k][p] /= alive_[p];
  for (size_t p = 0; p < kWidth; ++p) before_[p] = 1 / shares_[p];
  for (size_t p = 0; p < kWidth; ++p)
    if (stage.drawn[p].number >= alive_[p])
      for (size_t k = 0; k < K; ++k) t_[k][p] = r_[k][p] = 1;
}

template <class Paths, class Of>
void run(Paths& paths, const Of& stage, size_t events) {
  for (size_t i = 0; i < events; i += kWidth) paths.weigh(stage);
}

// ns a path and event.
template <class Paths, class Of>
double least(Paths& paths, const Of& stage) {
  constexpr size_t kEvents = 100 * kWidth;
  double best = 1e9;
  for (int i = 0; i < 200; ++i) {
    timespec start, end;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &start);
    run(paths, stage, kEvents);
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    best = std::min(
        best, 1e9 * static_cast<double>(end.tv_sec - start.tv_sec) + static_cast<double>(end.tv_nsec - start.tv_nsec));
  }
  return best / kEvents;
}

template <int K>
bool compare() {
  const Stage<K> stage;
  const auto lanes = std::make_unique<Lanes<K>>();
  const auto arrays = std::make_unique<Arrays<K>>();
  const double by_lanes = least(*lanes, stage), by_arrays = least(*arrays, stage);
  bool same = true;
  for (size_t p = 0; p < kWidth; ++p)
    for (size_t k = 0; k < K; ++k)
      same = same && lanes->throughput(p, k) == arrays->throughput(p, k) &&
             lanes->relative(p, k) == arrays->relative(p, k);
  std::cout << "hero wavelengths " << K << ": lanes " << by_lanes << " ns, arrays " << by_arrays << " ns, "
            << (same ? "same bits" : "OTHER BITS") << "\n";
  return same;
}

template <int K>
void run_one(bool arrays, size_t events) {
  const Stage<K> stage;
  const auto by_lanes = std::make_unique<Lanes<K>>();
  const auto by_arrays = std::make_unique<Arrays<K>>();
  arrays ? run(*by_arrays, stage, events) : run(*by_lanes, stage, events);
}

}  // namespace
}  // namespace suite

int main(int argc, char** argv) {
  if (argc == 4) {
    const bool arrays = std::strcmp(argv[1], "arrays") == 0;
    const size_t events = std::stoul(argv[3]);
    std::strcmp(argv[2], "ONE") == 0 ? suite::run_one<1>(arrays, events) : suite::run_one<8>(arrays, events);
    return 0;
  }
  const bool one = suite::compare<1>(), eight = suite::compare<8>();
  return one && eight ? 0 : 1;
}
