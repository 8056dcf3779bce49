#include "view.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "base/progress.h"
#include "base/run_app.h"
#include "math/warps.h"
#include "page/live_page.h"
#include "page/packed.h"

namespace suite {

namespace {

constexpr double kMostBytes = 20e6;
constexpr double kBytesOfCell = (4 * 3 * 2 + 5 * 2 + 4 + 1) * 4.0 / 3;

Dir direction_of(const sqt::Bundle::View& view) { return dir_from_angles(view.theta, view.phi); }

// The cells of one slice: corners in 1/32767, values of the function at the four corners and the centre, masses,
// orders.
void put_cells(LivePage& page, const sqt::Bundle& bundle, size_t view, size_t channel, double& lost) {
  static constexpr Vec2 kCorners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const Dir out = direction_of(bundle.info().views[view]);
  std::vector<int16_t> corners;
  std::vector<float> values, masses;
  std::vector<std::byte> orders;
  for (const sqt::Bundle::Cell& cell : bundle.cells(view, channel)) {
    for (const Vec2 u : kCorners) {
      const Dir in = bundle.incident(view, cell, u);
      for (const double x : {in.x, in.y, in.z}) corners.push_back(static_cast<int16_t>(std::lround(32767 * x)));
      values.push_back(static_cast<float>(bundle.value(out, in, channel)));
    }
    values.push_back(static_cast<float>(cell.value));
    masses.push_back(static_cast<float>(cell.mass));
    orders.push_back(static_cast<std::byte>(cell.id.order()));
  }
  const std::string id = strf("%zu.%zu", view, channel);
  const Packed packed = packed_half(values);
  lost = std::max(lost, packed.loss);
  page.data("c" + id, LiveKind::u8, std::as_bytes(std::span(corners)));
  page.data("v" + id, LiveKind::half, std::as_bytes(std::span(packed.codes)), packed.first);
  page.data("m" + id, LiveKind::f32, std::as_bytes(std::span(masses)));
  page.data("o" + id, LiveKind::u8, orders);
}

Json about_view(const sqt::Bundle& bundle, size_t view) {
  const sqt::Bundle::View& v = bundle.info().views[view];
  Json j = Json::object(), totals = Json::array(), deltas = Json::array();
  for (size_t c = 0; c < bundle.channels(); ++c) {
    totals.push(bundle.total(direction_of(v), c));
    const auto delta = bundle.info().has_delta() ? bundle.delta(direction_of(v), c) : std::nullopt;
    deltas.push(delta ? delta->total : 0.0);
  }
  j.set("number", view);
  j.set("theta", v.theta / kDegree);
  j.set("phi", v.phi / kDegree);
  j.set("totals", std::move(totals));
  j.set("deltas", std::move(deltas));
  return j;
}

}  // namespace

void write_lobe_view(const sqt::Bundle& bundle, const std::string& path) {
  const sqt::Bundle::Info& info = bundle.info();
  double cells = 0;
  for (size_t v = 0; v < info.views.size(); ++v)
    for (size_t c = 0; c < bundle.channels(); ++c) cells += static_cast<double>(bundle.cells(v, c).size());
  const auto step = static_cast<size_t>(std::max(1.0, std::ceil(cells * kBytesOfCell / kMostBytes)));
  Json about = Json::object(), channels = Json::array(), views = Json::array();
  for (const double um : info.function.wavelength_um) channels.push(um);
  for (size_t v = 0; v < info.views.size(); v += step) views.push(about_view(bundle, v));
  about.set("name", info.function.name);
  about.set("method", info.method);
  about.set("frame", info.frame);
  about.set("leaves", info.leaves);
  about.set("step", step);
  about.set("allViews", info.views.size());
  about.set("channels", std::move(channels));
  about.set("views", std::move(views));
  about.set("made", strf("suite %s: ", kVersion) + command_line());
  LivePage page(path, info.function.name + ": lobes and cells", {"scene_math.js", "lobe.js"}, about);
  double lost = 0;
  for (size_t v = 0; v < info.views.size(); v += step)
    for (size_t c = 0; c < bundle.channels(); ++c) put_cells(page, bundle, v, c, lost);
  Json end = Json::object();
  end.set("lost", lost);
  page.json("end", end);
  page.begin();
  page.commit();
  if (step > 1)
    note(strf("%s has one in %zu of the %zu view directions, to stay within %s", path.c_str(), step, info.views.size(),
              human_bytes(kMostBytes).c_str()));
  note(strf("%s: %s", path.c_str(), human_bytes(static_cast<double>(file_size(path))).c_str()));
}

}  // namespace suite
