#include "heat/surfaces.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "heat/air_through.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr size_t kTogether = 256;  // elements a piece of parallel work

// Parts of few elements are pieces themselves.
void for_elements(size_t count, const std::function<void(size_t, size_t)>& body) {
  count <= kTogether ? body(0, count) : parallel_for(0, count, kTogether, body);
}

double emitted_by(double kelvin) { return kStefanBoltzmann * kelvin * kelvin * kelvin * kelvin; }

// J/m2 that the layers of an element took up between two states; heat capacities may depend on temperature.
double taken_up(const SlabBatch& before, const SlabBatch& after, size_t element) {
  const auto heat = [element](const SlabBatch& of, size_t node) {
    double sum = 0, power = 1;
    for (const std::vector<double>& coefficients : of.grid().heat)
      sum += coefficients[node] * (power *= of.kelvin(element, node));
    return sum;
  };
  double stored = 0;
  for (size_t n = 0; n < after.nodes(); ++n) stored += heat(after, n) - heat(before, n);
  return stored;
}

// The state of a sweep: a span that repeats begins anywhere, others each time where they are.
template <class Part>
SlabBatch& begun(Part& part, bool periodic, bool first, double time) {
  if (periodic && first) part.next = std::move(part.batch);
  if (!periodic) part.next = part.batch;
  part.next->restart(time);
  return *part.next;
}

}  // namespace

FaceTraits SurfaceGroup::front_of(size_t element) const {
  FaceTraits face = front;
  if (!cosine_up.empty()) face.cosine_up = cosine_up[element];
  if (!front_emissivity.empty()) face.emissivity = front_emissivity[element];
  return face;
}

FaceTraits SurfaceGroup::back_of(size_t element) const {
  FaceTraits face = back;
  if (!cosine_up.empty()) face.cosine_up = -cosine_up[element];
  if (!back_emissivity.empty()) face.emissivity = back_emissivity[element];
  return face;
}

struct CoupledSurfaces::Through {
  const SurfaceLoads& loads;
  const SurfaceOptions& options;
  const AirThrough air;
  size_t moments = 0;
  std::vector<FixedLaw> front = {}, back = {};  // by group
  const Histories* around = nullptr;            // what all ends emit
  bool first = true;

  struct Face {
    size_t row;              // of the exchange
    const double* longwave;  // W/m2 that it receives, by moment
  };
  FaceWeather weather(Face face, size_t moment, const AirThrough::Air& now) const {
    FaceWeather w = air.weather(now);
    w.absorbed = loads.absorbed.at(face.row, moment);
    w.longwave = face.longwave[moment];
    w.source = loads.source.empty() ? 0 : loads.source[face.row];
    return w;
  }
  FaceWeather weather_at(Face face, const FixedLaw& law, size_t moment) const {
    FaceWeather w = weather(face, moment, air.around(moment));
    if (!law.film_at.empty()) w.film = law.film_at[moment];
    return w;
  }
  // What acts on a face through a step; its temperature is that at the step's begin.
  void act(const FaceTraits& traits, const FixedLaw& law, Face face, size_t step, double now, FaceLines& lines,
           size_t lane) const {
    FaceWeather begin = weather(face, step, air.at(step, 0)), end = weather(face, step + 1, air.at(step, 1));
    if (!law.film_begin.empty()) begin.film = law.film_begin[step], end.film = law.film_end[step];
    lines.quartic[lane] = traits.emissivity * kStefanBoltzmann;
    const auto taken = [&](const FaceWeather& w) { return w.absorbed + w.source + traits.emissivity * w.longwave; };
    if (!law.coefficient.empty()) {
      lines.linear[lane] = law.coefficient[step];
      lines.constant[lane] = {taken(begin) + law.times_air[step].begin, taken(end) + law.times_air[step].end};
      return;
    }
    // The tangent at the begin holds through the step; at its end the same temperature would lose what the air of then
    // takes.
    const FaceBalance a = balance_at(traits, begin, now);
    const double end_loss = loss_to_air(traits, end, now);
    lines.linear[lane] = {a.linear, a.linear};
    lines.constant[lane] = {a.constant, taken(end) + a.linear * now - end_loss};
  }
};

// Only of those faces that are worked on: histories of all faces at once would be as much memory as their answers.
struct CoupledSurfaces::Received {
  Received(const CoupledSurfaces& of, const Part& part, const Through& through) : moments(through.moments) {
    const size_t count = part.members.size();
    front.resize(count * moments);
    if (!of.group_of(part, 0).back_rows.empty()) back.resize(count * moments);
    for_elements(count, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        of.exchange_.receive_one(of.front_row(part, i), *through.around, through.loads.shares,
                                 {&front[i * moments], moments});
        if (!back.empty())
          of.exchange_.receive_one(of.back_row(part, i), *through.around, through.loads.shares,
                                   {&back[i * moments], moments});
      }
    });
  }
  size_t moments;
  std::vector<double> front, back;  // W/m2, by element of the part and moment
};

CoupledSurfaces::CoupledSurfaces(std::vector<SurfaceGroup> groups, ExchangeThrough exchange,
                                 const SurfaceNeighbours& neighbours)
    : groups_(std::move(groups)),
      exchange_(std::move(exchange)),
      step_error_(exchange_.elements()),
      behind_(step_error_),
      stored_(step_error_) {
  std::vector<int> seen(exchange_.elements(), 0);
  for (size_t g = 0; g < groups_.size(); ++g) {
    const SurfaceGroup& group = groups_[g];
    const size_t count = group.front_rows.size();
    if (!group.back_rows.empty() && group.back_rows.size() != count)
      throw Error(strf("surfaces have %zu fronts and %zu open backs", count, group.back_rows.size()),
                  "as many, or none");
    for (const auto* each : {&group.cosine_up, &group.front_emissivity, &group.back_emissivity})
      if (!each->empty() && each->size() != count)
        throw Error(strf("surfaces have %zu fronts and %zu tilts or emissivities", count, each->size()),
                    "as many, or none");
    for (const auto* rows : {&group.front_rows, &group.back_rows})
      for (const uint32_t row : *rows) {
        if (row >= seen.size()) throw Error(strf("a surface has row %u of an exchange of %zu", row, seen.size()));
        ++seen[row];
      }
    back_balance(group.behind);
    if (group.layers.empty() && (group.behind.kind != BackCondition::Kind::flux || group.behind.value != 0))
      throw Error("surfaces without heat capacity have something behind them", "layers, or a back that is open");
  }
  for (size_t row = 0; row < seen.size(); ++row)
    if (seen[row] != 1) throw Error(strf("%d surfaces have row %zu of the exchange", seen[row], row), "one each");
  for (SurfacePart& part : surface_parts(groups_, exchange_.elements(), neighbours)) {
    const SurfaceGroup& group = groups_[part.members.front().group];
    Part& made = parts_.emplace_back(std::move(part));
    if (!group.layers.empty())
      made.batch.emplace(group.layers, made.members.size(),
                         SlabBatchOptions{60, !group.back_rows.empty(), made.neighbours});
  }
}

void CoupledSurfaces::start(double kelvin) {
  for (Part& part : parts_)
    if (part.batch) part.batch->start(0, kelvin);
}

void CoupledSurfaces::check(const SurfaceLoads& loads) const {
  const size_t moments = loads.steps.size() + 1, faces = exchange_.elements();
  if (loads.steps.empty()) throw Error("a span of time without a step");
  if (loads.absorbed.rows() != faces || loads.absorbed.width() != moments ||
      loads.outside.size() != exchange_.outsides() * moments || !(loads.source.empty() || loads.source.size() == faces))
    throw Error(strf("loads of %zu x %zu absorbed and %zu outside values", loads.absorbed.rows(),
                     loads.absorbed.width(), loads.outside.size()),
                strf("%zu faces and %zu outsides at %zu moments", faces, exchange_.outsides(), moments));
}

void CoupledSurfaces::fill(const Part& part, size_t step, const Through& through, const Received& received,
                           const SlabBatch& batch, FaceLines& top, FaceLines& bottom) const {
  for_elements(part.members.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto [g, element] = part.members[i];
      const SurfaceGroup& group = groups_[g];
      through.act(group.front_of(element), through.front[g],
                  {group.front_rows[element], &received.front[i * through.moments]}, step, batch.top(i), top, i);
      if (!group.back_rows.empty()) {
        through.act(group.back_of(element), through.back[g],
                    {group.back_rows[element], &received.back[i * through.moments]}, step, batch.bottom(i), bottom, i);
      } else {
        const FaceBalance behind = back_balance(group.behind);
        bottom.constant[i] = {behind.constant, behind.constant};
        bottom.linear[i] = {behind.linear, behind.linear};
      }
    }
  });
}

void CoupledSurfaces::answer_of(Part& part, const Through& through, const PutEmitted& put) {
  part.batch || part.next ? answer(part, through, put) : answer_massless(part, through, put);
}

void CoupledSurfaces::answer(Part& part, const Through& through, const PutEmitted& put) {
  const SurfaceLoads& loads = through.loads;
  const size_t count = part.members.size();
  const bool open = !group_of(part, 0).back_rows.empty();
  SlabBatch& batch = begun(part, through.options.periodic, through.first, loads.begin);
  const Received received(*this, part, through);
  size_t step = 0;
  const BatchLoads lines = [&](double begin, double, const SlabBatch& now, FaceLines& top, FaceLines& bottom) {
    if (begin <= loads.begin) step = 0;  // another period
    fill(part, step++, through, received, now, top, bottom);
  };
  // What both sides emit, by element and moment.
  std::vector<double> tops(count * through.moments), bottoms(open ? tops.size() : 0);
  const auto record = [&](size_t moment) {
    for (size_t i = 0; i < count; ++i) {
      const size_t front = front_row(part, i);
      tops[i * through.moments + moment] = emitted_by(batch.top(i));
      step_error_[front] = std::fmax(moment <= 1 ? 0 : step_error_[front], moment == 0 ? 0 : batch.estimate(i));
      if (!open) {
        const BackCondition& behind = group_of(part, i).behind;
        if (moment <= 1) behind_[front] = 0;
        if (moment > 0) behind_[front] -= loads.steps[moment - 1] * back_balance(behind).flux(batch.bottom_mean(i));
        continue;
      }
      const size_t back = back_row(part, i);
      bottoms[i * through.moments + moment] = emitted_by(batch.bottom(i));
      step_error_[back] = step_error_[front];
    }
  };
  const auto hand_over = [&] {
    for (size_t i = 0; i < count; ++i) {
      const size_t at = i * through.moments;
      put(front_row(part, i), {&tops[at], through.moments});
      if (open) put(back_row(part, i), {&bottoms[at], through.moments});
    }
  };
  if (through.options.periodic) {
    PeriodicOptions past = through.options.past;
    past.harmonics = past.harmonics && through.first;
    // Without a memory of sweeps one period each does: the history and its past come together.
    if (through.options.coupling.memory == 0 && past.enough == 0) past.enough = 1;
    part.distance =
        find_periodic(batch, loads.begin, loads.steps, lines, past, [&](size_t k) { record(k + 1); }).distance;
    for (auto* values : {&tops, &bottoms})
      for (size_t begin = 0; begin < values->size(); begin += through.moments)
        (*values)[begin] = (*values)[begin + through.moments - 1];
    hand_over();
    batch.rest();
    return;
  }
  const SlabBatch before = batch;
  record(0);
  for (size_t k = 0; k < loads.steps.size(); ++k) {
    batch.step(loads.steps[k], lines);
    record(k + 1);
  }
  hand_over();
  for (size_t i = 0; i < count; ++i) stored_[front_row(part, i)] = taken_up(before, batch, i);
  batch.rest();
}

namespace {

// The temperature of an element without heat capacity; an error names its material.
double massless_of(const SurfaceGroup& group, std::span<const MasslessFace> faces) {
  try {
    return massless_kelvin(faces);
  } catch (const Error& e) {
    if (group.name.empty()) throw;
    throw Error("material '" + group.name + "': " + e.message(), e.hint());
  }
}

}  // namespace

void CoupledSurfaces::answer_massless(const Part& part, const Through& through, const PutEmitted& put) const {
  const SurfaceGroup& group = group_of(part, 0);
  const Received received(*this, part, through);
  const FixedLaw &front = through.front[part.members[0].group], &back = through.back[part.members[0].group];
  std::vector<MasslessFace> faces(group.back_rows.empty() ? 1 : 2);
  std::vector<double> emits(through.moments);
  for (size_t i = 0; i < part.members.size(); ++i) {
    const size_t element = part.members[i].element, at = i * through.moments;
    std::vector<Through::Face> sides{{group.front_rows[element], &received.front[at]}};
    if (faces.size() > 1) sides.push_back({group.back_rows[element], &received.back[at]});
    faces.front().traits = group.front_of(element);
    if (faces.size() > 1) faces.back().traits = group.back_of(element);
    for (size_t moment = 0; moment < through.moments; ++moment) {
      for (size_t f = 0; f < faces.size(); ++f)
        faces[f].weather = through.weather_at(sides[f], f == 0 ? front : back, moment);
      emits[moment] = emitted_by(massless_of(group, faces));
    }
    for (const Through::Face& side : sides) put(static_cast<uint32_t>(side.row), emits);
  }
}

CouplingResult CoupledSurfaces::couple(Through& through, Histories& emitted) {
  const CouplingOptions& options = through.options.coupling;
  if (options.memory == 0) {
    const Sweep sweep = [&](Histories& all) {
      through.around = &all;
      const double change = answer_in_place(
          all, parts_.size(), [&](size_t p, const PutEmitted& put) { answer_of(parts_[p], through, put); });
      through.first = false;
      return change;
    };
    return relax_histories(emitted, exchange_.elements(), sweep, options);
  }
  const Respond respond = [&](const Histories& around, Histories& answers) {
    through.around = &around;
    parallel_for(0, parts_.size(), 1, [&](size_t begin, size_t end) {
      for (size_t p = begin; p < end; ++p)
        answer_of(parts_[p], through, [&](uint32_t row, std::span<const double> values) { answers.set(row, values); });
    });
    through.first = false;
  };
  return couple_histories(exchange_.first(), emitted, respond, options);
}

SurfaceHistory CoupledSurfaces::solve(const SurfaceLoads& loads, const SurfaceOptions& options) {
  check(loads);
  Through through{loads, options, AirThrough(loads), loads.steps.size() + 1};
  for (const SurfaceGroup& group : groups_)
    through.front.push_back(through.air.law_of(group.front)), through.back.push_back(through.air.law_of(group.back));
  SurfaceHistory history;
  history.moments = through.moments;
  const size_t own = exchange_.elements();
  Histories emitted(own + exchange_.outsides(), through.moments);
  const std::vector<double> guess(through.moments, emitted_by(through.air.begins_at()));
  for (size_t i = 0; i < own; ++i) emitted.set(i, guess);
  for (size_t i = 0; i < exchange_.outsides(); ++i)
    emitted.set(own + i, {&loads.outside[i * through.moments], through.moments});
  history.coupling = couple(through, emitted);
  for (Part& part : parts_) part.batch.swap(part.next);
  if (options.last)
    for (Part& part : parts_) part.batch.reset(), part.next.reset();
  history.received = CompactRows(own, through.moments);
  parallel_for(0, own, 64, [&](size_t begin, size_t end) {
    std::vector<double> row(through.moments);
    for (size_t i = begin; i < end; ++i) {
      exchange_.receive_one(i, emitted, loads.shares, row);
      history.received.set(i, std::vector<float>(row.begin(), row.end()));
    }
  });
  emitted.shrink(own);
  emitted.change([](double e) { return std::sqrt(std::sqrt(e / kStefanBoltzmann)); });
  history.kelvin = std::move(emitted);
  history.step_error = step_error_;
  history.behind = behind_, history.stored = options.periodic ? std::vector<double>(stored_.size(), 0.0) : stored_;
  for (const Part& part : parts_) history.past_distance = std::fmax(history.past_distance, part.distance);
  return history;
}

}  // namespace suite
