#!/usr/bin/env python3
"""Scenes of many kinds that need more than 1 GiB of memory, each with the flags that it is rendered with.

Each maker writes its files into a folder and returns the scene's text; SCENES has all of them by name. What they take is
measured by memory_refusal_test.py. `large_scenes.py NAME FOLDER` writes one.
"""
import json
import math
import os
import struct
import sys
import zlib

import numpy as np
import OpenImageIO as oiio

HEAD = """Film "image" "integer xresolution" [%d] "integer yresolution" [%d] "string filename" ["x.exr"]
Sampler "halton" "integer pixelsamples" [1]
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
Integrator "path" "integer maxdepth" [2]
"""
SUN = 'LightSource "distant" "point from" [1 1 3] "point to" [0 0 0]\n'
QUAD = '"float uv" [0 0 1 0 1 1 0 1] "integer indices" [0 1 2 0 2 3]\n'


def scene(body, film=(64, 64), head="", light=SUN):
    return HEAD % film + head + "WorldBegin\n" + light + body + "WorldEnd\n"


class Folder:
    """Where the files of a scene go."""

    def __init__(self, path):
        self.path = path

    def at(self, name):
        return os.path.join(self.path, name)

    def write(self, name, *parts):
        with open(self.at(name), "wb") as f:
            for part in parts:
                f.write(part.encode() if isinstance(part, str) else part)


# Films: 48 bytes of sums for each pixel of each tile's reach, 12 of the picture, and what AOVs have.


def film(width, height, head='PixelFilter "box"\n', body='Shape "sphere"\n'):
    return lambda folder: scene(body, (width, height), head)


def many_things(count, statement='Shape "sphere" "float radius" .012\n'):
    """A wall of small things, each of a shape, an object or a material of its own, as the statement has it."""
    side = math.ceil(count ** 0.5)
    return "".join("AttributeBegin\nTranslate %.5g %.5g 0\n%sAttributeEnd\n" % (
        i % side / side * 3.6 - 1.8, i // side / side * 3.6 - 1.8, statement.replace("#", str(i))) for i in range(count))


def light_groups(folder):
    lights = "".join('LightSource "point" "point from" [%d 1 3] "string lightgroup" "g%d"\n' % (i, i) for i in range(6))
    return scene(lights + 'Shape "sphere"\n', (2600, 2600), 'PixelFilter "box"\n')


# Meshes.


def grid(side):
    """Vertices (rows of x y z) and triangles (rows of three numbers) of a wavy sheet of side x side cells."""
    y, x = np.mgrid[0:side + 1, 0:side + 1]
    points = np.stack([2 * x / side - 1, 2 * y / side - 1, 0.05 * ((x * 7 + y * 13) % 5)], -1).reshape(-1, 3)
    a = (y * (side + 1) + x)[:-1, :-1].reshape(-1, 1)
    return points.astype("f4"), np.hstack([a, a + 1, a + side + 2, a, a + side + 2, a + side + 1]).reshape(-1, 3).astype("i4")


def ply_head(vertices, faces, properties, kind="binary_little_endian"):
    return ("ply\nformat %s 1.0\nelement vertex %d\n" % (kind, vertices) +
            "".join("property float %s\n" % p for p in properties) +
            "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % faces)


def ply_parts(side, properties="x y z", quads=False):
    """A sheet of side x side cells as the parts of a file; properties beyond x y z are 0.25."""
    names = properties.split()
    points, corners = grid(side)
    rows = np.full((len(points), len(names)), 0.25, "f4")
    rows[:, :3] = points
    if quads:
        corners = corners.reshape(-1, 6)[:, [0, 1, 2, 5]]
    faces = np.empty(len(corners), [("n", "u1"), ("corners", "i4", corners.shape[1])])
    faces["n"], faces["corners"] = corners.shape[1], corners
    return ply_head(len(points), len(faces), names), rows.tobytes(), faces.tobytes()


def ply(side, properties="x y z", quads=False, body='Shape "plymesh" "string filename" "m.ply"\n', head="", size=(64, 64)):
    def make(folder):
        folder.write("m.ply", *ply_parts(side, properties, quads))
        return scene(body, size, head)
    return make


def list_of(numbers, form="%.4g"):
    """Rows of numbers as text, with a line for each."""
    rows = numbers.tolist()
    return ((" ".join([form] * len(rows[0])) + "\n") * len(rows)) % tuple(n for row in rows for n in row)


def ply_ascii(folder):
    points, corners = grid(2300)
    folder.write("m.ply", ply_head(len(points), len(corners), "xyz", "ascii"), list_of(points),
                 list_of(np.insert(corners, 0, 3, 1), "%d"))
    return scene('Shape "plymesh" "string filename" "m.ply"\n')


def mesh_text(side, more="", repeat=0):
    """A mesh in the text; `more` with # for `repeat` numbers of each vertex."""
    points, corners = grid(side)
    return 'Shape "trianglemesh" "point P" [%s] "integer indices" [%s] %s\n' % (
        list_of(points), list_of(corners, "%d"), more.replace("#", ".25 .5 .75 " * (repeat * (side + 1) ** 2)))


def heightfield(side):
    heights = " ".join(str(i * 7 % 10 / 100) for i in range(1000))
    return 'Shape "heightfield" "integer nu" %d "integer nv" %d "float Pz" [%s]\n' % (
        side, side, " ".join([heights] * (side * side // 1000)))


OCTAHEDRON = 'Shape "loopsubdiv" "integer nlevels" %d "point P" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1] ' \
             '"integer indices" [0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5]\n'
NURBS = ('Shape "nurbs" "integer nu" 4 "integer nv" 4 "integer uorder" 4 "integer vorder" 4 "float uknots" [0 0 0 0 1 1 1 1] '
         '"float vknots" [0 0 0 0 1 1 1 1] "point P" [%s]\n' % " ".join("%g %g %g" % (x, y, (x * y) % 3 * .1)
                                                                      for y in range(4) for x in range(4)))
MOVES = "ActiveTransform EndTime\nTranslate .1 0 0\nRotate 20 0 0 1\nActiveTransform All\n"
SHUTTER = "TransformTimes 0 1\n"


def objects(count, inside, places=1):
    text = "".join('ObjectBegin "o%d"\n%sObjectEnd\n' % (i, inside) for i in range(count))
    return text + "".join('AttributeBegin\nTranslate %.4g %.4g 0\nObjectInstance "o%d"\nAttributeEnd\n' % (
        i % 100 / 50 - 1, i // 100 % 100 / 50 - 1, i % count) for i in range(count * places))


SHEET = 'Shape "trianglemesh" "point P" [%s] "integer indices" [%s]\n' % tuple(
    list_of(numbers, form) for numbers, form in zip(grid(6), ("%.4g", "%d")))
ONE_TRIANGLE = 'Shape "trianglemesh" "point P" [0 0 0 .01 0 0 0 .01 0] "integer indices" [0 1 2]\n'


# Curves.


def hair(count, more=""):
    return "".join('Shape "curve" "float width" 0.002 "point P" [%.4g %.4g 0 %.4g %.4g .1 %.4g %.4g .2 %.4g %.4g .3] %s\n' % (
        x, y, x, y + .01, x + .01, y, x + .01, y + .01, more)
                   for x, y in (((i % 600) / 300 - 1, (i // 600) / 500 - 1) for i in range(count)))


def long_hair(count, more=""):
    return 'Shape "curve" "string basis" "bspline" "float width" 0.002 %s "point P" [%s]\n' % (more, " ".join(
        "%g %g %g" % ((i * 37 % 200) / 100 - 1, (i * 53 % 200) / 100 - 1, i % 7 / 7) for i in range(count)))


# Pictures.


def png(width, height, depth=8, interlaced=False, channels=3):
    """The bytes of a PNG file with few different rows."""
    row = bytes(b for x in range(width) for b in [x * 7 % 251] * (channels * depth // 8))
    kind = {1: 0, 3: 2, 4: 6}[channels]
    pack = zlib.compressobj(1)

    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    if interlaced:
        data = []
        for x0, y0, dx, dy in ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)):
            part = row[:-(-(width - x0) // dx) * channels * depth // 8]
            data.extend(pack.compress(b"\0" + part) for _ in range(y0, height, dy))
    else:
        data = [pack.compress(b"\0" + row) for _ in range(height)]
    body = b"".join(data) + pack.flush()
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, int(interlaced))) +
            chunk(b"IDAT", body) + chunk(b"IEND", b""))


def pfm(width, height):
    row = (np.arange(3 * width, dtype="f4") % 97 / 97).tobytes()
    return b"PF\n%d %d\n-1.0\n" % (width, height) + row * height


def by_oiio(folder, name, width, height, kind, tile=0):
    """A picture in a format that OpenImageIO writes."""
    spec = oiio.ImageSpec(width, height, 3, kind)
    if tile:
        spec.tile_width = spec.tile_height = tile
    out = oiio.ImageOutput.create(folder.at(name))
    rows = np.tile((np.arange(width, dtype="f4") % 97 / 97)[None, :, None], (height, 1, 3))
    if not out.open(folder.at(name), spec) or not out.write_image(rows):
        raise RuntimeError(out.geterror())
    out.close()


def shown(names, kind="spectrum", more=""):
    """A wall of squares, each of which shows the finest level of one of the pictures."""
    side = math.ceil(len(names) ** 0.5)
    text = ""
    for i, name in enumerate(names):
        x, y = i % side, i // side
        text += 'Texture "t%d" "%s" "imagemap" "string filename" "%s" "float uscale" .01 "float vscale" .01 %s\n' % (
            i, kind, name, more)
        text += 'Material "matte" "texture %s" "t%d"\n' % ("Kd" if kind == "spectrum" else "bumpmap", i)
        corners = [(4 / side * (x + a) - 2, 4 / side * (y + b) - 2) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        text += 'Shape "trianglemesh" "point P" [%s] ' % " ".join("%g %g 0" % c for c in corners) + QUAD
    return text


BIG_FILM = ((4300, 4300), 'PixelFilter "box"\n')


def pictures(count, make, size=BIG_FILM[0], **more):
    """So many pictures, each made by `make(folder, name)`, which ends in the name's ending."""
    def maker(folder):
        names = [make(folder, "t%d" % i) for i in range(count)]
        return scene(shown(names, **more), size, 'PixelFilter "box"\n')
    return maker


def png_file(width, height, **more):
    def make(folder, name):
        folder.write(name + ".png", png(width, height, **more))
        return name + ".png"
    return make


def pfm_file(width, height):
    def make(folder, name):
        folder.write(name + ".pfm", pfm(width, height))
        return name + ".pfm"
    return make


def oiio_file(ending, width, height, kind, tile=0):
    def make(folder, name):
        by_oiio(folder, name + ending, width, height, kind, tile)
        return name + ending
    return make


def lit_by(light, make, body='Shape "sphere"\n'):
    def maker(folder):
        return scene(body, light='LightSource "%s" "string mapname" "%s"\n' % (light, make(folder, "sky")))
    return maker


# Models.


def model(side, picture=None, places=1, binary=False):
    """A glTF model of a sheet, that many times, with a picture inside."""
    def maker(folder):
        points, corners = grid(side)
        count = len(points)
        parts = [points.tobytes(), np.tile(np.float32([0, 0, 1]), count).tobytes(),
                 np.tile(np.float32([.25, .5]), count).tobytes(), corners.tobytes()]
        if picture:
            parts.append(picture())
        starts = [sum(map(len, parts[:i])) for i in range(len(parts))]
        document = {
            "asset": {"version": "2.0"}, "buffers": [{"uri": "m.bin", "byteLength": sum(map(len, parts))}],
            "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": len(part)} for at, part in zip(starts, parts)],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": [-1, -1, 0],
                           "max": [1, 1, .2]}, {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3"},
                          {"bufferView": 2, "componentType": 5126, "count": count, "type": "VEC2"},
                          {"bufferView": 3, "componentType": 5125, "count": corners.size, "type": "SCALAR"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3}]}],
            "nodes": [{"mesh": 0, "translation": [i * .01, 0, 0]} for i in range(places)],
            "scenes": [{"nodes": list(range(places))}], "scene": 0}
        if picture:
            document["images"] = [{"bufferView": 4, "mimeType": "image/png"}]
            document["textures"] = [{"source": 0}]
            document["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
            document["meshes"][0]["primitives"][0]["material"] = 0
        if binary:
            del document["buffers"][0]["uri"]
            text = json.dumps(document).encode()
            text += b" " * (-len(text) % 4)
            data = b"".join(parts)
            data += b"\0" * (-len(data) % 4)
            folder.write("m.glb", struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A), text,
                         struct.pack("<II", len(data), 0x004E4942), data)
        else:
            folder.write("m.bin", *parts)
            folder.write("m.gltf", json.dumps(document))
        return scene('Shape "gltf" "string filename" "m.%s"\n' % ("glb" if binary else "gltf"),
                     *(BIG_FILM if picture else ()))
    return maker


def bsdf(folder):
    """A tabulated BSDF: 200 angles, a series of 2400 terms for each pair."""
    mu, terms = 220, 2500
    count = mu * mu * terms
    head = b"SCATFUN\x01" + struct.pack("<9if4i", 1, mu, count, terms, 1, 1, 0, 0, 0, 1.0, 0, 0, 0, 0)
    cosines = np.linspace(-1, 1, mu, dtype="f4")
    distribution = np.tile(np.linspace(0, 1, mu, dtype="f4"), mu)
    offsets = np.stack([np.arange(mu * mu) * terms, np.full(mu * mu, terms)], -1).astype("i4")
    series = np.zeros(terms, "f4")
    series[0] = 0.3
    folder.write("m.bsdf", head, *(part.tobytes() for part in (cosines, distribution, offsets)), series.tobytes() * (mu * mu))
    return scene('Material "fourier" "string bsdffile" "m.bsdf"\nShape "sphere" "float radius" .01\n', (3600, 3600), 'PixelFilter "box"\n')


def mixture(folder):
    folder.write("m.ply", *ply_parts(700, "x y z nx ny nz"))
    folder.write("sky.pfm", pfm(4096, 2048))
    folder.write("t.png", png(4096, 4096))
    return scene(shown(["t.png"]) + 'Shape "plymesh" "string filename" "m.ply"\n' + hair(30000), (4500, 4500),
                 light='LightSource "infinite" "string mapname" "sky.pfm"\n')


def text_of(make, size=(64, 64), head=""):
    """For scenes that are text alone; made when asked for."""
    return lambda folder: scene(make(), size, head)


def comments(folder):
    line = "# " + "x" * 997 + "\n"
    return scene(line * 700000 + 'Shape "sphere"\n', (4600, 4600), 'PixelFilter "box"\n')


BALLS = 'Shape "sphere" "float radius" .036\n'
BOX = 'PixelFilter "box"\n'
AOVS = [x for name in ("N", "albedo", "Z", "variance") for x in ("--aov", name)]

# By name: what makes each, the flags it is rendered with.
SCENES = {
    "film": (film(5500, 5500), []),
    "film_mitchell": (film(4300, 4300, 'PixelFilter "mitchell"\n'), []),
    "film_png": (film(5500, 5500), ["-o", "x.png"]),
    "film_tiff": (film(5500, 5500), ["-o", "x.tif"]),
    "film_float": (film(5500, 5500), ["--type", "float"]),
    "film_crop": (film(12000, 12000), ["--cropwindow", "0.2", "0.7", "0.1", "0.6"]),
    "film_quick": (film(20000, 20000), ["--quick"]),
    "film_wide": (film(2000, 2000, 'PixelFilter "gaussian" "float xwidth" 18 "float ywidth" 18\n'), []),
    "film_wider": (film(300, 300, 'PixelFilter "gaussian" "float xwidth" 110 "float ywidth" 110\n'), []),
    "film_aovs": (film(2600, 2600), AOVS),
    "film_variance": (film(3600, 3600), ["--aov", "variance"]),
    "film_mattes": (film(3000, 3000, BOX, many_things(2500, BALLS)), ["--aov", "shape", "--spp", "4"]),
    "film_mattes3": (film(2300, 2300, "", many_things(2500, BALLS)), ["--aov", "shape", "--aov", "material"]),
    "film_parts": (film(3000, 3000), [x for n in ("emission", "direct", "indirect", "P") for x in ("--aov", n)]),
    "film_groups": (light_groups, ["--aov", "lightgroups"]),
    "film_adaptive": (film(2600, 2600), ["--target-error", "50%"]),
    "film_in_time": (film(3000, 3000), ["--time-limit", "20s"]),
    "film_checkpoint": (film(5000, 5000), ["--checkpoint", "x.whit", "--every", "1s"]),
    "film_denoised": (film(2500, 2500), ["--denoise"]),
    "film_threads": (film(4600, 4600), ["--nthreads", "16"]),
    "film_worlds": (lambda folder: film(4600, 4600)(folder) + film(4600, 4600)(folder)[len(HEAD % (4600, 4600)):], []),

    "ply": (ply(2300), []),
    "ply_normals": (ply(2300, "x y z nx ny nz u v"), []),
    "ply_colours": (ply(2400, "x y z red green blue"), []),
    "ply_quads": (ply(2300, quads=True), []),
    "ply_ascii": (ply_ascii, []),
    "ply_twice": (ply(1700, body='Shape "plymesh" "string filename" "m.ply"\n' * 2), []),
    "ply_pieces": (ply(150, body='Shape "plymesh" "string filename" "m.ply"\nTranslate .01 .02 0\n' * 260), []),
    "ply_moving": (ply(2400, body=MOVES + 'Shape "plymesh" "string filename" "m.ply"\n', head=SHUTTER), []),
    "ply_alpha": (ply(2300, "x y z u v", body='Texture "a" "float" "checkerboard" "float tex1" 0 "float tex2" 1\n'
                      'Shape "plymesh" "string filename" "m.ply" "texture alpha" "a"\n'), []),
    "ply_emits": (ply(640, body='AreaLightSource "diffuse"\nShape "plymesh" "string filename" "m.ply"\n'), []),
    "ply_film": (ply(1600, size=(3600, 3600), head=BOX), []),
    "text": (text_of(lambda: mesh_text(2200)), []),
    "text_normals": (text_of(lambda: mesh_text(1900, '"normal N" [#] "vector S" [#]', 1)), []),
    "heightfield": (text_of(lambda: heightfield(2500)), []),
    "loopsubdiv": (text_of(lambda: OCTAHEDRON % 10 + 'Translate 1 0 0\n' + OCTAHEDRON % 10), []),
    "nurbs": (text_of(lambda: (NURBS + 'Translate 4 0 0\n') * 5500), []),

    "spheres": (text_of(lambda: many_things(500000)), []),
    "triangles": (text_of(lambda: many_things(400000, ONE_TRIANGLE)), []),
    "moving_spheres": (text_of(lambda: MOVES + many_things(110000), head=SHUTTER), []),
    "materials": (text_of(lambda: many_things(340000, 'Material "plastic" "rgb Kd" [.1 .2 .3]\nShape "sphere" "float radius" .01\n')),
                  []),
    "named_materials": (text_of(lambda: many_things(330000, 'MakeNamedMaterial "m#" "string type" "uber"\nNamedMaterial "m#"\n'
                                                    'Shape "sphere" "float radius" .01\n')), []),
    "textures": (text_of(lambda: many_things(260000, 'Texture "t#" "spectrum" "checkerboard"\nMaterial "matte" "texture Kd" "t#"\n'
                                             'Shape "sphere" "float radius" .01\n')), []),
    "point_lights": (text_of(lambda: many_things(800000, 'LightSource "point"\n') + 'Shape "sphere"\n'), []),
    "lamps": (text_of(lambda: many_things(300000, 'AreaLightSource "diffuse"\nShape "sphere" "float radius" .01\n')), []),
    "instances": (text_of(lambda: objects(1, ONE_TRIANGLE, 2500000)), []),
    "instances_mesh": (text_of(lambda: objects(1, OCTAHEDRON % 8, 1700000)), []),
    "instances_moving": (text_of(lambda: MOVES + objects(1, SHEET, 200000), head=SHUTTER), []),
    "objects": (text_of(lambda: objects(100000, SHEET)), []),
    "object_spheres": (text_of(lambda: objects(140000, 'Shape "sphere" "float radius" .02\n', 3)), []),

    "hair": (text_of(lambda: hair(350000)), []),
    "hair_cylinders": (text_of(lambda: hair(350000, '"string type" "cylinder"')), []),
    "hair_ribbons": (text_of(lambda: hair(350000, '"string type" "ribbon" "normal N" [0 0 1 0 0 1]')), []),
    "hair_long": (text_of(lambda: long_hair(1200000)), []),
    "hair_ribbon": (text_of(lambda: long_hair(950000, '"string type" "ribbon" "normal N" [%s]' % ("0 0 1 " * 949998))), []),
    "hair_fine": (text_of(lambda: long_hair(290000, '"integer splitdepth" 6')), []),
    "hair_moving": (text_of(lambda: MOVES + hair(110000), head=SHUTTER), []),
    "hair_object": (text_of(lambda: objects(2, hair(165000), 20)), []),

    "png": (pictures(1, png_file(8192, 8192)), []),
    "pngs": (pictures(9, png_file(3000, 3000)), []),
    "png_16": (pictures(4, png_file(4096, 4096, depth=16)), []),
    "png_grey": (pictures(9, png_file(4000, 4000, channels=1)), []),
    "png_interlaced": (pictures(1, png_file(19000, 19000, interlaced=True), size=(64, 64)), []),
    "png_more": (pictures(4, png_file(8192, 8192)), ["--texture-memory", "2048"]),
    "png_little": (pictures(4, png_file(4096, 4096), size=(5000, 5000)), ["--texture-memory", "64"]),
    "bump": (pictures(4, png_file(4096, 4096), kind="float"), []),
    "exr_half": (pictures(4, oiio_file(".exr", 4096, 4096, "half")), []),
    "exr_float": (pictures(4, oiio_file(".exr", 4096, 4096, "float")), []),
    "exr_tiled": (pictures(4, oiio_file(".exr", 4096, 4096, "half", 64)), []),
    "hdr": (pictures(4, oiio_file(".hdr", 4096, 4096, "float")), []),
    "tiff": (pictures(4, oiio_file(".tif", 4096, 4096, "uint8")), []),
    "jpeg": (pictures(4, oiio_file(".jpg", 4096, 4096, "uint8")), []),
    "pfm": (pictures(2, pfm_file(4096, 4096)), []),
    "sky_png": (lit_by("infinite", png_file(9000, 4500)), []),
    "sky_pfm": (lit_by("infinite", pfm_file(9000, 4500)), []),
    "sky_exr": (lit_by("infinite", oiio_file(".exr", 9000, 4500, "half")), []),
    "sky_hdr": (lit_by("infinite", oiio_file(".hdr", 9000, 4500, "float")), []),
    "skybox": (lit_by("skybox", pfm_file(9000, 5000)), []),
    "projection": (lambda folder: scene('Shape "sphere"\n', *BIG_FILM, light='LightSource "projection" "string mapname" "%s"\n' %
                                        png_file(8192, 8192)(folder, "p")), []),

    "gltf": (model(2150), []),
    "gltf_placed": (model(2150, places=50), []),
    "glb": (model(2150, binary=True), []),
    "gltf_picture": (model(300, lambda: png(8192, 8192)), []),
    "glb_picture": (model(300, lambda: png(8192, 8192), binary=True), []),

    "bsdf": (bsdf, []),
    "comments": (comments, []),
    "mixture": (mixture, []),
}

# Those whose textures are more than --texture-memory.
CAPPED = {"pngs", "exr_float", "hdr"}


def main():
    """large_scenes.py NAME FOLDER: writes NAME.pbrt and its files."""
    name, folder = sys.argv[1], Folder(sys.argv[2])
    folder.write(name + ".pbrt", SCENES[name][0](folder))


if __name__ == "__main__":
    main()
