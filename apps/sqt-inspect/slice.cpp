#include "slice.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "base/parallel.h"
#include "math/sampling.h"
#include "math/warps.h"

namespace suite {

namespace {

Dir in_plane(double theta_in_deg, bool sphere) {
  const double most = sphere ? 180 : 90;
  return dir_from_angles(std::min(std::fabs(theta_in_deg), most) * kDegree, theta_in_deg < 0 ? kPi : 0);
}

size_t nearest_channel(const sqt::Bundle& bundle, double wavelength_um) {
  const std::vector<double>& um = bundle.info().function.wavelength_um;
  size_t best = 0;
  for (size_t c = 1; c < um.size(); ++c)
    if (std::fabs(um[c] - wavelength_um) < std::fabs(um[best] - wavelength_um)) best = c;
  return best;
}

}  // namespace

std::string slice_csv(const sqt::Bundle& bundle, const std::vector<double>& view_deg) {
  std::string t =
      "# f in 1/sr, without cosine; negative theta_in_deg lies on the side of the mirror "
      "direction\ntheta_o_deg,theta_in_deg";
  for (const double um : bundle.info().function.wavelength_um) t += strf(",f_%g_um", um);
  t += '\n';
  const bool sphere = bundle.info().function.domain == sqt::Domain::sphere;
  const double most = sphere ? 180 : 89.5;
  std::vector<double> f(bundle.channels());
  for (const double view : view_deg)
    for (double theta = -most; theta <= most; theta += 0.5) {
      bundle.value(dir_from_angles(view * kDegree, 0), in_plane(theta, sphere), f);
      t += strf("%g,%g", view, theta);
      for (const double x : f) t += strf(",%.9g", x);
      t += '\n';
    }
  return t;
}

Canvas slice_plot(const sqt::Bundle& bundle, const std::vector<double>& view_deg, size_t channel,
                  const std::string& title, const sqt::Function* data) {
  static constexpr Rgb colors[] = {{31, 119, 180},  {214, 39, 40},  {44, 160, 44},
                                   {148, 103, 189}, {255, 127, 14}, {23, 190, 207}};
  const bool sphere = bundle.info().function.domain == sqt::Domain::sphere;
  PlotAxes axes;
  axes.title = strf("%s, principal plane, %g um", title.c_str(), bundle.info().function.wavelength_um[channel]);
  axes.x_label = "incident zenith [deg], negative towards the mirror direction";
  axes.y_label = "f [1/sr]";
  axes.x_high = sphere ? 180 : 90;
  axes.x_low = -axes.x_high;
  axes.log_y = true;
  axes.scale = 2;
  std::vector<PlotLine> lines;
  double high = 0, low = INFINITY;
  // What reaches beyond 80 deg is drawn and does not set the axis.
  auto add = [&](PlotLine line, double step, const std::function<double(Dir)>& f) {
    for (double theta = axes.x_low; theta <= axes.x_high; theta += step) {
      const double y = f(in_plane(theta, sphere));
      line.x.push_back(theta), line.y.push_back(y);
      if ((std::fabs(theta) <= 80 || sphere) && y > 0) high = std::max(high, y), low = std::min(low, y);
    }
    lines.push_back(std::move(line));
  };
  std::vector<double> f(bundle.channels());
  for (size_t v = 0; v < view_deg.size(); ++v) {
    const Dir out = dir_from_angles(view_deg[v] * kDegree, 0);
    add({strf("view %g deg", view_deg[v]), colors[v % std::size(colors)], {}, {}, false}, 0.1,
        [&](Dir in) { return bundle.value(out, in, channel); });
  }
  for (size_t v = 0; data && v < view_deg.size(); ++v) {
    const Dir out = dir_from_angles(view_deg[v] * kDegree, 0);
    // Dots of a darker kind, so that they show on the line of their view.
    const Rgb c = colors[v % std::size(colors)];
    auto dark = [](uint8_t x) { return static_cast<uint8_t>(x * 11 / 20); };
    add({strf("data %g deg", view_deg[v]), {dark(c.r), dark(c.g), dark(c.b)}, {}, {}, true}, 1, [&](Dir in) {
      data->value(out, in, f);
      return f[channel];
    });
  }
  high = std::max(high, 1e-9);
  axes.y_high = std::pow(10, std::ceil(std::log10(high) + 0.02));
  axes.y_low = std::max(axes.y_high * 1e-8, std::pow(10, std::floor(std::log10(std::min(low, high)) - 0.02)));
  Canvas canvas(1500, 940);
  draw_plot(canvas, 0, 0, 1500, 940, axes, lines);
  return canvas;
}

std::string sample_csv(const sqt::Bundle& bundle, Dir out, size_t channel, size_t n, uint64_t seed) {
  std::string t =
      "# drawn directions (point away from the surface), density 1/sr, weight = w / pdf\nx,y,z,pdf,weight\n";
  const SampleStream stream(seed, 0, 0);
  for (size_t i = 0; i < n; ++i) {
    const auto u = stream.draw(static_cast<uint32_t>(i), 0);
    const auto in = bundle.sample(out, {u[0], u[1]}, u[2], channel);
    if (!in) continue;
    const double p = bundle.pdf(out, *in, channel);
    t += strf("%.12g,%.12g,%.12g,%.9g,%.9g\n", in->x, in->y, in->z, p, bundle.eval(out, *in, channel) / p);
  }
  return t;
}

Answer answer(const sqt::Bundle& bundle, Dir out, Dir in, double wavelength_um) {
  const std::vector<double>& um = bundle.info().function.wavelength_um;
  // The neighbours in wavelength on either side; channels come in any order.
  const size_t nearest = nearest_channel(bundle, wavelength_um);
  size_t other = nearest;
  for (size_t c = 0; c < um.size(); ++c)
    if ((um[c] - wavelength_um) * (um[nearest] - wavelength_um) < 0 &&
        (other == nearest || std::fabs(um[c] - wavelength_um) < std::fabs(um[other] - wavelength_um)))
      other = c;
  const double t = other == nearest ? 0 : (wavelength_um - um[nearest]) / (um[other] - um[nearest]);
  auto mix = [&](auto ask) { return ask(nearest) * (1 - t) + ask(other) * t; };
  return {mix([&](size_t c) { return bundle.value(out, in, c); }),
          mix([&](size_t c) { return bundle.eval(out, in, c); }), bundle.pdf(out, in, nearest),
          mix([&](size_t c) { return bundle.total(out, c); })};
}

Canvas draw_sphere(const sqt::Bundle& bundle, int size) {
  const size_t channel[3] = {nearest_channel(bundle, 0.65), nearest_channel(bundle, 0.55),
                             nearest_channel(bundle, 0.45)};
  const Dir sun = normalized({-0.5, 0.55, 0.75}), eye{0, 0, 1};
  const double sky = 0.25, half = one_minus_cos(2 * kDegree);
  constexpr int suns = 16;
  std::vector<Rgb> pixels(static_cast<size_t>(size) * static_cast<size_t>(size), Rgb{40, 42, 46});
  parallel_for(0, static_cast<size_t>(size), 8, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y)
      for (size_t x = 0; x < static_cast<size_t>(size); ++x) {
        const double px = (static_cast<double>(x) + 0.5) / size * 2.1 - 1.05,
                     py = 1.05 - (static_cast<double>(y) + 0.5) / size * 2.1, r2 = px * px + py * py;
        if (r2 >= 1) continue;
        const Dir n{px, py, std::sqrt(1 - r2)};
        const Frame frame = Frame::with_tangent(n, {-n.z, 0, n.x});
        const Dir out = frame.to_local(eye);
        const Frame disk = Frame::around(sun);
        double L[3] = {};
        for (int s = 0; s < suns; ++s) {
          const auto u = sobol4(static_cast<uint32_t>(s));
          const Dir in = frame.to_local(disk.to_world(uniform_cone({unit_double(u[0]), unit_double(u[1])}, half)));
          for (int c = 0; c < 3; ++c)
            if (in.z > 0) L[c] += kPi * bundle.eval(out, in, channel[c]) / suns;  // irradiance pi
        }
        uint8_t rgb[3];
        for (int c = 0; c < 3; ++c) rgb[c] = srgb(0.8 * (L[c] + sky * bundle.total(out, channel[c])));
        pixels[y * static_cast<size_t>(size) + x] = {rgb[0], rgb[1], rgb[2]};
      }
  });
  Canvas canvas(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      canvas.set(x, y, pixels[static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x)]);
  return canvas;
}

}  // namespace suite
