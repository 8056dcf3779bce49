// Tables of Mueller matrices as text, beside the same table as a tensor file.
#include <gtest/gtest.h>

#include "base/error.h"
#include "formats/mueller_csv/mueller_csv.h"
#include "formats/pbsdf/pbsdf.h"
#include "support/mueller_formula.h"

namespace suite::format_mueller_csv_read_test {
namespace {

using test::MuellerFormula;

MuellerFormula small() {
  MuellerFormula f;
  f.theta_h_deg = {0, 20, 60, 90};
  f.theta_d_deg = {0, 40, 80};
  f.phi_d_deg = {-180, -90, 0, 90};
  f.wavelength_nm = {450, 650};
  return f;
}

// In the basis (p, s, k) and the signs of `to`.
std::string text_of(const MuellerFormula& f, const StokesConvention& to) {
  std::string text = strf("# name: formula\n# convention: %s\n", std::string(to.name).c_str());
  text += "wavelength_um,theta_h_deg,theta_d_deg,phi_d_deg";
  for (int i = 1; i <= 4; ++i)
    for (int j = 1; j <= 4; ++j) text += strf(",m%d%d", i, j);
  text += '\n';
  f.every([&](double h, double d, double p, double nm) {
    const Mueller ours =
        converted(MuellerFormula::at(h * kDegree, d * kDegree, p * kDegree, nm), {"", "", {1, -1, -1, -1}});
    text += strf("%g,%g,%g,%g", nm / 1000, h, d, p);
    for (const double x : converted(ours, to).m) text += strf(",%.9g", x);
    text += '\n';
  });
  return text;
}

std::string message(const std::string& text) {
  try {
    parse_mueller_csv(text, "x.csv");
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

TEST(MuellerCsv, IsTheSameTableInEveryConvention) {
  const auto tensor = parse_pbsdf(small().pbsdf().build(), "x.pbsdf");
  for (const StokesConvention& c : kStokesConventions) {
    const std::string text = text_of(small(), c);
    EXPECT_TRUE(is_mueller_csv(text));
    const auto brdf = parse_mueller_csv(text, "x.csv");
    EXPECT_EQ(brdf->info().name, "formula");
    ASSERT_EQ(brdf->data().values.size(), tensor->data().values.size());
    for (size_t i = 0; i < tensor->data().values.size(); ++i)
      ASSERT_NEAR(brdf->data().values[i], tensor->data().values[i], 1e-7) << c.name << ' ' << i;
  }
  EXPECT_FALSE(is_mueller_csv("theta_o,phi_o,theta_i,phi_i,wavelength_um,value\n"));
}

TEST(MuellerCsv, SaysWhatIsWrongAndWhere) {
  const std::string text = text_of(small(), kStokesConventions[0]);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string t = text;
    t.replace(t.find(from), from.size(), to);
    return message(t);
  };
  EXPECT_NE(with("m44", "m45").find("unknown column 'm45'"), std::string::npos);
  EXPECT_NE(with("# convention: meridian", "# convention: stokes").find("unknown convention"), std::string::npos);
  EXPECT_NE(with(",m44", "").find("column 'm44' is missing"), std::string::npos);
  const size_t line = text.find("0.45,20,0,-180"), end = text.find('\n', line) + 1;
  EXPECT_NE(message(text + text.substr(line, end - line)).find("given twice"), std::string::npos);
  EXPECT_EQ(message(text.substr(0, line) + text.substr(end)), "accepted") << "a row that is missing is filled";
  EXPECT_NE(with("0.45,20,0,-180", "0.45,95,0,-180").find("theta_h in degrees"), std::string::npos);
  EXPECT_NE(message(text.substr(0, text.find("0.45,"))).find("holds no matrices"), std::string::npos);
  EXPECT_NE(message(text + "0.45,1,2\n").find("the line has 3 values"), std::string::npos);
}

}  // namespace
}  // namespace suite::format_mueller_csv_read_test
