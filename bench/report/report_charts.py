"""What the charts of all benchmarks share: colours, type, saving, and SVG that follows the page's colours."""
import io
import os
import re
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)
from matplotlib.ticker import FuncFormatter, NullFormatter  # noqa: E402

INK, FAINT, GRID, PAPER = "#202428", "#6b7278", "#dfe2e5", "#ffffff"
ON_DARK = "#fefefe"  # words on a dark colour; not PAPER, since on a dark page these colours are light
# Okabe and Ito's colours for any kind of colour vision, without their yellow, which is lost on white paper.
# They differ in lightness too, so that a grey print can be read.
COLOURS = ["#0072b2", "#e69f00", "#009e73", "#d55e00", "#56b4e9", "#cc79a7", "#8c8c8c"]
DARK = ["#5aaee6", "#f0b429", "#2fc79b", "#f0824a", "#8fd0f5", "#e3a3c8", "#9a9a9a"]  # the same on a dark page
MARKERS = ["o", "s", "D", "^", "v", "P", "X"]
WIDTH = 7.2  # inches; an A4 page between its margins

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 8.5, "axes.titlesize": 9.5, "axes.titleweight": "bold", "axes.titlelocation": "left",
    "text.color": INK, "axes.labelcolor": INK, "axes.edgecolor": FAINT, "xtick.color": INK, "ytick.color": INK,
    "axes.linewidth": 0.7, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "axes.axisbelow": True,
    "grid.color": GRID, "grid.linewidth": 0.6, "xtick.major.width": 0.7, "ytick.major.width": 0.7,
    "xtick.minor.size": 0, "ytick.minor.size": 0, "lines.linewidth": 1.6, "lines.markersize": 4.8, "legend.frameon": False,
    "figure.facecolor": PAPER, "axes.facecolor": PAPER, "svg.hashsalt": "pliant", "svg.fonttype": "path", "savefig.dpi": 160,
})


def count(n):
    """1 296, 105 456: thin spaces, as in the tables."""
    return f"{n:,.0f}".replace(",", "\u2009")


def number(value, digits=3):
    """`digits` significant digits, never an exponent."""
    if value == 0:
        return "0"
    text = f"{value:.{digits}g}"
    if "e" not in text:
        return count(float(text)) if abs(value) >= 10000 else text
    return count(float(text)) if abs(value) >= 1 else f"{float(text):.10f}".rstrip("0")


def short(n):
    """Sizes on an axis: 1.3 k, 105 k, 1 M."""
    for unit, name in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if n >= 0.9995 * unit:
            return f"{n / unit:.3g}\u2009{name}"
    return f"{n:.0f}"


def log_axis(axis, label=short):
    axis.set_major_formatter(FuncFormatter(lambda value, _: label(value)))
    axis.set_minor_formatter(NullFormatter())


def panels(names, height, sharex=True, sharey=True):
    """One panel per name, two in a row, and the figure; a fourth place that is not needed stays empty."""
    columns = min(2, len(names))
    rows = -(-len(names) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(WIDTH, height * rows + 0.55), sharex=sharex, sharey=sharey, squeeze=False)
    flat = list(axes.flat)
    for axes_left in flat[len(names):]:
        axes_left.set_visible(False)
    for axes_of, name in zip(flat, names):
        axes_of.set_title(name)
    if len(names) > columns and len(names) % columns and sharex:
        flat[len(names) - columns].tick_params(labelbottom=True)
    return figure, flat[:len(names)]


def legend_above(figure, handles, columns=None):
    """Room for the legend is kept free above the panels."""
    columns = columns or len(handles)
    rows = -(-len(handles) // columns)
    height = figure.get_size_inches()[1]
    figure.legend(handles=handles, loc="upper left", ncol=columns, bbox_to_anchor=(0.005, 1), columnspacing=1.6, handlelength=2.2)
    figure.tight_layout(rect=(0, 0, 1, 1 - (0.14 + 0.19 * rows) / height), w_pad=1.4, h_pad=1.2)


def write_whole(path, data):
    """Under its own name only when it is complete."""
    path = Path(path)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(data)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def save(figure, folder, stem):
    """Writes stem.svg and stem.png; returns the SVG for the page."""
    svg, png = io.BytesIO(), io.BytesIO()
    figure.savefig(svg, format="svg", metadata={"Date": None, "Creator": None})
    figure.savefig(png, format="png")
    plt.close(figure)
    write_whole(Path(folder) / f"{stem}.svg", svg.getvalue())
    write_whole(Path(folder) / f"{stem}.png", png.getvalue())
    return inline(svg.getvalue().decode(), stem)


def inline(svg, stem):
    """An SVG inside a page: ids of its own, colours that the page may change, no size but its proportions."""
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r"<metadata>.*?</metadata>\s*", "", svg, flags=re.S)
    svg = re.sub(r'\bid="([^"]+)"', rf'id="{stem}-\1"', svg)
    svg = re.sub(r"url\(#([^)]+)\)", rf"url(#{stem}-\1)", svg)
    svg = re.sub(r'href="#([^"]+)"', rf'href="#{stem}-\1"', svg)
    svg = re.sub(r'<svg ([^>]*?)width="[^"]*"', r"<svg \1", svg, count=1)
    svg = re.sub(r'(<svg [^>]*?)height="[^"]*"', r"\1", svg, count=1)
    for colour, name in colour_names().items():
        svg = svg.replace(colour, f"var(--{name})")
    return svg


def colour_names():
    names = {INK: "ink", FAINT: "faint", GRID: "grid", PAPER: "paper", ON_DARK: "on"}
    names.update({colour: f"c{i}" for i, colour in enumerate(COLOURS)})
    return names
