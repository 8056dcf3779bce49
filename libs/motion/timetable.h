// Which of several states holds at a time: rows that each begin at a time and hold until the next one begins, once or
// over and over.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "motion/time_span.h"

namespace suite {

struct Timetable {
  std::vector<double> times;  // s, ascending: when each row begins
  // s: the rows begin again so much after they began, and did so before; 0 = once. Longer than the rows reach.
  double period = 0;

  // The row that holds at a time. Nothing before the first one of a table that does not repeat, or without rows.
  std::optional<size_t> at(double t) const;
  // Calls visit(row, span) for the rows that hold anywhere in a span, with the part of it in which they do: from its
  // beginning until just before its end, or to the end of the span. Of a table that begins again within the span each
  // row is visited once, with all of the span. Before the first row the row is nothing.
  template <class Visit>
  void over(TimeSpan span, const Visit& visit) const;
  // The same, `seconds` later.
  void delay(double seconds) {
    for (double& t : times) t += seconds;
  }
  // What is wrong with it, in words: times that are not finite or do not ascend, a period that is too short. Empty =
  // nothing.
  std::string fault() const;

 private:
  // When the row that holds at t ends; infinite = never.
  double end_of(std::optional<size_t> row, double t) const;
};

template <class Visit>
void Timetable::over(TimeSpan span, const Visit& visit) const {
  if (period > 0 && !(span.end - span.begin < period)) {
    for (size_t row = 0; row < times.size(); ++row) visit(std::optional(row), span);
    return;
  }
  double t = span.begin;
  for (size_t k = 0; k <= times.size() + 1 && t <= span.end; ++k) {
    const std::optional<size_t> row = at(t);
    const double end = end_of(row, t);
    visit(row, TimeSpan{t, end < span.end ? end : span.end});
    if (!(end <= span.end) || end - end != 0) return;  // beyond the span, or never
    t = end;
  }
}

}  // namespace suite
