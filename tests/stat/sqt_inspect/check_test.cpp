// Negative controls of sqt-inspect --check: bundles whose verbs disagree are found out.
#include <gtest/gtest.h>

#include <cmath>

#include "apps/sqt-inspect/check.h"
#include "optics/model_function.h"
#include "sqt/reciprocity.h"
#include "sqt_fit/paper_fit.h"

namespace suite::check_test {
namespace {

std::shared_ptr<const sqt::Bundle> glossy() {
  sqt::PaperOptions options;
  options.views = 4, options.order = 4;
  return sqt::make_bundle(sqt::fit_paper(*model_function("ward:specular=0.3,diffuse=0.3,roughness=0.3"), options));
}

// Hands on every question; a test overrides the one it spoils.
class Spoiled : public sqt::Bundle {
 public:
  explicit Spoiled(std::shared_ptr<const sqt::Bundle> b) : Bundle(b->info()), b_(std::move(b)) {}
  void value(Dir out, Dir in, std::span<double> f) const override { b_->value(out, in, f); }
  double value(Dir out, Dir in, size_t c) const override { return b_->value(out, in, c); }
  double total(Dir out, size_t c) const override { return b_->total(out, c); }
  void magnitude(Dir out, std::span<double> W) const override { b_->magnitude(out, W); }
  std::optional<Dir> sample(Dir out, Vec2 u, double lobe_u, size_t c) const override {
    return b_->sample(out, u, lobe_u, c);
  }
  double pdf(Dir out, Dir in, size_t c) const override { return b_->pdf(out, in, c); }
  void pdf(Dir out, Dir in, std::span<double> p) const override { b_->pdf(out, in, p); }
  std::optional<DeltaLobe> delta(Dir out, size_t c) const override { return b_->delta(out, c); }
  std::vector<Cell> cells(size_t v, size_t c) const override { return b_->cells(v, c); }
  Dir incident(size_t v, const Cell& cell, Vec2 u) const override { return b_->incident(v, cell, u); }

 protected:
  std::shared_ptr<const sqt::Bundle> b_;
};

TEST(InspectCheck, AcceptsAnHonestBundle) {
  const Report r = check_bundle(*glossy(), "x.sqt", 60000);
  EXPECT_EQ(r.count(Severity::error), 0u) << r.text();
}
TEST(InspectCheck, RejectsASamplerThatIsWrongByTwoPercent) {
  class Turned final : public Spoiled {
   public:
    using Spoiled::Spoiled;
    std::optional<Dir> sample(Dir out, Vec2 u, double lobe_u, size_t c) const override {
      auto d = b_->sample(out, u, lobe_u < 0.02 ? lobe_u / 0.02 : (lobe_u - 0.02) / 0.98, c);
      if (d && lobe_u < 0.02) d = Dir{-d->y, d->x, d->z};
      return d;
    }
  };
  EXPECT_GT(check_bundle(Turned(glossy()), "x.sqt", 100000).count("IN105"), 0u);
}
TEST(InspectCheck, RejectsATotalThatIsWrongByTwoPercent) {
  class Boastful final : public Spoiled {
   public:
    using Spoiled::Spoiled;
    double total(Dir out, size_t c) const override { return 1.02 * b_->total(out, c); }
  };
  EXPECT_GT(check_bundle(Boastful(glossy()), "x.sqt", 100000).count("IN106"), 0u);
}
// The number of the report is the one definition's, which sqt-fit writes into the header.
TEST(InspectCheck, SaysHowFarFromReciprocal) {
  class OneSided final : public Spoiled {
   public:
    using Spoiled::Spoiled;
    void value(Dir out, Dir in, std::span<double> f) const override {
      b_->value(out, in, f);
      for (double& v : f) v *= 1 + 0.5 * (out.z - in.z);
    }
  };
  const OneSided bundle(glossy());
  const Report r = check_bundle(bundle, "x.sqt", 1000);
  EXPECT_NE(r.text().find(strf("reciprocity_error %.2f %%", 100 * sqt::reciprocity_error(bundle).back())),
            std::string::npos)
      << r.text();
}
TEST(InspectCheck, RejectsBadValuesMassesAndOverlaps) {
  class Below final : public Spoiled {
   public:
    using Spoiled::Spoiled;
    double value(Dir out, Dir in, size_t c) const override { return in.z < -0.5 ? 0.1 : b_->value(out, in, c); }
  };
  class Negative final : public Spoiled {
   public:
    using Spoiled::Spoiled;
    double value(Dir out, Dir in, size_t c) const override { return in.z > 0.9 ? -1 : b_->value(out, in, c); }
  };
  class Doubled final : public Spoiled {
   public:
    using Spoiled::Spoiled;
    std::vector<Cell> cells(size_t v, size_t c) const override {
      auto list = b_->cells(v, c);
      list.push_back(list.front());
      return list;
    }
  };
  class Light final : public Spoiled {
   public:
    using Spoiled::Spoiled;
    std::vector<Cell> cells(size_t v, size_t c) const override {
      auto list = b_->cells(v, c);
      for (Cell& cell : list) cell.mass *= 0.99;
      return list;
    }
  };
  EXPECT_GT(check_bundle(Below(glossy()), "x", 1000).count("IN102"), 0u);
  EXPECT_GT(check_bundle(Negative(glossy()), "x", 1000).count("IN101"), 0u);
  EXPECT_GT(check_bundle(Doubled(glossy()), "x", 1000).count("IN107"), 0u);
  EXPECT_GT(check_bundle(Light(glossy()), "x", 1000).count("IN104"), 0u);
}

}  // namespace
}  // namespace suite::check_test
