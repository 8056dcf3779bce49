"""Curves with their bands of uncertainty as SVG, drawn without any library."""
import html

import numpy as np

COLOURS = ["#1f5fa8", "#c8501e", "#2b8a3e", "#7048a8"]
WIDTH, HEIGHT, LEFT, BOTTOM, TOP = 720, 300, 64, 40, 30
MOST = 150  # points of a curve without a line


def ticks(low, high, count=6):
    step = 10 ** np.floor(np.log10((high - low) / count))
    step *= next(m for m in (1, 2, 5, 10) if (high - low) / (step * m) <= count)
    return np.arange(np.ceil(low / step), np.floor(high / step) + 1) * step + 0.0


def spectra(title, x_unit, y_unit, curves, points=False):
    """curves: (name, x, y, sigma or None); the band is of 2 sigma. NaN in y leaves a gap; points: no line between values."""
    if points:
        curves = [(name, *(None if v is None else v[:: 1 + len(x) // MOST] for v in (x, y, sigma))) for name, x, y, sigma in curves]
    xs = np.concatenate([c[1] for c in curves])
    bands = [(c[2] - 2 * (0 if c[3] is None else c[3]), c[2] + 2 * (0 if c[3] is None else c[3])) for c in curves]
    middle = np.concatenate([c[2] for c in curves])
    x0, x1, y0, y1 = xs.min(), xs.max(), np.nanmin(middle), np.nanmax(middle)
    y0, y1 = y0 - 0.05 * (y1 - y0), y1 + 0.12 * (y1 - y0)
    px = lambda x: LEFT + (x - x0) / (x1 - x0) * (WIDTH - LEFT - 16)
    py = lambda y: HEIGHT - BOTTOM - (np.clip(y, y0, y1) - y0) / (y1 - y0) * (HEIGHT - BOTTOM - TOP)
    path = lambda x, y: " ".join("%.1f,%.1f" % p for p in zip(px(x), py(y)))
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" font-family="sans-serif" font-size="12">' % (WIDTH, HEIGHT),
           '<rect width="%d" height="%d" fill="white"/>' % (WIDTH, HEIGHT)]
    for t in ticks(x0, x1):
        out.append('<path d="M%.1f %d V%d" stroke="#ddd"/><text x="%.1f" y="%d" text-anchor="middle">%g</text>' % (px(t), TOP, HEIGHT - BOTTOM, px(t), HEIGHT - 22, t))
    for t in ticks(y0, y1, 5):
        out.append('<path d="M%d %.1f H%d" stroke="#ddd"/><text x="%d" y="%.1f" text-anchor="end">%g</text>' % (LEFT, py(t), WIDTH - 16, LEFT - 6, py(t) + 4, t))
    for (name, x, y, sigma), band, colour in zip(curves, bands, COLOURS):
        fine = np.isfinite(y)
        if sigma is not None:
            out.append('<polygon points="%s %s" fill="%s" opacity="0.2"/>' % (path(x[fine], band[1][fine]), path(x[fine][::-1], band[0][fine][::-1]), colour))
        if points:
            out.extend('<circle cx="%.1f" cy="%.1f" r="1.6" fill="%s"/>' % (*p, colour) for p in zip(px(x[fine]), py(y[fine])))
        else:
            out.append('<polyline points="%s" fill="none" stroke="%s" stroke-width="1.2"/>' % (path(x[fine], y[fine]), colour))
    first, step = (LEFT + 330, 130) if len(curves) <= 2 else (LEFT + 200, 115)
    for k, (name, *_) in enumerate(curves):
        out.append('<text x="%d" y="%d" fill="%s">%s</text>' % (first + step * k, 20, COLOURS[k], html.escape(name)))
    out.append('<text x="%d" y="20">%s</text><text x="%d" y="%d" text-anchor="middle">%s</text>' % (LEFT, html.escape(title), (LEFT + WIDTH) // 2, HEIGHT - 6, html.escape(x_unit)))
    out.append('<text x="14" y="%d" transform="rotate(-90 14 %d)" text-anchor="middle">%s</text></svg>' % (HEIGHT // 2, HEIGHT // 2, html.escape(y_unit)))
    return "\n".join(out) + "\n"
