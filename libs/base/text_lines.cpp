#include "base/text_lines.h"

#include <charconv>
#include <cmath>

namespace suite {

TextLines::TextLines(std::string_view text, std::string file, bool commas)
    : text_(text), file_(std::move(file)), commas_(commas) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
}

bool TextLines::next_raw() {
  if (offset_ >= text_.size()) return false;
  const size_t end = std::min(text_.find('\n', offset_), text_.size());
  line_ = text_.substr(offset_, end - offset_);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  offset_ = end + 1;
  ++number_;
  shared_ = {};
  words_.clear();
  const size_t hash = line_.find('#');
  comment_ = hash == std::string_view::npos ? std::string_view{} : line_.substr(hash + 1);
  const std::string_view body = line_.substr(0, hash);
  auto separates = [&](char c) { return c == ' ' || c == '\t' || (commas_ && c == ','); };
  for (size_t i = 0; i < body.size();) {
    while (i < body.size() && separates(body[i])) ++i;
    const size_t begin = i;
    while (i < body.size() && !separates(body[i])) ++i;
    if (i > begin) words_.push_back(body.substr(begin, i - begin));
  }
  return true;
}

bool TextLines::next() {
  while (next_raw())
    if (!words_.empty()) return true;
  return false;
}

Where TextLines::where(size_t word) const {
  const int column = word < words_.size() ? static_cast<int>(words_[word].data() - line_.data()) + 1
                                          : static_cast<int>(line_.size()) + 1;
  // Copied once, however many places of one line are kept.
  if (shared_.view().data() == nullptr) shared_ = SourceLine(line_);
  return {file_, number_, column, shared_, -1};
}

double TextLines::number(size_t i, const char* what, bool allow_nan) const {
  if (i >= words_.size()) throw error(i, strf("%s is missing", what), strf("the line has %zu values", words_.size()));
  std::string_view w = words_[i];
  if (w.starts_with('+')) w.remove_prefix(1);
  double value = 0;
  const auto [stop, code] = std::from_chars(w.data(), w.data() + w.size(), value);
  if (code == std::errc::result_out_of_range) throw error(i, strf("%s does not fit a double", what));
  if (code != std::errc() || stop != w.data() + w.size())
    throw error(i, strf("'%s' is not a number", std::string(words_[i].substr(0, 40)).c_str()),
                strf("%s is wanted here", what));
  if (!allow_nan && !std::isfinite(value)) throw error(i, strf("%s is not finite", what));
  // Where NaN is allowed a huge number may mark what is missing.
  if (!allow_nan && std::fabs(value) > kLargestNumber)
    throw error(i, strf("%s = %g is too large", what, value), strf("at most %g in size", kLargestNumber));
  return value;
}

double TextLines::number_in(size_t i, const char* what, double low, double high) const {
  const double value = number(i, what);
  if (!(value >= low && value <= high))
    throw error(i, strf("%s = %g is out of range", what, value), strf("give %g to %g", low, high));
  return value;
}

long long TextLines::integer(size_t i, const char* what, long long low, long long high) const {
  const double value = number_in(i, what, static_cast<double>(low), static_cast<double>(high));
  if (value != std::floor(value)) throw error(i, strf("%s is not a whole number", what));
  return static_cast<long long>(value);
}

}  // namespace suite
