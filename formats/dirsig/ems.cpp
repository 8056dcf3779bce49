#include "formats/dirsig/ems.h"

#include <algorithm>

#include "base/text_lines.h"

namespace suite::dirsig {

namespace {

constexpr int kAngles = 91;
constexpr long long kMostCurves = 100000;
constexpr size_t kMostRows = 1'000'000;
// Wavenumbers of the old layout begin at 39850 / cm, beyond any wavelength in micron of the new one.
constexpr double kMicronPerCm = 1e4;

Item& entry(Item& to, std::string name, std::string value, const Where& where) {
  Item& item = to.children.emplace_back();
  item.name = std::move(name);
  item.value = std::move(value);
  item.where = where;
  return item;
}

// Rows up to the next line of one word, which begins another curve. True when there is one.
bool read_rows(TextLines& lines, bool wavenumbers, CurveFile& made) {
  std::vector<double> x, y;
  bool more = false;
  while (lines.next()) {
    if (lines.words() == 1) {
      // What ends one curve says nothing of the next.
      more = lines.word(0) != "CURVE_END" || lines.next();
      break;
    }
    const double first = lines.number_in(0, wavenumbers ? "wavenumber" : "wavelength", 1e-3, 1e7);
    x.push_back(wavenumbers ? kMicronPerCm / first : first);
    y.push_back(lines.number(1, "value"));
    if (x.size() > 1 && !(x.back() > x[x.size() - 2]))
      throw lines.error(0, "the wavelengths do not ascend", "rows follow each other in wavelength");
    if (x.size() > kMostRows) throw lines.error(0, strf("a curve of more than %zu rows", kMostRows));
  }
  if (x.size() < 2) throw lines.error_at_end("a curve of fewer than two rows");
  made.wavelength_um.push_back(std::move(x));
  made.value.push_back(std::move(y));
  return more;
}

// Curves to the end of the text, each behind a line CURVE_BEGIN or its number.
void read_curves(TextLines& lines, size_t count, CurveFile& made) {
  bool more = lines.next();
  while (more) {
    const bool named = lines.word(0) == "CURVE_BEGIN";
    const Where where = lines.where();
    if (!named) lines.integer(0, "number of the curve", 0, kMostCurves);
    entry(made.account, "curve", std::string(lines.word(0)), where)
        .mark(named ? Fate::exact : Fate::converted, named ? "" : "wavenumbers became micron");
    more = read_rows(lines, !named, made);
  }
  if (made.value.size() != count)
    throw lines.error_at_end(strf("%zu curves, and %zu are announced in line 1", made.value.size(), count));
}

// Emissivities that noise or rounding has put beyond 0 to 1; those that are farther off are faults of the file.
void keep_within_one(CurveFile& made) {
  constexpr double kNear = 0.05;
  size_t count = 0;
  double most = 0;
  for (std::vector<double>& curve : made.value)
    for (double& v : curve) {
      const double off = std::max(-v, v - 1);
      if (!(off > 0) || off > kNear) continue;
      v = v < 0 ? 0 : 1;
      ++count, most = std::max(most, off);
    }
  if (count == 0) return;
  made.moved = true;
  made.account.children.back().mark(
      Fate::approximated, strf("%zu emissivities beyond 0 to 1, by %.2g at most, are taken as 0 and 1", count, most));
}

}  // namespace

CurveFile parse_ems(std::string_view text, const std::string& file) {
  TextLines lines(text, file);
  CurveFile made;
  made.account.name = "ems";
  made.account.where = {file, 1, 1, {}, -1};
  if (!lines.next()) throw lines.error_at_end("an emissivity file without a line");
  const long long count = lines.integer(0, "number of curves", 1, kMostCurves);
  entry(made.account, "number of curves", strf("%lld", count), lines.where()).mark(Fate::exact);
  for (int i = 0; i < kAngles; ++i) {
    if (!lines.next()) throw lines.error_at_end(strf("%d angular weights instead of %d", i, kAngles));
    if (lines.words() != 1) throw lines.error(0, strf("angular weight %d of %d is no single number", i + 1, kAngles));
    made.weights.push_back(lines.number_in(0, "angular weight", 0, 1e3));
    made.even = made.even && made.weights.back() == 1;
    if (i == 0) entry(made.account, "angular weights", strf("%d", kAngles), lines.where());
  }
  if (made.even)
    made.account.children.back().mark(Fate::exact, "all are 1");
  else
    made.account.children.back().mark(
        Fate::approximated, strf("emissivities hold for every angle; the weights run from %g at 0 to %g at 90 "
                                 "degrees",
                                 made.weights.front(), made.weights.back()));
  read_curves(lines, static_cast<size_t>(count), made);
  keep_within_one(made);
  return made;
}

CurveFile parse_ext(std::string_view text, const std::string& file, const char* unit) {
  TextLines lines(text, file);
  CurveFile made;
  made.account.name = "curve file";
  made.account.where = {file, 1, 1, {}, -1};
  if (!lines.next()) throw lines.error_at_end("a curve file without a line");
  const long long count = lines.integer(0, "number of curves", 1, 1);
  entry(made.account, "number of curves", strf("%lld", count), lines.where()).mark(Fate::exact);
  read_curves(lines, 1, made);
  made.account.mark(Fate::converted, std::string("values are ") + unit);
  return made;
}

CurveFile parse_two_columns(std::string_view text, const std::string& file, const char* what) {
  TextLines lines(text, file, true);
  CurveFile made;
  made.account.name = "curve file";
  made.account.where = {file, 1, 1, {}, -1};
  std::vector<double> x, y;
  while (lines.next()) {
    x.push_back(lines.number_in(0, "wavelength", 1e-3, 1e4));
    y.push_back(lines.number(1, what));
    if (x.size() > 1 && !(x.back() > x[x.size() - 2])) throw lines.error(0, "the wavelengths do not ascend");
    if (x.size() > kMostRows) throw lines.error(0, strf("a curve of more than %zu rows", kMostRows));
  }
  if (x.empty()) throw lines.error_at_end("a curve without a row");
  entry(made.account, what, strf("%zu rows", x.size()), made.account.where).mark(Fate::exact);
  made.wavelength_um.push_back(std::move(x));
  made.value.push_back(std::move(y));
  return made;
}

}  // namespace suite::dirsig
