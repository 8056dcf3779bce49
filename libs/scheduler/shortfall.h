// What results are known to lack: light that was not found (transport/lost_light.h), light that was cut at the maximum
// number of nodes (Accumulators::shortfall), samples that were rejected. Counted problem by problem, told per sensor.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "transport/pipeline.h"

namespace suite {

// Of one problem, at the reference band. Shares are of what it would show with what it lacks, 0..1.
struct Lack {
  double cut = 0, missing = 0;
  uint32_t rejected = 0;  // samples
  // More than 1 % cut, more than 0.1 % not found.
  bool truncated() const { return cut > 0.01; }
  bool unresolved() const { return missing > 1e-3; }
};

// Of the problems of a capture, or of all captures of a sensor.
struct Shortfall {
  // Problems with one flag, and their shares.
  struct Part {
    size_t problems = 0;
    double sum = 0, most = 0;
    double mean() const { return problems ? sum / static_cast<double>(problems) : 0; }
    void add(double share) { ++problems, sum += share, most = most > share ? most : share; }
    void merge(const Part& o) { problems += o.problems, sum += o.sum, most = most > o.most ? most : o.most; }
  };
  size_t problems = 0;
  Part unresolved, truncated;
  size_t rejecting = 0;  // problems that rejected samples
  uint64_t rejected = 0;
  void merge(const Shortfall& o);
};
Shortfall shortfall_of(std::span<const Lack> problems);

// One sentence about each thing that a sensor's results lack: how many problems, how much, what helps.
std::vector<std::string> sentences(const std::string& sensor, const Shortfall& shortfall);

// Sentences about sources whose light paths of a state will not find: behind smooth refracting surfaces, which is
// estimated, and by way of mirrors, which is not. paths: that a problem takes at most; disks that these meet often
// enough are left out. repeats: the scene does.
std::vector<std::string> lost_light(const Scene& scene, const SourceSpecs& sources, const Optics& optics,
                                    const PipelineOptions& options, uint32_t paths, bool repeats);

}  // namespace suite
