#include "map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

constexpr int kHeader = 34, kCaption = 30, kBarWidth = 110;

// The disk of one side of the surface on the canvas.
struct Disk {
  double cx, cy, radius;
  int side;  // +1 directions above the surface, -1 below
  // Lambert's projection keeps areas: r = radius sqrt(1 - |z|).
  Vec2 to_pixel(Dir d) const {
    const double s = std::hypot(d.x, d.y), r = radius * std::sqrt(std::max(0.0, 1 - std::fabs(d.z)));
    return s > 0 ? Vec2{cx + r * d.x / s, cy - r * d.y / s} : Vec2{cx, cy};
  }
  bool to_direction(double px, double py, Dir& d) const {
    const double x = (px - cx) / radius, y = (cy - py) / radius, r2 = x * x + y * y;
    if (r2 >= 1) return false;
    const double f = std::sqrt(2 - r2);
    d = {x * f, y * f, side * (1 - r2)};
    return true;
  }
};

void draw_values(Canvas& canvas, const Disk& disk, const sqt::Bundle& bundle, Dir out, size_t channel, double low,
                 double high) {
  const int x0 = static_cast<int>(disk.cx - disk.radius), x1 = static_cast<int>(disk.cx + disk.radius) + 1;
  const int y0 = static_cast<int>(disk.cy - disk.radius), y1 = static_cast<int>(disk.cy + disk.radius) + 1;
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      Dir in;
      if (disk.to_direction(x + 0.5, y + 0.5, in))
        canvas.set(x, y, viridis(log_position(bundle.value(out, in, channel), low, high)));
    }
}

// Borders of the leaves, followed through the slice's own frame; parts on the other side of the horizon are not drawn.
void draw_edges(Canvas& canvas, const Disk& disk, const sqt::Bundle& bundle, size_t view,
                std::span<const sqt::Bundle::Cell> cells) {
  static constexpr Vec2 corners[5] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  for (const sqt::Bundle::Cell& cell : cells) {
    const int steps = cell.id.order() >= 5 ? 2 : cell.id.order() >= 3 ? 6 : 24;
    // Cells of a few pixels would hide their own values: their borders fade.
    const double pixels = disk.radius / static_cast<double>(1 << cell.id.order()),
                 opacity = 0.2 * std::clamp((pixels - 2) / 6, 0.0, 1.0);
    if (opacity == 0) continue;
    for (int e = 0; e < 4; ++e) {
      Dir before{};
      for (int s = 0; s <= steps; ++s) {
        const double t = static_cast<double>(s) / steps;
        const Dir d = bundle.incident(view, cell,
                                      {corners[e].x + (corners[e + 1].x - corners[e].x) * t,
                                       corners[e].y + (corners[e + 1].y - corners[e].y) * t});
        if (s > 0 && d.z * disk.side > 0 && before.z * disk.side > 0)
          canvas.line(disk.to_pixel(before), disk.to_pixel(d), kWhite, opacity);
        before = d;
      }
    }
  }
}

void draw_marks(Canvas& canvas, const Disk& disk, Dir out) {
  const Rgb red{230, 40, 40};
  if (out.z * disk.side > 0) {
    const Vec2 p = disk.to_pixel(out);
    canvas.line({p.x - 5, p.y - 5}, {p.x + 5, p.y + 5}, red);
    canvas.line({p.x - 5, p.y + 5}, {p.x + 5, p.y - 5}, red);
  }
  // The mirror direction above, straight on below.
  const Dir mark = disk.side * out.z > 0 ? Dir{-out.x, -out.y, out.z} : Dir{-out.x, -out.y, -out.z};
  const Vec2 q = disk.to_pixel(mark);
  for (int k = 0; k < 24; ++k) {
    const double a = 2 * kPi * k / 24, b = 2 * kPi * (k + 1) / 24;
    canvas.line({q.x + 6 * std::cos(a), q.y + 6 * std::sin(a)}, {q.x + 6 * std::cos(b), q.y + 6 * std::sin(b)}, red);
  }
}

std::vector<size_t> chosen_views(const sqt::Bundle& bundle, size_t panels) {
  const size_t n = bundle.info().views.size();
  std::vector<size_t> views;
  const size_t wanted = std::min(std::max<size_t>(1, panels), n);
  for (size_t i = 0; i < wanted; ++i) views.push_back(wanted == 1 ? 0 : i * (n - 1) / (wanted - 1));
  return views;
}

// The largest value over the shown slices up to 80 deg, asked where the leaves are; beyond, data rise without bound.
double largest_value(const sqt::Bundle& bundle, std::span<const size_t> views, size_t channel) {
  double high = 0;
  for (const size_t v : views)
    if (v == views.front() || bundle.info().views[v].theta <= 80.1 * kDegree)
      for (const sqt::Bundle::Cell& c : bundle.cells(v, channel)) high = std::max(high, c.value);
  return high;
}

}  // namespace

Canvas draw_map(const sqt::Bundle& bundle, const std::string& title, const MapOptions& o) {
  const bool sphere = bundle.info().function.domain == sqt::Domain::sphere;
  const std::vector<size_t> views = chosen_views(bundle, o.panels);
  const int columns = static_cast<int>(std::min<size_t>(views.size(), 3)),
            rows = (static_cast<int>(views.size()) + columns - 1) / columns;
  const int panel_height = kCaption + o.panel_size * (sphere ? 2 : 1);
  Canvas canvas(columns * o.panel_size + kBarWidth, kHeader + rows * panel_height);
  canvas.text(8, 6, title, kBlack, 2);

  const double high = std::max(largest_value(bundle, views, o.channel), 1e-12), low = high * std::pow(10.0, -o.decades);
  const double wavelength = bundle.info().function.wavelength_um[o.channel];
  for (size_t i = 0; i < views.size(); ++i) {
    const size_t v = views[i];
    const sqt::Bundle::View view = bundle.info().views[v];
    const int x = static_cast<int>(i) % columns * o.panel_size,
              y = kHeader + static_cast<int>(i) / columns * panel_height;
    const Dir out = dir_from_angles(view.theta, view.phi);
    const std::vector<sqt::Bundle::Cell> cells = bundle.cells(v, o.channel);
    canvas.text(x + 8, y + 4,
                strf("view %.1f deg, azimuth %.0f deg, %g um", view.theta / kDegree, view.phi / kDegree, wavelength));
    canvas.text(x + 8, y + 15, strf("%zu leaves, total %.4f", cells.size(), bundle.total(out, o.channel)));
    for (int side = 0; side < (sphere ? 2 : 1); ++side) {
      const Disk disk{x + o.panel_size * 0.5, y + kCaption + o.panel_size * (side + 0.5), o.panel_size * 0.5 - 8,
                      side ? -1 : 1};
      draw_values(canvas, disk, bundle, out, o.channel, low, high);
      if (o.edges) draw_edges(canvas, disk, bundle, v, cells);
      draw_marks(canvas, disk, out);
    }
  }
  draw_log_bar(canvas, columns * o.panel_size + 16, kHeader + 60, 22, std::min(400, rows * panel_height - 90), low,
               high, "f [1/sr]");
  return canvas;
}

}  // namespace suite
