"""`pliant bench kernels`: what a step costs by element, backend and size, how it splits into passes, how far it is from the limit."""
import math

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import report_charts as charts
from report_charts import COLOURS, FAINT, INK, MARKERS, PAPER, count, number, short
from report_page import Column, Section, figure, heading, machine_facts, notice, paragraph, table, text

ELEMENTS = {"tet4": "tet4: linear tetrahedron", "tet4anp": "tet4anp: tetrahedron, nodal pressure",
            "hex8": "hex8: brick, one point", "hex8full": "hex8full: brick, eight points",
            "springs": "springs along the edges of tetrahedra", "membrane": "triangles of a membrane on a sheet of springs"}
# Passes that do the same for different elements share a colour, by the end of their kernel's name.
ROLES = [("_force", "element forces"), ("_update", "node update"), ("_dilation", "element volumes"), ("_pressure", "nodal pressure"),
         ("_prescribe", "prescribed nodes"), ("_node", "springs at nodes"), ("link_gather", "sums of links at nodes"), ("link_points", "points of links")]
NOISY = 0.10


def backend_name(name):
    if name == "cpu":
        return "C++ twin, float (cpu)"
    if name == "cpu:double":
        return "C++ twin, double (cpu:double)"
    return f"OpenCL ({name})" if name.startswith("opencl") else name


class Result:
    """The rows of one run, by what they are."""

    def __init__(self, result):
        self.machine, self.rows = result["machine"], result["rows"]
        self.steps = [r for r in self.rows if r["kernel"] == "step"]
        self.elements = list(dict.fromkeys(r["element"] for r in self.rows))
        backends = list(dict.fromkeys(r["backend"] for r in self.rows))
        self.backends = sorted(backends, key=lambda b: (not b.startswith("opencl"), b))  # the device first, then its twins
        self.main = self.backends[0]
        self.sizes = sorted({r["elements"] for r in self.steps})

    def line(self, element, backend):
        chosen = [r for r in self.steps if r["element"] == element and r["backend"] == backend]
        return sorted(chosen, key=lambda r: r["elements"])

    def passes(self, step):
        return [r for r in self.rows if r["kernel"] != "step" and all(r[k] == step[k] for k in ("element", "backend", "elements"))]

    def look(self, backend):
        i = self.backends.index(backend)
        return {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)]}

    def titles(self):
        return [ELEMENTS.get(e, e) for e in self.elements]

    def twins(self):
        """Steps that must have the same bits: one list per element and size, of the backends that are bit-exact here."""
        exact = {b["name"] for b in self.machine.get("backends", []) if b.get("bit_exact")}
        groups = {}
        for row in self.steps:
            if row["backend"] in exact:
                groups.setdefault((row["element"], row["elements"]), []).append(row)
        return {k: v for k, v in groups.items() if len(v) > 1}


def bound_by(row):
    memory = row["bytes_per_element"] / row["triad_bytes_per_second"]
    return "memory" if memory >= row["flops_per_element"] / row["fma_flops_per_second"] else "arithmetic"


def size_axis(result, axes):
    low, high = result.sizes[0], result.sizes[-1]
    axes.set_xscale("log")
    axes.set_xlim(low / 1.9, high * 1.9)
    if len(result.sizes) <= 6:
        rounded = list(dict.fromkeys(float(f"{s:.0e}") for s in result.sizes))
        axes.set_xticks(rounded)
    charts.log_axis(axes.xaxis)


def x_labels(result, panels):
    for axes in panels[-min(2, len(panels)):]:
        axes.set_xlabel("elements")


# --- time ----------------------------------------------------------------------------------------------------------------------

def times_of_a_step(axes):
    """Thin diagonals: along each, a whole step takes the same time. Needs the final layout, for the slope of the words."""
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    (x0, y0), (x1, y1) = axes.transData.transform([(left, bottom), (left * 10, bottom * 10)])
    slope = -math.degrees(math.atan2(y1 - y0, x1 - x0))
    for ms, words in ((0.01, "10 µs"), (0.1, "0.1 ms"), (1, "1 ms"), (10, "10 ms"), (100, "0.1 s"), (1000, "1 s")):
        total = ms * 1e6  # ns
        start, end = max(left, total / top), min(right, total / bottom)  # where the line enters the panel and leaves it
        if end < 3 * start:
            continue
        axes.plot([start, end], [total / start, total / end], color=FAINT, linewidth=0.7, linestyle=(0, (1, 2)), zorder=1)
        axes.text(start * 1.18, total / start / 1.18, words, color=FAINT, fontsize=6.8, rotation=slope, rotation_mode="anchor",
                  va="bottom", zorder=1.5)


def step_chart(result, folder):
    fig, panels = charts.panels(result.titles(), 2.35)
    values = [r["ns_per_element_step"] for r in result.steps]
    values += [r["ns_per_element_step"] * r["fraction_of_limit"] for r in result.steps if r["backend"] == result.main]
    for axes, element in zip(panels, result.elements):
        size_axis(result, axes)
        axes.set_yscale("log")
        axes.set_ylim(min(values) / 1.6, max(values) * 1.6)
        charts.log_axis(axes.yaxis, number)
        for backend in result.backends:
            line = result.line(element, backend)
            x, y = [r["elements"] for r in line], [r["ns_per_element_step"] for r in line]
            # The quartiles are about half the spread away on either side; the lower one stays above zero.
            below = [min(v * r["spread"] / 2, 0.9 * v) for v, r in zip(y, line)]
            above = [v * r["spread"] / 2 for v, r in zip(y, line)]
            look = result.look(backend)
            axes.errorbar(x, y, yerr=[below, above], elinewidth=0.9, ecolor=look["color"], markeredgecolor=PAPER, markeredgewidth=0.6,
                          zorder=3 + (backend == result.main), **look)
            if backend == result.main:
                axes.plot(x, [r["ns_per_element_step"] * r["fraction_of_limit"] for r in line], color=look["color"], linestyle="--",
                          linewidth=1.1, zorder=2)
    x_labels(result, panels)
    for axes in panels[::2]:
        axes.set_ylabel("ns per element and step")
    handles = [Line2D([], [], markeredgecolor=PAPER, label=backend_name(b), **result.look(b)) for b in result.backends]
    handles.append(Line2D([], [], color=result.look(result.main)["color"], linestyle="--", linewidth=1.1,
                          label=f"the machine's limit for {result.main}"))
    handles.append(Line2D([], [], color=FAINT, linestyle=(0, (1, 2)), linewidth=0.9, label="same time for the whole step"))
    charts.legend_above(fig, handles, 3)
    for axes in panels:
        times_of_a_step(axes)
    return charts.save(fig, folder, "kernels_step")


# --- split ---------------------------------------------------------------------------------------------------------------------

def role(kernel):
    return next((words for end, words in ROLES if kernel.endswith(end)), kernel)


def readable_on(colour):
    r, g, b = (int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5))
    return "#000000" if 0.3 * r + 0.59 * g + 0.11 * b > 0.5 else charts.ON_DARK


def split_chart(result, folder):
    kernels = list(dict.fromkeys(r["kernel"] for r in result.rows if r["kernel"] != "step"))
    roles = list(dict.fromkeys(role(k) for k in kernels))
    order = [words for _, words in ROLES]
    roles.sort(key=lambda r: order.index(r) if r in order else len(order))
    colour = {r: COLOURS[i % len(COLOURS)] for i, r in enumerate(roles)}
    deepest = max(len(result.line(e, result.main)) for e in result.elements)
    fig, panels = charts.panels(result.titles(), 0.75 + 0.32 * deepest, sharex=False, sharey=False)
    for axes, element in zip(panels, result.elements):
        steps = result.line(element, result.main)
        longest = max(max(s["ns_per_element_step"], sum(p["ns_per_element_step"] for p in result.passes(s))) for s in steps)
        for i, step in enumerate(steps):
            left, whole = 0.0, sum(p["ns_per_element_step"] for p in result.passes(step))
            for row in result.passes(step):
                ns, c = row["ns_per_element_step"], colour[role(row["kernel"])]
                axes.barh(i, ns, left=left, height=0.62, color=c, edgecolor=PAPER, linewidth=0.6)
                if ns > 0.09 * longest:
                    axes.text(left + ns / 2, i, f"{100 * ns / whole:.0f}%", ha="center", va="center", fontsize=7, color=readable_on(c))
                left += ns
            for end in (-1, 1):  # beside the bar, so that it hides no share
                axes.plot([step["ns_per_element_step"]] * 2, [i + 0.31 * end, i + 0.47 * end], color=INK, linewidth=1.8,
                          solid_capstyle="butt")
        axes.set_yticks(range(len(steps)), [short(s["elements"]) for s in steps])
        axes.set_ylim(len(steps) - 0.45, -0.55)
        axes.set_xlim(0, 1.06 * longest)
        axes.grid(False, axis="y")
        axes.tick_params(axis="y", length=0)
    for axes in panels[::2]:
        axes.set_ylabel("elements")
    for axes in panels[-min(2, len(panels)):]:
        axes.set_xlabel("ns per element and step")
    handles = [Patch(color=colour[r], label=r) for r in roles]
    handles.append(Line2D([], [], color=INK, linewidth=1.8, marker="|", linestyle="none", markersize=9, markeredgewidth=1.8,
                          label="whole step, timed at once"))
    charts.legend_above(fig, handles, 3)
    return charts.save(fig, folder, "kernels_split")


# --- limit ---------------------------------------------------------------------------------------------------------------------

def limit_chart(result, folder):
    fig, panels = charts.panels(result.titles(), 2.0)
    highest = max(100 * r["fraction_of_limit"] for r in result.steps)
    top = min(max(112, 1.08 * highest), 160)
    for axes, element in zip(panels, result.elements):
        size_axis(result, axes)
        axes.set_ylim(0, top)
        axes.set_yticks([0, 25, 50, 75, 100] + ([125, 150] if top > 130 else []))
        axes.yaxis.set_major_formatter(lambda v, _: f"{v:.0f}\u2009%")
        axes.axhline(100, color=INK, linewidth=1.1)
        for backend in result.backends:
            line, look = result.line(element, backend), result.look(backend)
            x, y = [r["elements"] for r in line], [100 * r["fraction_of_limit"] for r in line]
            axes.plot(x, [min(v, top * 1.2) for v in y], color=look["color"], zorder=3)
            for r, v in zip(line, y):
                inside = v <= top
                filled = look["color"] if bound_by(r) == "memory" else PAPER
                axes.plot(r["elements"], min(v, 0.97 * top), marker=look["marker"] if inside else "$\\uparrow$", color=look["color"],
                          markerfacecolor=filled if inside else look["color"], markeredgewidth=1.2 if inside else 0.4,
                          markersize=4.8 if inside else 8, zorder=4, clip_on=False)
    x_labels(result, panels)
    for axes in panels[::2]:
        axes.set_ylabel("share of the limit")
    handles = [Line2D([], [], label=backend_name(b), **result.look(b)) for b in result.backends]
    dot = {"marker": "o", "color": FAINT, "linestyle": "none", "markeredgewidth": 1.2}
    handles += [Line2D([], [], label="limit set by memory", **dot),
                Line2D([], [], label="limit set by arithmetic", markerfacecolor=PAPER, **dot),
                Line2D([], [], color=INK, linewidth=1.1, label="the machine's limit")]
    charts.legend_above(fig, handles, 3)
    return charts.save(fig, folder, "kernels_limit")


# --- page ----------------------------------------------------------------------------------------------------------------------

def headline(result):
    """The largest size of every element: the figures that are quoted."""
    rows = []
    for element in result.elements:
        for backend in result.backends:
            line = result.line(element, backend)
            if line:
                rows.append({**line[-1], "bound": bound_by(line[-1])})
    columns = [
        Column("element", "element", show=text, number=False), Column("backend", "backend", show=text, number=False),
        Column("elements", "elements", show=count), Column("nodes", "nodes", show=count),
        Column("ns_per_element_step", "time", "ns/element", show=number), Column("ms_per_step", "one step", "ms", show=number),
        Column("fraction_of_limit", "of the limit", "%", show=lambda v: f"{100 * v:.0f}"),
        Column("bound", "limit set by", show=text, number=False), Column("spread", "spread", "%", show=lambda v: f"{100 * v:.0f}"),
        Column("memory_bytes", "memory", "MiB", show=lambda v: number(v / 2**20)),
    ]
    return table(columns, rows, strong=lambda r: r["backend"] == result.main)


def all_rows(result):
    differing = {id(r) for group in result.twins().values() if len({x["hash"] for x in group}) > 1 for r in group}
    bad = {r["hash"] for r in result.rows if id(r) in differing}
    def percent(v):
        return f"{100 * v:.0f}"
    def giga(v):
        return number(v / 1e9)
    columns = [
        Column("element", "element", show=text, number=False), Column("backend", "backend", show=text, number=False),
        Column("elements", "elements", show=count), Column("kernel", "kernel", show=text, number=False),
        Column("ns_per_element_step", "time", "ns/element", show=number), Column("spread", "spread", "%", percent),
        Column("bytes_per_element", "traffic", "B/element", show=number, note="counted, each datum once"),
        Column("flops_per_element", "work", "flop/element", show=number, note="counted; an fma is two"),
        Column("bytes_per_second", "reached", "GB/s", giga), Column("triad_bytes_per_second", "triad", "GB/s", giga),
        Column("fma_flops_per_second", "fma", "Gflop/s", giga), Column("fraction_of_limit", "of the limit", "%", percent),
        Column("hash", "state hash", show=lambda v: f'<code class="{"differs" if v in bad else ""}">{text(v)}</code>', number=False),
    ]
    return table(columns, result.rows, sortable=True, strong=lambda r: r["kernel"] == "step")


def remarks(result):
    parts = []
    groups = result.twins()
    wrong = [f"{e} with {count(n)} elements" for (e, n), rows in groups.items() if len({r["hash"] for r in rows}) > 1]
    if wrong:
        parts.append(notice(f'<b>The backends differ in bits</b> for {text(", ".join(wrong))}. These times are times of a wrong answer.', bad=True))
    elif groups:
        names = " and ".join(dict.fromkeys(r["backend"] for rows in groups.values() for r in rows))
        parts.append(notice(f"Same bits: after 16 steps the states of {text(names)} have the same hash in all {len(groups)} "
                            "pairings of element and size."))
    noisy = [r for r in result.rows if r["spread"] > NOISY]
    if noisy:
        many = len(noisy) > len(result.rows) / 10
        why = "the machine was not quiet, and figures are orders of magnitude" if many else "the table of all rows shows which"
        parts.append(notice(f"{len(noisy)} of {len(result.rows)} rows spread by more than {100 * NOISY:.0f}&#8239;% between their "
                            f"quartiles: {why}.", bad=many))
    above = [r for r in result.steps if r["fraction_of_limit"] > 1]
    if above:
        parts.append(notice(f"{len(above)} of {len(result.steps)} steps come out above 100&#8239;% of the limit. Limit and step are timed one "
                            "after the other, so this is noise, or the limit was measured too low.", bad=True))
    return parts


METHOD = [
    "A cubic block is fixed at its lower face and hangs under gravity; it has about as many elements as asked for.",
    "After 16 steps that count for nothing but the hash, the schedule of a step is run in batches of about 20&#8239;ms "
    "(10&#8239;ms for a single pass), one batch to warm up, then nine (seven). The figure is the median of the batches' wall times, "
    "with the host waiting for the device at the end of a batch only. The spread is the distance of the quartiles over the median.",
]
LIMIT = [
    "No step can be faster than the machine moves its data or does its arithmetic. Both are measured on the same backend in the same "
    "run: the memory by a triad, a&#8239;=&#8239;b&#8239;+&#8239;s&#8239;c, over arrays that together are as large as all buffers of the "
    "step, so that both sit in the same cache or in none; the arithmetic by eight independent chains of fused multiply-adds.",
    "The least time is the larger of counted bytes over the triad's bandwidth and counted operations over the fma rate. Each datum is "
    "counted once, even where it is read again. <b>The share of the limit is that least time over the measured time.</b>",
    "A pass alone touches less memory than the whole step and may sit in a faster cache than the triad did; then its own share can "
    "exceed 100&#8239;%.",
]


def section(result, folder):
    r = Result(result)
    law = next((s["law"] for s in r.steps if "law" in s), "unknown")
    split = ("Time by pass, each timed alone, and, as a mark above and below the bar, the whole step timed at once. The mark is left of the bar's end where a "
             "pass finds the data that the one before left in the cache, and right of it where they push each other out. "
             "Every panel has its own scale; the shares are of the sum of the passes.")
    parts = [
        paragraph(f"What one time step costs for a block of the {text(law)} material. Commands: "
                  "<code>pliant bench kernels --out DIR</code>, then <code>python3 bench/report/report.py DIR</code>."),
        *remarks(r),
        heading("The largest blocks"), headline(r),
        heading("Time against size"),
        figure(step_chart(r, folder), "Time per element and step against the number of elements, a panel per element type",
               "Lower is better. Vertical bars show the spread between the quartiles. All points of a dotted diagonal take the time written "
               "on it for a whole step; a simulation whose time step is at least that long keeps up with real time. The dashed line is "
               "the least time that the machine allows, which is explained below."),
        heading(f"Where the time goes: {r.main}"),
        figure(split_chart(r, folder), "Time of each pass of a step, stacked, for every element type and size", split),
        heading("How far from the limit"),
        figure(limit_chart(r, folder), "Share of the machine's limit that a step reaches, a panel per element type",
               "Higher is better; an arrow at the upper edge stands for a value beyond it."),
        *[paragraph(p) for p in LIMIT],
        heading("How it was measured"), *[paragraph(p) for p in METHOD], machine_facts(r.machine),
        heading("All rows"), paragraph("A heading sorts by its column. Bold rows are whole steps."), all_rows(r),
    ]
    return Section("Kernels", "kernels", parts)
