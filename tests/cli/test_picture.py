#!/usr/bin/env python3
"""Pictures and animations of a run: complete files, what the options do, and what is said when they cannot be had."""
import json
import struct
import subprocess
import zlib

from harness import PLIANT, CliTest, main


def png(path):
    """Width, height and the raw rows of a PNG with 8-bit RGB; checks every chunk's sum."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed, size, last = 8, b"", None, None
    while at < len(data):
        (length,), kind = struct.unpack(">I", data[at : at + 4]), data[at + 4 : at + 8]
        body = data[at + 8 : at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length : at + 12 + length])[0], (path, kind)
        if kind == b"IHDR":
            size = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            packed += body
        at, last = at + 12 + length, kind
    assert last == b"IEND" and size[2:] == (8, 2), (path, last, size)
    raw = zlib.decompress(packed)
    assert len(raw) == size[1] * (1 + 3 * size[0]), path
    return size[0], size[1], raw


def glb(path):
    data = path.read_bytes()
    magic, version, total, text, kind = struct.unpack("<4sIII4s", data[:20])
    assert (magic, version, total, kind) == (b"glTF", 2, len(data), b"JSON"), path
    document = json.loads(data[20 : 20 + text])
    size, kind = struct.unpack("<I4s", data[20 + text : 28 + text])
    assert kind == b"BIN\0" and 28 + text + size == len(data), path
    assert document["buffers"][0]["byteLength"] == size
    for view in document["bufferViews"]:
        assert view["byteOffset"] % 4 == 0 and view["byteOffset"] + view["byteLength"] <= size
    return document


class Picture(CliTest):
    def has_pictures(self):
        """Whether this build draws. If not, it must say why and what it has instead."""
        command = ["run", self.scene("probe"), "--steps", 0, "--out", "probe", "--format", "png", "--size", "16x16", "--samples", 1]
        done = subprocess.run([PLIANT, *map(str, command)], capture_output=True, text=True, cwd=self.folder, timeout=500)
        if done.returncode == 0:
            return True
        self.assertEqual(done.returncode, 2)
        self.assertIn("Embree", done.stderr)
        self.assertIn("allowed are vtu, obj, gltf", done.stderr)
        return False

    def test_frames(self):
        if not self.has_pictures():
            self.skipTest("a build without Embree")
        scene = self.scene()
        run = ["run", scene, "--seconds", 0.05, "--every", 50, "--format", "png,gltf", "--size", "64x48", "--samples", 2]
        first = self.json(*run, "--out", "a")
        frames = [name for name in self.names("a") if name.endswith(".png")]
        self.assertEqual(len(frames), first["frames"])
        self.assertEqual(self.names("a"), sorted(frames + ["scene.glb"]))
        rows = [png(self.folder / "a" / name) for name in frames]
        self.assertEqual({(w, h) for w, h, _ in rows}, {(64, 48)})
        self.assertNotEqual(rows[0][2], rows[-1][2])
        document = glb(self.folder / "a" / "scene.glb")
        self.assertEqual(len(document["meshes"][0]["primitives"][0]["targets"]), len(frames) - 1)
        # The same again, byte by byte.
        self.pliant(*run, "--out", "b")
        for name in self.names("a"):
            self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "b" / name).read_bytes(), name)

    def test_colours(self):
        if not self.has_pictures():
            self.skipTest("a build without Embree")
        seen = {}
        for color in ["none", "displacement", "energy", "mises", "green_strain", "almansi_strain", "pressure", "model"]:
            self.pliant("run", self.scene(), "--steps", 200, "--every", 200, "--out", color, "--format", "png", "--size", "64x48",
                        "--samples", 1, "--color", color)
            seen[color] = png(self.folder / color / self.names(color)[-1])[2]
        self.assertEqual(len(set(seen.values())), 8)

    def test_view(self):
        if not self.has_pictures():
            self.skipTest("a build without Embree")
        pictures = []
        for i, view in enumerate([{}, {"eye": [0, 0.3, 0.5]}, {"up": [1, 0, 0]}, {"field_of_view": 60, "eye": [0, 0.3, 0.5]},
                                  {"ground": False}]):
            self.pliant("run", self.scene(view=view), "--steps", 0, "--out", f"v{i}", "--format", "png", "--size", "48x48", "--samples", 1)
            pictures.append(png(self.folder / f"v{i}" / self.names(f"v{i}")[0])[2])
        self.assertEqual(len(set(pictures)), 5)
        self.refused("info", self.scene(view={"eye": [1, 2]}), words=["/view/eye"])
        self.refused("info", self.scene(view={"up": [0, 0, 0]}), words=["/view/up", "not all zero"])
        self.refused("info", self.scene(view={"field_of_view": 0}), words=["/view/field_of_view", "1 <= field_of_view <= 120"])
        self.refused("info", self.scene(view={"ground": 0}), words=["/view/ground", "true or false"])
        self.refused("info", self.scene(view={"eye": [1, 1, 1], "target": [1, 1, 1]}), words=["/view/eye", "other than the target"])

    def test_words(self):
        scene = self.scene()
        start = ["run", scene, "--steps", 0, "--out", "x", "--format"]
        self.refused(*start, "gif", words=["gif", "vtu, obj, png, gltf"])
        self.refused(*start, "vtu", "--color", "mises", words=["--color", "--format png"])
        if not self.has_pictures():
            return
        self.refused(*start, "png", "--size", "12", words=["--size", "1280x720"])
        self.refused(*start, "png", "--size", "10x10", words=["16 to 8192"])
        self.refused(*start, "png", "--color", "missed", words=["missed", "did you mean mises?"])
        self.refused(*start, "png", "--color", "mises", "--range", "5,1", words=["--range", "ascending"])
        self.refused(*start, "png", "--range", "0,1", words=["--range", "--color"])


if __name__ == "__main__":
    main()
