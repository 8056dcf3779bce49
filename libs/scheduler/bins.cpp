#include "scheduler/bins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scheduler/air_bins.h"
#include "scheduler/air_choice.h"
#include "scheduler/products.h"

namespace suite {

namespace {

constexpr double kUsualError = 1e-3;    // judges even bins
constexpr size_t kMostCells = 1 << 16;  // of a state
constexpr size_t kMostOfABand = 512;    // bins
constexpr size_t kCellsAcross = 32;     // of the narrowest band, to begin with

// One state of a sensor and what it is looking at.
class StateBins {
 public:
  StateBins(const SpectralState& state, std::span<const Band> bands, const std::vector<SeenSpectra>& seen,
            bool white_light)
      : state_(state), bands_(bands), wanted_(state.choice.error > 0 ? state.choice.error : kUsualError) {
    double narrowest = INFINITY, support = 0;
    for (const Band& b : bands) narrowest = std::min(narrowest, b.high_um() - b.low_um());
    for (const Bin& b : whole_stretches().bins) support += b.high_um - b.low_um;
    cell_ = std::max(narrowest / kCellsAcross, 4 * support / kMostCells);
    SpectralState fine = make_state(bands, cell_, 0, 1);
    SpectralState probe = fine;
    const std::vector<Bin> between = places(fine).bins;
    probe.bins.insert(probe.bins.end(), between.begin(), between.end());
    recipe_ = ProductRecipe(seen, probe, white_light);
    refine(std::move(fine));
  }

  // The state with the fewest bins found.
  SpectralState choose() {
    const double room = std::max(wanted_ - unresolved_, 0.5 * wanted_);
    const double widest = state_.choice.widest_um;
    SpectralState whole = widest > 0 ? make_state(bands_, widest) : whole_stretches();
    if (judge(whole) <= room) return finished(std::move(whole));
    SpectralState some = sparse(room);
    const double of_some = error_, of_even = judge(state_);
    if (of_even <= std::max(room, of_some) && state_.size() <= some.size()) return finished(state_);
    error_ = std::max(of_some, judge(some));  // stretches count in the first
    return finished(std::move(some));
  }

  // The largest error of a state's bins, kept for the report.
  double judge(const SpectralState& state) {
    const SpectralProducts products = recipe_.over(state);
    const std::vector<BandCells> cells = cells_of(state, bands_);
    error_ = 0, band_ = 0, product_ = products.products.size();
    of_band_.assign(bands_.size(), 0.0);
    for (size_t b = 0; b < bands_.size(); ++b)
      for (size_t p = 0; p < products.products.size(); ++p) {
        if (!(means_[b][p].mean > 0)) continue;
        double value = 0;
        for (size_t k = 0; k < cells[b].share.size(); ++k)
          value += cells[b].share[k] * products.at(products.products[p], cells[b].first + k);
        const double e = means_[b][p].error(value);
        of_band_[b] = std::max(of_band_[b], e);
        if (e > error_) error_ = e, band_ = b, product_ = p;
      }
    return error_;
  }
  double error_of(size_t band) const { return of_band_[band] + unresolved_; }  // as judged last
  double wanted() const { return wanted_; }

  BinReport report(const std::string& sensor, size_t bins) const {
    BinReport r{sensor, bands_.size(), bins, wanted_, error_ + unresolved_, cell_, {}, {}, state_.choice.error > 0};
    r.band = bands_[band_].name;
    r.under = recipe_.name_of(product_);
    return r;
  }

 private:
  using Means = std::vector<std::vector<BandMean>>;  // [band][product]

  // Halves the cells until no band of no product changes.
  void refine(SpectralState fine) {
    means_ = means_over(recipe_.over(fine), fine);
    for (;;) {
      cell_ /= 2;
      fine_ = make_state(bands_, cell_, 0, 1);
      products_ = recipe_.over(fine_);
      Means means = means_over(products_, fine_);
      const double change = difference(means_, means);
      means_ = std::move(means);
      // Lines that are much finer than the cells do not change by halving, but show at single places in the cells.
      // These are no better than a few times the error wanted, so that less does not count.
      const double hidden = difference(means_over(recipe_.over(places(fine_)), fine_), means_);
      const bool lines = hidden > 8 * wanted_;
      unresolved_ = lines ? hidden : change / 2;  // halving leaves a quarter: a third of the change
      if ((change <= wanted_ / 8 && !lines) || 2 * fine_.size() > kMostCells) return;
    }
  }

  static double difference(const Means& a, const Means& b) {
    double most = 0;
    for (size_t i = 0; i < a.size(); ++i)
      for (size_t p = 0; p < a[i].size(); ++p)
        if (a[i][p].mean > 0 && b[i][p].mean > 0) most = std::max(most, b[i][p].error(a[i][p].mean));
    return most;
  }
  // One bin for bands that overlap or touch.
  SpectralState whole_stretches() const { return make_state(bands_, state_.high_um - state_.low_um); }
  // A place near the middle of every bin, as narrow as Planck's function allows. Not the middle itself: there even
  // combs of lines may all have their mean.
  static SpectralState places(SpectralState state) {
    for (Bin& b : state.bins) {
      const double width = b.high_um - b.low_um, place = b.low_um + 0.4571 * width,
                   half = std::min(1e-7 * place, width / 128);
      b = {place - half, place + half};
    }
    return state;
  }
  Means means_over(const SpectralProducts& products, const SpectralState& state) const {
    Means means;
    for (const BandCells& cells : cells_of(state, bands_)) means.push_back(band_means(products, cells));
    return means;
  }

  // Some of the fine cells.
  SpectralState sparse(double tolerance) {
    std::vector<BandCells> cells = cells_of(fine_, bands_);
    if (state_.choice.widest_um > 0)
      for (BandCells& band : cells) band.stretches = stretches_of(band);
    const ChosenCells chosen = choose_cells(products_, cells, tolerance, kMostOfABand);
    SpectralState state = state_;
    state.bins.clear();
    for (const size_t c : chosen.cells) state.bins.push_back(fine_.bins[c]);
    state.shares = chosen.shares;
    error_ = chosen.error;
    return state;
  }

  // The cells of a band in steps of the widest bin.
  std::vector<std::array<size_t, 2>> stretches_of(const BandCells& band) const {
    std::vector<std::array<size_t, 2>> stretches;
    const size_t end = band.first + band.share.size();
    for (size_t begin = band.first; begin < end;) {
      size_t next = begin + 1;
      while (next < end && fine_.bins[next].high_um - fine_.bins[begin].low_um <= state_.choice.widest_um) ++next;
      stretches.push_back({begin, next});
      begin = next;
    }
    return stretches;
  }

  SpectralState finished(SpectralState s) const {
    s.low_um = state_.low_um, s.high_um = state_.high_um, s.reference_um = state_.reference_um;
    s.choice = state_.choice;
    place_knots(s, state_.choice.knots);
    return s;
  }

  const SpectralState state_;
  std::span<const Band> bands_;
  double wanted_, cell_ = 0, unresolved_ = 0;
  ProductRecipe recipe_;
  SpectralState fine_;
  SpectralProducts products_;  // over the fine cells
  Means means_;                // over the fine cells; 0 = does not matter
  double error_ = 0;
  std::vector<double> of_band_;
  size_t band_ = 0, product_ = 0;  // whose it is
};

// The bins of one state under real air, and what is known of them.
class StateInAir {
 public:
  StateInAir(const Scene& scene, std::span<const SourceSpecs> sources, const Sensor& sensor, size_t state,
             bool white_light, FoundHeat found)
      : air_(*sources[0].air),
        state_(sensor.states()[state]),
        bands_(sensor.bands(state)),
        seen_(spectra_of(scene, sources, bands_, found)),
        paths_(sources, sensor, state),
        without_gases_(state_, bands_, seen_, white_light),
        white_light_(white_light) {}

  // User's bins are even: for spectral_error 0, and where a widest bin is given.
  SpectralState make() {
    const bool even = !(state_.choice.error > 0) || state_.choice.widest_um > 0;
    if (!even) {
      check_gases_known(air_, state_, bands_);
      const AirChoice choice(air_, paths_, seen_, state_, bands_, white_light_);
      SpectralState chosen = choice.choose(without_gases_.wanted());
      without_gases_.judge(choice.cells());
      note(choice.judge(chosen), choice.floors());
      return chosen;
    }
    AirBins in_air = bins_in_air(air_, state_, bands_);
    without_gases_.judge(in_air.intervals);
    intervals_ = in_air.intervals.size();
    // Even bins that are as narrow as the cells are as good as these.
    if (2 * intervals_ < air_cells(bands_).size()) {
      const AirChoice choice(air_, paths_, seen_, state_, bands_, white_light_);
      note(choice.judge(in_air.state), choice.floors());
    } else {
      judged_ = false;  // but what curves do within them is known
      note(std::vector<AirChoice::Worst>(bands_.size()), std::vector<double>(bands_.size(), 0.0));
    }
    return std::move(in_air.state);
  }

  BinReport report(const std::string& sensor, const SpectralState& state) const {
    BinReport r = without_gases_.report(sensor, intervals_ ? intervals_ : state.size());
    r.cell_um = INFINITY;
    r.g_points = intervals_ ? state.size() : 0;
    r.bias = bias_;
    for (const Bin& b : air_cells(bands_).bins) r.cell_um = std::min(r.cell_um, b.high_um - b.low_um);
    r.through_gases = judged_, r.chosen = intervals_ == 0;
    r.reached = 0;
    for (size_t b = 0; b < bands_.size(); ++b) {
      if (!(bias_[b].relative > r.reached) && b > 0) continue;
      r.reached = bias_[b].relative, r.band = bands_[b].name;
      if (!under_[b].empty()) r.under = under_[b];
    }
    for (size_t b = 0; b < bands_.size(); ++b)
      if (judged_ && !bias_[b].within)
        r.missed.push_back({bands_[b].name, bands_[b].center_um, bias_[b].relative, under_[b]});
    std::stable_sort(r.missed.begin(), r.missed.end(),
                     [](const auto& a, const auto& b) { return a.center_um < b.center_um; });
    return r;
  }

 private:
  void note(const std::vector<AirChoice::Worst>& worst, const std::vector<double>& floors) {
    bias_.clear(), under_.clear();
    for (size_t b = 0; b < bands_.size(); ++b) {
      const double error = std::max(worst[b].error, without_gases_.error_of(b));
      bias_.push_back({error, floors[b], error <= without_gases_.wanted(), worst[b].of_dark});
      under_.push_back(worst[b].error >= error ? worst[b].under : std::string());
    }
  }

  const AirSpec& air_;
  const SpectralState state_;
  std::span<const Band> bands_;
  std::vector<SeenSpectra> seen_;
  AirPaths paths_;
  StateBins without_gases_;
  bool white_light_;
  bool judged_ = true;    // along paths through the air
  size_t intervals_ = 0;  // of even bins
  std::vector<BandBias> bias_;
  std::vector<std::string> under_;
};

}  // namespace

std::string BinReport::text() const {
  const char* what = g_points > 0 ? "interval" : "bin";
  return strf("sensor '%s': %zu band%s in %zu %s%s%s, within %.2g %% of bins of %.3g nm%s", sensor.c_str(), bands,
              bands == 1 ? "" : "s", bins, what, bins == 1 ? "" : "s",
              g_points > 0 ? strf(" and %zu g-points of gases", g_points).c_str() : "", 100 * reached, 1000 * cell_um,
              through_gases ? " through the air" : "") +
         (under.empty() ? "" : " (farthest: band '" + band + "', " + under + ")");
}

std::string BinReport::missed_text() const {
  constexpr size_t kNamed = 300;
  std::string text;
  for (size_t i = 0; i < std::min(kNamed, missed.size()); ++i)
    text += strf("%s'%s' (%.4g um) %.2g %%", i ? ", " : "", missed[i].band.c_str(), missed[i].center_um,
                 100 * missed[i].error);
  return text + (missed.size() > kNamed ? strf(" and %zu more", missed.size() - kNamed) : "");
}

void add_biases(std::span<const BinReport> reports, BandBiases& to) {
  for (size_t s = 0; s < reports.size(); ++s)
    if (!reports[s].bias.empty()) to[{reports[s].sensor, s}] = reports[s].bias;
}

// All that the bins of a state depend on but for scene and sources.
struct BinChooser::Question {
  SpectralState state;
  std::vector<Band> bands;
  std::vector<double> paths;  // through the air; empty without
  bool white_light = false;

  bool operator==(const Question& o) const {
    return white_light == o.white_light && paths == o.paths && same(state, o.state) &&
           std::equal(bands.begin(), bands.end(), o.bands.begin(), o.bands.end(),
                      [](const Band& a, const Band& b) { return same(a, b); });
  }

 private:
  static bool same(const SpectralState& a, const SpectralState& b) {
    const auto rest = [](const SpectralState& s) {
      return std::array{s.low_um,       s.high_um,          s.reference_um,
                        s.choice.error, s.choice.widest_um, static_cast<double>(s.choice.knots)};
    };
    return rest(a) == rest(b) && a.bins == b.bins && a.knots == b.knots && a.shares == b.shares;
  }
  static bool same(const Band& a, const Band& b) {
    const Curve &c = a.response, &d = b.response;
    return a.name == b.name && a.center_um == b.center_um && a.fwhm_um == b.fwhm_um &&
           c.is_constant() == d.is_constant() && c.outside() == d.outside() && c.wavelength_um() == d.wavelength_um() &&
           c.value() == d.value();
  }
};

struct BinChooser::Answer {
  std::optional<SpectralState> made;  // nothing: the state stays as it is
  BinReport report;                   // without the sensor's name
};

BinChooser::BinChooser(const Scene& scene, std::span<const SourceSpecs> sources, FoundHeat heat)
    : scene_(scene), sources_(sources), heat_(heat) {}
BinChooser::~BinChooser() = default;

const BinChooser::Answer& BinChooser::answer(Sensor& sensor, size_t state, bool white_light) {
  const bool air = !sources_.empty() && sources_[0].air;
  const std::span<const Band> bands = sensor.bands(state);
  Question question{sensor.states()[state], {bands.begin(), bands.end()}, {}, white_light};
  if (air) question.paths = AirPaths(sources_, sensor, state).key();
  for (const auto& [asked, known] : known_)
    if (asked == question) return known;
  ++found_;
  Answer found;
  if (air) {
    StateInAir in_air(scene_, sources_, sensor, state, white_light, heat_);
    found.made = in_air.make();
    found.report = in_air.report({}, *found.made);
  } else {
    StateBins bins(question.state, bands, spectra_of(scene_, sources_, bands, heat_), white_light);
    if (question.state.choice.error > 0)
      found.made = bins.choose();
    else
      bins.judge(question.state);
    found.report = bins.report({}, found.made ? found.made->size() : question.state.size());
  }
  constexpr size_t kKept = 64;
  if (known_.size() == kKept) known_.erase(known_.begin());
  return known_.emplace_back(std::move(question), std::move(found)).second;
}

std::vector<BinReport> BinChooser::choose(Sensor& sensor) {
  bool white_light = false;
  for (const Task& t : sensor.tasks())
    for (const Capture& c : t.captures) white_light = white_light || c.bin_by == Capture::BinBy::sun;
  std::vector<BinReport> reports;
  for (size_t s = 0; s < sensor.states().size(); ++s) {
    const Answer& a = answer(sensor, s, white_light);
    reports.push_back(a.report);
    reports.back().sensor = sensor.name();
    if (a.made) sensor.take_state(s, *a.made);
  }
  return reports;
}

std::vector<BinReport> choose_bins(const Scene& scene, std::span<const SourceSpecs> sources, Sensor& sensor,
                                   FoundHeat heat) {
  return BinChooser(scene, sources, heat).choose(sensor);
}

}  // namespace suite
