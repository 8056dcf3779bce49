#include "heat/cell_contacts.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

// Middles may be as near as this share of the cells' sizes: those of right triangles lie on the side between them.
constexpr double kNearest = 1e-3;

// Of what a contact looks like from one cell: its length across the way from the middle, and the distance to it.
struct Half {
  double across, distance;
};
Half half_of(const CellMiddle& middle, Vec3 contact, Vec3 out, double along) {
  const double across = length(out);
  constexpr double kRound = 0.3;  // a contact all around: no side of it is its own
  if (across < kRound * along) return {along, length(contact - middle.place)};
  return {across, dot(contact - middle.place, out) / across};
}

}  // namespace

void CellContacts::report(const CellSide& side, uint32_t other, double length) {
  const bool first = side.cell < other;
  const Vec3 out = side.out * length;
  parts_.push_back({std::min(side.cell, other), std::max(side.cell, other), length / 2,
                    (side.a + side.b) * (length / 4), first ? out : Vec3{}, first ? Vec3{} : out});
}

void CellContacts::add_line(std::span<const CellSide> sides) {
  constexpr double kNothing = 1e-9;
  std::vector<double> ends;
  for (const CellSide& s : sides) ends.push_back(s.from), ends.push_back(s.to);
  std::sort(ends.begin(), ends.end());
  std::vector<const CellSide*> by_begin, here;
  for (const CellSide& s : sides) by_begin.push_back(&s);
  std::stable_sort(by_begin.begin(), by_begin.end(), [](auto* a, auto* b) { return a->from < b->from; });
  const size_t first = parts_.size();
  size_t next = 0;
  for (size_t k = 0; k + 1 < ends.size(); ++k) {
    const double low = ends[k], high = ends[k + 1], middle = (low + high) / 2;
    if (high - low < kNothing) continue;
    while (next < by_begin.size() && by_begin[next]->from < middle) here.push_back(by_begin[next++]);
    std::erase_if(here, [&](const CellSide* s) { return s->to < middle; });
    if (here.size() < 2) continue;
    const double share = 2 / static_cast<double>(here.size());
    for (const CellSide* s : here) {
      const auto at = [&](double x) { return s->a + (s->b - s->a) * ((x - s->from) / (s->to - s->from)); };
      const CellSide part{s->cell, low, high, at(low), at(high), s->out};
      for (const CellSide* o : here)
        if (o->cell != s->cell) report(part, o->cell, share * length(part.b - part.a));
    }
  }
  put_together(first);
}

void CellContacts::put_together(size_t from) {
  const auto begin = parts_.begin() + static_cast<std::ptrdiff_t>(from);
  std::stable_sort(begin, parts_.end(),
                   [](const Part& x, const Part& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  auto last = begin;
  for (auto p = begin; p != parts_.end(); ++p) {
    if (p == begin) continue;
    if (p->a != last->a || p->b != last->b) {
      *++last = *p;
      continue;
    }
    last->length += p->length, last->middle += p->middle, last->out_a += p->out_a, last->out_b += p->out_b;
  }
  if (begin != parts_.end()) parts_.erase(last + 1, parts_.end());
}

std::vector<CellContact> CellContacts::found(std::span<const CellMiddle> middles) && {
  put_together(0);
  std::vector<CellContact> out;
  for (const Part& p : parts_) {
    if (!(p.length > 0)) continue;
    const CellMiddle &a = middles[p.a], &b = middles[p.b];
    const Vec3 contact = p.middle / p.length;
    const Half from_a = half_of(a, contact, p.out_a, p.length), from_b = half_of(b, contact, p.out_b, p.length);
    const double distance = std::fmax(from_a.distance + from_b.distance, kNearest * (a.size + b.size));
    if (distance > 0) out.push_back({p.a, p.b, (from_a.across + from_b.across) / 2 / distance});
  }
  return out;
}

}  // namespace suite
