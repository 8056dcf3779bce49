// The border to C: no exception crosses it. What is thrown within becomes a code and a message of the thread.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "math/vec.h"

namespace suite {

// Runs `work`; RS_OK, or what remote_scenes.h says of a fault.
int at_border(const std::function<void()>& work);

// The same, of calls that may warn: what `work` adds is rs_told() of the thread afterwards, one sentence a line.
int at_border(const std::function<void(std::vector<std::string>& told)>& work);

// Throws Error unless `given` is there: `name` is that of the parameter.
void need(const void* given, const char* name);
// The i-th row of an n x 3 array.
inline Vec3 row3(const double* array, size_t i) { return {array[3 * i], array[3 * i + 1], array[3 * i + 2]}; }
inline void put3(double* array, size_t i, const Vec3& v) {
  array[3 * i] = v.x, array[3 * i + 1] = v.y, array[3 * i + 2] = v.z;
}
// Error naming the row unless all of an n x 3 array are unit vectors within 1e-6.
void need_units(const double* array, size_t n, const char* name);
// Error naming the row unless all numbers are finite. per: numbers a row.
void need_finite(const double* array, size_t n, size_t per, const char* name);

// body(begin, end) over [0, n) on all cores, denormals as the ray tracer wants them.
void in_parallel(size_t n, const std::function<void(size_t, size_t)>& body);

}  // namespace suite
