// What results are known to lack: light that was not found (transport/lost_light.h), light that was cut at the maximum
// number of nodes (Accumulators::shortfall), samples that were rejected. Counted problem by problem, reported per
// sensor.
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "transport/pipeline.h"

namespace suite {

// Of one problem, at the reference band. Shares are of what it would show with what it lacks, 0..1.
struct Lack {
  static constexpr double kCut = 0.01, kMissing = 1e-3, kOfError = 0.1;
  double cut = 0, missing = 0;
  // Its standard error over its radiance, without what it lacks; infinite where that is not known.
  double error = 0;
  uint32_t rejected = 0;  // samples
  // More than 1 % cut, more than 0.1 % not found; and more than a tenth of the error, which less enlarges by 0.5 % at
  // most.
  bool truncated() const { return matters(cut, kCut); }
  bool unresolved() const { return matters(missing, kMissing); }

 private:
  bool matters(double share, double least) const {
    return share > least && !(error < INFINITY && share / (1 - share) <= kOfError * error);
  }
};

// Of the problems of a capture, or of all captures of a sensor.
struct Shortfall {
  // Problems with one flag, and their shares; and the sum of the shares of all problems, flagged or not.
  struct Part {
    size_t problems = 0;
    double sum = 0, most = 0, all = 0;
    double mean() const { return problems ? sum / static_cast<double>(problems) : 0; }
    void add(double share, bool flagged) {
      all += share;
      if (flagged) ++problems, sum += share, most = most > share ? most : share;
    }
    void merge(const Part& o) {
      problems += o.problems, sum += o.sum, all += o.all, most = most > o.most ? most : o.most;
    }
  };
  size_t problems = 0;
  Part unresolved, truncated;
  size_t rejecting = 0;  // problems that rejected samples
  uint64_t rejected = 0;
  double mean_of_all(const Part& part) const { return problems ? part.all / static_cast<double>(problems) : 0; }
  void merge(const Shortfall& o);
};
Shortfall shortfall_of(std::span<const Lack> problems);

// One diagnostic for each thing that a sensor's results lack: how many problems, how much, what helps. Also where no
// problem is flagged for its noise, but the mean of all lacks as much as flags one. Light that was not found is known
// along straight lines only (transport/lost_light.h): what curved surfaces and mirrors focus is more, by no known
// factor, and the text says so.
std::vector<Diagnostic> diagnose_shortfall(const std::string& sensor, const Shortfall& shortfall);

// Paths that leaked out of bodies of media where these have no boundary, as out of a sheet of water that ends in the
// open: nothing where that is less than kStrays of their throughput, more than rounding at edges of meshes makes.
inline constexpr double kStrays = 1e-4;
std::optional<Diagnostic> diagnose_leaks(const RunStatistics& statistics, const Scene& scene);

// Sources whose light the paths of a state will not find: behind smooth refracting surfaces, which is estimated, and
// caustics by way of mirrors, which are not. paths: that a problem takes at most; disks that these meet often
// enough are left out. repeats: the scene does.
std::vector<Diagnostic> diagnose_lost_light(const Scene& scene, const SourceSpecs& sources, const Optics& optics,
                                            const PipelineOptions& options, uint32_t paths, bool repeats);

}  // namespace suite
