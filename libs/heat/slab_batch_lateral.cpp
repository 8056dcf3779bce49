#include "heat/slab_batch_lateral.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "base/error.h"
#include "base/parallel.h"
#include "thermal/tr_bdf2.h"

namespace suite {

using namespace tr_bdf2;

namespace {

constexpr double kNothing = 1e-11;  // K
constexpr size_t kMostTurns = 50000;

}  // namespace

SlabBatch::Lateral::Lateral(const SlabBatch& batch)
    : b_(batch), net_(*batch.neighbours_), n_(batch.nodes()), blocks_(batch.now_.size() / n_), rows_(blocks_ * n_) {
  const SlabGrid& g = b_.grid_;
  for (size_t m = 0; m < along_.size(); ++m) {
    along_[m].assign(n_, 0);
    for (size_t i = 0; i + 1 < n_; ++i) {  // half of an interval's sheet to each of its nodes
      const double h = g.depth[i + 1] - g.depth[i], half = g.conductance[m][i] * h * h / 2;
      along_[m][i] += half, along_[m][i + 1] += half;
    }
  }
  first_link_.push_back(0);
  for (size_t block = 0; block < blocks_; ++block) {
    for (uint32_t l = 0; l < kLanes && block * kLanes + l < b_.elements_; ++l)
      for (const SlabNeighbours::Other& o : net_.of(block * kLanes + l))
        links_.push_back({l, b_.index(o.element, 0) * kLanes + o.element % kLanes, o.ratio});
    first_link_.push_back(links_.size());
  }
}

// Values of a state as doubles, lane by lane.
template <class State>
static auto values(State& of) {
  using Value = std::conditional_t<std::is_const_v<State>, const double, double>;
  static_assert(sizeof(of[0]) == 16 * sizeof(double));
  return reinterpret_cast<Value*>(of.data());
}

template <class Use>
void SlabBatch::Lateral::every_link(size_t block, const Use& use) const {
  const double* now = values(b_.now_);
  const size_t own = block * n_ * kLanes;
  for (size_t k = first_link_[block]; k < first_link_[block + 1]; ++k) {
    const Link& link = links_[k];
    if (b_.linear_) {
      for (size_t i = 0; i < n_; ++i)
        use(own + i * kLanes + link.lane, link.other + i * kLanes, link.ratio * along_[0][i]);
    } else {
      for (size_t i = 0; i < n_; ++i) {
        const size_t a = own + i * kLanes + link.lane, b = link.other + i * kLanes;
        use(a, b, link.ratio * along(i, (now[a] + now[b]) / 2));
      }
    }
  }
}

template <class Body>
void SlabBatch::Lateral::every_block(const Body& body) const {
  parallel_for(0, blocks_, 16, [&](size_t begin, size_t end) {
    for (size_t block = begin; block < end; ++block) body(block);
  });
}

template <class Term>
double SlabBatch::Lateral::sum(const Term& term) const {
  std::vector<double> terms(blocks_);
  every_block([&](size_t block) { terms[block] = term(block); });
  double all = 0;
  for (const double t : terms) all += t;
  return all;
}

SlabBatch::Lanes SlabBatch::Lateral::weights(size_t block) const {
  Lanes w;
  for (size_t l = 0; l < kLanes && block * kLanes + l < b_.elements_; ++l) w.set(l, net_.area(block * kLanes + l));
  return w;
}

double SlabBatch::Lateral::product(size_t block, const State& a, const State& b) const {
  Lanes sum;
  for (size_t i = block * n_; i < (block + 1) * n_; ++i)
    for (size_t v = 0; v < kVectors; ++v) sum.v[v] += a[i].v[v] * b[i].v[v];
  const Lanes w = weights(block);
  double out = 0;
  for (size_t l = 0; l < kLanes; ++l) out += w.get(l) * sum.get(l);
  return out;
}

void SlabBatch::Lateral::add(const State& kelvin, double factor, State& to) const {
  const double* T = values(kelvin);
  double* in = values(to);
  every_block([&](size_t block) {
    every_link(block, [&](size_t own, size_t other, double g) { in[own] += factor * g * (T[other] - T[own]); });
  });
}

// What neighbours, as they are in `of`, bring into a block's equations, off `from`.
void SlabBatch::Lateral::take_neighbours(size_t block, const State& of, State& from) const {
  const double* x = values(of);
  double* out = values(from);
  every_link(block, [&](size_t own, size_t other, double g) { out[own] -= scale_ * g * x[other]; });
}

// Adds what goes to neighbours, makes the rows symmetric and factors them.
void SlabBatch::Lateral::factor(size_t block, double scale) {
  Row* rows = &rows_[block * n_];
  every_link(block, [&](size_t own, size_t, double g) {
    const size_t l = own % kLanes;
    Lanes& diagonal = rows_[own / kLanes].diagonal;
    diagonal.set(l, diagonal.get(l) + scale * g);
  });
  for (size_t i = 0; i < n_; ++i)
    for (size_t v = 0; v < kVectors; ++v) {
      Four diagonal = rows[i].diagonal.v[v];
      if (i + 1 <
          n_) {  // as with the mean of both conductivities; they are one where it does not depend on temperature
        const Four mean = (rows[i].upper.v[v] + rows[i + 1].lower.v[v]) / 2.0;
        rows[i].upper.v[v] = rows[i + 1].lower.v[v] = mean;
      }
      if (i > 0) diagonal -= rows[i].lower.v[v] * rows[i - 1].upper.v[v];
      const Four pivot = 1.0 / diagonal;
      rows[i].diagonal.v[v] = pivot;
      rows[i].upper.v[v] *= pivot;
    }
}

void SlabBatch::Lateral::precondition(size_t block, const State& right, State& out) const {
  const Row* rows = &rows_[block * n_];
  const Lanes* r = &right[block * n_];
  Lanes* x = &out[block * n_];
  for (size_t i = 0; i < n_; ++i)
    for (size_t v = 0; v < kVectors; ++v)
      x[i].v[v] = (i > 0 ? r[i].v[v] - rows[i].lower.v[v] * x[i - 1].v[v] : r[i].v[v]) * rows[i].diagonal.v[v];
  for (size_t i = n_ - 1; i-- > 0;)
    for (size_t v = 0; v < kVectors; ++v) x[i].v[v] -= rows[i].upper.v[v] * x[i + 1].v[v];
}

void SlabBatch::Lateral::linearise(const State& kelvin, const std::vector<FaceEnds>& faces, double fraction,
                                   double scale) {
  scale_ = scale;
  floor_ = sum([&](size_t block) {
    b_.set_matrix(&kelvin[block * n_], faces[block].at(fraction), scale, &rows_[block * n_]);
    const Lanes w = weights(block);
    double sum = 0;
    for (size_t i = block * n_; i < (block + 1) * n_; ++i)
      for (size_t l = 0; l < kLanes; ++l) sum += w.get(l) * rows_[i].diagonal.get(l);
    factor(block, scale);
    return sum * kNothing * kNothing;
  });
}

void SlabBatch::Lateral::linearise(double capacity, double weight, std::span<const double> top,
                                   std::span<const double> bottom) {
  scale_ = weight;
  every_block([&](size_t block) {
    SlabGrid buffer;
    for (size_t l = 0; l < kLanes; ++l) {
      const size_t e = std::min(block * kLanes + l, b_.elements_ - 1);
      const SlabGrid& g = b_.linearised(e, buffer);
      for (size_t i = 0; i < n_; ++i) {
        const double above = i > 0 ? g.conductance[0][i - 1] : top[e];
        const double below = i + 1 < n_ ? g.conductance[0][i] : bottom[e];
        Row& row = rows_[block * n_ + i];
        row.lower.set(l, -weight * above), row.upper.set(l, -weight * below);
        row.diagonal.set(l, capacity * g.heat[0][i] + weight * (above + below));
      }
    }
    factor(block, weight);
  });
  floor_ = 0;
}

void SlabBatch::Lateral::solve_linear(State& right, double share, double& first) {
  const size_t size = blocks_ * n_;
  State x(size), z(size), p(size), own(right), q(size);  // own: the rows times p, neighbours left out
  const auto every_lane = [&](size_t block, const auto& body) {
    for (size_t i = block * n_; i < (block + 1) * n_; ++i)
      for (size_t v = 0; v < kVectors; ++v) body(i, v);
  };
  double left = sum([&](size_t block) {
    precondition(block, right, z);
    std::copy_n(&z[block * n_], n_, &p[block * n_]);
    return product(block, right, z);
  });
  if (first == 0) first = left;
  const double enough = std::fmax(share * share * first, floor_);
  for (size_t turn = 0; left > enough && turn < kMostTurns; ++turn) {
    const double across = sum([&](size_t block) {
      std::copy_n(&own[block * n_], n_, &q[block * n_]);
      take_neighbours(block, p, q);
      return product(block, p, q);
    });
    if (!(across > 0)) break;
    const double far = left / across;
    const double next = sum([&](size_t block) {
      every_lane(block, [&](size_t i, size_t v) { x[i].v[v] += far * p[i].v[v], right[i].v[v] -= far * q[i].v[v]; });
      precondition(block, right, z);
      return product(block, right, z);
    });
    const double keep = next / left;
    every_block([&](size_t block) {
      every_lane(block, [&](size_t i, size_t v) {
        p[i].v[v] = z[i].v[v] + keep * p[i].v[v];
        own[i].v[v] = right[i].v[v] + keep * own[i].v[v];
      });
    });
    left = next;
  }
  right = std::move(x);
}

bool SlabBatch::Lateral::solve(const State& history, const std::vector<FaceEnds>& faces, double fraction, double scale,
                               State& kelvin, State& heat) {
  // K: the next change would be its square by some hundred kelvin; less so with conductivities of the mean.
  const double enough = b_.linear_ ? 1e-3 : 1e-5;
  const size_t size = blocks_ * n_;
  State gain(size), right(size);
  std::vector<double> change(blocks_, INFINITY);
  double first = 0;
  const auto evaluate = [&] {
    every_block([&](size_t block) {
      const size_t at = block * n_;
      b_.evaluate(&kelvin[at], faces[block].at(fraction), &heat[at], &gain[at]);
    });
  };
  for (int turn = 0; turn < 40 && *std::max_element(change.begin(), change.end()) > enough; ++turn) {
    evaluate();
    add(kelvin, 1, gain);
    every_block([&](size_t block) {
      const Lanes w = weights(block);
      for (size_t i = block * n_; i < (block + 1) * n_; ++i)
        for (size_t v = 0; v < kVectors; ++v) {
          const Four left = history[i].v[v] + scale * gain[i].v[v] - heat[i].v[v];
          right[i].v[v] = w.v[v] > 0.0 ? left : Four{};
        }
    });
    linearise(kelvin, faces, fraction, scale);
    solve_linear(right, b_.left_, first);
    every_block([&](size_t block) {
      Lanes far;
      for (size_t i = block * n_; i < (block + 1) * n_; ++i)
        for (size_t v = 0; v < kVectors; ++v) {
          const Four by = right[i].v[v], T = kelvin[i].v[v], size_of = by < 0.0 ? -by : by;
          kelvin[i].v[v] = T + by < 0.1 * T ? 0.1 * T : T + by;
          far.v[v] = far.v[v] > size_of ? far.v[v] : size_of;
        }
      change[block] = far.largest();
    });
  }
  evaluate();
  return std::ranges::all_of(change, [&](double c) { return c <= enough; });
}

// Backward differences over the whole step, of first order: elements stay within the range of what is around them, as
// the middle of the other scheme does not where neighbours differ by as much as their temperature.
void SlabBatch::step_backward(double dt, const std::vector<FaceEnds>& faces, const std::vector<Lanes>& stored) {
  const size_t n = nodes(), size = now_.size();
  Lateral lateral(*this);
  Lateral::State heat(size);
  end_ = now_;
  const bool found = lateral.solve(stored, faces, 1, dt, end_, heat);
  for (size_t block = 0; block < size / n; ++block) {
    std::copy_n(&end_[block * n], n, middle_.begin());
    keep_means(block);
    for (size_t i = 0; i < n; ++i)  // all that it changes may be wrong
      for (size_t v = 0; v < kVectors; ++v)
        middle_[i].v[v] = found ? end_[block * n + i].v[v] - now_[block * n + i].v[v] : Four{} + NAN;
    keep_estimates(block, middle_.data());
  }
}

// As step_newton, of all blocks at once.
void SlabBatch::step_lateral(double dt) {
  const size_t n = nodes(), size = now_.size(), blocks = size / n;
  const double s = kD * dt, curve = kW / kD;
  std::vector<FaceEnds> faces;
  for (size_t block = 0; block < blocks; ++block) faces.push_back(gather(block));
  Lateral lateral(*this);
  Lateral::State stored(size), rates(size), history(size), middle(now_), between(size), heat(size);
  const auto every = [&](const auto& body) {
    parallel_for(0, size, 256, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        for (size_t v = 0; v < kVectors; ++v) body(i, v);
    });
  };
  parallel_for(0, blocks, 16, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b) evaluate(&now_[b * n], faces[b].begin, &stored[b * n], &rates[b * n]);
  });
  lateral.add(now_, 1, rates);
  every([&](size_t i, size_t v) { history[i].v[v] = stored[i].v[v] + s * rates[i].v[v]; });
  if (!lateral.solve(history, faces, kGamma, s, middle, between)) return step_backward(dt, faces, stored);
  every([&](size_t i, size_t v) { history[i].v[v] = stored[i].v[v] + curve * (between[i].v[v] - stored[i].v[v]); });
  end_ = middle;
  if (!lateral.solve(history, faces, 1, s, end_, heat)) return step_backward(dt, faces, stored);
  for (size_t block = 0; block < blocks; ++block) {
    std::copy_n(&middle[block * n], n, middle_.begin());
    keep_means(block);
  }
  Lateral::State& right = history;
  every([&](size_t i, size_t v) {
    const Four to_middle = between[i].v[v] - stored[i].v[v], rest = heat[i].v[v] - history[i].v[v];
    right[i].v[v] = (kError2 * to_middle + kError3 * rest) / kD + dt * (kError1 - kError2) * rates[i].v[v];
  });
  for (size_t l = elements_ % kLanes; l > 0 && l < kLanes; ++l)
    for (size_t i = size - n; i < size; ++i) right[i].set(l, 0);  // lanes that are left over
  lateral.linearise(end_, faces, 1, s);
  double first = 0;
  lateral.solve_linear(right, 1e-3, first);
  for (size_t block = 0; block < blocks; ++block) keep_estimates(block, &right[block * n]);
}

void SlabBatch::solve_lateral(double capacity, double weight, std::span<const double> top,
                              std::span<const double> bottom, std::vector<double>& x) const {
  const size_t n = nodes();
  Lateral::State right(now_.size());
  for (size_t e = 0; e < elements_; ++e)
    for (size_t i = 0; i < n; ++i) right[index(e, i)].set(e % kLanes, x[e * n + i]);
  Lateral lateral(*this);
  lateral.linearise(capacity, weight, top, bottom);
  double first = 0;
  lateral.solve_linear(right, 1e-8, first);
  for (size_t e = 0; e < elements_; ++e)
    for (size_t i = 0; i < n; ++i) x[e * n + i] = right[index(e, i)].get(e % kLanes);
}

void SlabBatch::add_from_neighbours(const std::vector<double>& x, std::vector<double>& gain) const {
  const size_t n = nodes();
  Lateral::State kelvin(now_.size()), in(now_.size());
  for (size_t e = 0; e < elements_; ++e)
    for (size_t i = 0; i < n; ++i) kelvin[index(e, i)].set(e % kLanes, x[e * n + i]);
  Lateral(*this).add(kelvin, 1, in);
  for (size_t e = 0; e < elements_; ++e)
    for (size_t i = 0; i < n; ++i) gain[e * n + i] += in[index(e, i)].get(e % kLanes);
}

}  // namespace suite
