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
    ("Python", "BladeForce.name"): "a key of what World.blade_forces() returns",
    ("Python", "ProbeValue.probe"): "a key of what World.probes() returns",
    ("Python", "ProbeValue.quantity"): "a key of what World.probes() has for a probe",
    ("Python", "ProbeValue.numbers"): "an array of World.probes()",
    ("C", "WorldInfo.reason"): "for people, who see it in `pliant devices`",
    ("C", "DeviceSample.dated"): "of devices by text for `pliant run --live`; a device of a program says its time",
    ("Python", "DeviceSample.dated"): "of devices by text for `pliant run --live`; a device of a program says its time",
    ("C", "HapticState.last"): "an argument of pliant_haptic_loop_state of its own, so that it can grow",
    ("C", "HapticDevice::read"): "a loop calls it; pliant_haptic_device_create takes one",
    ("C", "HapticDevice::write"): "a loop calls it; pliant_haptic_device_create takes one",
    ("C", "ManualDevice::read"): "a loop calls it",
    ("C", "ManualDevice::write"): "a loop calls it",
    ("C", "ManualDevice::limits"): "pliant_haptic_device_limits",
    ("C", "ManualDevice::counts"): "pliant_haptic_device_counts",
    ("Python", "HapticDevice::HapticDevice"): "a thread of the loop would have to wait for Python; ManualDevice takes poses from it",
    ("Python", "HapticDevice::read"): "a loop calls it",
    ("Python", "HapticDevice::write"): "a loop calls it",
    ("Python", "ManualDevice::read"): "a loop calls it",
    ("Python", "ManualDevice::write"): "a loop calls it",
    ("Python", "ManualDevice::limits"): "inherited",
    ("Python", "ManualDevice::counts"): "inherited",
    **{("Python", f"DeviceSample.{n}"): "an argument of ManualDevice.set_pose()" for n in ("position", "turn", "buttons")},
    **{("Python", f"DeviceSample.{n}"): "DeviceCounts.received and DeviceWrench tell it" for n in ("time", "number")},
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
    ("C", "HapticDevice::destroy"): "C has no destructors",
    ("C", "HapticLoop::destroy"): "C has no destructors",
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
           "ProbeValue": "probe_value", "ToolForce": "tool_force", "BladeForce": "blade_force", "CutAttempt": "cut_attempt", "Interpenetration": "interpenetration", "PickedPoint": "picked_point", "LiveState": "live_state",
           "LiveOptions": "live_options", "Event": "event", "ForceSample": "force_sample", "HapticOptions": "haptic_options", "HapticSample": "haptic_sample",
           "HapticState": "haptic_state", "DeviceSample": "device_sample", "DeviceWrench": "device_wrench", "DeviceLimits": "device_limits",
           "DeviceCounts": "device_counts"}
CLASSES = {"World": "world", "HapticLoop": "haptic_loop", "HapticDevice": "haptic_device", "ManualDevice": "manual_device"}
C_NAMES = {"HapticDevice::open": "open_haptic_device"} | {f"{n}::create": f"{n}::{n}" for n in CLASSES}

# The classes of Python; other structs are dicts or arguments.
COMPARED = ("StepReport", "Frame", "HapticState", "HapticSample", "DeviceWrench", "DeviceLimits", "DeviceCounts", *CLASSES)


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
    """Of a struct; one line may declare several."""
    text = re.sub(r"^\s*(?:[A-Z]\w*\(|: ).*$", "", text, flags=re.M)  # constructors
    text = re.sub(r"\{[^{}]*\}|<[^<>]*>", "", text)
    return set(re.findall(r"(\w+)(?:\[\d+\]|\s*=[^;,]*)?[;,]", text))


def calls_of(headers, name):
    """The public calls of a class, its constructors by its own name."""
    public = block(headers, re.search(rf"class PLIANT_API {name}\b[^;{{]*", headers)[0]).split("private:")[0]
    public = re.sub(r"\)([\w\s]*)\{[^{}]*\}", r")\1;", public.replace("{}", ""))
    calls = re.findall(r"(?<![\w~:])(\w+)\([^;]*?\)\s*(?:const)?\s*(?:noexcept)?\s*(?:override|= 0|= default)?;", public)
    return {f"{name}::{n}" for n in calls}


def cpp():
    names = ("world", "scene", "frame", "probe", "tool", "world_types", "live", "haptics", "haptic_device")
    headers = re.sub(r"\[\[deprecated[^\n]*", "", "".join(code_of(f"include/pliant/{n}.h") for n in names))
    found = set().union(*(calls_of(headers, name) for name in CLASSES))
    found |= set(re.findall(r"^PLIANT_API .*?(\w+)\(", headers, re.M))
    wrench = members(block(code_of("include/pliant/wrench.h"), "struct Wrench "))
    for name in STRUCTS:
        found |= {f"{name}.{m}" for m in members(block(headers, f"struct {name} "))}
        if f"struct {name} : Wrench" in headers:
            found |= {f"{name}.{m}" for m in wrench}
    return found


def c():
    text = "".join(code_of(f"include/pliant/c/{n}.h") for n in ("pliant", "types", "state", "blades", "cut", "live", "haptics", "haptic_device"))
    found = set()
    for call in re.findall(r"^PLIANT_API .*?pliant_(\w+)\(", text, re.M):
        of = next((n for n, short in CLASSES.items() if call.startswith(short + "_")), None)
        name = call if of is None else f"{of}::{call[len(CLASSES[of]) + 1:]}"
        found.add(C_NAMES.get(name, name))
    for name, short in STRUCTS.items():
        for m in members(block(text, f"typedef struct pliant_{short} ")) - {"size", "reserved"}:
            range_of = re.fullmatch(r"(.*)(vertex|triangle)_(first|count)", m)
            if range_of and (range_of[3] == "first" or f"{range_of[1]}{range_of[2]}_first" not in text):
                m = range_of[1] + {"vertex": "vertices", "triangle": "triangles"}[range_of[2]]
            if not m.endswith("_count"):
                found.add(f"{name}.{m}")
    return found


def touch():
    """Of python/haptics.cpp: each class is bound by one expression."""
    text = code_of("python/haptics.cpp")
    found = set(re.findall(r'm\.def\("(\w+)"', text))
    for of, bound in re.findall(r"py::class_<(\w+)(.*?)(?=py::class_<|\n})", text.replace("m.def", ""), re.S):
        mark = "::" if of in CLASSES else "."
        found |= {f"{of}{mark}{n}" for n in re.findall(r'\.def(?:_readonly|_property_readonly)?\(\s*"([a-z]\w*)"', bound)}
        if "py::init" in bound:
            found.add(f"{of}::{of}")
    found |= {f"HapticOptions.{n}" for n in re.findall(r'\{"(\w+)", "\w+", put<', text)}
    return found


def python():
    text = "".join(code_of(f"python/{n}.cpp") for n in ("pliant", "tools", "live", "state"))
    define = r'\.def(?:_readonly|_property_readonly)?\(\s*"(\w+)"'
    live = block(text, "void bind_live(")
    world, module = block(text, "void bind_world(") + block(text, "void bind_tools(") + block(text, "void bind_state(") + live, block(text, "PYBIND11_MODULE(")
    found = {f"World::{n}" for n in re.findall(define, world)} | {"World::__init__"}
    found |= {f"World::{n}" for n in re.findall(r"^World\.([a-z]\w*) =", (SOURCE / "python/pliant/__init__.py").read_text(), re.M)}
    found |= set(re.findall(r'm\.def\("(\w+)"', module)) | set(re.findall(r'm\.attr\("(\w+)"\) =', module)) - {"__module__"}
    constructor = world[world.index("py::init"):world.index(".def_property_readonly")]
    found |= {f"WorldOptions.{n}" for n in re.findall(r'py::arg\("(\w+)"\)', constructor)} - {f"WorldOptions.{n}" for n in ("scene", "surfaces", "folder")}
    for name, function in {"StepReport": "bind_report", "Frame": "bind_frame"}.items():
        found |= {f"{name}.{n}" for n in re.findall(define, block(text, f"void {function}("))}
    for name, variable, function in (("WorldInfo", "d", "info"), ("BodyInfo", "body", "info"), ("CutResult", "d", "result"), ("PickedPoint", "d", "picked"),
                                     ("LiveState", "live", "live_state"), ("Event", "event", "events"), ("ToolForce", "tool", "tool_forces"), ("BladeForce", "blade", "blade_forces"), ("CutAttempt", "attempt", "cut_attempts"),
                                     ("Interpenetration", "found", "interpenetrations")):
        kind = "list" if name in ("Interpenetration", "Event", "CutAttempt") else "dict"
        found |= {f"{name}.{n}" for n in re.findall(rf'\b{variable}\["(\w+)"\] =', block(text, f"py::{kind} {function}("))}
    found |= {f"LiveOptions.{n}" for n in re.findall(r'py::arg\("(\w+)"\)', live[:live.index("stop_live")])}
    found |= touch()
    found |= {f"ForceSample.{n}" for n in re.findall(r'add\("(\w+)"', block(text, "py::dtype dtype_of_force_sample("))}
    return {PYTHON_NAMES.get(n, n) for n in found}


def module():
    """What the module itself holds, or None."""
    try:
        import pliant
    except ImportError:
        return None
    found = {n for n, v in vars(pliant).items() if not n.startswith("_") and not isinstance(v, type)} | {"__version__"}
    for name in COMPARED:
        kind = getattr(pliant, name)
        mark = "::" if name in CLASSES else "."
        found |= {f"{name}{mark}{n}" for n in vars(kind) if not n.startswith("_")}
        if name in CLASSES and name != "HapticDevice":
            found.add(f"{name}::{name}")
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
        said = {n for n in python() if "." not in n or n.split(".")[0] in COMPARED}  # others are dicts or arguments
        wrong += [f"the module and its source differ in {n}" for n in sorted(held ^ said)]
    print("the Python module " + ("is not there: only its source was read" if held is None else "holds what its source says"))
    if wrong:
        sys.exit("\n".join(wrong))


main()
