#!/usr/bin/env python3
"""`whit watch` shows what `whit render` renders, and shows it again whenever a file that the scene is made of changes."""
import itertools
import os
import signal
import subprocess
import sys
import time

import numpy
import OpenImageIO as oiio

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from watcher import BODY, SCENE, WHIT, Watcher, write  # noqa: E402

PROBLEMS = []
NUMBERS = itertools.count()


def expect(what, value, expected):
    if value != expected:
        PROBLEMS.append("%s: %s, expected %s" % (what, value, expected))


def rendered(watcher, *flags):
    """What `whit render` makes of the scene."""
    # Another file each time: of one that has changed within a second, OpenImageIO may show what it was.
    out = watcher.path("rendered%d.exr" % next(NUMBERS))
    subprocess.run([WHIT, "render", watcher.path("scene.pbrt"), "--quiet", "--display", "none", "--outfile", out, *flags],
                   check=True)
    return oiio.ImageBuf(out).get_pixels(oiio.FLOAT)[..., :3]


def expect_same(what, pixels, picture):
    # Both are half floats, of numbers that may differ in the order of their sums: a unit in the last place is 2^-10.
    worst = float(numpy.max(numpy.abs(pixels - picture) / (1e-3 + numpy.abs(picture))))
    if worst > 2 ** -9:
        PROBLEMS.append("%s: pixels differ by %g" % (what, worst))


def check_edits(watcher):
    state = watcher.done()
    before = watcher.pixels(state)
    expect_same("at first", before, rendered(watcher))
    expect("files", state["file_count"], 2)
    write(watcher.path("body.pbrt"), BODY.replace("0.5 0.25", "0.1 0.75"))
    state = watcher.done(state["reading"] + 1)
    after = watcher.pixels(state)
    expect("an include changes the picture", bool(numpy.any(before != after)), True)
    expect_same("after a change of an include", after, rendered(watcher))
    # In place, as some editors write.
    with open(watcher.path("scene.pbrt"), "w", encoding="utf-8") as f:
        f.write(SCENE.replace("fov\" 40", "fov\" 30"))
    state = watcher.done(state["reading"] + 1)
    expect_same("after a change in place", watcher.pixels(state), rendered(watcher))


def check_errors(watcher):
    state = watcher.done()
    before = watcher.pixels(state)
    write(watcher.path("body.pbrt"), BODY.replace("Shape", "Shpae"))
    state = watcher.wait_for(lambda s: s["stale"])
    problem = state["problems"][0]
    expect("file", os.path.basename(problem["where"]["file"]), "body.pbrt")
    expect("path", problem["where"]["path"], watcher.path("body.pbrt"))
    expect("place", [problem["where"]["line"], problem["where"]["column"]], [2, 1])
    expect("error", problem["error"], True)
    expect("remedy", "Shape" in problem["remedy"], True)
    expect("excerpt", 'Shpae "sphere" "float radius" 1' in problem["excerpt"], True)
    expect("the last good picture", bool(numpy.array_equal(watcher.pixels(state), before)), True)
    expect("not written then", bool(watcher.post("camera/write", {})["problem"]), True)
    # What is rendered past is a mistake too, and there is a picture.
    write(watcher.path("body.pbrt"), BODY.replace("radius", "raduis"))
    state = watcher.done(state["reading"] + 1)
    expect("a mistake", [[p["error"], p["where"]["line"], p["where"]["column"]] for p in state["problems"]], [[True, 2, 16]])
    write(watcher.path("body.pbrt"), BODY)
    state = watcher.done(state["reading"] + 1)
    expect("no problem any more", state["problems"], [])
    os.remove(watcher.path("body.pbrt"))
    state = watcher.wait_for(lambda s: s["stale"])
    expect("a file is gone", "body.pbrt" in state["problems"][0]["message"], True)
    write(watcher.path("body.pbrt"), BODY)
    expect("it is back", watcher.done(state["reading"] + 1)["stale"], False)


def check_many_errors(watcher):
    """50 are told, and how many more there are: 300 in all."""
    state = watcher.done()
    write(watcher.path("body.pbrt"), 'Shape "sphere" "float radius" "x"\n' * 300)
    state = watcher.wait_for(lambda s: s["stale"])
    expect("many errors", [len(state["problems"]), state["problems_left_out"]], [50, 250])
    write(watcher.path("body.pbrt"), BODY)
    watcher.done(state["reading"] + 1)


def check_missing_include():
    """An include that has never been there is waited for."""
    with Watcher(scene=SCENE.replace("body.pbrt", "later.pbrt")) as watcher:
        state = watcher.wait_for(lambda s: s["stale"])
        write(watcher.path("later.pbrt"), BODY)
        expect("it is there", watcher.done(state["reading"] + 1)["stale"], False)
        os.remove(watcher.path("scene.pbrt"))
        state = watcher.wait_for(lambda s: s["stale"])
        expect("no scene, no place", "where" in state["problems"][0], False)


def check_refines_beside_an_error():
    """A mistake in the text neither throws the picture away nor ends its refinement."""
    with Watcher(scene=SCENE.replace("pixelsamples\" 4", "pixelsamples\" 65536")) as watcher:
        state = watcher.wait_for(lambda s: s["samples"] >= 4)
        write(watcher.path("body.pbrt"), "Shpae\n")
        stale = watcher.wait_for(lambda s: s["stale"])
        expect("the picture stays", stale["samples"] >= state["samples"], True)
        later = watcher.wait_for(lambda s: s["samples"] > stale["samples"])
        expect("it goes on beside the mistake", later["stale"], True)
    # One that is finished stays finished.
    with Watcher() as watcher:
        number = watcher.done()["picture"]["number"]
        write(watcher.path("body.pbrt"), "Shpae\n")
        stale = watcher.wait_for(lambda s: s["stale"] and s["phase"] == "done")
        time.sleep(0.5)
        expect("no other picture", watcher.state()["picture"]["number"], number)


def check_ends_while_it_works():
    """A million spheres take seconds to read and to build; a signal ends it in a moment all the same."""
    scene = SCENE.replace('Include "body.pbrt"', 'Shape "sphere" "float radius" 1\n' * 1000000)
    for phase in ("reading", "building"):
        with Watcher(scene=scene) as watcher:
            try:
                watcher.wait_for(lambda s, phase=phase: s["phase"] in (phase, "rendering", "done"))
            finally:
                start = time.monotonic()
                expect("a signal while " + phase, watcher.end(signal.SIGINT), 0)
                expect("in a moment", time.monotonic() - start < 3, True)


def check_effects(watcher):
    state = watcher.done()
    before = watcher.pixels(state)
    write(watcher.path("body.pbrt"), BODY.replace("Material", 'LightSource "distant" "point from" [0 5 0]\nMaterial'))
    state = watcher.done(state["reading"] + 1)
    names = [e["name"] for e in state["effects"]]
    for name in ("diffuse", "delta-lights", "environment-lights", "shadows"):
        expect("effect " + name, name in names, True)
    watcher.post("effects", {"off": ["delta-lights"]})
    off = watcher.wait_for(lambda s: s["phase"] == "done" and any(e["off"] for e in s["effects"]))
    expect_same("without delta-lights", watcher.pixels(off), rendered(watcher, "--without", "delta-lights"))
    expect_same("which is as before", watcher.pixels(off), before)
    watcher.post("effects", {"off": []})
    on = watcher.wait_for(lambda s: s["phase"] == "done" and not any(e["off"] for e in s["effects"]))
    expect_same("with them", watcher.pixels(on), rendered(watcher))
    costs = watcher.wait_for(lambda s: all(e["cost"] is not None for e in s["effects"] if not e["why_off"]))
    expect("costs are shares", all(e["cost"] is None or e["cost"] < 1 for e in costs["effects"]), True)
    write(watcher.path("body.pbrt"), BODY)
    watcher.done(state["reading"] + 1)


def check_spot(watcher):
    import json
    watcher.done()
    spot = json.loads(watcher.get("at?x=32&y=24")[2])
    expect("hit", spot["hit"], True)
    expect("shape", [spot["shape"], os.path.basename(spot["shape_at"]["file"]), spot["shape_at"]["line"]],
           ["sphere", "body.pbrt", 2])
    expect("material", [spot["material_kind"], spot["material_at"]["line"]], ["matte", 1])
    # From (0, 0, -5) to the sphere of radius 1 around the origin.
    expect("depth", abs(spot["depth"] - 4) < 1e-5, True)
    expect("nothing", json.loads(watcher.get("at?x=1&y=1")[2])["hit"], False)


def check_camera(watcher):
    state = watcher.done()
    expect("where it is", [state["camera"]["eye"], state["camera"]["direction"], state["camera"]["moved"]],
           [[0, 0, -5], [0, 0, 1], False])
    watcher.post("camera", {"eye": [1, 0.5, -4], "direction": [-0.2, -0.1, 1], "up": [0, 1, 0]})
    state = watcher.wait_for(lambda s: s["camera"]["moved"] and s["phase"] == "done" and s["picture"]["done"])
    moved = watcher.pixels(state)
    expect("written", watcher.post("camera/write", {})["problem"], "")
    with open(watcher.path("scene.pbrt"), encoding="utf-8") as f:
        text = f.read()
    expect("the rest of the file stays", text.split("\n")[1:], SCENE.split("\n")[1:])
    numbers = [float(v) for v in text.split("\n")[0].split()[1:]]
    expect("the eye", numpy.allclose(numbers[:3], [1, 0.5, -4], atol=1e-9), True)
    state = watcher.done(state["reading"] + 1)
    expect("it is the file's now", state["camera"]["moved"], False)
    # Of another space that rounds otherwise: pixels at the sphere's outline may fall on its other side.
    now = watcher.pixels(state)
    expect("the same picture", float(numpy.mean(numpy.abs(now - moved))) < 2e-3, True)
    expect_same("which is the file's", now, rendered(watcher))
    write(watcher.path("scene.pbrt"), SCENE)
    watcher.done(state["reading"] + 1)


def check_files():
    """Textures, meshes and models with their buffers."""
    body = """Texture "t" "spectrum" "imagemap" "string filename" "t.png"
Material "matte" "texture Kd" "t"
Shape "plymesh" "string filename" "m.ply"
Material "matte"
"""
    ply = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property float u
property float v
element face 1
property list uchar int vertex_indices
end_header
-1 -1 0 0 0
%g -1 0 1 0
0 1 0 0 1
3 0 1 2
"""
    gltf = """{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"buffers": [{"uri": "the%20buffer.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}]}
"""

    def picture(watcher, colour):
        image = oiio.ImageBuf(oiio.ImageSpec(4, 4, 3, oiio.UINT8))
        oiio.ImageBufAlgo.fill(image, colour)
        image.write(watcher("t.new.png"))
        os.replace(watcher("t.new.png"), watcher("t.png"))

    def buffer(path, x):
        with open(path("b.new"), "wb") as f:
            f.write(numpy.array([-1, -1, 0, x, -1, 0, 0, 1, 0], dtype="<f4").tobytes())
        os.replace(path("b.new"), path("the buffer.bin"))

    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        def path(name):
            return os.path.join(folder, name)
        write(path("scene.pbrt"), SCENE)
        write(path("body.pbrt"), body + 'Translate 0 0 1\nShape "gltf" "string filename" "m.gltf"\n')
        write(path("m.ply"), ply % 1)
        write(path("m.gltf"), gltf)
        buffer(path, 1)
        picture(path, (0.2, 0.4, 0.6))
        with Watcher(folder=folder) as watcher:
            state = watcher.done()
            expect("problems", state["problems"], [])
            for what, change in {"texture": lambda: picture(path, (0.9, 0.1, 0.1)),
                                 "mesh": lambda: write(path("m.ply"), ply % 0.4),
                                 "buffer": lambda: buffer(path, 0.2),
                                 "model": lambda: write(path("m.gltf"), gltf.replace('"mesh": 0', '"mesh": 0, "scale": [2, 1, 1]'))
                                 }.items():
                before = watcher.pixels(state)
                change()
                state = watcher.done(state["reading"] + 1)
                after = watcher.pixels(state)
                expect("a %s changes the picture" % what, bool(numpy.any(before != after)), True)
                expect_same("after a change of a " + what, after, rendered(watcher))


def check_views(watcher):
    state = watcher.done()
    number, size = state["picture"]["number"], state["picture"]["width"] * state["picture"]["height"] * 3
    expect("views", "" in state["views"] and "sRGB" in state["views"] and "ACES SDR" in state["views"], True)
    plain = watcher.get("picture/%d?view=sRGB" % number)[2]
    expect("bytes", len(plain), size)
    brighter = watcher.get("picture/%d?view=sRGB&exposure=1" % number)[2]
    pixels = watcher.pixels(state)
    for what, data, gain in (("view", plain, 1), ("exposure", brighter, 2)):
        light = numpy.clip(pixels * gain, 0, 1)
        byte = numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055) * 255
        wrong = numpy.abs(numpy.frombuffer(data, dtype=numpy.uint8).reshape(byte.shape) - byte).max()
        expect(what, bool(wrong < 0.51), True)


def check_terminal():
    with Watcher() as watcher:
        watcher.done()
        for kind, start in (("blocks", b"\033[38;2;"), ("kitty", b"\033_Ga=T"), ("sixel", b"\033Pq")):
            drawn = subprocess.run([WHIT, "watch", "--terminal=" + kind, watcher.path("scene.pbrt")], capture_output=True,
                                   timeout=60, check=False)
            expect("--terminal=" + kind, [drawn.returncode, drawn.stdout.startswith(start)], [0, True])
        write(watcher.path("body.pbrt"), 'Shpae "sphere"\n')
        failed = subprocess.run([WHIT, "watch", "--terminal", watcher.path("scene.pbrt")], capture_output=True, timeout=60,
                                check=False, text=True)
        expect("with errors", [failed.returncode, "body.pbrt:1:" in failed.stderr], [3, True])


def main():
    with Watcher() as watcher:
        check_edits(watcher)
        write(watcher.path("scene.pbrt"), SCENE)
        write(watcher.path("body.pbrt"), BODY)
        watcher.wait_for(lambda s: s["phase"] == "done" and s["camera"]["text"].startswith("LookAt"))
    with Watcher() as watcher:
        for check in (check_errors, check_many_errors, check_effects, check_spot, check_camera, check_views):
            check(watcher)
    check_missing_include()
    check_refines_beside_an_error()
    check_ends_while_it_works()
    check_files()
    check_terminal()
    usage = subprocess.run([WHIT, "watch"], capture_output=True, check=False)
    expect("no scene", usage.returncode, 2)
    missing = subprocess.run([WHIT, "watch", "/nowhere/scene.pbrt"], capture_output=True, check=False)
    expect("no such scene", missing.returncode, 4)
    for line in PROBLEMS:
        print(line)
    sys.exit(1 if PROBLEMS else 0)


if __name__ == "__main__":
    main()
