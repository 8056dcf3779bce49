// Families of four children of which not all are known. Internal to libs/sqt_fit.
#pragma once
namespace suite::sqt {

// Children that are not known, in terms of those that are: the mirror image across the symmetry plane, else `rest` of
// the sum and the number of those known. present: bit k set when child k is known; v: the four children's numbers,
// filled in place.
template <class Rest>
void complete(unsigned present, float (&v)[4], Rest rest) {
  if (present == 15) return;
  if (!(present & 2) && (present & 4)) v[1] = v[2], present |= 2;
  if (!(present & 4) && (present & 2)) v[2] = v[1], present |= 4;
  float sum = 0;
  int n = 0;
  for (int k = 0; k < 4; ++k)
    if (present & (1u << k)) sum += v[k], ++n;
  for (int k = 0; k < 4; ++k)
    if (!(present & (1u << k))) v[k] = n ? rest(sum, n) : 0;
}
// Values: the unknown ones are the mean of the others, which is the parent's.
inline void complete_values(unsigned present, float (&v)[4]) {
  complete(present, v, [](float sum, int n) { return sum / static_cast<float>(n); });
}
// Differences from a prediction: three details cannot move a family's mean, so those that nobody will look at take up
// what keeps it where it is and the known ones exact.
inline void complete_differences(unsigned present, float (&v)[4]) {
  complete(present, v, [](float sum, int n) { return -sum / static_cast<float>(4 - n); });
}

}  // namespace suite::sqt
