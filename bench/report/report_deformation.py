"""`pliant bench deformation`: the published scenes, what a node costs on larger bodies, and the error that the hybrid pays."""
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import report_charts as charts
from report_charts import COLOURS, FAINT, INK, MARKERS, PAPER, WIDTH, count, number, short
from report_kernels import readable_on
from report_page import Column, Section, figure, heading, machine_facts, notice, paragraph, table, text

METHODS = {"hybrid": ("hybrid", COLOURS[0]), "tled": ("elements alone", COLOURS[1]), "flsm": ("matching alone", COLOURS[2])}
# What passes do, by the beginning of their kernel's name; the first that fits.
ROLES = [("tled_", "element forces"), ("flsm_bar", "sums over regions"), ("flsm_plate", "sums over regions"),
         ("flsm_region", "rotations of regions"), ("flsm_goal", "goals of nodes"), ("flsm_", "update by goals, interface"),
         ("brick_update", "update by forces"), ("node_update", "update by forces"), ("", "loads, prescribed nodes")]
CUTS = {"none": "whole", "plane": "a plane cut", "random": "1 % of the links cut"}
FRAME = 1000 / 60  # [ms]
NOISY = 0.15


def percent(value, digits=2):
    return "0" if value == 0 else number(100 * value, digits)


def share(value):
    return f"{100 * value:.0f}"


class Result:
    """The rows of one run, by part."""

    def __init__(self, result):
        self.machine, self.rows = result["machine"], result["rows"]
        self.scenes, self.scaling, self.accuracy = ([r for r in self.rows if r["part"] == p] for p in ("scenes", "scaling", "accuracy"))
        self.backends = list(dict.fromkeys(r["backend"] for r in self.scenes))
        self.names = list(dict.fromkeys(r["scene"] for r in self.scenes))

    def row(self, scene, method, backend):
        return next((r for r in self.scenes if (r["scene"], r["method"], r["backend"]) == (scene, method, backend)), None)

    def twins(self):
        """Rows of part scenes that must have the same bits."""
        exact = {b["name"] for b in self.machine.get("backends", []) if b.get("bit_exact")}
        groups = {}
        for row in self.scenes:
            if row["backend"] in exact:
                groups.setdefault((row["scene"], row["method"]), []).append(row)
        return {k: v for k, v in groups.items() if len({r["backend"] for r in v}) > 1}


# --- the published scenes ----------------------------------------------------------------------------------------------------

def bars(r, axes, backend, key, low, high):
    axes.set_xscale("log")
    axes.set_xlim(low, high)
    charts.log_axis(axes.xaxis, number)
    for i, scene in enumerate(r.names):
        for j, (method, (_, colour)) in enumerate(METHODS.items()):
            row = r.row(scene, method, backend)
            if row is None:
                continue
            y = i + 0.27 * (j - 1)
            axes.barh(y, row[key] - low, left=low, height=0.25, color=colour)
            axes.text(row[key] * 1.08, y, number(row[key]), va="center", fontsize=6.4, color=INK, zorder=5,
                      bbox={"facecolor": PAPER, "edgecolor": "none", "pad": 0.4})
        source = next(row["source_ms"] for row in r.scenes if row["scene"] == scene)
        axes.plot([source, source], [i - 0.43, i + 0.43], color=INK, linewidth=2.2, solid_capstyle="butt", zorder=4)
    axes.set_yticks(range(len(r.names)), r.names)
    axes.set_ylim(len(r.names) - 0.45, -0.55)
    axes.grid(False, axis="y")
    axes.tick_params(axis="y", length=0)


def scenes_chart(r, folder):
    titles = [f"{backend}: {what}" for backend in r.backends for what in ("one step", "one frame of 1/60 s")]
    fig, panels = charts.panels(titles, 0.8 + 0.34 * len(r.names), sharex=False)
    for i, axes in enumerate(panels):
        backend, key = r.backends[i // 2], ("ms_per_step", "ms_per_frame")[i % 2]
        values = [row[key] for row in r.scenes] + [row["source_ms"] for row in r.scenes] + [row["limit_ms"] for row in r.scenes] * (i % 2 == 0)
        bars(r, axes, backend, key, min(values) / 3, max(values) * 2.6)
        line = r.scenes[0]["limit_ms"] if i % 2 == 0 else FRAME
        axes.axvline(line, color=FAINT, linestyle="--", linewidth=1.1, zorder=0.9)
        axes.set_xlabel("ms per step" if i % 2 == 0 else "ms per frame")
    handles = [Patch(color=colour, label=words) for words, colour in METHODS.values()]
    handles.append(Line2D([], [], color=INK, marker="|", linestyle="none", markersize=10, markeredgewidth=2.2, label="published total"))
    handles.append(Line2D([], [], color=FAINT, linestyle="--", linewidth=1.1, label=f'{r.scenes[0]["limit_ms"]:g} ms per step; real time per frame'))
    charts.legend_above(fig, handles, 3)
    return charts.save(fig, folder, "deformation_scenes")


def scenes_table(r):
    differing = {row["hash"] for group in r.twins().values() if len({x["hash"] for x in group}) > 1 for row in group}
    rows = [{**row, "words": METHODS.get(row["method"], (row["method"],))[0], "over_step": row["source_ms"] / row["ms_per_step"],
             "over_frame": row["source_ms"] / row["ms_per_frame"]} for row in r.scenes]
    columns = [
        Column("scene", "scene", show=text, number=False), Column("words", "method", show=text, number=False),
        Column("backend", "backend", show=text, number=False), Column("nodes", "nodes", show=count),
        Column("ratio", "ratio", show=lambda v: f"{v:.3f}", note="operational and interface nodes over all nodes"),
        Column("ms_per_step", "step", "ms", number), Column("dt", "dt", "ms", lambda v: number(1e3 * v)),
        Column("ms_per_frame", "frame", "ms", number), Column("source_ms", "source", "ms", lambda v: f"{v:.1f}"),
        Column("over_step", "source", "/ step", number), Column("over_frame", "source", "/ frame", number),
        Column("spread", "spread", "%", share),
        Column("hash", "state hash", show=lambda v: f'<code class="{"differs" if v in differing else ""}">{text(v)}</code>', number=False),
    ]
    return table(columns, rows, sortable=True, strong=lambda row: row["method"] == "hybrid")


def role(kernel):
    return next(words for start, words in ROLES if kernel.startswith(start))


def split_chart(r, folder):
    backend = r.backends[0]
    roles = list(dict.fromkeys(words for _, words in ROLES))
    fig, panels = charts.panels(r.names, 1.5, sharex=True, sharey=False)
    used, longest = set(), 0.0
    totals = {}
    for scene in r.names:
        for method in METHODS:
            row = r.row(scene, method, backend)
            sums = totals[scene, method] = dict.fromkeys(roles, 0.0)
            for p in row["passes"] if row else []:
                sums[role(p["kernel"])] += p["us_per_launch"] * p["launches_per_step"]
            if row:  # a pass that was disturbed must not make all others small: bars end at twice the whole step
                longest = max(longest, 1e3 * row["ms_per_step"], min(sum(sums.values()), 2e3 * row["ms_per_step"]))
    for axes, scene in zip(panels, r.names):
        for i, method in enumerate(METHODS):
            row, left = r.row(scene, method, backend), 0.0
            for words, us in totals[scene, method].items():
                if us == 0:
                    continue
                colour = COLOURS[roles.index(words) % len(COLOURS)]
                used.add(words)
                axes.barh(i, us, left=left, height=0.6, color=colour, edgecolor=PAPER, linewidth=0.6)
                seen = min(left + us, 1.05 * longest) - left
                if seen > 0.09 * longest:
                    whole = sum(totals[scene, method].values())
                    axes.text(left + seen / 2, i, f"{100 * us / whole:.0f}%", ha="center", va="center", fontsize=6.6, color=readable_on(colour))
                left += us
            if left > 1.05 * longest:
                axes.annotate(f"{number(left)} \u2192", (1, i + 0.5), xycoords=("axes fraction", "data"), ha="right", va="center", fontsize=6.6)
            for end in (-1, 1) if row else ():
                axes.plot([1e3 * row["ms_per_step"]] * 2, [i + 0.3 * end, i + 0.46 * end], color=INK, linewidth=1.8, solid_capstyle="butt")
        axes.set_yticks(range(len(METHODS)), [words for words, _ in METHODS.values()], fontsize=7.5)
        axes.set_ylim(len(METHODS) - 0.45, -0.55)
        axes.set_xlim(0, 1.05 * longest)
        axes.grid(False, axis="y")
        axes.tick_params(axis="y", length=0)
    for axes in panels[-min(2, len(panels)):]:
        axes.set_xlabel("µs per step")
    handles = [Patch(color=COLOURS[roles.index(words) % len(COLOURS)], label=words) for words in roles if words in used]
    handles.append(Line2D([], [], color=INK, marker="|", linestyle="none", markersize=9, markeredgewidth=1.8, label="whole step, timed at once"))
    charts.legend_above(fig, handles, 3)
    return charts.save(fig, folder, "deformation_split")


# --- larger bodies -------------------------------------------------------------------------------------------------------------

def scaling_chart(r, folder):
    sizes = sorted({row["nodes"] for row in r.scaling})
    fig, panels = charts.panels([f"{count(n)} nodes" for n in sizes], 2.5)
    top = max(max(row["ns_per_node"], row.get("limit_ns", 0)) for row in r.scaling)
    for axes, nodes in zip(panels, sizes):
        here = [row for row in r.scaling if row["nodes"] == nodes]
        for i, cut in enumerate(CUTS):
            line = sorted((row for row in here if row["method"] == "flsm" and row["cut"] == cut), key=lambda row: row["width"])
            axes.plot([row["width"] + 0.06 * (i - 1) for row in line], [row["ns_per_node"] for row in line], color=COLOURS[i], marker=MARKERS[i],
                      markeredgecolor=PAPER, markeredgewidth=0.6, zorder=3)
        for row in here:
            if row["method"] == "hybrid":
                axes.plot(row["width"], row["ns_per_node"], marker="*", markersize=9, color=COLOURS[3], linestyle="none", zorder=4)
        for width, limit in {row["width"]: row["limit_ns"] for row in here if "limit_ns" in row}.items():
            axes.plot([width - 0.3, width + 0.3], [limit, limit], color=INK, linewidth=1.6, solid_capstyle="butt", zorder=2)
            axes.text(width + 0.3, limit, f" {limit:.0f}", va="center", fontsize=7, color=INK)
        axes.set_xticks(sorted({row["width"] for row in here}))
        axes.set_xlim(0.5, max(row["width"] for row in here) + 0.6)
        axes.set_ylim(0, 1.08 * top)
        axes.grid(False, axis="x")
    for axes in panels[-min(2, len(panels)):]:
        axes.set_xlabel("half-width of the regions")
    for axes in panels[::2]:
        axes.set_ylabel("ns per node and step")
    handles = [Line2D([], [], color=COLOURS[i], marker=MARKERS[i], markeredgecolor=PAPER, label=f"shape matching, {words}")
               for i, words in enumerate(CUTS.values())]
    handles.append(Line2D([], [], color=COLOURS[3], marker="*", markersize=9, linestyle="none", label="hybrid"))
    handles.append(Line2D([], [], color=INK, linewidth=1.6, label="limit"))
    charts.legend_above(fig, handles, 3 if len(sizes) > 1 else 2)
    return charts.save(fig, folder, "deformation_scaling")


def set_up_chart(r, folder):
    rows = [row for row in r.scaling if "set_up_seconds" in row]
    fig, (axes,) = charts.panels(["Set-up"], 2.4)
    kinds = list(dict.fromkeys((row["method"], row["width"]) for row in rows))
    handles = []
    for i, kind in enumerate(kinds):
        line = sorted((row for row in rows if (row["method"], row["width"]) == kind), key=lambda row: row["nodes"])
        axes.plot([row["nodes"] for row in line], [row["set_up_seconds"] for row in line], color=COLOURS[i], marker=MARKERS[i],
                  markeredgecolor=PAPER, zorder=3)
        words = "hybrid" if kind[0] == "hybrid" else "shape matching"
        handles.append(Line2D([], [], color=COLOURS[i], marker=MARKERS[i], markeredgecolor=PAPER, label=f"{words}, half-width {kind[1]}"))
    last = max(rows, key=lambda row: row["nodes"])
    ends = [min(row["nodes"] for row in rows) / 1.6, last["nodes"] * 1.6]
    axes.plot(ends, [last["set_up_seconds"] * n / last["nodes"] for n in ends], color=FAINT, linestyle=(0, (1, 2)), linewidth=1, zorder=1)
    handles.append(Line2D([], [], color=FAINT, linestyle=(0, (1, 2)), linewidth=1, label="growth with the number of nodes"))
    limits = [row for row in rows if "limit_set_up_seconds" in row]
    if limits:
        axes.plot(limits[0]["nodes"], limits[0]["limit_set_up_seconds"], marker="_", markersize=22, markeredgewidth=2, color=INK)
        handles.append(Line2D([], [], color=INK, marker="_", linestyle="none", markersize=12, markeredgewidth=2,
                              label=f'limit: {limits[0]["limit_set_up_seconds"]:g} s'))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(*ends)
    charts.log_axis(axes.xaxis, short)
    charts.log_axis(axes.yaxis, number)
    axes.set_xlabel("nodes")
    axes.set_ylabel("seconds")
    charts.legend_above(fig, handles, 3)
    return charts.save(fig, folder, "deformation_set_up")


def scaling_table(r):
    rows = [{**row, "words": METHODS[row["method"]][0], "links": CUTS.get(row["cut"], row["cut"])} for row in r.scaling]
    columns = [
        Column("words", "method", show=text, number=False), Column("nodes", "nodes", show=count), Column("width", "half-width"),
        Column("links", "links", show=text, number=False), Column("ns_per_node", "one step", "ns/node", number),
        Column("limit_ns", "limit", "ns/node", number), Column("ms_per_step", "one step", "ms", number),
        Column("fraction", "of best", "%", share, note="least time by the machine's bandwidth and arithmetic over the measured time"), Column("set_up_seconds", "set-up", "s", number), Column("spread", "spread", "%", share),
    ]
    return table(columns, rows, sortable=True, strong=lambda row: row["ns_per_node"] > row.get("limit_ns", float("inf")))


# --- the hybrid's error --------------------------------------------------------------------------------------------------------

def series_lines(r):
    """{name: rows of hybrids by ratio}; files without `series` have the scene's own alpha only."""
    lines = {}
    for row in r.accuracy:
        if row["method"] == "hybrid" and row["error_operational"] is not None:
            lines.setdefault(row.get("series", "alpha of the scene"), []).append(row)
    return {name: sorted(rows, key=lambda row: row["ratio"]) for name, rows in lines.items()}


def error_chart(r, folder):
    fig, (left, right) = charts.panels(["Error of the operational region", "Speed-up of a step"], 2.7, sharey=False)
    lines = series_lines(r)
    for i, rows in enumerate(lines.values()):
        look = {"color": COLOURS[i % 7], "marker": MARKERS[i % 7], "markeredgecolor": PAPER, "markeredgewidth": 0.6,
                "linestyle": ("-", "-", "--", "-.")[i % 4]}
        x = [row["ratio"] for row in rows]
        left.plot(x, [100 * row["error_operational"] for row in rows], **look)
        right.plot(x, [row["speedup"] for row in rows], **look)
    left.set_yscale("log")
    errors = [100 * row["error_operational"] for rows in lines.values() for row in rows]
    ticks = [s * 10.0 ** e for e in range(-4, 3) for s in (1, 2, 5)]
    left.set_ylim(min(errors) / 1.5, max(errors) * 1.5)
    left.set_yticks([t for t in ticks if min(errors) / 1.5 <= t <= max(errors) * 1.5])
    charts.log_axis(left.yaxis, lambda v: f"{number(v)}\u2009%")
    right.axhline(1, color=INK, linewidth=1.1)
    right.set_ylim(0, 1.1 * max(1, *(row["speedup"] for rows in lines.values() for row in rows)))
    for axes in (left, right):
        axes.set_xlim(0, 1)
        axes.set_xlabel("share of nodes in finite elements")
    left.set_ylabel("relative L2 error")
    right.set_ylabel("finite elements over hybrid")
    handles = [Line2D([], [], color=COLOURS[i % 7], marker=MARKERS[i % 7], markeredgecolor=PAPER, label=name,
                      linestyle=("-", "-", "--", "-.")[i % 4]) for i, name in enumerate(lines)]
    charts.legend_above(fig, handles, 2)
    return charts.save(fig, folder, "deformation_error")


def error_shares(r):
    """Per ratio: errors, and what part of the squared error goes with the stiffness, then with Poisson's ratio; the coupling has the rest."""
    lines = series_lines(r)

    def at(name, ratio):
        return next((row["error_operational"] for row in lines.get(name, []) if abs(row["ratio"] - ratio) < 0.02), None)

    found = []
    for row in lines.get("alpha of the scene", []):
        own, matched, free = row["error_operational"], at("stiffness matched", row["ratio"]), at("stiffness matched, nu = 0", row["ratio"])
        if not matched or not free or not own:
            continue
        without_stiffness, without_poisson = min(own, matched), min(own, matched, free)
        found.append({"ratio": row["ratio"], "own": own, "matched": matched, "free": free, "rest_of_matched": (free / matched) ** 2,
                      "stiffness": 1 - (without_stiffness / own) ** 2, "poisson": (without_stiffness**2 - without_poisson**2) / own**2,
                      "coupling": (without_poisson / own) ** 2})
    return found


def shares_sentence(found):
    middle = min(found, key=lambda f: abs(f["ratio"] - 0.5))
    rest = [f["rest_of_matched"] for f in found]
    words = (f'<b>At ratio {middle["ratio"]:.1f}, of the squared error with the scene\'s own alpha {share(middle["stiffness"])}&#8239;% come from the '
             f'mismatch of stiffness, {share(middle["poisson"])}&#8239;% from Poisson\'s ratio and {share(middle["coupling"])}&#8239;% from the coupling '
             "and the width of the regions.</b> Once the stiffness is matched, coupling and width are "
             f'{share(min(1, middle["rest_of_matched"]))}&#8239;% of what is left ({share(min(1, min(rest)))} to '
             f"{share(min(1, max(rest)))}&#8239;% over all ratios) and Poisson's ratio is the remainder.")
    above = [f for f in found if f["free"] > f["matched"]]
    if above:
        ratios = ", ".join(f'{f["ratio"]:.1f}' for f in above)
        words += (f" At ratio {ratios} a material without lateral contraction has a larger error than the material itself: there the two causes partly cancel, "
                  "no part can be given to Poisson's ratio, and all that is left counts as coupling and width.")
    return paragraph(words)


def error_parts(r, folder):
    lines, found = series_lines(r), error_shares(r)
    parts = [heading("What the hybrid's error and speed-up are"),
             figure(error_chart(r, folder), "Error of the operational region and speed-up against the share of finite elements",
                    "The liver under its local indentation, at the end of the load. Left: displacements of the operational nodes against finite elements alone on the "
                    "same lattice and with the same step, lower is better. Right: time of a step of finite elements alone over that of the hybrid; "
                    "above the black line the hybrid is faster. With substeps one step of shape matching serves several of finite elements.")]
    slower = [row for rows in lines.values() for row in rows if row["speedup"] < 1]
    if slower:
        parts.append(notice(f"{len(slower)} of {sum(map(len, lines.values()))} hybrids take longer per step than finite elements alone: here a node of shape "
                            "matching costs more than one of these elements."))
    if found:
        columns = [Column("ratio", "ratio", show=lambda v: f"{v:.2f}"), Column("own", "alpha of the scene", "error, %", percent),
                   Column("matched", "stiffness matched", "error, %", percent), Column("free", "and nu = 0", "error, %", percent),
                   Column("stiffness", "stiffness", "share, %", share), Column("poisson", "Poisson", "share, %", share),
                   Column("coupling", "coupling, width", "share, %", share)]
        parts += [shares_sentence(found),
                  paragraph("Shares are of the squared error: the part that goes when alpha is chosen for the material's Young's modulus is the stiffness's, the part "
                            "that goes when the material too has no lateral contraction is that of Poisson's ratio, and what stays is left to the coupling and to "
                            "regions wider than an element."), table(columns, found)]
    columns = [Column("name", "series", show=text, number=False), Column("ratio", "ratio", show=lambda v: f"{v:.3f}"),
               Column("error_operational", "error", "%", percent), Column("error_near_interface", "near interface", "%", percent),
               Column("error_far", "far from it", "%", percent), Column("error_flsm", "matching alone", "%", percent),
               Column("ms_per_step", "one step", "ms", number), Column("speedup", "speed-up", show=number), Column("spread", "spread", "%", share)]
    return parts + [table(columns, [{**row, "name": name} for name, rows in lines.items() for row in rows], sortable=True)]


# --- page ----------------------------------------------------------------------------------------------------------------------

def remarks(r):
    parts, groups = [], r.twins()
    wrong = [f"{scene} ({METHODS[method][0]})" for (scene, method), rows in groups.items() if len({row["hash"] for row in rows}) > 1]
    if wrong:
        parts.append(notice(f'<b>The backends differ in bits</b> for {text(", ".join(wrong))}.', bad=True))
    elif groups:
        names = " and ".join(dict.fromkeys(row["backend"] for rows in groups.values() for row in rows))
        parts.append(notice(f"Same bits: {text(names)} have the same state hash in all {len(groups)} pairings of scene and method."))
    noisy = [row for row in r.rows if row.get("spread", 0) > NOISY]
    if noisy:
        parts.append(notice(f"{len(noisy)} of {len(r.rows)} rows spread by more than {100 * NOISY:.0f}&#8239;% between their quartiles: the tables show which.",
                            bad=len(noisy) > len(r.rows) / 10))
    return parts


def section(result, folder):
    r = Result(result)
    parts = [paragraph("Bodies of finite elements where the tool works and of lattice shape matching elsewhere. Commands: "
                       "<code>pliant bench deformation --out DIR</code>, then <code>python3 bench/report/report.py DIR</code>."), *remarks(r)]
    if r.scenes:
        parts += [heading("The four published scenes (Hybrid Deformation Model)"),
                  figure(scenes_chart(r, folder), "Time per step and per frame for each scene and method, with the published total",
                         "Lower is better; logarithmic axes. The heavy stroke is the published total cost of a step, on the authors' machine. A frame takes as many steps as "
                         "1/60&#8239;s needs, each within the stable step; left of the dashed line a scene keeps up with real time."),
                  scenes_table(r), heading(f"Where the time goes: {r.backends[0]}"),
                  figure(split_chart(r, folder), "Time of the passes of a step, stacked, for each scene and method",
                         "Each pass by the device's own clock; the mark above and below a bar is the whole step, timed at once. A bar that ends with an arrow holds a pass that something else delayed.")]
    if r.scaling:
        parts += [heading(f'Larger bodies: {r.scaling[0]["backend"]}'),
                  figure(scaling_chart(r, folder), "Time per node and step against the half-width of the regions, a panel per size",
                         "The liver under gravity. Lower is better. Cut links make regions of odd shapes, which the ordered sums miss and a list completes.")]
        if any("set_up_seconds" in row for row in r.scaling):
            parts.append(figure(set_up_chart(r, folder), "Seconds of set-up against the number of nodes", "From the scene to the first step: lattice, model, program and device."))
        parts += [paragraph("Bold rows are above their limit."), scaling_table(r)]
    if series_lines(r):
        parts += error_parts(r, folder)
    return Section("Deformation", "deformation", [*parts, heading("Machine"), machine_facts(r.machine)])
