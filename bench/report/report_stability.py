"""The stability benchmark on the page: limits predicted and measured, and maps of where each method fails."""
import matplotlib.pyplot as plt
from matplotlib.colors import LogNorm, Normalize
from matplotlib.lines import Line2D

import report_charts as charts
import report_page as page

METHODS = ["tet4", "tet4anp", "hex8", "hex8full", "flsm", "hybrid"]
MAP = plt.get_cmap("cividis")  # blue to yellow: ordered in lightness for any kind of colour vision
BLACK, WHITE, NONE = "#101010", "#fdfdfd", "#e9ebed"


def rows_of(rows, sweep, **parameters):
    return [r for r in rows if r["sweep"] == sweep and all(r["parameters"].get(k) == v for k, v in parameters.items())]


def values(rows, key):
    return sorted({r["parameters"][key] for r in rows if key in r["parameters"]})


def plain(x):
    if isinstance(x, str):
        return x
    return f"{x:.0e}".replace("e-0", "e-").replace("e+0", "e") if x and (abs(x) < 1e-3 or abs(x) >= 1e4) else f"{x:.4g}"


def share(row):
    return row["predicted"] / row["measured"] if row["predicted"] and row["measured"] else None


def heat(axes, rows, across, up, value, words, norm):
    """One cell per row; grey where there is no value. The words stand in the cell."""
    xs, ys = values(rows, across), values(rows, up)
    for row in rows:
        if across not in row["parameters"] or up not in row["parameters"]:
            continue
        x, y = xs.index(row["parameters"][across]), ys.index(row["parameters"][up])
        v = value(row)
        colour = NONE if v is None else MAP(norm(v))
        axes.add_patch(plt.Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=colour, edgecolor=WHITE, linewidth=0.8))
        dark = v is not None and 0.3 * colour[0] + 0.59 * colour[1] + 0.11 * colour[2] < 0.5
        axes.text(x, y, words(row), ha="center", va="center", fontsize=6.6, color=WHITE if dark else BLACK)
    axes.set_xticks(range(len(xs)), [plain(x) for x in xs])
    axes.set_yticks(range(len(ys)), [plain(y) for y in ys])
    axes.set_xlim(-0.5, len(xs) - 0.5)
    axes.set_ylim(-0.5, len(ys) - 0.5)
    axes.grid(False)
    axes.tick_params(length=0)


def maps(folder, stem, groups, across, up, labels, value, words, norm, height=2.1):
    """`groups` are (title, rows); returns the figure's SVG."""
    figure, flat = charts.panels([title for title, _ in groups], height, sharex=False, sharey=False)
    for i, (axes, (_, rows)) in enumerate(zip(flat, groups)):
        heat(axes, rows, across, up, value, words, norm)
        axes.set_xlabel(labels[0])
        if i % 2 == 0:
            axes.set_ylabel(labels[1])
    figure.tight_layout(w_pad=1.4, h_pad=1.2)
    return charts.save(figure, folder, stem)


def by_method(rows):
    return [(m, [r for r in rows if r["method"] == m]) for m in METHODS if any(r["method"] == m for r in rows)]


def percent(row):
    s = share(row)
    return "" if s is None else f"{100 * s:.0f}"


def safe_map(folder, stem, rows, across, up, labels):
    """Estimate over measured limit in per cent; 85 to 100 is what the engine promises."""
    return maps(folder, stem, by_method(rows), across, up, labels, share, percent, Normalize(0.7, 1.02))


def share_chart(rows, folder):
    figure, axes = plt.subplots(figsize=(charts.WIDTH, 2.9))
    methods = [m for m in METHODS if any(r["method"] == m for r in rows)]
    shares = values(rows, "share")
    norm = LogNorm(5, 5000)
    for row in rows:
        x, y = shares.index(row["parameters"]["share"]), methods.index(row["method"])
        stopped = row["reached"]
        colour = MAP(1 - norm(min(max(row["measured"], 5), 5000))) if stopped else NONE
        axes.add_patch(plt.Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=colour, edgecolor=WHITE, linewidth=0.8))
        dark = stopped and 0.3 * colour[0] + 0.59 * colour[1] + 0.11 * colour[2] < 0.5
        axes.text(x, y, f'{row["measured"]:.0f}' if stopped else "runs", ha="center", va="center", fontsize=7,
                  color=WHITE if dark else BLACK)
    axes.set_xticks(range(len(shares)), [f"{s:g}" for s in shares])
    axes.set_yticks(range(len(methods)), methods)
    axes.set_xlim(-0.5, len(shares) - 0.5)
    axes.set_ylim(len(methods) - 0.5, -0.5)
    axes.set_xlabel("dt over the engine's stable step")
    axes.grid(False)
    axes.tick_params(length=0)
    figure.tight_layout()
    return charts.save(figure, folder, "stability_share")


def limits_chart(rows, folder, stem, quantity, label, describe):
    """Predicted (ring) and measured (dot; an arrow head where the sweep ended first), one line per row."""
    rows = [r for r in rows if r["quantity"] == quantity and r["measured"]]
    figure, axes = plt.subplots(figsize=(charts.WIDTH, 0.5 + 0.17 * len(rows)))
    for i, row in enumerate(rows):
        colour = charts.COLOURS[METHODS.index(row["method"])]
        if row["predicted"]:
            axes.plot([row["predicted"], row["measured"]], [i, i], color=charts.FAINT, linewidth=0.8)
            axes.plot(row["predicted"], i, "o", markerfacecolor=charts.PAPER, markeredgecolor=charts.INK)
        axes.plot(row["measured"], i, "o" if row["reached"] else ">", color=colour)
    axes.set_yticks(range(len(rows)), [f'{r["method"]}: {describe(r["parameters"])}' for r in rows], fontsize=6.6)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xscale("log")
    charts.log_axis(axes.xaxis, lambda v: charts.number(v, 2))
    axes.set_xlabel(label)
    handles = [Line2D([], [], marker="o", linestyle="", markerfacecolor=charts.PAPER, markeredgecolor=charts.INK, label="predicted"),
               Line2D([], [], marker="o", linestyle="", color=charts.INK, label="measured"),
               Line2D([], [], marker=">", linestyle="", color=charts.INK, label="sweep ended before the limit")]
    charts.legend_above(figure, handles)
    return charts.save(figure, folder, stem)


def subcycling_chart(rows, folder):
    goals = [g for g in ("held", "extrapolated") if rows_of(rows, "subcycling", goals=g)]
    figure, flat = charts.panels([f"{g} goals" for g in goals], 2.4)
    alphas = values(rows, "alpha")
    for axes, goal in zip(flat, goals):
        for i, alpha in enumerate(alphas):
            some = sorted(rows_of(rows, "subcycling", goals=goal, alpha=alpha), key=lambda r: r["parameters"]["substeps"])
            n = [r["parameters"]["substeps"] for r in some]
            colour = charts.COLOURS[i]
            axes.plot(n, [1e3 * r["measured"] for r in some], marker=charts.MARKERS[i], color=colour)
            axes.plot(n, [1e3 * r["predicted"] for r in some], "--", color=colour)
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.set_xlabel("steps of elements per step of shape matching")
        charts.log_axis(axes.xaxis, lambda v: f"{v:.0f}")
        charts.log_axis(axes.yaxis, lambda v: charts.number(v, 2))
    flat[0].set_ylabel("longest step of the elements [ms]")
    handles = [Line2D([], [], color=charts.COLOURS[i], marker=charts.MARKERS[i], label=f"alpha {a:g}") for i, a in enumerate(alphas)]
    charts.legend_above(figure, handles + [Line2D([], [], color=charts.INK, linestyle="--", label="the engine's estimate")])
    return charts.save(figure, folder, "stability_subcycling")


def summary(rows):
    steps = [r for r in rows if r["quantity"] == "dt [s]" and share(r) and r["reached"]]
    out = []
    if steps:
        low, high = min(map(share, steps)), max(map(share, steps))
        out.append(page.notice(f"The engine's stable step against the measured limit, over {len(steps)} bodies: "
                               f"{100 * low:.0f} to {100 * high:.1f} %. Above 100 % would be unsafe.", bad=high > 1))
    lost = [r for r in rows if not r.get("finite", True) and r["exit_code"] == 0]
    out.append(page.notice(f"{len(lost)} runs ended with numbers that are not finite and exit code 0." if lost else
                           "No run ended with numbers that are not finite and exit code 0.", bad=bool(lost)))
    return out


def parameters_text(parameters):
    return ", ".join(f"{k} {plain(v)}" for k, v in parameters.items())


COLUMNS = [
    page.Column("sweep", "Sweep", number=False), page.Column("method", "Method", number=False),
    page.Column("text", "Parameters", number=False), page.Column("quantity", "Limit of", number=False),
    page.Column("predicted", "Predicted", show=lambda v: f"{v:.4g}"), page.Column("measured", "Measured", show=lambda v: f"{v:.4g}"),
    page.Column("reached", "Reached", show=lambda v: "yes" if v else "no", number=False),
    page.Column("outcome", "Past it", number=False), page.Column("exit_code", "Exit code"),
]


def charts_of(rows, folder):
    """(heading, SVG, caption) of every sweep that is there."""
    def some(sweep):
        return rows_of(rows, sweep)

    step = [r for r in some("step") if r["method"] not in ("flsm", "hybrid")]
    safe = "Numbers: the engine's estimate in per cent of the measured limit of the step."
    if step:
        yield ("Step by element, aspect ratio and Poisson's ratio",
               safe_map(folder, "stability_step", step, "poisson", "aspect", ("Poisson's ratio", "aspect ratio")), safe)
    if some("share"):
        yield ("Steps until the engine stops", share_chart(some("share"), folder),
               "How many steps a body with noise of a thousandth of an edge runs before the engine stops with exit code 4.")
    if some("contrast"):
        yield ("Two materials in one body", safe_map(folder, "stability_contrast", some("contrast"), "density_ratio", "stiffness_ratio",
                                                    ("ratio of densities", "ratio of stiffnesses")), safe)
    if some("bodies"):
        yield ("Two bodies in one scene", safe_map(folder, "stability_bodies", some("bodies"), "mass_ratio", "size_ratio",
                                                  ("ratio of masses", "ratio of sizes")), safe)
    if some("stretch"):
        yield ("Stretch and compression", limits_chart(some("stretch"), folder, "stability_stretch", "stretch", "stretch",
                                                       lambda p: f'{p["law"]}, {p["step"]} step, {"pressed" if p["towards"] < 1 else "pulled"}'),
               "A column that keeps its width, moved slowly. Predicted: where the engine's estimate falls to the fixed step.")
    if some("inversion"):
        yield ("Return from a bad start", limits_chart(some("inversion"), folder, "stability_inversion", "push in edges", "push [edges]",
                                                       lambda p: p["start"]),
               "A corner pushed into the body and let go. Predicted: where its element turns inside out.")
    if some("load"):
        for quantity, name in (("traction over E", "traction"), ("motion in edges", "motion")):
            yield (f"A {name} switched on at once",
                   limits_chart(some("load"), folder, f"stability_{name}", quantity, quantity, lambda p: f'{p["direction"]}, {p["step"]} step'),
                   "The largest that a clamped bar survives.")
    if some("hourglass"):
        yield ("Hourglass energy in bending",
               maps(folder, "stability_hourglass", [("hex8", some("hourglass"))], "layers", "factor", ("layers through the thickness", "hourglass factor"),
                    lambda r: r["measured"], lambda r: f'{100 * r["measured"]:.0f} %\n({100 * (r["predicted"] or 0):.0f})', Normalize(0, 1), 2.6),
               "Share of the strain energy of a bent bar, measured and, in brackets, predicted.")
    if some("matching"):
        groups = [(f"w = {w:g}", rows_of(rows, "matching", width=w)) for w in values(some("matching"), "width")]
        yield ("Stiffness of shape matching",
               maps(folder, "stability_matching", groups, "alpha", "dt", ("alpha", "dt [s]"), lambda r: r["measured"],
                    lambda r: charts.short(r["measured"]), LogNorm(10, 1e7)), "Young's modulus of the middle of a hanging bar [Pa].")
    if some("beta"):
        groups = [(c, rows_of(rows, "beta", coupling=c)) for c in values(some("beta"), "coupling")]
        yield ("Stiffness of the interface",
               maps(folder, "stability_beta", groups, "beta_ratio", "density", ("beta over m omega²", "density [kg/m³]"), share, percent,
                    Normalize(0.5, 1.02)), safe)
    if some("subcycling"):
        yield ("Steps of elements per step of shape matching", subcycling_chart(some("subcycling"), folder),
               "Solid: the shortest step at which noise grew. Dashed: the engine's estimate.")


def section(result, folder):
    rows = result["rows"]
    parts = [page.paragraph("Every limit is looked for by bisection on small bodies; the parameters, the prediction and what the engine "
                            "said past the limit are in the table.")] + summary(rows)
    for title, svg, caption in charts_of(rows, folder):
        parts += [page.heading(title), page.figure(svg, title, caption)]
    for row in rows:
        row["text"] = parameters_text(row["parameters"])
    parts += [page.heading("All rows"), page.table(COLUMNS, rows, sortable=True)]
    return page.Section("Where each method fails", "stability", parts)
