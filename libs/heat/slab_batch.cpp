// One step of a batch. With C the heat capacities, K the conduction and s = d dt the stages solve
//   C x + s (K x + face losses(x)) = right,
// and because properties are constant the gains of a stage follow from its own equation.
#include "heat/slab_batch.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "thermal/step_control.h"
#include "thermal/tr_bdf2.h"

namespace suite {

using namespace tr_bdf2;

namespace {

constexpr double kCurve = kW / kD;  // the end stage starts from now + kCurve (middle - now)

}  // namespace

SlabBatch::SlabBatch(std::vector<SlabLayer> layers, size_t elements, SlabBatchOptions options)
    : layers_(std::move(layers)), elements_(elements), top_lines_(elements), bottom_lines_(elements) {
  check_slab_layers(layers_);
  linear_ = has_constant_properties(layers_);
  if (elements_ == 0) throw Error("a batch of slabs without an element", "at least one");
  if (!(options.resolution > 0 && std::isfinite(options.resolution)))
    throw Error(strf("a resolution of %g s", options.resolution), "more than 0");
  neighbours_ = std::move(options.neighbours), left_ = options.left;
  if (neighbours_) SUITE_CHECK_EQ(neighbours_->size(), elements_);
  grid_ = make_slab_grid(layers_, options.resolution, options.fast_below);
  const size_t n = nodes(), blocks = (elements_ + kLanes - 1) / kLanes;
  now_.resize(blocks * n);
  for (auto* v : {&middle_, &gain_, &right_, &heat_}) v->resize(n);
  matrix_.resize(n);
  for (auto* v : {&top_mean_, &bottom_mean_, &estimate_}) v->resize(elements_);
  for (auto* v : {&elimination_.up, &elimination_.down, &elimination_.pivot, &elimination_.beta, &elimination_.gamma})
    v->resize(n);
  start(0, 300);
}

void SlabBatch::start(double t, double kelvin) {
  if (!(kelvin >= 1 && kelvin <= 1e4)) throw Error(strf("a slab starts at %g K", kelvin), "1 to 10000 K");
  t_ = t;
  next_step_ = 1;
  std::fill(now_.begin(), now_.end(), Lanes(kelvin));
}

void SlabBatch::set_kelvin(size_t element, size_t node, double kelvin) {
  SUITE_CHECK(element < elements_ && node < nodes());
  if (!(kelvin >= 1 && kelvin <= 1e4)) throw Error(strf("a node of a slab is set to %g K", kelvin), "1 to 10000 K");
  now_[index(element, node)].set(element % kLanes, kelvin);
}

void SlabBatch::eliminate(double scale) {
  if (elimination_.scale == scale) return;
  Elimination& e = elimination_;
  const std::vector<double>&k = grid_.conductance[0], &c = grid_.heat[0];
  const size_t n = nodes(), last = n - 2;  // the last node that is eliminated, or the top face itself
  auto diagonal = [&](size_t i) { return c[i] + scale * ((i > 0 ? k[i - 1] : 0) + (i + 1 < n ? k[i] : 0)); };
  std::vector<double> reach(n, 0.0);  // what the bottom's temperature adds to right'
  double d = diagonal(last);
  reach[last] = scale * k[last];
  for (size_t i = last; i-- > 0;) {
    e.pivot[i + 1] = 1 / d;
    e.up[i] = -scale * k[i] * e.pivot[i + 1];
    e.down[i + 1] = -scale * k[i] * e.pivot[i + 1];
    reach[i] = -e.up[i] * reach[i + 1];
    d = diagonal(i) + e.up[i] * scale * k[i];
  }
  e.top_diagonal = d;
  e.coupling = reach[0];
  e.beta[0] = 1;
  e.gamma[0] = 0;
  for (size_t i = 1; i <= last; ++i) {
    e.beta[i] = -e.down[i] * e.beta[i - 1];
    e.gamma[i] = e.pivot[i] * reach[i] - e.down[i] * e.gamma[i - 1];
  }
  e.bottom_conductance = scale * k[last];
  e.bottom_diagonal = diagonal(n - 1) - e.bottom_conductance * e.gamma[last];
  e.scale = scale;
  ++counters_.eliminations;
}

void SlabBatch::check_lines(const FaceLines& lines, const char* which) const {
  SUITE_CHECK(lines.constant.size() == elements_ && lines.linear.size() == elements_ &&
              lines.quartic.size() == elements_);
  bool good = true;
  for (size_t e = 0; e < elements_; ++e) {
    const StepLine &c = lines.constant[e], &l = lines.linear[e];
    good = good && std::isfinite(c.begin) && std::isfinite(c.end) && l.begin >= 0 && l.end >= 0 && l.begin < INFINITY &&
           l.end < INFINITY && lines.quartic[e] >= 0 && lines.quartic[e] < INFINITY;
  }
  if (!good)
    throw Error(strf("the loads on the %s of slabs are no loads at %.9g s", which, t_),
                "finite numbers, exchange 0 or more");
}

SlabBatch::FaceEnds SlabBatch::gather(size_t block) const {
  FaceEnds f;
  const size_t from = block * kLanes;
  for (size_t l = 0; l < kLanes; ++l) {
    const size_t e = std::min(from + l, elements_ - 1);  // lanes that are left over do as the last element
    const auto put = [l, e](const FaceLines& lines, Faces::One& begin, Faces::One& end) {
      begin.constant.set(l, lines.constant[e].begin);
      begin.linear.set(l, lines.linear[e].begin);
      begin.quartic.set(l, lines.quartic[e]);
      end.constant.set(l, lines.constant[e].end);
      end.linear.set(l, lines.linear[e].end);
    };
    put(top_lines_, f.begin.top, f.end.top);
    put(bottom_lines_, f.begin.bottom, f.end.bottom);
  }
  f.end.top.quartic = f.begin.top.quartic;
  f.end.bottom.quartic = f.begin.bottom.quartic;
  return f;
}

SlabBatch::Faces SlabBatch::FaceEnds::at(double fraction) const {
  Faces now = begin;
  for (size_t l = 0; l < kVectors; ++l) {
    now.top.constant.v[l] += fraction * (end.top.constant.v[l] - begin.top.constant.v[l]);
    now.top.linear.v[l] += fraction * (end.top.linear.v[l] - begin.top.linear.v[l]);
    now.bottom.constant.v[l] += fraction * (end.bottom.constant.v[l] - begin.bottom.constant.v[l]);
    now.bottom.linear.v[l] += fraction * (end.bottom.linear.v[l] - begin.bottom.linear.v[l]);
  }
  return now;
}

double SlabBatch::Lanes::largest() const {
  double most = v[0][0];
  for (size_t l = 1; l < kLanes; ++l) most = get(l) > most ? get(l) : most;
  return most;
}

// Eliminates upwards in place, then gathers downwards what the nodes between the faces are by themselves, also in
// place: right[0] is the top face's equation, right[n - 1] the bottom's; returns own of the last node between.
SlabBatch::Lanes SlabBatch::rise(Lanes* right) const {
  const Elimination& e = elimination_;
  const size_t n = nodes();
  for (size_t i = n - 2; i-- > 0;) {
    const double up = e.up[i];
    Four* r = right[i].v;
    const Four* below = right[i + 1].v;
    for (size_t l = 0; l < kVectors; ++l) r[l] -= up * below[l];
  }
  Lanes own;
  for (size_t i = 1; i + 1 < n; ++i) {
    const double pivot = e.pivot[i], down = e.down[i];
    Four* r = right[i].v;
    for (size_t l = 0; l < kVectors; ++l) r[l] = own.v[l] = pivot * r[l] - down * own.v[l];
  }
  return own;
}

// All nodes from those of the faces.
void SlabBatch::fall(const Lanes* right, const Lanes& top, const Lanes& bottom, Lanes* kelvin) const {
  const size_t n = nodes();
  kelvin[0] = top;
  for (size_t i = 1; i + 1 < n; ++i) {
    const double beta = elimination_.beta[i], gamma = elimination_.gamma[i];
    const Four* r = right[i].v;
    Four* T = kelvin[i].v;
    for (size_t l = 0; l < kVectors; ++l) T[l] = r[l] + beta * top.v[l] + gamma * bottom.v[l];
  }
  kelvin[n - 1] = bottom;
}

// Newton's method for the two faces from the start in top and bottom.
void SlabBatch::solve_faces(const Lanes* right, const Lanes& own, const Faces& faces, Lanes& top, Lanes& bottom) const {
  const Elimination& e = elimination_;
  const double s = e.scale, d_top = e.top_diagonal, d_bottom = e.bottom_diagonal, across = e.coupling;
  const Four *right_top = right[0].v, *right_bottom = right[nodes() - 1].v;
  constexpr double kEnough = 1e-4;  // K: the next change would be its square by some hundred kelvin
  double worst = INFINITY;
  for (int k = 0; k < 60 && worst > kEnough; ++k) {
    Lanes change;
    for (size_t l = 0; l < kVectors; ++l) {
      const auto t = top.v[l], b = bottom.v[l];
      const auto qt = faces.top.quartic.v[l] * t * t * t, qb = faces.bottom.quartic.v[l] * b * b * b;
      const auto gt = faces.top.linear.v[l], gb = faces.bottom.linear.v[l];
      const auto over_top = d_top * t - across * b - right_top[l] - s * (faces.top.constant.v[l] - (gt + qt) * t);
      const auto over_bottom = d_bottom * b - across * t - right_bottom[l] - e.bottom_conductance * own.v[l] -
                               s * (faces.bottom.constant.v[l] - (gb + qb) * b);
      const auto jt = d_top + s * (gt + 4 * qt), jb = d_bottom + s * (gb + 4 * qb);
      const auto scale = 1.0 / (jt * jb - across * across);
      const auto dt = -(jb * over_top + across * over_bottom) * scale;
      const auto db = -(jt * over_bottom + across * over_top) * scale;
      const auto next_t = t + dt, next_b = b + db;
      top.v[l] = next_t < 0.1 * t ? 0.1 * t : next_t;
      bottom.v[l] = next_b < 0.1 * b ? 0.1 * b : next_b;
      const auto far_t = dt < 0 ? -dt : dt, far_b = db < 0 ? -db : db;
      change.v[l] = far_t > far_b ? far_t : far_b;
    }
    worst = change.largest();
  }
}

// The trapezoidal rule over kGamma of the step; keeps the gains at its begin.
void SlabBatch::middle_stage(size_t block, double dt, const FaceEnds& faces) {
  const size_t n = nodes();
  const Lanes* now = &now_[block * n];
  const std::vector<double>&k = grid_.conductance[0], &c = grid_.heat[0], &source = grid_.source;
  const double s = kD * dt;
  const Faces& begin = faces.begin;
  Lanes above;  // flux into the node from above
  for (size_t l = 0; l < kVectors; ++l) {
    const auto T = now[0].v[l];
    above.v[l] = begin.top.constant.v[l] - T * (begin.top.linear.v[l] + begin.top.quartic.v[l] * T * T * T);
  }
  for (size_t i = 0; i < n; ++i) {
    const double conductance = i + 1 < n ? k[i] : 0, heat = c[i], own = source[i];
    const Four *T = now[i].v, *next = now[i + 1 < n ? i + 1 : i].v;
    Four *g = gain_[i].v, *r = right_[i].v;
    for (size_t l = 0; l < kVectors; ++l) {
      const auto below = conductance * (T[l] - next[l]);
      g[l] = own + above.v[l] - below;
      above.v[l] = below;
      r[l] = heat * T[l] + s * (g[l] + own);
    }
  }
  for (size_t l = 0; l < kVectors; ++l) {
    const auto T = now[n - 1].v[l];
    const auto flux =
        begin.bottom.constant.v[l] - T * (begin.bottom.linear.v[l] + begin.bottom.quartic.v[l] * T * T * T);
    gain_[n - 1].v[l] += flux;
    right_[n - 1].v[l] += s * flux;
  }
  const Lanes own = rise(right_.data());
  Lanes top = now[0], bottom = now[n - 1];
  solve_faces(right_.data(), own, faces.at(kGamma), top, bottom);
  fall(right_.data(), top, bottom, middle_.data());
}

// Backward differences over both stages.
void SlabBatch::end_stage(size_t block, const FaceEnds& faces) {
  const size_t n = nodes();
  const Lanes* now = &now_[block * n];
  for (size_t i = 0; i < n; ++i) {
    const double heat = grid_.heat[0][i], own = elimination_.scale * grid_.source[i];
    const Four *T = now[i].v, *m = middle_[i].v;
    Four* r = right_[i].v;
    for (size_t l = 0; l < kVectors; ++l) r[l] = heat * (T[l] + kCurve * (m[l] - T[l])) + own;
  }
  const Lanes own = rise(right_.data());
  Lanes top = middle_[0], bottom = middle_[n - 1];
  solve_faces(right_.data(), own, faces.end, top, bottom);
  fall(right_.data(), top, bottom, &end_[block * n]);
}

// The difference to the embedded result, through the stage's own matrix so that stiff nodes do not exaggerate it.
void SlabBatch::estimate_error(size_t block, double dt, const FaceEnds& faces) {
  const size_t n = nodes();
  const Lanes *now = &now_[block * n], *end = &end_[block * n];
  for (size_t i = 0; i < n; ++i) {
    const double heat = grid_.heat[0][i];
    const Four *T = now[i].v, *m = middle_[i].v, *e = end[i].v, *g = gain_[i].v;
    Four* r = right_[i].v;
    for (size_t l = 0; l < kVectors; ++l) {
      const auto to_middle = m[l] - T[l], rest = e[l] - T[l] - kCurve * to_middle;
      r[l] = heat / kD * (kError2 * to_middle + kError3 * rest) + dt * (kError1 - kError2) * g[l];
    }
  }
  const Lanes own = rise(right_.data());
  Faces slopes = faces.end;  // of the losses at the end, as lines
  for (size_t l = 0; l < kVectors; ++l) {
    const auto t = end[0].v[l], b = end[n - 1].v[l];
    slopes.top.linear.v[l] += 4 * slopes.top.quartic.v[l] * t * t * t;
    slopes.bottom.linear.v[l] += 4 * slopes.bottom.quartic.v[l] * b * b * b;
  }
  Lanes top, bottom;
  const Elimination& f = elimination_;
  for (size_t l = 0; l < kVectors; ++l) {
    const auto jt = f.top_diagonal + f.scale * slopes.top.linear.v[l],
               jb = f.bottom_diagonal + f.scale * slopes.bottom.linear.v[l];
    const auto a = right_[0].v[l], b = right_[n - 1].v[l] + f.bottom_conductance * own.v[l];
    const auto scale = 1.0 / (jt * jb - f.coupling * f.coupling);
    top.v[l] = (jb * a + f.coupling * b) * scale;
    bottom.v[l] = (jt * b + f.coupling * a) * scale;
  }
  fall(right_.data(), top, bottom, middle_.data());
  keep_estimates(block, middle_.data());
}

void SlabBatch::keep_means(size_t block) {
  constexpr double kVanished = 1e-3;  // K: Newton's method looked for a temperature below 0 K
  const size_t n = nodes();
  const Lanes *now = &now_[block * n], *end = &end_[block * n];
  for (size_t l = 0; l < kLanes && block * kLanes + l < elements_; ++l) {
    const size_t e = block * kLanes + l;
    top_mean_[e] = kW * (now[0].get(l) + middle_[0].get(l)) + kD * end[0].get(l);
    bottom_mean_[e] = kW * (now[n - 1].get(l) + middle_[n - 1].get(l)) + kD * end[n - 1].get(l);
    // A first stage that fell to nothing is mended by the second, as where a search begins far from its loads.
    const double coldest = std::fmin(end[0].get(l), end[n - 1].get(l));
    if (!(coldest > kVanished)) vanished_ = true;
  }
}

// The largest of the nodes; infinite where the stages found no temperatures.
void SlabBatch::keep_estimates(size_t block, const Lanes* errors) {
  const size_t n = nodes();
  Lanes worst, sum;
  for (size_t i = 0; i < n; ++i) {
    const Four *e = errors[i].v, *T = end_[block * n + i].v;
    for (size_t l = 0; l < kVectors; ++l) {
      const auto size = e[l] < 0 ? -e[l] : e[l];
      worst.v[l] = size > worst.v[l] ? size : worst.v[l];
      sum.v[l] += size + T[l];
    }
  }
  for (size_t l = 0; l < kLanes && block * kLanes + l < elements_; ++l)
    estimate_[block * kLanes + l] = std::isfinite(sum.get(l)) ? worst.get(l) : INFINITY;
}

double SlabBatch::attempt(double dt, const BatchLoads& loads) {
  loads(t_, t_ + dt, *this, top_lines_, bottom_lines_);
  end_.resize(now_.size());
  vanished_ = false;
  check_lines(top_lines_, "top");
  check_lines(bottom_lines_, "bottom");
  if (neighbours_) {
    step_lateral(dt);
    return vanished_ ? INFINITY : largest_estimate();
  }
  if (linear_) eliminate(kD * dt);
  const size_t blocks = now_.size() / nodes();
  for (size_t block = 0; block < blocks; ++block) {
    const FaceEnds faces = gather(block);
    if (!linear_) {
      step_newton(block, dt, faces);
      continue;
    }
    middle_stage(block, dt, faces);
    end_stage(block, faces);
    keep_means(block);
    estimate_error(block, dt, faces);  // overwrites the middle
  }
  return vanished_ ? INFINITY : largest_estimate();
}

void SlabBatch::accept(double dt) {
  now_.swap(end_);
  t_ += dt;
  ++counters_.steps;
}

void SlabBatch::step(double dt, const BatchLoads& loads) {
  SUITE_CHECK(dt > 0 && std::isfinite(dt));
  std::isfinite(attempt(dt, loads)) ? accept(dt) : step_in_parts(dt);
}

void SlabBatch::advance(double t, const BatchLoads& loads, const StepControl& control, std::vector<double>* steps) {
  SUITE_CHECK(control.tolerance > 0 && control.max_step > 0 && control.min_step > 0);
  if (!(t >= t_)) throw Error(strf("slabs at %.9g s are asked to go to %.9g s", t_, t), "times ascend");
  const auto take = [&](double dt) {
    accept(dt);
    if (steps) steps->push_back(dt);
  };
  next_step_ = advance_by_error(
      t_, t, std::fmin(next_step_, control.max_step), control, [&](double dt) { return attempt(dt, loads); }, take,
      [this] { ++counters_.rejected; });
}

std::vector<double> refine_steps(double begin, std::span<const double> steps, std::span<const double> asked,
                                 double finest) {
  SUITE_CHECK(finest > 0);
  std::vector<double> refined;
  double t = begin;
  size_t next = 0;
  for (const double dt : steps) {
    t += dt;
    while (next < asked.size() && asked[next] < t - 1e-6 * dt) ++next;
    double left = dt;
    if (next < asked.size() && asked[next] <= t + 1e-6 * dt)
      for (; left / 8 >= finest; left /= 8) refined.push_back(left * 7 / 8);
    refined.push_back(left);
  }
  return refined;
}

}  // namespace suite
