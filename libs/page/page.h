// Figures as one HTML page that needs nothing else: tables, and plots drawn as inline SVG.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace suite {

struct PlotSeries {
  std::string name;
  std::vector<double> x, y;
  std::vector<double> low, high;  // a band around y; empty = none
};
struct Plot {
  std::string title, x_label, y_label;
  bool log_x = true, log_y = true;  // points that are not positive are left out of a logarithmic axis
  std::vector<PlotSeries> series;
};
struct PageTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};
struct Page {
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<Plot> plots;
  std::vector<PageTable> tables;
};

std::string svg_of(const Plot& plot);  // a standalone <svg> element
std::string html_of(const Page& page);

// A page from a CSV table: lines with # are paragraphs, the first other line names the columns; plots each column y
// against each column x, one series for each text in column `group` (empty = one series), and shows the table. Error at
// `file` when a column is missing or a row is short.
Page page_of_csv(std::string_view csv, const std::string& title, const std::vector<std::string>& x,
                 const std::vector<std::string>& y, const std::string& group, const std::string& file);

}  // namespace suite
