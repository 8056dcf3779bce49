#include "page/page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "base/error.h"
#include "base/markup.h"

namespace suite {

namespace {

constexpr double kWidth = 640, kHeight = 400, kLeft = 78, kRight = 170, kTop = 36, kBottom = 52;
constexpr double kBoldEm = 0.65;  // mean width of a character of bold sans-serif over its size
const char* kColours[] = {"#1b6ca8", "#c0392b", "#1e8449", "#8e44ad", "#b9770e", "#16808a", "#7f3f1f", "#555555"};

// One axis: the range of its values and where they stand on the page.
struct Axis {
  bool log;
  double low = INFINITY, high = -INFINITY, from, to;
  Axis(bool logarithmic, double begin, double end) : log(logarithmic), from(begin), to(end) {}
  bool has(double v) const { return std::isfinite(v) && (!log || v > 0); }
  void take(double v) {
    if (has(v)) low = std::min(low, v), high = std::max(high, v);
  }
  void settle() {
    if (!(low <= high)) low = 1, high = 10;
    if (log) {
      low /= 1.15, high *= 1.15;
    } else {
      const double room = high > low ? 0.06 * (high - low) : std::max(1e-9, 0.1 * std::fabs(high));
      low -= room, high += room;
    }
  }
  double place(double v) const {
    const double s = log ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
    return from + s * (to - from);
  }
  std::vector<double> ticks() const {
    std::vector<double> t;
    if (log) {
      const bool dense = std::log10(high / low) < 3;
      for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10)
        for (const double m : {1.0, 2.0, 5.0})
          if ((dense || m == 1) && decade * m >= low && decade * m <= high) t.push_back(decade * m);
    }
    if (t.size() < 2) {  // also of a logarithmic axis over less than a decade
      t.clear();
      const double raw = (high - low) / 5, unit = std::pow(10, std::floor(std::log10(raw)));
      const double step = unit * (raw / unit < 1.5 ? 1 : raw / unit < 3.5 ? 2 : raw / unit < 7.5 ? 5 : 10);
      for (double v = std::ceil(low / step) * step; v <= high; v += step)
        t.push_back(std::fabs(v) < 1e-9 * step ? 0 : v);
    }
    return t;
  }
};

// A tick in as many digits as tell it from its neighbour.
std::string tick_text(const std::vector<double>& ticks, size_t i) {
  double step = INFINITY;
  for (size_t k = 1; k < ticks.size(); ++k) step = std::min(step, std::fabs(ticks[k] - ticks[k - 1]));
  const double size = std::fabs(ticks[i]);
  const int digits = size > 0 && std::isfinite(step)
                         ? static_cast<int>(std::floor(std::log10(size)) - std::floor(std::log10(step))) + 1
                         : 6;
  return strf("%.*g", std::clamp(digits, 6, 15), ticks[i]);
}

std::string frame_of(const Plot& plot, const Axis& x, const Axis& y) {
  std::string s = strf("<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"#fafafa\" stroke=\"#999\"/>", kLeft,
                       kTop, kWidth - kLeft - kRight, kHeight - kTop - kBottom);
  const std::vector<double> along = x.ticks(), up = y.ticks();
  for (size_t i = 0; i < along.size(); ++i) {
    const double t = along[i];
    s += strf(
        "<line x1=\"%.1f\" y1=\"%g\" x2=\"%.1f\" y2=\"%g\" stroke=\"#ddd\"/><text x=\"%.1f\" y=\"%g\" "
        "text-anchor=\"middle\">%s</text>",
        x.place(t), kTop, x.place(t), kHeight - kBottom, x.place(t), kHeight - kBottom + 16,
        tick_text(along, i).c_str());
  }
  for (size_t i = 0; i < up.size(); ++i) {
    const double t = up[i];
    s += strf(
        "<line x1=\"%g\" y1=\"%.1f\" x2=\"%g\" y2=\"%.1f\" stroke=\"#ddd\"/><text x=\"%g\" y=\"%.1f\" "
        "text-anchor=\"end\">%s</text>",
        kLeft, y.place(t), kWidth - kRight, y.place(t), kLeft - 6, y.place(t) + 4, tick_text(up, i).c_str());
  }
  s += strf("<text x=\"%g\" y=\"20\" font-size=\"%.3g\" font-weight=\"bold\">", kLeft,
            std::min(15.0, (kWidth - kLeft) / (kBoldEm * std::max<double>(1, plot.title.size())))) +
       in_markup(plot.title) + "</text>";
  s += strf("<text x=\"%g\" y=\"%g\" text-anchor=\"middle\">", (kLeft + kWidth - kRight) / 2, kHeight - 14) +
       in_markup(plot.x_label) + "</text>";
  s +=
      strf("<text transform=\"translate(16 %g) rotate(-90)\" text-anchor=\"middle\">", (kTop + kHeight - kBottom) / 2) +
      in_markup(plot.y_label) + "</text>";
  return s;
}

std::string curve_of(const PlotSeries& p, const Axis& x, const Axis& y, const char* colour) {
  std::string line, marks, upper, lower;
  for (size_t i = 0; i < p.x.size(); ++i) {
    if (!x.has(p.x[i]) || !y.has(p.y[i])) continue;
    const double px = x.place(p.x[i]), py = y.place(p.y[i]);
    line += strf("%.1f,%.1f ", px, py);
    marks += strf("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>", px, py, colour);
    if (i < p.low.size() && i < p.high.size() && y.has(p.low[i]) && y.has(p.high[i])) {
      upper += strf("%.1f,%.1f ", px, y.place(p.high[i]));
      lower = strf("%.1f,%.1f ", px, y.place(p.low[i])) + lower;
    }
  }
  std::string s;
  if (!upper.empty()) s += "<polygon points=\"" + upper + lower + "\" fill=\"" + colour + "\" fill-opacity=\"0.15\"/>";
  return s + "<polyline points=\"" + line + "\" fill=\"none\" stroke=\"" + colour + "\" stroke-width=\"1.6\"/>" + marks;
}

}  // namespace

std::string svg_of(const Plot& plot) {
  Axis x(plot.log_x, kLeft, kWidth - kRight), y(plot.log_y, kHeight - kBottom, kTop);
  for (const PlotSeries& p : plot.series) {
    for (const double v : p.x) x.take(v);
    for (const auto* values : {&p.y, &p.low, &p.high})
      for (const double v : *values) y.take(v);
  }
  x.settle();
  y.settle();
  std::string s = strf(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" height=\"%g\" "
      "font-family=\"sans-serif\" font-size=\"12\">",
      kWidth, kHeight, kWidth, kHeight);
  s += frame_of(plot, x, y);
  for (size_t i = 0; i < plot.series.size(); ++i) {
    const char* colour = kColours[i % std::size(kColours)];
    s += curve_of(plot.series[i], x, y, colour);
    const double row = kTop + 14 + 17 * static_cast<double>(i);
    if (row < kHeight - kBottom)
      s += strf("<rect x=\"%g\" y=\"%g\" width=\"10\" height=\"10\" fill=\"%s\"/><text x=\"%g\" y=\"%g\">",
                kWidth - kRight + 10, row - 9, colour, kWidth - kRight + 25, row) +
           in_markup(plot.series[i].name) + "</text>";
  }
  return s + "</svg>\n";
}

std::string html_of(const Page& page) {
  std::string h =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>" +
      in_markup(page.title) +
      "</title><link rel=\"icon\" href=\"data:,\"><style>body{font:14px "
      "sans-serif;margin:2em;max-width:1400px}table{border-collapse:collapse;margin-bottom:1em}"
      "td,th{padding:3px 9px;text-align:right;border-bottom:1px solid "
      "#ddd}td:first-child,th:first-child{text-align:left}"
      "svg{margin:4px;max-width:100%;height:auto}table{display:block;overflow-x:auto}"
      "@media(max-width:600px){body{margin:8px}}</style></head><body>\n<h1>" +
      in_markup(page.title) + "</h1>\n";
  for (const std::string& p : page.paragraphs) h += "<p>" + in_markup(p) + "</p>\n";
  for (const Plot& p : page.plots) h += svg_of(p);
  for (const PageTable& t : page.tables) {
    h += "<h2>" + in_markup(t.title) + "</h2>\n<table><tr>";
    for (const std::string& c : t.columns) h += "<th>" + in_markup(c) + "</th>";
    h += "</tr>\n";
    for (const auto& row : t.rows) {
      h += "<tr>";
      for (const std::string& cell : row) h += "<td>" + in_markup(cell) + "</td>";
      h += "</tr>\n";
    }
    h += "</table>\n";
  }
  return h + "</body></html>\n";
}

Page page_of_csv(std::string_view csv, const std::string& title, const std::vector<std::string>& x,
                 const std::vector<std::string>& y, const std::string& group, const std::string& file) {
  Page page;
  page.title = title;
  PageTable table;
  table.title = "Table";
  std::istringstream in{std::string(csv)};
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    if (line[0] == '#') {
      page.paragraphs.push_back(
          line.substr(line.find_first_not_of("# ") == std::string::npos ? line.size() : line.find_first_not_of("# ")));
      continue;
    }
    std::vector<std::string> cells;
    std::istringstream fields(line);
    for (std::string cell; std::getline(fields, cell, ',');) cells.push_back(cell);
    if (table.columns.empty())
      table.columns = cells;
    else if (cells.resize(std::max(cells.size(), size_t{1})); cells.size() != table.columns.size())
      throw Error(Where{file, number, 0, line, -1},
                  strf("the row has %zu cells, the table %zu columns", cells.size(), table.columns.size()));
    else
      table.rows.push_back(cells);
  }
  auto column = [&](const std::string& name) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), name);
    if (found == table.columns.end())
      throw Error(Where{file, 0, 0, {}, -1}, "there is no column '" + name + "'", name_hint(name, table.columns));
    return static_cast<size_t>(found - table.columns.begin());
  };
  for (size_t i = 0; i < x.size() * y.size(); ++i) {
    const std::string &along = x[i / y.size()], &name = y[i % y.size()];
    const size_t cx = column(along), cy = column(name);
    std::map<std::string, PlotSeries> series;
    for (const auto& row : table.rows) {
      PlotSeries& s = series[group.empty() ? name : row[column(group)]];
      s.x.push_back(std::strtod(row[cx].c_str(), nullptr));
      s.y.push_back(std::strtod(row[cy].c_str(), nullptr));
    }
    Plot plot{name + " against " + along, along, name, true, true, {}};
    for (auto& [key, s] : series) s.name = key, plot.series.push_back(std::move(s));
    page.plots.push_back(std::move(plot));
  }
  page.tables.push_back(std::move(table));
  return page;
}

}  // namespace suite
