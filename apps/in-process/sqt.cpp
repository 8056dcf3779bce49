// Fitted scattering functions at the border: arrays of directions against sqt::Bundle.
#include <cmath>

#include "apps/in-process/border.h"
#include "apps/in-process/remote_scenes.h"
#include "base/error.h"
#include "formats/sqt/sqt.h"

struct rs_sqt {
  suite::SqtFile file;
};

namespace suite {

namespace {

Handles<rs_sqt>& functions() {
  static auto* const all = new Handles<rs_sqt>;  // never destroyed: threads may use it to the end of the process
  return *all;
}

std::shared_ptr<const sqt::Bundle> bundle_of(const rs_sqt* sqt) { return functions().get(sqt, "sqt")->file.bundle; }

void need_channel(const sqt::Bundle& bundle, size_t channel) {
  if (channel >= bundle.channels())
    throw Error(strf("there is no channel %zu", channel), strf("channels are 0 to %zu", bundle.channels() - 1));
}

// For each of n directions a row of `per` numbers.
template <class Row>
int rows(size_t n, const double* out, double* to, size_t per, const Row& row) {
  if (n == 0) return RS_OK;
  need(out, "out");
  need(to, "the array of answers");
  need_units(out, n, "out");
  in_parallel(n, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) row(i, row3(out, i), std::span(to + i * per, per));
  });
  return RS_OK;
}

void need_in(size_t n, const double* in) {
  if (n == 0) return;
  need(in, "in");
  need_units(in, n, "in");
}

constexpr Vec3 kNowhere{NAN, NAN, NAN};

}  // namespace

}  // namespace suite

using suite::at_border;

int rs_sqt_open(const char* path, rs_sqt** sqt) {
  return at_border([&] {
    suite::need(path, "path");
    suite::need(sqt, "sqt");
    *sqt = suite::functions().add(std::make_shared<const rs_sqt>(suite::read_sqt(path)));
  });
}

void rs_sqt_close(rs_sqt* sqt) { suite::functions().close(sqt); }

const char* rs_sqt_header(const rs_sqt* handle) {
  const auto sqt = suite::functions().find(handle);
  return sqt ? sqt->file.header.c_str() : nullptr;
}

void rs_sqt_describe(const rs_sqt* handle, rs_sqt_info* info) {
  *info = {};
  const auto sqt = suite::functions().find(handle);
  if (!sqt) return;
  const suite::sqt::Bundle& bundle = *sqt->file.bundle;
  const suite::sqt::Bundle::Info& known = bundle.info();
  *info = {bundle.channels(),
           known.magnitude_um.size(),
           known.function.wavelength_um.data(),
           known.magnitude_um.data(),
           bundle.cosine_weighted(),
           known.function.domain == suite::sqt::Domain::sphere,
           static_cast<int>(known.delta)};
}

int rs_sqt_evaluate(const rs_sqt* sqt, size_t n, const double* out, const double* in, double* f) {
  return at_border([&] {
    const auto held = suite::bundle_of(sqt);
    const suite::sqt::Bundle& bundle = *held;
    suite::need_in(n, in);
    suite::rows(n, out, f, bundle.channels(),
                [&](size_t i, suite::Dir o, std::span<double> to) { bundle.value(o, suite::row3(in, i), to); });
  });
}

int rs_sqt_total(const rs_sqt* sqt, size_t n, const double* out, double* total) {
  return at_border([&] {
    const auto held = suite::bundle_of(sqt);
    const suite::sqt::Bundle& bundle = *held;
    suite::rows(n, out, total, bundle.channels(), [&](size_t, suite::Dir o, std::span<double> to) {
      for (size_t c = 0; c < to.size(); ++c) to[c] = bundle.total(o, c);
    });
  });
}

int rs_sqt_magnitude(const rs_sqt* sqt, size_t n, const double* out, double* total) {
  return at_border([&] {
    const auto held = suite::bundle_of(sqt);
    const suite::sqt::Bundle& bundle = *held;
    suite::rows(n, out, total, bundle.info().magnitude_um.size(),
                [&](size_t, suite::Dir o, std::span<double> to) { bundle.magnitude(o, to); });
  });
}

int rs_sqt_sample(const rs_sqt* sqt, size_t n, const double* out, size_t channel, const double* u, double* in,
                  double* pdf) {
  return at_border([&] {
    const auto held = suite::bundle_of(sqt);
    const suite::sqt::Bundle& bundle = *held;
    suite::need_channel(bundle, channel);
    if (n) suite::need(u, "u");
    for (size_t i = 0; i < 3 * n; ++i)
      if (!(u[i] >= 0 && u[i] < 1)) throw suite::Error(suite::strf("u: row %zu has %g", i / 3, u[i]), "[0, 1)");
    suite::rows(n, out, in, 3, [&](size_t i, suite::Dir o, std::span<double> to) {
      const auto drawn = bundle.sample(o, {u[3 * i], u[3 * i + 1]}, u[3 * i + 2], channel);
      suite::put3(to.data(), 0, drawn.value_or(suite::kNowhere));
      if (pdf) pdf[i] = drawn ? bundle.pdf(o, *drawn, channel) : 0;
    });
  });
}

int rs_sqt_pdf(const rs_sqt* sqt, size_t n, const double* out, const double* in, double* pdf) {
  return at_border([&] {
    const auto held = suite::bundle_of(sqt);
    const suite::sqt::Bundle& bundle = *held;
    suite::need_in(n, in);
    suite::rows(n, out, pdf, bundle.channels(),
                [&](size_t i, suite::Dir o, std::span<double> to) { bundle.pdf(o, suite::row3(in, i), to); });
  });
}

int rs_sqt_dirac(const rs_sqt* sqt, size_t n, const double* out, size_t channel, double* in, double* total) {
  return at_border([&] {
    const auto held = suite::bundle_of(sqt);
    const suite::sqt::Bundle& bundle = *held;
    suite::need_channel(bundle, channel);
    if (n) suite::need(total, "total");
    suite::rows(n, out, in, 3, [&](size_t i, suite::Dir o, std::span<double> to) {
      const auto lobe = bundle.info().has_delta() ? bundle.delta(o, channel) : std::nullopt;
      suite::put3(to.data(), 0, lobe ? lobe->in : suite::kNowhere);
      total[i] = lobe ? lobe->total : 0;
    });
  });
}
