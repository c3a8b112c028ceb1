"""The haptics benchmark on the page: forces over a stroke, and how far each model is from the full one."""
import report_charts as charts
import report_page as page

SHOWN = (("full", "full model, in every tick"), ("4 rings, 30 frames a second", "buffer of 4 rings"), ("held", "force of the last frame"))


def scenes_of(result):
    return list(dict.fromkeys(trace["scene"] for trace in result["traces"]))


def curve(trace):
    times = [trace["period"] * (i + 1) for i in range(len(trace["force"]))]
    return times, [sum(f * f for f in force) ** 0.5 for force in trace["force"]]


def forces(result, folder):
    names = [scene for scene in scenes_of(result) if "," not in scene]
    figure, flat = charts.panels([name.capitalize() for name in names], 2.1, sharex=False, sharey=False)
    for axes, name in zip(flat, names):
        for (model, label), colour in zip(SHOWN, charts.COLOURS):
            for trace in result["traces"]:
                if (trace["scene"], trace["model"]) == (name, model):
                    axes.plot(*curve(trace), color=colour, label=label, linewidth=1.0 if model == "held" else 1.3)
        axes.set_xlabel("time [s]")
        axes.set_ylabel("force [N]")
    flat[0].legend(fontsize=7)
    figure.tight_layout(w_pad=1.4, h_pad=1.2)
    return charts.save(figure, folder, "haptics_forces")


def differences(result, folder):
    test = "root mean square difference from the full model, over the largest force"
    rows = [r for r in result["rows"] if r["part"] == "strokes" and r["test"] == test]
    names = list(dict.fromkeys(r["scene"].split(", ")[0] for r in rows))
    figure, flat = charts.panels([name.capitalize() for name in names], 2.1, sharex=True, sharey=True)
    for axes, name in zip(flat, names):
        for frames, colour in (("30", charts.COLOURS[1]), ("60", charts.COLOURS[0])):
            points = []
            for row in rows:
                scene, rings, rate = row["scene"].split(", ")
                if scene == name and rate.startswith(frames):
                    points.append((int(rings.split()[0]), 100 * row["value"]))
            axes.plot(*zip(*sorted(points)), marker="o", color=colour, label=f"{frames} frames a second")
        axes.set_xlabel("rings of the buffer")
        axes.set_ylabel("difference [%]")
        axes.set_ylim(bottom=0)
    flat[0].legend(fontsize=7)
    figure.tight_layout(w_pad=1.4, h_pad=1.2)
    return charts.save(figure, folder, "haptics_differences")


COLUMNS = [page.Column("test", "test"), page.Column("scene", "scene"), page.Column("value", "value", show=lambda v: charts.number(v)),
           page.Column("bound", "bound", show=lambda v: charts.number(v))]


def section(result, folder):
    parts = []
    if any(trace["model"] == "held" for trace in result["traces"]):
        caption = "A ball is pressed in, drawn along and lifted; 30 frames and 1000 ticks a second."
        parts += [page.heading("Force on the hand"), page.figure(forces(result, folder), "Force on the hand", caption)]
    if any(r["part"] == "strokes" for r in result["rows"]) and not result["quick"]:
        caption = "Root mean square difference of the buffer's force from the full model's, over the largest force."
        parts += [page.heading("Rings of the buffer"), page.figure(differences(result, folder), "Rings of the buffer", caption)]
    summary = result["summary"]
    rows = [{k: v for k, v in row.items() if v is not None} for row in result["rows"]]
    parts += [page.heading("All rows"), page.paragraph(f'{summary["ok"]} of {summary["asked"]} rows with a bound keep it.'),
              page.table(COLUMNS, rows, sortable=True)]
    return page.Section("What a hand feels", "haptics", parts)
