#include "transport/parallel_faces.h"

#include <vector>

namespace suite {

double passed(std::span<const double> reflectance) {
  double sum = 1;
  for (const double r : reflectance) {
    if (!(r < 1)) return 0;
    sum += r / (1 - r);
  }
  return 1 / sum;
}

double passed_within(std::span<const double> reflectance, int most) {
  const size_t faces = reflectance.size();
  if (faces == 0) return 1;
  if (most < 0 || faces > static_cast<size_t>(most)) return 0;
  // Light on its way to face i, onward and back; what comes back from the first has left.
  std::vector<double> on(faces + 1, 0.0), back(faces, 0.0), next_on, next_back;
  on[0] = 1;
  double sum = 0;
  for (int meeting = 0; meeting < most; ++meeting) {
    next_on.assign(faces + 1, 0.0), next_back.assign(faces, 0.0);
    for (size_t i = 0; i < faces; ++i) {
      const double r = reflectance[i];
      next_on[i + 1] += on[i] * (1 - r) + back[i] * r;
      if (i > 0) next_back[i - 1] += on[i] * r + back[i] * (1 - r);
    }
    sum += next_on[faces];
    next_on[faces] = 0;
    on.swap(next_on), back.swap(next_back);
  }
  return sum;
}

}  // namespace suite
