"""What an installed wheel loads: nothing of its libraries from the system. Called by ./dev wheel."""
import sys

import pliant

assert pliant.__file__.startswith(sys.prefix), pliant.__file__
backends = pliant.backends()
assert "cpu" in backends, backends
scene = {"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "bodies": [{
    "name": "block", "surface": "memory:0", "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.45}}]}
box = ([[x, y, z] for z in (0, 0.06) for y in (0, 0.08) for x in (0, 0.1)],
       [[0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6]])
hashes = {}
for backend in backends:
    if backend not in ("cpu:double", "cpu:check"):
        world = pliant.World(scene, [box], backend=backend)
        world.step(100)
        hashes[backend] = world.hash()
assert len(set(hashes.values())) == 1, hashes
world.add_tool({"name": "ball", "shape": {"sphere": 0.02}, "path": [[0, 0.05, 0.3, 0.03]]})
assert world.tool_forces()["ball"]["position"].tolist() == [0.05, 0.3, 0.03], "arrays are right with the newest NumPy, too"
with open("/proc/self/maps") as maps:
    loaded = {line.split()[-1] for line in maps if ".so" in line}
own = [f for f in loaded if any(f"/lib{name}" in f for name in ("assimp", "fmt", "pugixml", "embree", "tbb", "OpenCL"))]
foreign = [f for f in own if not f.startswith(sys.prefix)]
assert own and not foreign, foreign
print(f"{', '.join(hashes)}: the same bits; {len(own)} libraries from the wheel, none of them from the system")
