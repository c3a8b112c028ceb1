"""The cutting benchmark on the page: what a cut costs, what each method leaves behind, and the stable step over random cuts."""
import base64
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import report_charts as charts
import report_page as page

METHODS = ["virtual nodes", "removal", "decomposition", "separation"]
STAGES = [("ms_search", "collision"), ("ms_topology", "topology"), ("ms_surface", "surface"), ("ms_model", "model"), ("ms_upload", "upload"), ("ms_step", "look at the step")]
FRAME_LIMIT = 2.0  # ms per frame that cutting may take


def part(rows, name):
    return [r for r in rows if r["part"] == name]


def method_colour(method):
    return charts.COLOURS[METHODS.index(method)]


def ratio(row):
    return row["dt_after"] / row["dt_before"]


def error(value):
    return "0" if value == 0 else f"{value:.1e}".replace("e-0", "e&#8722;").replace("e-", "e&#8722;").replace("e+0", "e")


def share(value):
    return f"{100 * value:.3g}&#8239;%"


def split_chart(rows, folder, stem, name_of):
    """Median time of a cut by stage, one bar per row."""
    figure, axes = plt.subplots(figsize=(charts.WIDTH, 0.75 + 0.27 * len(rows)))
    for i, row in enumerate(rows):
        left = 0
        for k, (key, _) in enumerate(STAGES):
            value = row.get(key) or 0
            axes.barh(i, value, left=left, height=0.62, color=charts.COLOURS[k])
            left += value
        axes.text(left, i, f' {charts.number(row["ms_per_cut"] or 0, 2)}', va="center", fontsize=7.5)
    axes.set_yticks(range(len(rows)), [name_of(r) for r in rows])
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlabel("median time of a cut [ms]")
    axes.grid(axis="y", visible=False)
    charts.legend_above(figure, [Patch(color=charts.COLOURS[k], label=label) for k, (_, label) in enumerate(STAGES)])
    return charts.save(figure, folder, stem)


def step_chart(rows, folder):
    """Share of the cuts after which the stable step is below a share of that before."""
    figure, axes = plt.subplots(figsize=(charts.WIDTH, 3.0))
    handles = []
    for row in rows:
        quantiles = row["dt_ratio_quantiles"]
        colour = method_colour(row["method"])
        dash = "--" if row["element"] == "hex8" else "-"
        axes.step([max(q, 1e-6) for q in quantiles], [k for k in range(len(quantiles))], where="post", color=colour, linestyle=dash)
        label = f'{row["method"]}, {row["element"]}: at least {charts.number(row["dt_ratio_least"], 2)}'
        handles.append(Line2D([], [], color=colour, linestyle=dash, label=label))
    axes.set_xscale("log")
    charts.log_axis(axes.xaxis, lambda v: charts.number(v, 2))
    axes.set_xlabel("stable step after the cut over that before all cuts")
    axes.set_ylabel("share of the cuts below [%]")
    axes.set_ylim(0, 102)
    charts.legend_above(figure, handles, 2)
    return charts.save(figure, folder, "cutting_steps")


def method_chart(rows, folder):
    """Stable step and material that are left, by method and body."""
    bodies = list(dict.fromkeys(r["scene"] for r in rows))
    figure, flat = charts.panels(["stable step that is left [%]", "mass that is left [%]"], 0.85 + 0.16 * len(bodies) * len(METHODS), sharex=False)
    for axes, value in zip(flat, (ratio, lambda r: 1 + r["mass_error"])):
        names = []
        for b, body in enumerate(bodies):
            for m, method in enumerate(METHODS):
                y = b * (len(METHODS) + 0.8) + m
                names.append((y, f"{body}: {method}"))
                found = [r for r in rows if r["scene"] == body and r["method"] == method]
                if not found:
                    continue
                percent = 100 * value(found[0])
                axes.barh(y, max(percent, 0.01), height=0.7, color=method_colour(method))
                axes.text(max(percent, 0.01), y, f" {charts.number(percent, 3)}", va="center", fontsize=7)
        axes.set_yticks([y for y, _ in names], [n for _, n in names], fontsize=7)
        axes.set_ylim(names[-1][0] + 0.6, -0.6)
        axes.grid(axis="y", visible=False)
    flat[0].set_xscale("log")
    flat[0].set_xlim(0.005, 400)
    charts.log_axis(flat[0].xaxis, lambda v: charts.number(v, 2))
    flat[1].set_xlim(0, 125)
    figure.tight_layout(w_pad=1.4)
    return charts.save(figure, folder, "cutting_methods")


def pictures(rows, folder):
    """The bodies after the cuts with their pieces apart, where the benchmark could draw them."""
    parts = []
    for body in dict.fromkeys(r["scene"] for r in rows):
        cells = []
        for method in METHODS:
            file = Path(folder) / f'cutting_{body}_{method.replace(" ", "_")}.png'
            if not file.is_file():
                continue
            data = base64.b64encode(file.read_bytes()).decode()
            cells.append(f'<figure class="cell"><img alt="{page.text(body)} cut by {page.text(method)}" src="data:image/png;base64,{data}">'
                         f"<figcaption>{page.text(body)}: {page.text(method)}</figcaption></figure>")
        if cells:
            parts.append('<div style="display:grid;grid-template-columns:repeat(2,1fr);gap:0 1rem">' + "".join(cells) + "</div>")
    style = "<style>.cell{margin:.5rem 0}.cell img{width:100%;height:auto;display:block;border-radius:3px}</style>"
    return style + "".join(parts) if parts else ""


COLUMNS = [
    page.Column("scene", "scene", number=False, show=page.text),
    page.Column("method", "method", number=False, show=page.text),
    page.Column("element", "element", number=False, show=page.text),
    page.Column("cuts", "cuts", show=charts.count, note="in the table of scenes: frames in which elements were divided"),
    page.Column("ms_per_cut", "cut", "ms", lambda v: charts.number(v, 3), "median over the cuts that divided elements"),
    page.Column("ms_worst_frame", "worst", "ms", lambda v: charts.number(v, 3), "of all frames"),
    page.Column("mass_error", "mass", "relative", error),
    page.Column("volume_error", "volume", "relative", error, "enclosed by the surface at rest"),
    page.Column("closed", "closed", "", lambda v: "yes" if v else '<span class="differs">no</span>', number=False,
                note="every edge of the surface belongs to two triangles"),
    page.Column("elements_before", "elements", "before", charts.count),
    page.Column("elements_after", "elements", "after", charts.count),
    page.Column("dt_before", "stable step", "ms before", lambda v: charts.number(1e3 * v, 3), "bound of the single elements at rest"),
    page.Column("dt_after", "stable step", "ms after", lambda v: charts.number(1e3 * v, 3)),
    page.Column("ms_per_step_before", "a step takes", "ms before", lambda v: charts.number(v, 3)),
    page.Column("ms_per_step_after", "a step takes", "ms after", lambda v: charts.number(v, 3)),
    page.Column("ms_per_frame", "1/60 s takes", "ms after", lambda v: charts.number(v, 3), "steps alone"),
]


def table(rows):
    """Only columns that these rows fill, and what kind of rows they are only where they differ."""
    columns = [c for c in COLUMNS if any(r.get(c.key) is not None for r in rows)]
    columns = [c for c in columns if c.key not in ("method", "element", "cuts") or len({r.get(c.key) for r in rows}) > 1]
    return page.table(columns, rows, sortable=True, strong=lambda r: r["method"] == "virtual nodes" and len({x["method"] for x in rows}) > 1)


def methods_part(rows, folder):
    cuts = max(r["cuts"] for r in rows)
    least = {m: min(ratio(r) for r in rows if r["method"] == m) for m in METHODS if any(r["method"] == m for r in rows)}
    words = [f"The same {cuts} planar and curved cuts of the same tetrahedra."]
    if "decomposition" in least and "virtual nodes" in least:
        words.append(f'Decomposition leaves {share(least["decomposition"])} of the stable step in the worst case, virtual nodes '
                     f'{share(least["virtual nodes"])}: their copies share a cell, and its mass and stiffness alike.')
    if "removal" in least:
        lost = max(-r["mass_error"] for r in rows if r["method"] == "removal")
        words.append(f"Removal keeps the step and loses up to {share(lost)} of the mass.")
    distances = [r["distance_in_edges"] for r in rows if r.get("distance_in_edges") is not None]
    if distances:
        words.append(f"Separation follows existing faces: after its local remeshing the cut lies {charts.number(max(distances), 2)} "
                     "edge lengths from the blade on average.")
    return [page.heading("Four methods, the same cuts"), page.paragraph(*words),
            page.figure(method_chart(rows, folder), "what is left of step and mass", "What the cuts leave of the stable step (logarithmic) and of the mass."),
            table(rows),
            page.figure(split_chart(rows, folder, "cutting_split_methods", lambda r: f'{r["scene"]}: {r["method"]}'),
                        "time of a cut by stage", "Where the time of a cut goes. The other methods make body, model and buffers anew; their "
                        "search is part of their topology. Medians of the stages do not add up to the median of the whole."),
            pictures(rows, folder)]


def steps_part(rows, folder):
    mine = [r for r in rows if r["method"] == "virtual nodes"]
    words = [f'{charts.count(max(r["cuts"] for r in rows))} random planes and strips for each method, one to five on a body: through nodes, along '
             "edges and faces, across older cuts and themselves."]
    if mine:
        words.append(f'Virtual nodes keep {share(min(r["dt_ratio_least"] for r in mine))} of the bound that an automatic step uses.')
        known = [r["stable_ratio_least"] for r in mine if r.get("stable_ratio_least") is not None]
        if known:
            words.append(f"The limit itself, estimated after every cut by a Lanczos iteration, keeps at least {share(min(known))} of that of the "
                         "whole body. The step keeps to the bound of the single elements, which lies below it.")
    columns = [page.Column("method", "method", number=False, show=page.text), page.Column("element", "element", number=False, show=page.text),
               page.Column("cuts", "cuts", show=charts.count),
               page.Column("dt_ratio_least", "least", "of the step", lambda v: f"{v:.2e}" if v < 1e-3 else f"{v:.4f}"),
               page.Column("q1", "1 in 100", "of the step", lambda v: f"{v:.2e}" if v < 1e-3 else f"{v:.4f}"),
               page.Column("q50", "median", "of the step", lambda v: f"{v:.4f}"),
               page.Column("stable_ratio_least", "Lanczos, least", "of the limit", lambda v: f"{v:.4f}"),
               page.Column("mass_error", "mass", "relative", error), page.Column("volume_error", "volume", "relative", error),
               page.Column("closed", "closed", "", lambda v: "yes" if v else '<span class="differs">no</span>', number=False)]
    filled = [{**r, "q1": r["dt_ratio_quantiles"][1], "q50": r["dt_ratio_quantiles"][50]} for r in rows]
    return [page.heading("The stable step over random cuts"), page.paragraph(*words),
            page.figure(step_chart(rows, folder), "stable step over random cuts", "How many cuts leave less than a share of the stable step "
                        "(logarithmic). Virtual nodes stand at 1."),
            page.table(columns, filled)]


def scenes_part(rows, folder):
    late = [r["scene"] for r in rows if r["ms_per_cut"] is not None and r["ms_per_cut"] > FRAME_LIMIT]
    words = ["The shipped scenes as an application would run them: the blade moves every 1/60 s, and cuts what it has swept over."]
    words.append(f"The median cut stays below {FRAME_LIMIT:g} ms in every scene." if not late else
                 f'The median cut takes longer than {FRAME_LIMIT:g} ms in {", ".join(late)}.')
    return [page.heading("Scenes, frame by frame"), page.paragraph(*words), table(rows),
            page.figure(split_chart(rows, folder, "cutting_split", lambda r: r["scene"]), "time of a cut by stage",
                        "Median of each stage, and beside the bar of the whole, over the frames in which elements were divided.")]


def section(result, folder):
    rows = result["rows"]
    out = page.Section("Cutting", "cutting")
    out.parts.append(page.machine_facts(result["machine"]))
    for name, make in (("scenes", scenes_part), ("methods", methods_part), ("steps", steps_part)):
        some = part(rows, name)
        if some:
            out.parts += make(some, folder)
    return out
