// Tensor trees as an independent reader has them: a parser and a look-up of this test's own, after the description of
// Radiance's files (bsdf_t.c), that shares nothing with the writer.
#include "formats/tensor_tree/tensor_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "base/error.h"
#include "support/sqt_examples.h"

namespace suite::format_tensor_tree_tensor_tree_test {
namespace {

struct Node {
  std::vector<Node> branch;
  std::vector<double> grid;
};

class Reader {
 public:
  explicit Reader(const std::string& xml) : rank_(xml.find("TensorTree3") != std::string::npos ? 3 : 4) {
    const size_t from = xml.find("<ScatteringData>") + 16, to = xml.find("</ScatteringData>");
    text_ = xml.substr(from, to - from);
    at_ = text_.c_str();
    root_ = node();
    blank();
    whole_ = *at_ == 0;
  }
  bool whole() const { return whole_; }
  double f(Dir out, Dir in) const {
    std::vector<double> p;
    auto add = [&p](double x, double y) {
      // Concentric map by polar angle: the ring's number and the way around it, in eighths of a turn.
      const double r = std::sqrt(x * x + y * y);
      const double ax = std::fabs(x), ay = std::fabs(y);
      const double t = r > 0 ? std::atan2(std::min(ax, ay), std::max(ax, ay)) / (kPi / 4) * r : 0;
      const double a = std::copysign(ax >= ay ? r : t, x), b = std::copysign(ax >= ay ? t : r, y);
      p.push_back((a + 1) / 2), p.push_back((b + 1) / 2);
    };
    if (rank_ == 3) {
      p.push_back(0.4999999 - 0.5 * std::hypot(in.x, in.y));
      const double turn = azimuth(out) - azimuth(in) + kPi, s = std::hypot(out.x, out.y);
      add(s * std::cos(turn), s * std::sin(turn));
    } else {
      add(-in.x, -in.y);
      add(out.x, out.y);
    }
    return look(root_, p);
  }

 private:
  void blank() {
    while (*at_ && std::isspace(static_cast<unsigned char>(*at_))) ++at_;
  }
  Node node() {
    Node n;
    blank();
    EXPECT_EQ(*at_, '{');
    ++at_;
    for (blank(); *at_ == '{'; blank()) n.branch.push_back(node());
    for (; *at_ && *at_ != '}'; blank()) {
      char* end;
      n.grid.push_back(std::strtod(at_, &end));
      if (end == at_) break;
      at_ = end;
    }
    EXPECT_EQ(*at_, '}');
    ++at_;
    EXPECT_TRUE(n.branch.empty() ? !n.grid.empty() : n.branch.size() == size_t{1} << rank_ && n.grid.empty());
    return n;
  }
  double look(const Node& n, std::vector<double> p) const {
    if (n.branch.empty()) {
      const size_t side = static_cast<size_t>(
          std::lround(std::pow(static_cast<double>(n.grid.size()), 1.0 / static_cast<double>(rank_))));
      size_t at = 0;
      for (const double x : p) at = at * side + std::min(side - 1, static_cast<size_t>(x * static_cast<double>(side)));
      return n.grid.at(at);
    }
    size_t which = 0;
    for (size_t i = 0; i < p.size(); ++i) {
      p[i] *= 2;
      if (p[i] >= 1) which |= size_t{1} << i, p[i] -= 1;
    }
    return look(n.branch[which], p);
  }
  size_t rank_;
  std::string text_;
  const char* at_;
  Node root_;
  bool whole_ = false;
};

struct Agreement {
  double with_tree = 0, with_function = 0;  // largest; cosine-weighted mean, relative
};
Agreement agreement(const sqt::Function& function, const TensorTree& tree, const Reader& reader) {
  Agreement a;
  double error = 0, sum = 0;
  for (int o = 3; o < 80; o += 7)
    for (int i = 2; i < 80; i += 5)
      for (int p = 0; p < 360; p += 11) {
        const Dir out = dir_from_angles(o * kDegree, 0.7), in = dir_from_angles(i * kDegree, p * kDegree + 0.71);
        double t, f;
        tree.value(out, in, {&t, 1}), function.value(out, in, {&f, 1});
        const double r = reader.f(out, in), w = in.z * std::sin(i * kDegree);
        a.with_tree = std::max(a.with_tree, std::fabs(r - t));
        error += w * std::fabs(r - f), sum += w * f;
      }
  a.with_function = error / sum;
  return a;
}

TEST(TensorTree, ALambertSurfaceIsOneLeaf) {
  const test::Analytic grey([](Dir, Dir) { return 0.1; });
  const TensorTree tree(grey, 0, {});
  // The half of the hypercube that no direction has holds a 0 of its own.
  EXPECT_LE(tree.leaves(), 8u);
  EXPECT_FALSE(tree.full());
  const Reader reader(tree.xml("a -- comment & more"));
  EXPECT_TRUE(reader.whole());
  EXPECT_FLOAT_EQ(static_cast<float>(reader.f({0, 0, 1}, normalized(Dir{0.3, 0.2, 0.5}))), 0.1F);
}

// Agreement's sum is over other directions than the aim's measure: half as much again is allowed. A finer aim must be
// a smaller error, which a tree of a fixed depth would not show.
TEST(TensorTree, KeepsAnErrorAsAnotherReaderSeesIt) {
  const test::Analytic gloss = test::glossy(0.25, 1);
  for (const double aim : {0.05, 0.015}) {
    const TensorTree tree(gloss, 0, {.error = aim, .leaves = 1'000'000});
    EXPECT_FALSE(tree.full());
    const Agreement a = agreement(gloss, tree, Reader(tree.xml("")));
    EXPECT_LT(a.with_tree, 1e-5);  // of values to 12: five digits are written
    EXPECT_LT(a.with_function, 1.5 * aim);
    EXPECT_GT(a.with_function, 0.3 * aim);
  }
}

// A lobe of one degree: what is missed between the points that are asked first would be missed for good. Its height
// along the mirror direction is kept.
TEST(TensorTree, FindsNarrowLobes) {
  const test::Analytic satin = test::glossy(0.02, 1);
  const TensorTree tree(satin, 0, {.error = 0.1, .leaves = 3'000'000});
  EXPECT_FALSE(tree.full());
  for (const int deg : {10, 35, 60}) {
    const Dir out = dir_from_angles(deg * kDegree, 0.3), in = dir_from_angles(deg * kDegree, 0.3 + kPi);
    double t, f;
    tree.value(out, in, {&t, 1}), satin.value(out, in, {&f, 1});
    EXPECT_NEAR(t / f, 1, 0.1) << deg;
  }
}

// Cells are cut on while whoever measures finds more than was asked for, and no longer; nan is no error that cuts
// lessen.
TEST(TensorTree, IsCutUntilTheMeasuredErrorIsKept) {
  const test::Analytic gloss = test::glossy(0.25, 1);
  const TensorTree own(gloss, 0, {.error = 0.05});
  const std::vector<double> found = {0.1, 0.06, 0.047};
  size_t asked = 0;
  const TensorTree tree(gloss, 0, {.error = 0.05, .measure = [&](const sqt::Function&) { return found.at(asked++); }});
  EXPECT_EQ(asked, found.size());
  EXPECT_GT(tree.leaves(), 2 * own.leaves());
  EXPECT_FALSE(tree.full());
  asked = 0;
  const TensorTree unknown(gloss, 0, {.error = 0.05, .measure = [&](const sqt::Function&) { return ++asked, NAN; }});
  EXPECT_EQ(asked, 1u);
}

TEST(TensorTree, TellsWhenLeavesRunOut) {
  const test::Analytic gloss = test::glossy(0.1, 1);
  const TensorTree tree(gloss, 0, {.error = 0.005, .leaves = 30'000});
  EXPECT_TRUE(tree.full());
  EXPECT_LE(tree.leaves(), 30'000u);
}

// Directions that are not exchangeable, and azimuths that count: each must land where it belongs.
TEST(TensorTree, KeepsDirectionsApart) {
  const test::Analytic slanted(
      [](Dir out, Dir in) { return 0.2 + 0.1 * in.x + 0.05 * in.y + 0.03 * out.x * in.z - 0.02 * out.y; }, 1,
      sqt::Domain::hemisphere, sqt::Quantity::bsdf, false);
  const TensorTree tree(slanted, 0, {.error = 0.03});
  const Agreement a = agreement(slanted, tree, Reader(tree.xml("")));
  EXPECT_LT(a.with_tree, 1e-5);
  EXPECT_LT(a.with_function, 0.04);
  const test::Analytic leaning([](Dir out, Dir in) { return 0.1 + 0.2 * in.z * in.z + 0.05 * out.z; });
  const TensorTree upright(leaning, 0, {.error = 0.01});
  EXPECT_LT(agreement(leaning, upright, Reader(upright.xml(""))).with_function, 0.015);
}

TEST(TensorTree, RefusesWhatIsNoBrdf) {
  const test::Analytic both([](Dir, Dir) { return 0.1; }, 1, sqt::Domain::sphere);
  EXPECT_THROW(TensorTree(both, 0, {}), Error);
}

}  // namespace
}  // namespace suite::format_tensor_tree_tensor_tree_test
