#include "map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/run_app.h"
#include "math/warps.h"

namespace suite {

namespace {

constexpr double kReliable = 80.1 * kDegree;  // polar angles up to which data count for the colour scale

// A cap of directions on the canvas, in Lambert's projection, which keeps areas: r = radius sqrt((1 - z) / span).
struct Disk {
  double cx, cy, radius;
  Frame frame;  // z the centre of the cap; x to the right, y up
  double span;  // 1 - cos of the angle at the rim
  bool upper;   // shows directions above the surface; only directions on that side are drawn

  bool shows(Dir d) const { return (d.z > 0) == upper && dot(d, frame.z) >= 1 - span - 1e-9; }
  Vec2 to_pixel(Dir d) const {
    const Vec3 l = frame.to_local(d);
    const double s = std::hypot(l.x, l.y), r = radius * std::sqrt(std::max(0.0, 1 - l.z) / span);
    return s > 0 ? Vec2{cx + r * l.x / s, cy - r * l.y / s} : Vec2{cx, cy};
  }
  bool to_direction(double px, double py, Dir& d) const {
    const double x = (px - cx) / radius, y = (cy - py) / radius, r2 = x * x + y * y;
    if (r2 >= 1) return false;
    const double z = 1 - span * r2, s = std::sqrt(span * (1 + z));
    d = frame.to_world({x * s, y * s, z});
    return (d.z > 0) == upper;
  }
};

struct Panel {
  size_t view;
  Dir out;
  Disk disk;
  std::vector<float> values;  // [row][column] of the disk's square; NaN outside
};

Disk disk_of(Dir out, bool upper, const MapOptions& o, double cx, double cy) {
  Disk disk{cx, cy, o.panel_size * 0.5 - 10, Frame{}, 1, upper};
  if (!upper) disk.frame = Frame{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};  // seen through the surface
  if (!(o.zoom_deg > 0)) return disk;
  disk.span = one_minus_cos(o.zoom_deg * kDegree);
  const Dir centre{-out.x, -out.y, upper ? out.z : -out.z};
  // In the plane of incidence: to the right is where the view comes from.
  const double s = std::hypot(out.x, out.y);
  const Vec3 level = s > 1e-9 ? Vec3{out.x / s, out.y / s, 0} : Vec3{1, 0, 0};
  disk.frame = Frame::with_tangent(centre, level);
  if (!upper) disk.frame.y = disk.frame.y * -1.0;
  return disk;
}

void ask_values(Panel& panel, const sqt::Bundle& bundle, size_t channel, int size) {
  const size_t n = static_cast<size_t>(size);
  panel.values.assign(n * n, std::nanf(""));
  const double x0 = panel.disk.cx - size * 0.5, y0 = panel.disk.cy - size * 0.5;
  parallel_for(0, n, 8, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y)
      for (size_t x = 0; x < n; ++x) {
        Dir in;
        if (panel.disk.to_direction(x0 + static_cast<double>(x) + 0.5, y0 + static_cast<double>(y) + 0.5, in))
          panel.values[y * n + x] = static_cast<float>(bundle.value(panel.out, in, channel));
      }
  });
}

// Ends of the colour scale: the largest value of the shown slices where data are reliable, asked where the leaves are;
// and the value that all but half a percent of the reliable pixels exceed.
std::pair<double, double> value_range(const std::vector<Panel>& panels, const sqt::Bundle& bundle,
                                      const MapOptions& o) {
  const bool phase = !bundle.cosine_weighted();
  auto reliable = [&](Dir d) { return phase || std::fabs(d.z) >= std::cos(kReliable); };
  double high = 0;
  std::vector<float> seen;
  for (const Panel& p : panels) {
    for (const sqt::Bundle::Cell& c : bundle.cells(p.view, o.channel)) {
      const Dir in = bundle.incident(p.view, c, {0.5, 0.5});
      if (reliable(p.out) && reliable(in) && p.disk.shows(in)) high = std::max(high, c.value);
    }
    const size_t n = static_cast<size_t>(o.panel_size);
    for (size_t i = 0; i < p.values.size(); i += 7) {
      Dir in;
      const double x = p.disk.cx - o.panel_size * 0.5 + static_cast<double>(i % n) + 0.5,
                   y = p.disk.cy - o.panel_size * 0.5 + static_cast<double>(i / n) + 0.5;
      if (p.values[i] > 0 && p.disk.to_direction(x, y, in) && reliable(in)) seen.push_back(p.values[i]);
    }
  }
  if (seen.empty()) seen.push_back(1e-12f);
  const auto smallest = seen.begin() + static_cast<ptrdiff_t>(seen.size() / 200);
  std::nth_element(seen.begin(), smallest, seen.end());
  const double low = *smallest;
  high = std::max({high, static_cast<double>(*std::max_element(seen.begin(), seen.end())), 1e-12});
  // An even function needs some range, too.
  return {std::clamp(low, high * std::pow(10.0, -o.decades), high / 2), high};
}

void draw_values(Canvas& canvas, const Panel& p, int size, double low, double high) {
  const int x0 = static_cast<int>(p.disk.cx - size * 0.5), y0 = static_cast<int>(p.disk.cy - size * 0.5);
  const size_t n = static_cast<size_t>(size);
  for (size_t i = 0; i < p.values.size(); ++i)
    if (!std::isnan(p.values[i]))
      canvas.set(x0 + static_cast<int>(i % n), y0 + static_cast<int>(i / n),
                 viridis(log_position(p.values[i], low, high)));
}

// Borders of the leaves, followed through the slice's own frame; parts that the disk does not show are not drawn.
void draw_edges(Canvas& canvas, const Disk& disk, const sqt::Bundle& bundle, size_t view,
                std::span<const sqt::Bundle::Cell> cells) {
  static constexpr Vec2 corners[5] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  for (const sqt::Bundle::Cell& cell : cells) {
    if (disk.span < 0.9 && !disk.shows(bundle.incident(view, cell, {0.5, 0.5})) &&
        !disk.shows(bundle.incident(view, cell, {0, 0})) && !disk.shows(bundle.incident(view, cell, {1, 1})))
      continue;
    const double pixels = disk.radius / std::sqrt(disk.span) / static_cast<double>(1 << cell.id.order());
    const int steps = std::clamp(static_cast<int>(pixels / 4), 2, 48);
    // Cells of a few pixels would hide their own values: their borders fade.
    const double opacity = 0.35 * std::clamp((pixels - 2) / 8, 0.0, 1.0);
    if (opacity == 0) continue;
    for (int e = 0; e < 4; ++e) {
      Dir before{};
      for (int s = 0; s <= steps; ++s) {
        const double t = static_cast<double>(s) / steps;
        const Dir d = bundle.incident(view, cell,
                                      {corners[e].x + (corners[e + 1].x - corners[e].x) * t,
                                       corners[e].y + (corners[e + 1].y - corners[e].y) * t});
        if (s > 0 && disk.shows(d) && disk.shows(before))
          canvas.line(disk.to_pixel(before), disk.to_pixel(d), kWhite, opacity);
        before = d;
      }
    }
  }
}

// Dotted rings of equal angle from the centre, labelled; and the rim.
void draw_rings(Canvas& canvas, const Disk& disk, double rim_deg, int scale) {
  const double step = rim_deg > 60   ? 30
                      : rim_deg > 25 ? 10
                      : rim_deg > 10 ? 5
                      : rim_deg > 5  ? 2
                      : rim_deg > 2  ? 1
                                     : 0.5;
  for (double deg = step; deg < rim_deg - 1e-9; deg += step) {
    const double r = disk.radius * std::sqrt(one_minus_cos(deg * kDegree) / disk.span);
    const int dots = static_cast<int>(2 * kPi * r / 7);
    for (int k = 0; k < dots; ++k) {
      const Vec2 p{disk.cx + r * std::cos(2 * kPi * k / dots), disk.cy - r * std::sin(2 * kPi * k / dots)};
      Dir d;
      if (disk.to_direction(p.x, p.y, d)) canvas.stroke(p, p, 1.6, kWhite, 0.8);
    }
    const std::string label = strf("%g", deg);
    const int x = static_cast<int>(disk.cx) - Canvas::text_width(label, scale) / 2,
              y = static_cast<int>(disk.cy + r) + 3;
    canvas.text(x + 1, y + 1, label, kBlack, scale);
    canvas.text(x, y, label, kWhite, scale);
  }
  for (int k = 0; k < 360; ++k) {
    const double a = 2 * kPi * k / 360, b = 2 * kPi * (k + 1) / 360;
    canvas.line({disk.cx + disk.radius * std::cos(a), disk.cy + disk.radius * std::sin(a)},
                {disk.cx + disk.radius * std::cos(b), disk.cy + disk.radius * std::sin(b)}, kGrey);
  }
}

void draw_marks(Canvas& canvas, const Disk& disk, Dir out) {
  const Rgb red{230, 40, 40};
  if (disk.shows(out)) {
    const Vec2 p = disk.to_pixel(out);
    canvas.stroke({p.x - 6, p.y - 6}, {p.x + 6, p.y + 6}, 2, red);
    canvas.stroke({p.x - 6, p.y + 6}, {p.x + 6, p.y - 6}, 2, red);
  }
  // The mirror direction above, straight on below.
  const Vec2 q = disk.to_pixel({-out.x, -out.y, disk.upper ? out.z : -out.z});
  for (int k = 0; k < 24; ++k) {
    const double a = 2 * kPi * k / 24, b = 2 * kPi * (k + 1) / 24;
    canvas.stroke({q.x + 8 * std::cos(a), q.y + 8 * std::sin(a)}, {q.x + 8 * std::cos(b), q.y + 8 * std::sin(b)}, 1.6,
                  red);
  }
}

std::vector<size_t> chosen_views(const sqt::Bundle& bundle, const MapOptions& o) {
  const std::vector<sqt::Bundle::View>& all = bundle.info().views;
  std::vector<size_t> views;
  for (const double deg : o.view_deg) {
    size_t best = 0;
    for (size_t v = 1; v < all.size(); ++v)
      if (std::fabs(all[v].theta - deg * kDegree) < std::fabs(all[best].theta - deg * kDegree)) best = v;
    if (std::find(views.begin(), views.end(), best) == views.end()) views.push_back(best);
  }
  if (!views.empty()) return views;
  std::vector<size_t> reliable;
  for (size_t v = 0; v < all.size(); ++v)
    if (v == 0 || all[v].theta <= kReliable || !bundle.cosine_weighted()) reliable.push_back(v);
  const size_t n = reliable.size(), wanted = std::min(std::max<size_t>(1, o.panels), n);
  for (size_t i = 0; i < wanted; ++i) views.push_back(reliable[wanted == 1 ? 0 : i * (n - 1) / (wanted - 1)]);
  return views;
}

}  // namespace

Canvas draw_map(const sqt::Bundle& bundle, const std::string& title, const MapOptions& o) {
  const bool sphere = bundle.info().function.domain == sqt::Domain::sphere;
  const std::vector<size_t> views = chosen_views(bundle, o);
  const int scale = o.panel_size >= 400 ? 2 : 1, line = Canvas::text_height(scale) + 2 * scale;
  const int head = 3 * line, caption = 2 * line + 4;
  const int columns = static_cast<int>(std::min<size_t>(views.size(), 3)),
            rows = (static_cast<int>(views.size()) + columns - 1) / columns;
  const int panel_height = caption + o.panel_size * (sphere ? 2 : 1);
  const int width = columns * o.panel_size + 90 * scale, height = head + rows * panel_height;
  if (width > 16384 || height > 16384)
    throw UsageError(strf("--panels and --size ask for a sheet of %d x %d pixels; 16384 are the most", width, height));
  Canvas canvas(width, height);
  const double wavelength = bundle.info().function.wavelength_um[o.channel];
  canvas.text(8, 6, strf("%s, %g um", title.c_str(), wavelength), kBlack, scale);
  canvas.text(8, 6 + line,
              o.zoom_deg > 0 ? strf("within %g deg of the mirror direction", o.zoom_deg)
                             : std::string("cross: view, circle: mirror direction"),
              kBlack, scale);

  std::vector<Panel> panels;
  for (size_t i = 0; i < views.size(); ++i) {
    const sqt::Bundle::View view = bundle.info().views[views[i]];
    const Dir out = dir_from_angles(view.theta, view.phi);
    const double x = (static_cast<double>(i % static_cast<size_t>(columns)) + 0.5) * o.panel_size,
                 y = head + static_cast<double>(i / static_cast<size_t>(columns)) * panel_height + caption;
    for (int side = 0; side < (sphere ? 2 : 1); ++side) {
      panels.push_back({views[i], out, disk_of(out, side == 0, o, x, y + o.panel_size * (side + 0.5)), {}});
      ask_values(panels.back(), bundle, o.channel, o.panel_size);
    }
  }
  const auto [low, high] = value_range(panels, bundle, o);
  for (const Panel& p : panels) {
    const sqt::Bundle::View view = bundle.info().views[p.view];
    const std::vector<sqt::Bundle::Cell> cells = bundle.cells(p.view, o.channel);
    draw_values(canvas, p, o.panel_size, low, high);
    if (o.edges) draw_edges(canvas, p.disk, bundle, p.view, cells);
    draw_rings(canvas, p.disk, o.zoom_deg > 0 ? o.zoom_deg : 90, scale);
    draw_marks(canvas, p.disk, p.out);
    if (sphere && !p.disk.upper) continue;
    const int x = static_cast<int>(p.disk.cx) - o.panel_size / 2 + 8,
              y = static_cast<int>(p.disk.cy) - o.panel_size / 2 - caption;
    canvas.text(x, y,
                strf("view %.1f deg", view.theta / kDegree) +
                    (bundle.info().function.isotropic ? "" : strf(", azimuth %.0f deg", view.phi / kDegree)),
                kBlack, scale);
    canvas.text(x, y + line, strf("%zu leaves, total %.4f", cells.size(), bundle.total(p.out, o.channel)), kBlack,
                scale);
  }
  draw_log_bar(canvas, columns * o.panel_size + 8 * scale, head + caption + 12, 12 * scale,
               std::min(560, rows * panel_height - caption - 40), low, high, "f [1/sr]", scale);
  return canvas;
}

}  // namespace suite
