"""`pliant bench accuracy`: speed against error of every method, its fronts, orders of convergence and locking."""
import math

from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D
from matplotlib.ticker import NullLocator

import report_charts as charts
from report_charts import COLOURS, FAINT, GRID, INK, PAPER, count, number, short
from report_page import Column, Section, figure, heading, machine_facts, notice, paragraph, table, text

# One colour per family; within shape matching and the hybrids the marker tells them apart.
LOOKS = {
    "tet4": (COLOURS[3], "^"), "tet4anp": (COLOURS[1], "v"), "hex8": (COLOURS[0], "s"), "hex8full": (COLOURS[2], "D"),
    "flsm-1": (COLOURS[5], "P"), "flsm-2": (COLOURS[5], "X"), "flsm-3": (COLOURS[5], "*"),
    "hybrid-25": (COLOURS[4], "<"), "hybrid-50": (COLOURS[4], "o"), "hybrid-75": (COLOURS[4], ">"),
}
WORDS = {
    "tet4": "linear tetrahedra", "tet4anp": "tetrahedra with averaged nodal pressure", "hex8": "hexahedra with one point",
    "hex8full": "hexahedra with eight points", "flsm-1": "shape matching, half-width 1", "flsm-2": "shape matching, half-width 2",
    "flsm-3": "shape matching, half-width 3", "hybrid-25": "hybrid, 25 % of the nodes in hex8",
    "hybrid-50": "hybrid, 50 % of the nodes in hex8", "hybrid-75": "hybrid, 75 % of the nodes in hex8",
}
TOLERANCES = [0.1, 0.03, 0.01, 0.003]
NOISY = 0.15
TOP = 1.0  # an error of 100 % is what a body that does not move at all would have
COST = "ms_per_simulated_second"


def percent(value, digits=2):
    return "0" if value == 0 else number(100 * value, digits)


def answered(row):
    return row["failure"] is None and row["error_l2"] is not None


class Result:
    """The rows of one run, by problem and method."""

    def __init__(self, result):
        self.machine, self.rows, self.problems = result["machine"], result["rows"], result["problems"]
        self.findings, self.quick = result["findings"], result.get("quick", False)
        self.methods = [f["method"] for f in self.findings]
        self.main = self.rows[0]["backend"]

    def of(self, problem, **same):
        return [r for r in self.rows if r["problem"] == problem["name"] and all(r[k] == v for k, v in same.items())]

    def front(self, problem):
        return sorted((r for r in self.of(problem) if r["pareto"]), key=lambda r: r[COST])

    def series(self, problem, method, step="0.9"):
        """One method from coarse to fine on the main backend."""
        rows = [r for r in self.of(problem, method=method, step=step, backend=self.main) if answered(r)]
        return sorted(rows, key=lambda r: r["resolution"])

    def shown_methods(self, problem):
        return [m for m in self.methods if any(answered(r) and r["error_l2"] < TOP for r in self.of(problem, method=m))]

    def cheapest(self, problem, tolerance):
        good = [r for r in self.of(problem) if answered(r) and max(r["error_l2"], problem["floor"]) <= tolerance]
        return min(good, key=lambda r: r[COST]) if good else None

    def excess(self, problem, method):
        """The least factor by which a point of the method is slower than the front at the same error; 1: on the front."""
        front = self.front(problem)
        factors = []
        for row in self.of(problem, method=method):
            if not answered(row) or row["error_l2"] >= TOP:
                continue
            error = max(row["error_l2"], problem["floor"])
            times = [f[COST] for f in front if max(f["error_l2"], problem["floor"]) <= error]
            if times:
                factors.append(row[COST] / min(times))
        return min(factors) if factors else None


def look(method):
    colour, marker = LOOKS.get(method, (COLOURS[6], "."))
    return {"color": colour, "marker": marker, "markersize": 7 if marker == "*" else 5, "markeredgewidth": 0.6}


def handle(method):
    return Line2D([], [], linestyle="none", markeredgecolor=PAPER, label=method, **look(method))


# --- one problem ---------------------------------------------------------------------------------------------------------------

def height(problem, row):
    """Far below what the reference is good for, all errors stand on one line."""
    return max(row["error_l2"], problem["floor"] / 5)


def error_axis(axes, problem, rows):
    errors = [height(problem, r) for r in rows]
    low, high = min(errors + [problem["floor"]]), min(max(errors), TOP)
    axes.set_yscale("log")
    axes.set_ylim(low / 2, high * 1.8)
    axes.yaxis.set_major_formatter(lambda v, _: f"{percent(v)}\u2009%")
    axes.yaxis.set_minor_locator(NullLocator())
    if high / low < 30:
        ticks = [s * 10.0 ** e for e in range(-7, 2) for s in (1, 2, 5) if low / 2 <= s * 10.0 ** e <= high * 1.8]
        axes.set_yticks(ticks)
    axes.axhspan(low / 4, problem["floor"], color=GRID, alpha=0.75, linewidth=0, zorder=0)


def speed_panel(result, problem, axes, rows):
    axes.set_xscale("log")
    error_axis(axes, problem, rows)
    for method in result.shown_methods(problem):
        line = [r for r in result.series(problem, method) if r["error_l2"] < TOP]
        style = look(method)
        axes.plot([r[COST] for r in line], [height(problem, r) for r in line], color=style["color"], linewidth=0.8, alpha=0.55, zorder=2)
        for row in (r for r in rows if r["method"] == method):
            hollow = row["precision"] == "double"
            axes.plot(row[COST], height(problem, row), linestyle="none", zorder=4 if row["pareto"] else 3,
                      **{**style, "markerfacecolor": PAPER if hollow else style["color"],
                         "markeredgecolor": style["color"] if hollow else PAPER, "markeredgewidth": 1.0 if hollow else 0.6})
    front = result.front(problem)
    if front:
        x, y = [], []
        for i, row in enumerate(front):  # a staircase: nothing measured is below and left of it
            error = max(row["error_l2"], problem["floor"])
            if i:
                x.append(row[COST])
                y.append(y[-1])
            x.append(row[COST])
            y.append(error)
        x.append(max(r[COST] for r in rows) * 1.5)
        y.append(y[-1])
        axes.plot(x, y, color=INK, linewidth=1.1, zorder=1.8)
    low, high = min(r[COST] for r in rows), max(r[COST] for r in rows)
    axes.set_xlim(low / 1.6, high * 1.6)
    if high * 1.6 > 1000:
        axes.axvline(1000, color=FAINT, linewidth=0.9, linestyle=(0, (1, 2)))
        axes.text(1000 / 1.06, axes.get_ylim()[1] / 1.1, "real time", rotation=90, va="top", ha="right", fontsize=6.8, color=FAINT)
    charts.log_axis(axes.xaxis, lambda v: number(v) if v < 1000 else short(v))
    axes.set_title("Speed against error")
    axes.set_xlabel("ms of computing per simulated second")
    axes.set_ylabel("relative L2 error")


def order_guides(axes, resolutions):
    """Dotted slopes of first and second order in the lower left corner, where errors seldom are."""
    if len(resolutions) < 2:
        return
    (_, _), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    start, end = resolutions[0], resolutions[0] * min(2, resolutions[1] / resolutions[0])
    y0 = min(1.12 * bottom * (end / start) ** 2, top)
    for order in (1, 2):
        y1 = y0 * (start / end) ** order
        axes.plot([start, end], [y0, y1], color=FAINT, linewidth=0.9, linestyle=(0, (1, 2)), zorder=1)
        axes.annotate(f"order {order}", (end, y1), xytext=(3, 0), textcoords="offset points", ha="left", va="center", fontsize=6.8,
                      color=FAINT)


def resolution_panel(result, problem, axes, rows):
    axes.set_xscale("log")
    error_axis(axes, problem, rows)
    resolutions = sorted({r["resolution"] for r in rows})
    axes.set_xlim(resolutions[0] / 1.3, resolutions[-1] * 1.3)
    for method in result.shown_methods(problem):
        line = [r for r in result.series(problem, method) if r["error_l2"] < TOP]
        axes.plot([r["resolution"] for r in line], [height(problem, r) for r in line], markeredgecolor=PAPER, linewidth=1.3, zorder=3,
                  **look(method))
    order_guides(axes, resolutions)
    axes.xaxis.set_major_locator(NullLocator())
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticks(resolutions, [str(r) for r in resolutions])
    axes.set_title("Error against resolution")
    axes.set_xlabel(f"cells along {number(1000 * problem['characteristic'])} mm")


def problem_chart(result, problem, folder):
    rows = [r for r in result.of(problem) if answered(r) and r["error_l2"] < TOP]
    fig, panels = charts.panels(["speed", "resolution"], 2.75, sharex=False, sharey=True)
    speed_panel(result, problem, panels[0], rows)
    resolution_panel(result, problem, panels[1], rows)
    handles = [handle(m) for m in result.shown_methods(problem)]
    if any(r["precision"] == "double" for r in rows):
        handles.append(Line2D([], [], linestyle="none", marker="o", markersize=5, color=FAINT, markerfacecolor=PAPER, label="double (hollow)"))
    handles.append(Line2D([], [], color=INK, linewidth=1.1, label="the front"))
    charts.legend_above(fig, handles, -(-len(handles) // 2))
    return charts.save(fig, folder, f"accuracy_{problem['name'].replace('.', '_')}")


def sentence(result, problem):
    """What to read from the charts of a problem, from its rows."""
    parts = []
    for tolerance in (0.1, 0.01):
        row = result.cheapest(problem, tolerance)
        if row:
            parts.append(f"The cheapest answer within {percent(tolerance)}&#8239;% is {text(row['method'])} at resolution {row['resolution']} "
                         f"({percent(row['error_l2'])}&#8239;% for {number(row[COST])}&#8239;ms per simulated second).")
        else:
            best = min((r for r in result.of(problem) if answered(r)), key=lambda r: r["error_l2"], default=None)
            if best:
                parts.append(f"Nothing measured is within {percent(tolerance)}&#8239;%; the best is {text(best['method'])} with "
                             f"{percent(best['error_l2'])}&#8239;%.")
            break
    orders = {m: result.series(problem, m)[-1]["order"] for m in result.methods if result.series(problem, m)}
    known = [f"{text(m)} {number(o, 2)}" for m, o in orders.items() if o is not None and m in ("tet4", "tet4anp", "hex8", "hex8full")]
    if known:
        parts.append("Order of convergence between the two finest bodies: " + ", ".join(known) + ".")
    lost = [r for r in result.of(problem) if not answered(r)]
    off = [r for r in result.of(problem) if answered(r) and r["error_l2"] >= TOP]
    for rows, words in ((off, "is wrong by 100&#8239;% or more and not drawn"), (lost, "has no answer")):
        if rows:
            names = ", ".join(dict.fromkeys(text(r["method"]) for r in rows))
            parts.append(f"Some of {names} ({len(rows)} point{'s' if len(rows) > 1 else ''}) {words}.")
    return " ".join(parts)


# --- all problems --------------------------------------------------------------------------------------------------------------

def overview_chart(result, folder):
    """How much slower than the best each method is, problem by problem."""
    shade = LinearSegmentedColormap.from_list("cost", ["#08519c", "#4a90c8", "#a9cfe6", "#eef5fa"])
    names, methods = [p["title"] for p in result.problems], result.methods
    fig, axes = charts.plt.subplots(figsize=(charts.WIDTH, 0.95 + 0.265 * len(names)))
    for i, problem in enumerate(result.problems):
        for j, method in enumerate(methods):
            value = result.excess(problem, method)
            colour = PAPER if value is None else shade(min(1.0, math.log(max(value, 1)) / math.log(30)))
            axes.add_patch(charts.plt.Rectangle((j - 0.5, i - 0.5), 1, 1, facecolor=colour, edgecolor=PAPER, linewidth=1.5))
            dark = value is not None and value < 2.6
            words = "–" if value is None else "front" if value <= 1.0001 else f"{number(value, 2)}×"
            axes.text(j, i, words, ha="center", va="center", fontsize=7.2, fontweight="bold" if words == "front" else "normal",
                      color=charts.ON_DARK if dark else "#202429")
    axes.set_xlim(-0.5, len(methods) - 0.5)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_xticks(range(len(methods)), [m.replace("hybrid-", "hybrid\n") for m in methods])
    axes.set_yticks(range(len(names)), names)
    axes.tick_params(length=0, labeltop=True, labelbottom=False)
    axes.grid(False)
    for side in axes.spines.values():
        side.set_visible(False)
    fig.tight_layout()
    return charts.save(fig, folder, "accuracy_overview")


def cantilevers(result):
    return sorted((p for p in result.problems if p["name"].startswith("cantilever-")), key=lambda p: p["poisson"])


def locking_chart(result, folder):
    group = cantilevers(result)
    refines = sorted({r["refine"] for p in group for r in result.of(p)})[-2:]
    where = {r: result.of(group[0], refine=r)[0]["resolution"] for r in refines}
    fig, panels = charts.panels([f"{where[r]} cells through the height" for r in refines], 2.7)
    methods = [m for m in result.methods if result.shown_methods(group[0]) and any(m in result.shown_methods(p) for p in group)]
    for axes, refine in zip(panels, refines):
        axes.set_yscale("log")
        for method in methods:
            points = [(i, r) for i, p in enumerate(group) for r in result.series(p, method) if r["refine"] == refine and r["error_l2"] < TOP]
            axes.plot([i for i, _ in points], [r["error_l2"] for _, r in points], markeredgecolor=PAPER, linewidth=1.3, **look(method))
        axes.fill_between(range(len(group)), [p["floor"] for p in group], 1e-9, color=GRID, alpha=0.75, linewidth=0, zorder=0)
        axes.set_xticks(range(len(group)), [number(p["poisson"]) for p in group])
        axes.set_xlabel("Poisson's ratio")
        axes.yaxis.set_major_formatter(lambda v, _: f"{percent(v)}\u2009%")
        axes.yaxis.set_minor_locator(NullLocator())
    errors = [r["error_l2"] for p in group for m in methods for r in result.series(p, m) if r["error_l2"] < TOP and r["refine"] in refines]
    panels[0].set_ylim(min(errors + [p["floor"] for p in group]) / 1.6, max(errors) * 1.6)
    panels[0].set_ylabel("relative L2 error")
    charts.legend_above(fig, [handle(m) for m in methods], -(-len(methods) // 2))
    return charts.save(fig, folder, "accuracy_locking")


def locking_sentence(result):
    group = cantilevers(result)
    low, high = group[0], group[-1]
    grown = []
    for method in result.methods:
        a, b = result.series(low, method), result.series(high, method)
        if a and b and a[-1]["refine"] == b[-1]["refine"]:
            grown.append((b[-1]["error_l2"] / a[-1]["error_l2"], method))
    elements = sorted((g for g in grown if g[1] in ("tet4", "tet4anp", "hex8", "hex8full")), reverse=True)
    words = ", ".join(f"{text(m)} {number(f, 2)} times" for f, m in elements)
    return (f"A line that rises to the right locks: its elements become too stiff as the material becomes incompressible. From nu = "
            f"{number(low['poisson'])} to {number(high['poisson'])}, at the finest resolution, the error grows by: {words}. Shape matching has "
            "no Poisson's ratio of its own, so its error changes only because the right answer does.")


def picks(result):
    rows = []
    for problem in result.problems:
        row = {"title": problem["title"]}
        for tolerance in TOLERANCES:
            best = result.cheapest(problem, tolerance)
            row[str(tolerance)] = None if best is None else best
        rows.append(row)
    def show(r):
        return f"{text(r['method'])} {r['resolution']}<span class=unit>{number(r[COST])} ms/s, {percent(r['error_l2'])} %</span>"
    columns = [Column("title", "problem", show=text, number=False)]
    columns += [Column(str(t), f"within {percent(t)} %", show=show, number=False) for t in TOLERANCES]
    return table(columns, rows)


# --- page ----------------------------------------------------------------------------------------------------------------------

def finding(result, found):
    titles = {p["name"]: p["title"] for p in result.problems}
    name = text(found["method"])
    if found["on_front"]:
        return f"<b>{name}</b> ({text(WORDS.get(found['method'], ''))}): on the front of {text(', '.join(titles[p] for p in found['on_front']))}."
    values = [(v, p["title"]) for p in result.problems if (v := result.excess(p, found["method"])) is not None]
    nearest = f" It comes nearest in {text(min(values)[1])}, at {number(min(values)[0], 2)} times the time." if values else ""
    return (f"<b>{name}</b> ({text(WORDS.get(found['method'], ''))}): never on a front. For every one of its points another one is at least as "
            f"fast and as accurate.{nearest}")


def remarks(result):
    parts = []
    if result.quick:
        parts.append(notice("This is the quick form: coarse bodies, coarse references, short timing. Read the shape of it, not the figures.", bad=True))
    noisy = [r for r in result.rows if r["spread"] is not None and r["spread"] > NOISY]
    if noisy:
        many = len(noisy) > len(result.rows) / 5
        parts.append(notice(f"The times of {len(noisy)} of {len(result.rows)} points spread by more than {100 * NOISY:.0f}&#8239;% between their "
                            f"quartiles{': the machine was not quiet' if many else '; the table of all points shows which'}. Errors do not "
                            "depend on it.", bad=many))
    lost = [r for r in result.rows if not answered(r)]
    if lost:
        parts.append(notice(f"{len(lost)} of {len(result.rows)} points have no answer: the body did not come to rest or a step failed. "
                            "The table of all points gives the reason."))
    return parts


def all_rows(result):
    def small(v):
        return "yes" if v else ""
    columns = [
        Column("problem", "problem", show=text, number=False), Column("method", "method", show=text, number=False),
        Column("resolution", "cells", show=str, note="along the problem's characteristic length"), Column("nodes", "nodes", show=count),
        Column("step", "step", show=text, number=False, note="share of the stable step, or 1/60 s"),
        Column("dt", "dt", "ms", lambda v: number(1e3 * v)), Column("backend", "backend", show=text, number=False),
        Column("seconds", "to rest", "s", number), Column(COST, "per simulated s", "ms", number),
        Column("ns_per_node_step", "node step", "ns", number), Column("spread", "spread", "%", lambda v: f"{100 * v:.0f}"),
        Column("error_l2", "error L2", "%", lambda v: percent(v, 3)), Column("error_max", "error max", "%", lambda v: percent(v, 3)),
        Column("order", "order", show=lambda v: f"{v:.2f}"), Column("pareto", "front", show=small, number=False),
        Column("failure", "why no answer", show=text, number=False),
    ]
    return table(columns, result.rows, sortable=True, strong=lambda r: r["pareto"])


def references(result):
    rows = [{**p, "error": p["reference_error"] or None, "taken": p["reference_seconds"] if p["reference_nodes"] else None}
            for p in result.problems]
    columns = [
        Column("title", "problem", show=text, number=False), Column("reference", "compared with", show=text, number=False),
        Column("error", "its own error", "%", percent, note="exact answers: as answers to the three-dimensional problem"),
        Column("samples", "points", show=count), Column("taken", "time", "s", number),
    ]
    return table(columns, rows)


METHOD = [
    "A body is loaded smoothly and brought to rest by mass damping that is critical for its slowest mode; it is at rest when "
    "what is still missing, judged by the rate at which the motion fades, is below 10<sup>-5</sup> of the largest displacement. Loads on faces "
    "become consistent node forces. Boxes and the liver are lattices for every method; Cook's membrane is a conforming mesh for finite "
    "elements and a lattice for shape matching and hybrids.",
    "Errors compare displacements at fixed points inside the body (on the surface of the liver), which belong to no mesh, by interpolation in the "
    "elements: the L2 error is the root of the summed squares over that of the reference, the maximum is relative to the largest displacement. They "
    "repeat to the bit. The order of convergence is the slope of the L2 error between a resolution and the next coarser one; it is left out "
    "where the error is less than twice what the reference is good for.",
    "The time of a step is the median of seven batches at the state of rest, the automatic step's estimates included; the spread is "
    "the distance of the quartiles over the median. <b>ms per simulated second</b> is that time over the step length: below 1000 a "
    "body keeps up with real time. <b>To rest</b> is that time by the steps that it took. Building the model is not counted.",
    "A point is on the front when no other point of the problem is at least as fast and as accurate. Errors below what the reference is "
    "good for (the grey band) count as equal, and errors of 100&#8239;% or more, which a body that does not move at all would "
    "have, never count.",
    "Steps: 0.9 and 0.45 are shares of the stable step of finite elements and hybrids, and for shape matching of the largest step at which "
    "it can have the material's stiffness (<code>\"stiffness\": {\"young\": E}</code>). 1/60&#8239;s is the step of a screen, "
    "where shape matching is as stiff as its lattice allows and no stiffer.",
]


def section(result, folder):
    r = Result(result)
    parts = [
        paragraph("What a method costs and how far its answer is from the right one, on problems whose answers are exact or converged. Commands: "
                  "<code>pliant bench accuracy --out DIR</code>, then <code>python3 bench/report/report.py DIR</code>."),
        *remarks(r),
        heading("Which method, at a glance"),
        figure(overview_chart(r, folder), "Factor by which each method is slower than the best, per problem",
               "Each cell: how many times slower the method's best point is than the fastest point of equal or smaller error. "
               "<b>front</b> means that nothing measured beats it. A dash: no answer with an error below 100&#8239;%."),
        heading("The cheapest answer within a tolerance"), picks(r),
        paragraph("Method, resolution, computing time per simulated second, and the error it has. An empty cell: nothing measured is that good, or "
                  "the reference is not."),
        "<ul>" + "".join(f"<li>{finding(r, f)}</li>" for f in r.findings) + "</ul>",
    ]
    if len(cantilevers(r)) > 1:
        parts += [heading("Locking"), figure(locking_chart(r, folder), "Error of the cantilever against Poisson's ratio", locking_sentence(r))]
    for problem in r.problems:
        parts += [heading(problem["title"]), paragraph(text(problem["lead"]), f"Reference: {text(problem['reference'])}.")]
        if any(answered(row) and row["error_l2"] < TOP for row in r.of(problem)):
            parts.append(figure(problem_chart(r, problem, folder), f"Speed against error and error against resolution: {problem['title']}",
                                sentence(r, problem)))
    parts += [heading("What it is compared with"), references(r), heading("How it was measured"), *[paragraph(p) for p in METHOD],
              machine_facts(r.machine), heading("All points"),
              paragraph("A heading sorts by its column. Bold points are on the front of their problem."), all_rows(r)]
    return Section("Speed against accuracy", "accuracy", parts)
