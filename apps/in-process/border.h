// The border to C: no exception crosses it. What is thrown within becomes a code and a message of the thread.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "math/vec.h"

namespace suite {

// Runs `work`; RS_OK, or what remote_scenes.h says of a fault.
int at_border(const std::function<void()>& work);

// The same, of calls that may warn: what `work` adds is rs_told() of the thread afterwards, one sentence a line.
int at_border(const std::function<void(std::vector<std::string>& sentences)>& work);

// What callers hold of an object: a number that is never given twice, in place of an address. So an object that has
// been closed is known to be, and it lives until the calls that are using it have ended, in whichever threads.
uintptr_t new_handle();
template <class T>
class Handles {
 public:
  T* add(std::shared_ptr<const T> object) {
    T* const handle = reinterpret_cast<T*>(new_handle());
    const std::lock_guard lock(mutex_);
    open_.emplace(handle, std::move(object));
    return handle;
  }
  // Null: closed, or never opened.
  std::shared_ptr<const T> find(const T* handle) const {
    const std::lock_guard lock(mutex_);
    const auto at = open_.find(handle);
    return at == open_.end() ? nullptr : at->second;
  }
  // Throws Error where there is none. name: of the parameter.
  std::shared_ptr<const T> get(const T* handle, const char* name) const {
    if (auto object = find(handle)) return object;
    throw Error(std::string(name) + (handle ? " has been closed" : " is NULL"));
  }
  void close(const T* handle) {
    std::shared_ptr<const T> last;  // goes after the lock
    const std::lock_guard lock(mutex_);
    if (const auto at = open_.find(handle); at != open_.end()) last = std::move(at->second), open_.erase(at);
  }

 private:
  mutable std::mutex mutex_;
  std::map<const T*, std::shared_ptr<const T>> open_;
};

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
