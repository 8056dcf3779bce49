#include "apps/in-process/border.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>

#include "apps/in-process/remote_scenes.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/run_app.h"
#include "trace/tracer.h"

namespace suite {

namespace {

// Of the thread, so that callers do not mix theirs up.
std::string& message() {
  thread_local std::string text;
  return text;
}

std::string& messages() {
  thread_local std::string text;
  return text;
}

int refused(int code, const char* text) {
  try {
    message() = text;
    while (message().ends_with('\n')) message().pop_back();
  } catch (const std::bad_alloc&) {
    message().clear();
  }
  return code;
}

}  // namespace

int at_border(const std::function<void()>& work) {
  try {
    work();
    return RS_OK;
  } catch (const Error& e) {
    return refused(RS_INPUT, e.what());
  } catch (const std::bad_alloc&) {
    return refused(RS_INPUT, "error: there is not enough memory");
  } catch (const std::exception& e) {
    return refused(RS_BUG, e.what());
  } catch (...) {
    return refused(RS_BUG, "error: something unknown was thrown");
  }
}

int at_border(const std::function<void(std::vector<std::string>& sentences)>& work) {
  return at_border([&]() {
    messages().clear();
    std::vector<std::string> sentences;
    work(sentences);
    for (const std::string& sentence : sentences) messages() += (messages().empty() ? "" : "\n") + sentence;
  });
}

uintptr_t new_handle() {
  static std::atomic<uintptr_t> last{0};
  return 16 * ++last;  // never 0, and as even as an address
}

void need(const void* given, const char* name) {
  if (!given) throw Error(std::string(name) + " is NULL");
}

void need_units(const double* array, size_t n, const char* name) {
  for (size_t i = 0; i < n; ++i)
    if (const Vec3 v = row3(array, i); !(std::fabs(dot(v, v) - 1) <= 2e-6))
      throw Error(strf("%s: row %zu (%g, %g, %g) is no unit vector", name, i, v.x, v.y, v.z),
                  "divide directions by their length");
}

void need_finite(const double* array, size_t n, size_t per, const char* name) {
  for (size_t i = 0; i < n * per; ++i)
    if (!(std::fabs(array[i]) <= kLargestNumber))
      throw Error(strf("%s: row %zu has %g", name, i / per, array[i]), strf("numbers up to %g", kLargestNumber));
}

void in_parallel(size_t n, const std::function<void(size_t, size_t)>& body) {
  parallel_for(0, n, 1024, [&](size_t begin, size_t end) {
    const FlushDenormals flush;
    body(begin, end);
  });
}

}  // namespace suite

int rs_interface(void) { return RS_INTERFACE; }
const char* rs_version(void) { return suite::kVersion; }
const char* rs_message(void) { return suite::message().c_str(); }
const char* rs_told(void) { return suite::messages().c_str(); }

int rs_set_threads(int threads) {
  return suite::at_border([&] {
    if (threads < 0 || threads > 4096) throw suite::Error(suite::strf("%d threads", threads), "0 to 4096");
    suite::set_threads(threads);
  });
}
