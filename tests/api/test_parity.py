"""The calls of C++, C and Python side by side: what one of them lacks has to stand here with its reason.

Parsed from include/pliant and python/; where the Python module can be imported, what it holds has to be what its source says.
The members of options, reports, frames and other structs are compared likewise.
"""
import os
import re
import sys
from pathlib import Path

SOURCE = Path(os.environ.get("PLIANT_SOURCE", Path(__file__).resolve().parents[2]))

# What C++ has, and why C or Python has not.
MISSING = {
    ("C", "World::World"): "SceneSpec is a struct of C++; pliant_world_parse takes a scene as text with surfaces in memory",
    ("C", "World::add_tool"): "ToolSpec is a struct of C++; pliant_world_parse_tool takes a tool as text",
    ("C", "World::change"): "ChangeSpec is a struct of C++; pliant_world_parse_change takes a change as text",
    ("C", "box_surface"): "a helper for small programs; eight vertices are written down as quickly",
    ("C", "WorldInfo.backend"): "in the text of pliant_world_backend",
    ("C", "WorldInfo.device"): "in the text of pliant_world_backend",
    ("C", "WorldInfo.remarks"): "in the text of pliant_world_remarks",
    ("Python", "Event.placed"): "the position is None where it is not",
    ("Python", "ToolForce.name"): "a key of what World.tool_forces() returns",
    ("Python", "ProbeValue.probe"): "a key of what World.probes() returns",
    ("Python", "ProbeValue.quantity"): "a key of what World.probes() has for a probe",
    ("Python", "ProbeValue.numbers"): "an array of World.probes()",
    ("C", "WorldInfo.reason"): "for people, who see it in `pliant devices`",
    ("Python", "World::open"): "World(file)",
    ("Python", "World::parse"): "World(dict, surfaces, folder)",
    ("Python", "World::parse_tool"): "add_tool(dict, folder)",
    ("Python", "World::parse_change"): "change(body=..., material={...})",
    ("Python", "box_surface"): "a helper for small programs; eight vertices are written down as quickly",
}
# What C or Python has, and why C++ has not.
BEYOND = {
    ("C", "last_error"): "C has no exceptions",
    ("C", "status_name"): "C has no exceptions",
    ("C", "World::destroy"): "C has no destructors",
    ("C", "World::backend"): "WorldInfo::backend and device as one text",
    ("C", "World::body"): "an element of WorldInfo::bodies",
    ("C", "World::body_nodes"): "BodyInfo::nodes",
    ("C", "World::grab_trace"): "C has no overloads: World::force_trace of a grab",
    ("C", "World::forget_consumer"): "for C the library holds the frames that others hold themselves",
    ("C", "World::positions"): "a copy of three numbers per vertex",
    ("C", "World::normals"): "a copy of three numbers per vertex",
    ("C", "World::triangles"): "a copy in the caller's memory",
    ("C", "World::cut_faces"): "a copy with zeros where there is no cut",
    ("Python", "World::show"): "the page in the browser is Python; examples/window is C++",
}
PYTHON_NAMES = {"backends": "backend_names", "__version__": "version", "World::__init__": "World::World"}
STRUCTS = {"WorldOptions": "options", "StepReport": "report", "CutResult": "cut", "WorldInfo": "info", "BodyInfo": "body", "Frame": "frame",
           "ProbeValue": "probe_value", "ToolForce": "tool_force", "Interpenetration": "interpenetration", "PickedPoint": "picked_point", "LiveState": "live_state",
           "LiveOptions": "live_options", "Event": "event", "ForceSample": "force_sample"}


def code_of(path):
    """Without comments."""
    return re.sub(r"//[^\n]*", "", re.sub(r"/\*.*?\*/", "", (SOURCE / path).read_text(), flags=re.S))


def block(text, begin):
    """What stands between the first brace after `begin` and the one that closes it."""
    at = start = text.index("{", text.index(begin)) + 1
    depth = 1
    while depth > 0:
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        at += 1
    return text[start:at - 1]


def members(text):
    return set(re.findall(r"(\w+)(?:\[\d+\]|\{[^;]*\}|\s*=[^;]*)?;", text))


def cpp():
    world = re.sub(r"\[\[deprecated[^\n]*", "", code_of("include/pliant/world.h"))
    found = {f"World::{n}" for n in re.findall(r"(?<![\w~:])(\w+)\([^;]*?\)\s*(?:const)?\s*(?:noexcept)?;",
                                               block(world, "class PLIANT_API World").split("private:")[0])}
    headers = world + code_of("include/pliant/scene.h") + code_of("include/pliant/frame.h") + code_of("include/pliant/probe.h") + code_of("include/pliant/tool.h") + code_of("include/pliant/world_types.h")
    headers += code_of("include/pliant/live.h")
    found |= set(re.findall(r"^PLIANT_API .*?(\w+)\(", headers, re.M))
    for name in STRUCTS:
        found |= {f"{name}.{m}" for m in members(block(headers, f"struct {name} "))}
    return found


def c():
    calls = re.findall(r"^PLIANT_API .*?pliant_(\w+)\(", code_of("include/pliant/c/pliant.h") + code_of("include/pliant/c/live.h"), re.M)
    found = {re.sub("^world_", "World::", n) for n in calls}
    types = code_of("include/pliant/c/types.h") + code_of("include/pliant/c/live.h")
    for name, short in STRUCTS.items():
        for m in members(block(types, f"typedef struct pliant_{short} ")) - {"size", "reserved"}:
            range_of = re.fullmatch(r"(.*)(vertex|triangle)_(first|count)", m)
            if range_of and (range_of[3] == "first" or f"{range_of[1]}{range_of[2]}_first" not in types):
                m = range_of[1] + {"vertex": "vertices", "triangle": "triangles"}[range_of[2]]
            if not m.endswith("_count"):
                found.add(f"{name}.{m}")
    return found


def python():
    text = code_of("python/pliant.cpp")
    define = r'\.def(?:_readonly|_property_readonly)?\(\s*"(\w+)"'
    live = block(text, "void bind_live(")
    world, module = block(text, "void bind_world(") + block(text, "void bind_tools(") + live, block(text, "PYBIND11_MODULE(")
    found = {f"World::{n}" for n in re.findall(define, world)} | {"World::__init__"}
    found |= {f"World::{n}" for n in re.findall(r"^World\.([a-z]\w*) =", (SOURCE / "python/pliant/__init__.py").read_text(), re.M)}
    found |= set(re.findall(r'm\.def\("(\w+)"', module)) | set(re.findall(r'm\.attr\("(\w+)"\) =', module)) - {"__module__"}
    constructor = world[world.index("py::init"):world.index(".def_property_readonly")]
    found |= {f"WorldOptions.{n}" for n in re.findall(r'py::arg\("(\w+)"\)', constructor)} - {f"WorldOptions.{n}" for n in ("scene", "surfaces", "folder")}
    for name, function in {"StepReport": "bind_report", "Frame": "bind_frame"}.items():
        found |= {f"{name}.{n}" for n in re.findall(define, block(text, f"void {function}("))}
    for name, variable, function in (("WorldInfo", "d", "info"), ("BodyInfo", "body", "info"), ("CutResult", "d", "result"), ("PickedPoint", "d", "picked"),
                                     ("LiveState", "live", "live_state"), ("Event", "event", "events"), ("ToolForce", "tool", "tool_forces"), ("Interpenetration", "found", "interpenetrations")):
        kind = "list" if name in ("Interpenetration", "Event") else "dict"
        found |= {f"{name}.{n}" for n in re.findall(rf'\b{variable}\["(\w+)"\] =', block(text, f"py::{kind} {function}("))}
    found |= {f"LiveOptions.{n}" for n in re.findall(r'py::arg\("(\w+)"\)', live[:live.index("stop_live")])}
    found |= {f"ForceSample.{n}" for n in re.search(r"PYBIND11_NUMPY_DTYPE\(pliant::ForceSample, ([^)]*)\)", live)[1].split(", ")}
    return {PYTHON_NAMES.get(n, n) for n in found}


def module():
    """What the module itself holds, or None."""
    try:
        import pliant
    except ImportError:
        return None
    found = {f"World::{n}" for n in vars(pliant.World) if not n.startswith("_")} | {"World::__init__"}
    found |= {n for n, v in vars(pliant).items() if not n.startswith("_") and not isinstance(v, type)} | {"__version__"}
    for name in ("StepReport", "Frame"):
        found |= {f"{name}.{n}" for n in vars(getattr(pliant, name)) if not n.startswith("_")}
    return {PYTHON_NAMES.get(n, n) for n in found}


def main():
    wrong = []
    reference = cpp()
    assert {"World::advance_async", "World::frame_since", "World::poll", "StepReport.message", "backend_names"} <= reference, reference
    for language, found in (("C", c()), ("Python", python())):
        for name in sorted(reference - found):
            if (language, name) not in MISSING:
                wrong.append(f"{language} lacks {name}: add it, or its reason to MISSING")
        for name in sorted(found - reference):
            if (language, name) not in BEYOND:
                wrong.append(f"{language} alone has {name}: add it to C++, or its reason to BEYOND")
        for of, name in MISSING:
            if of == language and (name in found or name not in reference):
                wrong.append(f"MISSING names {name} for {language}, which has it, or C++ has not")
        for of, name in BEYOND:
            if of == language and (name not in found or name in reference):
                wrong.append(f"BEYOND names {name} for {language}, which has it not, or C++ has")
        print(f"{language}: {len(found & reference)} of {len(reference)} calls and members of C++, {len(found - reference)} of its own")
    held = module()
    if held is not None:
        said = {n for n in python() if "." not in n or n.split(".")[0] in ("StepReport", "Frame")}  # others are dicts or arguments
        wrong += [f"the module and its source differ in {n}" for n in sorted(held ^ said)]
    print("the Python module " + ("is not there: only its source was read" if held is None else "holds what its source says"))
    if wrong:
        sys.exit("\n".join(wrong))


main()
