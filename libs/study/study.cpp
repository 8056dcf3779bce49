#include "study/study.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "base/error.h"

namespace suite {

StudyPlan plan_of(const std::string& budgets, long long seeds, uint64_t first_seed) {
  StudyPlan plan;
  plan.first_seed = first_seed;
  if (seeds < 1 || seeds > 1000) throw Error(strf("a study wants 1 to 1000 seeds, found %lld", seeds));
  plan.seeds = static_cast<int>(seeds);
  std::istringstream in(budgets);
  int timed = 0;
  for (std::string one; std::getline(in, one, ',');) {
    double value = 0;
    const char* last = one.data() + one.size();
    const auto [end, error] = std::from_chars(one.data(), last, value);
    const std::string unit(end, static_cast<size_t>(last - end));
    if (error != std::errc() || !(unit.empty() || unit == "s"))
      throw Error("'" + one + "' is no budget", "paths as in 4,8,16 or seconds as in 1s,2s,4s");
    timed += unit == "s";
    if (!(value > 0) || value > 1e9 || (unit.empty() && value != std::floor(value)))
      throw Error("a budget of '" + one + "' gives nothing to study", "whole paths from 1, or seconds above 0");
    if (!plan.budgets.empty() && value <= plan.budgets.back())
      throw Error("the budgets do not ascend at '" + one + "'");
    plan.budgets.push_back(value);
  }
  if (plan.budgets.empty() || plan.budgets.size() > 32) throw Error("a study wants 1 to 32 budgets");
  if (timed != 0 && timed != static_cast<int>(plan.budgets.size()))
    throw Error("budgets are all in paths or all in seconds");
  plan.by_time = timed != 0;
  return plan;
}

double forecast_paths_per_problem(const StudyPlan& plan, bool with_reference) {
  double sum = with_reference ? StudyPlan::kReferenceFactor * plan.budgets.back() : 0;
  for (const double b : plan.budgets) sum += b * plan.seeds;
  return sum;
}

namespace {

Budget budget_for(const StudyPlan& plan, double amount) {
  Budget b;
  if (plan.by_time) {
    b.seconds = amount;
    b.max_paths = 1u << 20;
  } else {
    b.min_paths = b.max_paths = static_cast<uint32_t>(std::min(amount, 1073741824.0));
  }
  return b;
}

void add_rows(const StudyPlan& plan, const StudyRun& run, double budget, const StudyOutput& out,
              const StudyImage& reference, std::vector<StudyRow>& rows) {
  const JobReport& r = out.report;
  for (const Comparison& c : compare(out.image, reference)) {
    StudyRow row;
    row.by_time = plan.by_time;
    row.budget = budget;
    row.seed = run.seed;
    row.build_seconds = r.build_seconds;
    row.file_seconds = out.file_seconds;
    row.seconds = std::max(1e-9, r.seconds - r.build_seconds - out.file_seconds);
    row.paths = static_cast<double>(r.statistics.paths);
    row.rays = static_cast<double>(r.statistics.trace.rays);
    row.nodes = static_cast<double>(r.statistics.nodes);
    row.paths_per_problem = row.paths / static_cast<double>(std::max<size_t>(1, r.problems));
    row.share_in_embree = r.share_in_embree;
    if (const double cycles = static_cast<double>(r.statistics.cycles); cycles > 0) {
      row.share_sample = static_cast<double>(r.statistics.path_cycles) / cycles - r.share_in_embree;
      row.share_shade = static_cast<double>(r.statistics.shade_cycles) / cycles;
      row.share_sensor = static_cast<double>(r.statistics.sensor_cycles) / cycles;
    }
    row.peak_bytes = out.peak_bytes;
    row.figures = c;
    row.ended = r.stopped_by;
    rows.push_back(std::move(row));
  }
}

}  // namespace

StudyRun reference_run(const StudyPlan& plan) {
  return {budget_for(plan, StudyPlan::kReferenceFactor * plan.budgets.back()),
          StudyPlan::kReferenceSeed + plan.first_seed, true};
}

void run_study(const StudyPlan& plan, const StudyImage& reference, const StudyTools& tools,
               std::vector<StudyRow>& rows) {
  const double all = forecast_paths_per_problem(plan, false);
  double done = 0;
  for (const double budget : plan.budgets)
    for (int k = 0; k < plan.seeds; ++k) {
      const StudyRun run{budget_for(plan, budget), plan.first_seed + static_cast<uint64_t>(k), false};
      const bool known = std::any_of(rows.begin(), rows.end(), [&](const StudyRow& r) {
        return r.by_time == plan.by_time && r.budget == budget && r.seed == run.seed;
      });
      if (!known) {
        add_rows(plan, run, budget, tools.run(run), reference, rows);
        tools.save(rows);
      }
      done += budget;
      tools.progress(done / all, strf("%g %s, seed %llu%s", budget, plan.by_time ? "s" : "paths",
                                      static_cast<unsigned long long>(run.seed), known ? " (kept from before)" : ""));
    }
}

namespace {

Plot error_plot(const StudySummary& s, bool against_seconds) {
  Plot plot{against_seconds ? "Error against seconds" : "Error against paths",
            against_seconds ? "seconds of rendering" : "paths of a run",
            "relative RMSE",
            true,
            true,
            {}};
  for (const StudySeries& series : s.series) {
    PlotSeries p;
    p.name = strf("%s (%.2f)", series.name.c_str(), against_seconds ? series.slope_seconds : series.slope_paths);
    for (const StudyPoint& q : series.points) {
      p.x.push_back(against_seconds ? q.seconds : q.paths);
      p.y.push_back(q.rmse);
      p.low.push_back(q.low);
      p.high.push_back(q.high);
    }
    plot.series.push_back(std::move(p));
  }
  return plot;
}

Plot bias_plot(const StudySummary& s) {
  Plot plot{"Mean signed difference", "paths of a run", "by the mean, %", true, false, {}};
  for (const StudySeries& series : s.series) {
    PlotSeries p;
    p.name = series.name;
    for (const StudyPoint& q : series.points) {
      p.x.push_back(q.paths);
      p.y.push_back(100 * q.bias);
      p.low.push_back(100 * (q.bias - 1.96 * q.bias_error));
      p.high.push_back(100 * (q.bias + 1.96 * q.bias_error));
    }
    plot.series.push_back(std::move(p));
  }
  return plot;
}

// What a run's seconds go into; every series of a sensor has the same runs, so the first one tells.
Plot cost_plot(const StudySummary& s) {
  Plot plot{"Where the time goes", "paths of a run", "seconds", true, true, {}};
  if (s.series.empty()) return plot;
  const std::vector<StudyPoint>& points = s.series.front().points;
  auto add = [&](const char* name, auto seconds_of) {
    PlotSeries p;
    p.name = name;
    for (const StudyPoint& q : points) p.x.push_back(q.paths), p.y.push_back(seconds_of(q));
    plot.series.push_back(std::move(p));
  };
  add("trace", [](const StudyPoint& q) { return q.seconds * q.share_in_embree; });
  add("sample", [](const StudyPoint& q) { return q.seconds * q.share_sample; });
  add("shade", [](const StudyPoint& q) { return q.seconds * q.share_shade; });
  add("sensor", [](const StudyPoint& q) { return q.seconds * q.share_sensor; });
  add("build", [](const StudyPoint& q) { return q.build_seconds; });
  add("I/O", [](const StudyPoint& q) { return q.file_seconds; });
  return plot;
}

// The same as numbers.
PageTable cost_table(const StudySummary& s) {
  PageTable t{
      "Where the time goes: ray tracer; surfaces, sources and directions; radiance and truth; the sensor's rays; "
      "acceleration structures; handing over results",
      {"budget", "seconds", "trace %", "sample %", "shade %", "sensor %", "other %", "build s", "I/O s"},
      {}};
  if (s.series.empty()) return t;
  for (const StudyPoint& p : s.series.front().points) {
    const double other = 1 - p.share_in_embree - p.share_sample - p.share_shade - p.share_sensor;
    t.rows.push_back({strf("%g %s", p.budget, s.series.front().by_time ? "s" : "paths"), strf("%.3g", p.seconds),
                      strf("%.1f", 100 * p.share_in_embree), strf("%.1f", 100 * p.share_sample),
                      strf("%.1f", 100 * p.share_shade), strf("%.1f", 100 * p.share_sensor), strf("%.1f", 100 * other),
                      strf("%.3g", p.build_seconds), strf("%.3g", p.file_seconds)});
  }
  return t;
}

Plot coverage_plot(const StudySummary& s) {
  Plot plot{"Coverage of the 95 % intervals", "paths of a run", "% of the unflagged pixels", true, false, {}};
  for (const StudySeries& series : s.series) {
    PlotSeries p;
    p.name = series.name;
    for (const StudyPoint& q : series.points) p.x.push_back(q.paths), p.y.push_back(100 * q.coverage);
    plot.series.push_back(std::move(p));
  }
  return plot;
}

}  // namespace

Page page_of(const StudySummary& s, const std::vector<StudyRow>& rows, const std::string& title,
             const std::vector<std::string>& paragraphs) {
  Page page{
      title, paragraphs, {error_plot(s, true), error_plot(s, false), bias_plot(s), coverage_plot(s), cost_plot(s)}, {}};
  page.paragraphs.push_back(strf("Bias: smallest p of %zu tests is %.3g, so the runs %s at 1 %% family-wise.", s.tests,
                                 s.smallest_p, s.unbiased ? "pass" : "FAIL"));
  PageTable slopes{"Slopes of log error (standard error)", {"series", "against seconds", "against paths"}, {}};
  PageTable points{
      "Budgets",
      {"series", "budget", "runs", "seconds", "RMSE %", "95 % of RMSE", "bias %", "p", "coverage %", "zero variance %",
       "flagged %", "beyond %", "of it flagged %", "efficiency 1/s", "Mpaths/s", "Mrays/s", "Embree %"},
      {}};
  for (const StudySeries& series : s.series) {
    slopes.rows.push_back({series.name, strf("%.3f (%.3f)", series.slope_seconds, series.slope_seconds_error),
                           strf("%.3f (%.3f)", series.slope_paths, series.slope_paths_error)});
    for (const StudyPoint& p : series.points)
      points.rows.push_back({series.name, strf("%g %s", p.budget, series.by_time ? "s" : "paths"), strf("%d", p.runs),
                             strf("%.3g", p.seconds), strf("%.4g", 100 * p.rmse),
                             strf("%.4g to %.4g", 100 * p.low, 100 * p.high), strf("%+.2g", 100 * p.bias),
                             strf("%.2g", p.bias_p), std::isnan(p.coverage) ? "none" : strf("%.1f", 100 * p.coverage),
                             strf("%.2f", 100 * p.zero_share), strf("%.2f", 100 * p.flagged_share),
                             strf("%.2f", 100 * p.exceeding_share),
                             std::isnan(p.found_share) ? "none" : strf("%.1f", 100 * p.found_share),
                             strf("%.3g", p.efficiency), strf("%.3g", p.paths_per_second / 1e6),
                             strf("%.3g", p.rays_per_second / 1e6), strf("%.0f", 100 * p.share_in_embree)});
  }
  PageTable runs{"Runs", {"series", "budget", "seed", "seconds", "nodes a path", "peak MB", "ended by"}, {}};
  for (const StudyRow& r : rows)
    runs.rows.push_back({r.figures.series, strf("%g", r.budget), strf("%llu", static_cast<unsigned long long>(r.seed)),
                         strf("%.3g", r.seconds), strf("%.2f", r.nodes / r.paths), strf("%.0f", r.peak_bytes / 1e6),
                         r.ended});
  page.tables = {std::move(slopes), std::move(points), cost_table(s), std::move(runs)};
  return page;
}

Json json_of(const StudySummary& s, const std::vector<StudyRow>& rows) {
  Json all = Json::object();
  all.set("bias_tests", s.tests);
  all.set("smallest_p", s.smallest_p);
  all.set("unbiased_at_1_percent_family_wise", s.unbiased);
  Json series = Json::array();
  for (const StudySeries& one : s.series) {
    Json j = Json::object();
    j.set("name", one.name);
    j.set("slope_seconds", one.slope_seconds), j.set("slope_seconds_error", one.slope_seconds_error);
    j.set("slope_paths", one.slope_paths), j.set("slope_paths_error", one.slope_paths_error);
    Json points = Json::array();
    for (const StudyPoint& p : one.points) {
      Json q = Json::object();
      q.set("budget", p.budget), q.set("unit", one.by_time ? "s" : "paths"), q.set("runs", p.runs),
          q.set("seconds", p.seconds), q.set("paths", p.paths);
      q.set("relative_rmse", p.rmse), q.set("low", p.low), q.set("high", p.high), q.set("bias", p.bias),
          q.set("bias_error", p.bias_error), q.set("bias_p", p.bias_p);
      q.set("coverage", p.coverage), q.set("zero_variance_share", p.zero_share),
          q.set("flagged_share", p.flagged_share), q.set("exceeding_share", p.exceeding_share),
          q.set("found_share", p.found_share), q.set("false_share", p.false_share), q.set("efficiency", p.efficiency);
      q.set("paths_per_second", p.paths_per_second), q.set("rays_per_second", p.rays_per_second),
          q.set("share_in_embree", p.share_in_embree), q.set("share_sample", p.share_sample),
          q.set("share_shade", p.share_shade), q.set("share_sensor", p.share_sensor),
          q.set("build_seconds", p.build_seconds), q.set("file_seconds", p.file_seconds);
      points.push(std::move(q));
    }
    j.set("points", std::move(points));
    series.push(std::move(j));
  }
  all.set("series", std::move(series));
  double peak = 0;
  for (const StudyRow& r : rows) peak = std::max(peak, r.peak_bytes);
  all.set("peak_bytes", peak);
  all.set("runs", rows.size());
  return all;
}

}  // namespace suite
