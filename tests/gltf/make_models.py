#!/usr/bin/env python3
"""Writes small glTF models, one for each feature that whit reads, for tests and to look at.

    tests/gltf/make_models.py FOLDER [NAME...]

A model is a function below; its name is the file's, its docstring says what a picture of it shows. They are plain JSON and
bytes, so that what is tested is the reader and no other library's idea of the format.
"""
import base64
import json
import math
import os
import struct
import sys
import zlib

import numpy as np

FLOAT, UBYTE, BYTE, USHORT, SHORT, UINT = 5126, 5121, 5120, 5123, 5122, 5125
DTYPES = {FLOAT: "<f4", UBYTE: "u1", BYTE: "i1", USHORT: "<u2", SHORT: "<i2", UINT: "<u4"}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
QUAD = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
QUAD_UV = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], float)  # v points down: the picture stands upright
QUAD_INDICES = [0, 1, 2, 0, 2, 3]


def png(pixels):
    """A PNG file of an array height x width x 1, 3 or 4 of bytes."""
    h, w, channels = pixels.shape
    rows = b"".join(b"\0" + pixels[y].astype("u1").tobytes() for y in range(h))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    kind = {1: 0, 3: 2, 4: 6}[channels]
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", w, h, 8, kind, 0, 0, 0)) + \
        chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def picture(channels=3, size=32):
    """Four quarters: red, green, blue (top left, top right, bottom left), grey steps; alpha falls to the right."""
    p = np.zeros((size, size, channels), int)
    half = size // 2
    p[:half, :half, 0] = 230
    p[:half, half:, 1] = 200
    p[half:, :half, 2] = 240
    p[half:, half:, :3] = (np.arange(half) * 255 // half)[:, None]
    if channels == 4:
        p[:, :, 3] = 255 - np.arange(size)[None, :] * 255 // (size - 1)
    return p


class Model:
    """A document under construction; see add() for what a mesh is made of."""

    def __init__(self, camera=True):
        self.bytes = bytearray()
        self.doc = {"asset": {"version": "2.0", "generator": "whit's tests"}, "scene": 0,
                    "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "accessors": [], "bufferViews": []}
        if camera:
            self.camera()

    def put(self, key, value):
        """Adds to one of the document's lists; its index."""
        self.doc.setdefault(key, []).append(value)
        return len(self.doc[key]) - 1

    def use(self, extension, required=False):
        for key in ["extensionsUsed"] + (["extensionsRequired"] if required else []):
            if extension not in self.doc.setdefault(key, []):
                self.doc[key].append(extension)

    def view(self, data, **more):
        while len(self.bytes) % 4:
            self.bytes.append(0)
        at = len(self.bytes)
        self.bytes += data
        return self.put("bufferViews", {"buffer": 0, "byteOffset": at, "byteLength": len(data), **more})

    def accessor(self, values, component=FLOAT, **more):
        a = np.asarray(values)
        a = a.reshape(len(a), -1)
        stored = a.astype(DTYPES[component])
        row = stored.tobytes()
        if stored.itemsize * a.shape[1] % 4 and a.shape[1] > 1:  # attributes begin at multiples of four
            size = stored.itemsize * a.shape[1]
            stride = (size + 3) // 4 * 4
            row = b"".join(stored[i].tobytes() + bytes(stride - size) for i in range(len(a)))
            view = self.view(row, byteStride=stride)
        else:
            view = self.view(row)
        entry = {"bufferView": view, "componentType": component, "count": len(a), "type": TYPES[a.shape[1]], **more}
        if component == FLOAT and len(a):
            entry["min"], entry["max"] = stored.min(0).tolist(), stored.max(0).tolist()
        return self.put("accessors", entry)

    def image(self, data, mime="image/png", **sampler):
        image = self.put("images", {"bufferView": self.view(data), "mimeType": mime})
        texture = {"source": image}
        if sampler:
            texture["sampler"] = self.put("samplers", sampler)
        return self.put("textures", texture)

    def material(self, **m):
        for name in m.get("extensions", {}):
            self.use(name)
        return self.put("materials", m)

    def add(self, positions=QUAD, indices=QUAD_INDICES, normals=None, uv=None, uv1=None, tangents=None, colors=None,
            material=None, index_type=USHORT, mode=None, at=None, node=True, **attributes):
        """A mesh of one primitive, and a node for it; returns the mesh's index."""
        a = {"POSITION": positions if isinstance(positions, int) else self.accessor(positions)}
        for name, values in [("NORMAL", normals), ("TEXCOORD_0", uv), ("TEXCOORD_1", uv1), ("TANGENT", tangents), ("COLOR_0", colors)]:
            if values is not None:
                a[name] = values if isinstance(values, int) else self.accessor(values)
        a.update(attributes)
        primitive = {"attributes": a}
        if indices is not None:
            primitive["indices"] = self.accessor(indices, index_type)
        if mode is not None:
            primitive["mode"] = mode
        if material is not None:
            primitive["material"] = material
        mesh = self.put("meshes", {"primitives": [primitive]})
        if node:
            self.node(mesh=mesh, **({"translation": at} if at else {}))
        return mesh

    def node(self, root=True, **n):
        index = self.put("nodes", n)
        if root:
            self.doc["scenes"][0]["nodes"].append(index)
        return index

    def camera(self, at=(0, 0, 4), yfov=0.7, **turn):
        camera = self.put("cameras", {"type": "perspective", "perspective": {"yfov": yfov, "znear": 0.01, "aspectRatio": 1}})
        return self.node(camera=camera, translation=list(at), **turn)

    def light(self, kind, color=(1, 1, 1), intensity=1.0, spot=None, **node):
        self.use("KHR_lights_punctual")
        lights = self.doc.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"type": kind, "color": list(color), "intensity": intensity, **({"spot": spot} if spot else {})})
        self.node(extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **node)

    def glb(self):
        doc = dict(self.doc, buffers=[{"byteLength": len(self.bytes)}])
        text = json.dumps(doc).encode()
        text += b" " * (-len(text) % 4)
        body = bytes(self.bytes) + bytes(-len(self.bytes) % 4)
        return struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(body)) + \
            struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(body), 0x004E4942) + body

    def gltf(self, uri):
        return json.dumps(dict(self.doc, buffers=[{"byteLength": len(self.bytes), "uri": uri}]), indent=1)

    def data_uri(self):
        return "data:application/octet-stream;base64," + base64.b64encode(bytes(self.bytes)).decode()


def sphere(n=24):
    """Positions, normals, texture coordinates and indices of a unit sphere."""
    p, uv, indices = [], [], []
    for i in range(n // 2 + 1):
        for j in range(n + 1):
            t, f = math.pi * i / (n // 2), 2 * math.pi * j / n
            p.append([math.sin(t) * math.sin(f), math.cos(t), math.sin(t) * math.cos(f)])
            uv.append([j / n, i / (n // 2)])
    for i in range(n // 2):
        for j in range(n):
            a = i * (n + 1) + j
            if i > 0:
                indices += [a, a + n + 1, a + 1]
            if i < n // 2 - 1:
                indices += [a + 1, a + n + 1, a + n + 2]
    return np.array(p), np.array(p), np.array(uv), indices


def ball(model, material, at=(0, 0, 0), **more):
    p, n, uv, i = sphere()
    return model.add(p, i, normals=n, uv=uv, material=material, at=list(at), **more)


def lit(model):
    """A lamp from the upper left."""
    model.light("directional", intensity=2.5, rotation=[-0.35, -0.2, 0, 0.9])
    return model


# ---- Geometry ----

def triangles_u8():
    """A grey square; indices are bytes."""
    m = lit(Model())
    m.add(index_type=UBYTE)
    return m


def triangles_u16():
    """The same; indices of two bytes."""
    m = lit(Model())
    m.add(index_type=USHORT)
    return m


def triangles_u32():
    """The same; indices of four bytes."""
    m = lit(Model())
    m.add(index_type=UINT)
    return m


def triangles_plain():
    """The same without indices."""
    m = lit(Model())
    m.add(QUAD[QUAD_INDICES], None)
    return m


def strip():
    """The same as a triangle strip."""
    m = lit(Model())
    m.add(QUAD[[0, 1, 3, 2]], None, mode=5)
    return m


def fan():
    """A hexagon as a triangle fan with indices."""
    m = lit(Model())
    ring = [[math.cos(k * math.pi / 3), math.sin(k * math.pi / 3), 0] for k in range(6)]
    m.add([[0, 0, 0]] + ring, [0, 1, 2, 3, 4, 5, 6, 1], mode=6)
    return m


def points_and_lines():
    """A square; the points and lines beside it are left out, and that is said."""
    m = lit(Model())
    m.add()
    m.add(QUAD, None, mode=0)
    m.add(QUAD, None, mode=3)
    m.add(QUAD, None, mode=2)
    return m


def flat_normals():
    """A sphere of flat faces: it has no normals."""
    m = lit(Model())
    p, _, _, i = sphere(16)
    m.add(p, i)
    return m


def smooth_normals():
    """A smooth sphere."""
    m = lit(Model())
    ball(m, None)
    return m


def interleaved():
    """A square with a picture; positions, normals and coordinates are interleaved in one buffer view."""
    m = lit(Model())
    rows = b"".join(struct.pack("<8f", *p, 0, 0, 1, *t) for p, t in zip(QUAD, QUAD_UV))
    view = m.view(rows, byteStride=32)

    def part(offset, kind, **more):
        return m.put("accessors", {"bufferView": view, "byteOffset": offset, "componentType": FLOAT, "count": 4, "type": kind, **more})
    texture = m.image(png(picture()))
    material = m.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}, "metallicFactor": 0})
    m.add(part(0, "VEC3", min=[-1, -1, 0], max=[1, 1, 0]), normals=part(12, "VEC3"), uv=part(24, "VEC2"), material=material)
    return m


def sparse():
    """A square whose upper right corner is pulled inwards by a sparse accessor; another has no buffer view at all."""
    m = lit(Model())
    p = m.accessor(QUAD)
    where, what = m.view(struct.pack("<H", 2)), m.view(struct.pack("<3f", 0.3, 0.3, 0))
    m.doc["accessors"][p]["sparse"] = {"count": 1, "indices": {"bufferView": where, "componentType": USHORT},
                                       "values": {"bufferView": what}}
    m.add(p)
    q = m.put("accessors", {"componentType": FLOAT, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0], "sparse": {
        "count": 3, "indices": {"bufferView": m.view(bytes([0, 1, 2])), "componentType": UBYTE},
        "values": {"bufferView": m.view(struct.pack("<9f", 0.6, 0.6, 0, 1, 0.6, 0, 1, 1, 0))}}})
    m.add(q, [0, 1, 2])
    return m


def normalised():
    """A square with a picture; its coordinates are normalised bytes and shorts, its colours normalised bytes."""
    m = lit(Model())
    uv = m.accessor(QUAD_UV * 65535, USHORT, normalized=True)
    colors = m.accessor([[255, 255, 255, 255], [255, 128, 128, 255], [255, 255, 255, 255], [128, 255, 128, 255]], UBYTE, normalized=True)
    texture = m.image(png(picture()))
    m.add(uv=uv, colors=colors, material=m.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}, "metallicFactor": 0}))
    return m


def quantized():
    """A square; positions are shorts and normals normalised bytes (KHR_mesh_quantization), scaled by its node."""
    m = lit(Model())
    m.use("KHR_mesh_quantization", required=True)
    p = m.accessor(QUAD * 1000, SHORT, min=[-1000, -1000, 0], max=[1000, 1000, 0])
    n = m.accessor([[0, 0, 127]] * 4, BYTE, normalized=True)
    mesh = m.add(p, normals=n, node=False)
    m.node(mesh=mesh, scale=[0.001] * 3)
    return m


def vertex_colors():
    """A square from red to green to blue to white, by colours of its vertices."""
    m = lit(Model())
    m.add(colors=[[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], material=m.material(pbrMetallicRoughness={"metallicFactor": 0}))
    return m


def two_uv_sets():
    """A square with a picture by the second set of coordinates (a quarter of it), and what it emits by the first."""
    m = lit(Model())
    color, glow = m.image(png(picture())), m.image(png(picture()))
    m.add(uv=QUAD_UV, uv1=QUAD_UV * 0.5, material=m.material(
        pbrMetallicRoughness={"baseColorTexture": {"index": color, "texCoord": 1}, "metallicFactor": 0},
        emissiveTexture={"index": glow}, emissiveFactor=[0.2, 0.2, 0.2]))
    return m


def bumps(size=32):
    """A normal map of ridges along the diagonal."""
    y, x = np.mgrid[0:size, 0:size]
    n = np.stack([0.4 * np.sin((x + y) * math.pi / 4), -0.4 * np.sin((x + y) * math.pi / 4), np.ones((size, size))], -1)
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    return np.round((n * 0.5 + 0.5) * 255)


def normal_map():
    """A square with ridges; its tangents have to be made."""
    m = lit(Model())
    texture = m.image(png(bumps()))
    m.add(normals=[[0, 0, 1]] * 4, uv=QUAD_UV, material=m.material(
        pbrMetallicRoughness={"metallicFactor": 0, "roughnessFactor": 0.4}, normalTexture={"index": texture, "scale": 0.8}))
    return m


def tangents():
    """The same with tangents in the file, the right half mirrored."""
    m = lit(Model())
    texture = m.image(png(bumps()))
    material = m.material(pbrMetallicRoughness={"metallicFactor": 0, "roughnessFactor": 0.4}, normalTexture={"index": texture})
    m.add(QUAD * [0.5, 1, 1], normals=[[0, 0, 1]] * 4, uv=QUAD_UV, tangents=[[1, 0, 0, 1]] * 4, material=material, at=[-0.5, 0, 0])
    m.add(QUAD * [0.5, 1, 1], normals=[[0, 0, 1]] * 4, uv=QUAD_UV * [-1, 1], tangents=[[-1, 0, 0, -1]] * 4, material=material, at=[0.5, 0, 0])
    return m


# ---- Materials ----

def grid(materials, m=None):
    """Balls side by side, one for each material."""
    m = m or Model()
    for k, material in enumerate(materials):
        columns = math.ceil(math.sqrt(len(materials)))
        mesh = ball(m, m.material(**material), node=False)
        step, size = 2.4 / columns, 1.1 / columns
        m.node(mesh=mesh, scale=[size] * 3, translation=[(k % columns - (columns - 1) / 2) * step, ((columns - 1) / 2 - k // columns) * step, 0])
    return m


def pbr(color=(0.8, 0.3, 0.2), metallic=0.0, roughness=0.4, **more):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness}, **more}


def metallic_roughness():
    """Nine balls: rougher to the right, more metallic downwards."""
    return grid([pbr(metallic=y / 2, roughness=0.05 + 0.45 * x) for y in range(3) for x in range(3)])


def metallic_roughness_texture():
    """A ball, metal above and plastic below, rougher around."""
    m = Model()
    p = np.zeros((16, 16, 3), int)
    p[:8, :, 2] = 255
    p[:, :, 1] = (np.arange(16) * 16)[None, :]
    texture = m.image(png(p))
    ball(m, m.material(pbrMetallicRoughness={"baseColorFactor": [0.9, 0.7, 0.3, 1], "metallicRoughnessTexture": {"index": texture}}))
    return m


def base_color_texture():
    """An upright picture: red, green, blue, grey steps, from the top left."""
    m = lit(Model())
    m.add(normals=[[0, 0, 1]] * 4, uv=QUAD_UV, material=m.material(
        pbrMetallicRoughness={"baseColorTexture": {"index": m.image(png(picture()))}, "metallicFactor": 0}))
    return m


def occlusion():
    """A square as if its occlusion map were not there, which is said."""
    m = lit(Model())
    texture = m.image(png(picture()))
    m.add(uv=QUAD_UV, material=m.material(**pbr(), occlusionTexture={"index": texture}))
    return m


def emissive():
    """A glowing square of radiance (4, 2, 1) lights the one below it."""
    m = Model()
    m.add(QUAD * 0.5, at=[0, 0.6, 0], material=m.material(
        **pbr(), emissiveFactor=[1, 0.5, 0.25], doubleSided=True, extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 4}}))
    m.add([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material=m.material(**pbr((0.8, 0.8, 0.8))), at=[0, -0.4, 0])
    m.light("point", intensity=0.0)  # no sky
    return m


def emissive_texture():
    """A screen that shows a picture and lights the floor before it."""
    m = Model()
    texture = m.image(png(picture()))
    m.add(QUAD * 0.6, uv=QUAD_UV, at=[0, 0.4, 0], material=m.material(**pbr((0, 0, 0)), emissiveFactor=[1, 1, 1], emissiveTexture={"index": texture},
                                                                       extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 3}}))
    m.add([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material=m.material(**pbr((0.8, 0.8, 0.8))), at=[0, -0.4, 0.4])
    m.light("point", intensity=0.0)
    return m


def alpha_mask():
    """A square, cut away where the picture's alpha is below 0.4: the right part is not there."""
    m = lit(Model())
    texture = m.image(png(picture(4)), wrapS=33071, wrapT=33071)
    m.add(uv=QUAD_UV, material=m.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}, "metallicFactor": 0}, alphaMode="MASK", alphaCutoff=0.4))
    return m


def alpha_blend():
    """A square that fades to the right; a smaller one that glows is behind it."""
    m = lit(Model())
    texture = m.image(png(picture(4)), wrapS=33071, wrapT=33071)
    m.add(uv=QUAD_UV, material=m.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}, "metallicFactor": 0}, alphaMode="BLEND"))
    m.add(QUAD * 0.7, at=[0, 0, -0.5], material=m.material(**pbr((0.9, 0.9, 0.9)), emissiveFactor=[0.3, 0.3, 0.3]))
    return m


def double_sided():
    """A square seen from behind, lit on the side that is seen."""
    m = lit(Model())
    m.add(indices=[0, 2, 1, 0, 3, 2], material=m.material(**pbr(), doubleSided=True))
    return m


def texture_transform():
    """A picture shifted, turned by 30 degrees and shrunk to half (KHR_texture_transform)."""
    m = lit(Model())
    texture = m.image(png(picture()))
    m.use("KHR_texture_transform", required=True)
    m.add(uv=QUAD_UV, material=m.material(pbrMetallicRoughness={"metallicFactor": 0, "baseColorTexture": {
        "index": texture, "extensions": {"KHR_texture_transform": {"offset": [0.1, 0.2], "rotation": math.pi / 6, "scale": [2, 2]}}}}))
    return m


def wrap_modes():
    """Four squares of coordinates up to 2: repeated, clamped, mirrored, and nearest texels without filtering."""
    m = lit(Model())
    for k, sampler in enumerate([{"wrapS": 10497, "wrapT": 10497}, {"wrapS": 33071, "wrapT": 33071}, {"wrapS": 33648, "wrapT": 33648},
                                 {"magFilter": 9728, "wrapS": 33071, "wrapT": 10497}]):
        texture = m.image(png(picture(size=4)), **sampler)
        m.add(QUAD * 0.45, uv=QUAD_UV * 2, at=[k % 2 - 0.5, 0.5 - k // 2, 0], material=m.material(
            pbrMetallicRoughness={"metallicFactor": 0, "baseColorTexture": {"index": texture}}))
    return m


def extension(name, values, **base):
    return [pbr(extensions={name: v}, **base) for v in values]


def ior():
    """Four balls of a higher and higher index of refraction: 1.2, 1.5, 2 and 0 (all is reflected)."""
    return grid(extension("KHR_materials_ior", [{"ior": v} for v in (1.2, 1.5, 2.0, 0.0)], roughness=0.2))


def transmission():
    """Four thin balls: opaque, half, all, and all but rough."""
    materials = extension("KHR_materials_transmission", [{"transmissionFactor": v} for v in (0, 0.5, 1)], color=(0.8, 0.9, 1), roughness=0)
    return grid(materials + extension("KHR_materials_transmission", [{"transmissionFactor": 1}], color=(0.8, 0.9, 1), roughness=0.4))


def volume():
    """Four balls of glass, smooth and rough: thin ones and solid ones."""
    out = []
    for roughness in (0, 0.3):
        for thickness in (0, 1):
            m = pbr((1, 1, 1), roughness=roughness)
            m["extensions"] = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {
                "thicknessFactor": thickness, "attenuationDistance": 1, "attenuationColor": [0.5, 1, 0.5]}}
            out.append(m)
    return grid(out)


def specular():
    """Four balls: no gloss, half, all, and reddish gloss."""
    return grid(extension("KHR_materials_specular", [{"specularFactor": v} for v in (0, 0.5, 1)] + [{"specularColorFactor": [1, 0.1, 0.1]}], roughness=0.2))


def clearcoat():
    """Four rough balls: bare, half coated, coated, with a rough coat."""
    return grid(extension("KHR_materials_clearcoat", [{"clearcoatFactor": v} for v in (0, 0.5, 1)] + [
        {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.5}], roughness=0.8))


def sheen():
    """Four balls of cloth."""
    return grid(extension("KHR_materials_sheen", [{"sheenColorFactor": [c] * 3, "sheenRoughnessFactor": r} for c in (0.3, 1) for r in (0.3, 0.8)],
                          color=(0.1, 0.1, 0.3), roughness=0.9))


def anisotropy():
    """Four balls of brushed metal."""
    return grid(extension("KHR_materials_anisotropy", [{"anisotropyStrength": s, "anisotropyRotation": r} for s in (0, 0.8) for r in (0, math.pi / 2)],
                          metallic=1.0, roughness=0.3))


def anisotropy_texture():
    """A disc of metal, brushed along circles about its middle: two beams of light."""
    m = lit(Model())
    y, x = np.mgrid[0:64, 0:64] / 31.5 - 1
    radius = np.maximum(np.hypot(x, y), 1e-6)
    # In the picture y points down, along the bitangent up. The tangent of a circle.
    p = np.stack([(y / radius + 1) / 2, (x / radius + 1) / 2, np.ones_like(x)], -1)
    texture = m.image(png(np.round(p * 255)))
    m.light("point", intensity=4, translation=[0.5, 0.5, 2])
    m.add(normals=[[0, 0, 1]] * 4, uv=QUAD_UV, material=m.material(**pbr((0.9, 0.9, 0.9), 1.0, 0.35, extensions={
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.9, "anisotropyTexture": {"index": texture}}})))
    return m


def unlit():
    """A picture as it is: decoded, the values of the file."""
    m = Model()
    texture = m.image(png(picture()))
    m.add(uv=QUAD_UV, material=m.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}}, extensions={"KHR_materials_unlit": {}}))
    return m


def variants():
    """A red square, and blue as variant \"sea\"."""
    m = lit(Model())
    m.use("KHR_materials_variants")
    red, blue = m.material(**pbr((0.9, 0.1, 0.1))), m.material(**pbr((0.1, 0.1, 0.9)))
    mesh = m.add(material=red)
    m.doc.setdefault("extensions", {})["KHR_materials_variants"] = {"variants": [{"name": "fire"}, {"name": "sea"}]}
    m.doc["meshes"][mesh]["primitives"][0]["extensions"] = {"KHR_materials_variants": {"mappings": [{"material": blue, "variants": [1]}]}}
    return m


# ---- Nodes ----

def instances():
    """A mesh that three nodes have, one of them mirrored."""
    m = lit(Model())
    p, n, uv, i = sphere(12)
    mesh = m.add(p * 0.4, i, normals=n, node=False, material=m.material(**pbr()))
    m.node(mesh=mesh, translation=[-0.8, 0, 0])
    m.node(mesh=mesh, scale=[-1, 1.5, 1])
    m.node(mesh=mesh, matrix=[1, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1, 0, 0.8, 0, 0, 1])
    return m


def gpu_instancing():
    """A row of five balls, turned and scaled (EXT_mesh_gpu_instancing)."""
    m = lit(Model())
    m.use("EXT_mesh_gpu_instancing", required=True)
    p, n, uv, i = sphere(12)
    mesh = m.add(p * 0.25, i, normals=n, node=False)
    t = m.accessor([[k * 0.5 - 1, 0, 0] for k in range(5)])
    s = m.accessor([[1, 0.5 + 0.3 * k, 1] for k in range(5)])
    r = m.accessor([[0, 0, math.sin(k * 0.2), math.cos(k * 0.2)] for k in range(5)])
    m.node(mesh=mesh, extensions={"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": t, "ROTATION": r, "SCALE": s}}})
    return m


def hierarchy():
    """A square turned by 45 degrees by its parent, shifted to the right by its grandparent."""
    m = lit(Model())
    mesh = m.add(QUAD * 0.5, node=False)
    child = m.node(root=False, mesh=mesh, scale=[1, 0.5, 1])
    parent = m.node(root=False, rotation=[0, 0, math.sin(math.pi / 8), math.cos(math.pi / 8)], children=[child])
    m.node(translation=[0.5, 0, 0], children=[parent])
    return m


def orthographic():
    """A square that is half as wide as the picture, by an orthographic camera."""
    m = lit(Model(camera=False))
    camera = m.put("cameras", {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 2, "znear": 0, "zfar": 10}})
    m.node(camera=camera, translation=[0, 0, 4], name="parallel")
    m.add()
    return m


def no_camera():
    """A ball and a square, framed from the front, the right and above, under the gradient."""
    m = Model(camera=False)
    ball(m, m.material(**pbr()))
    m.add([[-2, -1, 2], [2, -1, 2], [2, -1, -2], [-2, -1, -2]])
    return m


def two_scenes():
    """A ball; the other scene, \"square\", has a square."""
    m = lit(Model())
    ball(m, None)
    mesh = m.add(node=False)
    square = m.node(root=False, mesh=mesh)
    m.doc["scenes"].append({"name": "square", "nodes": [0, 1, square]})
    return m


def lights():
    """A floor under a red point, a green spot and, faintly, blue light from above and the left."""
    m = Model(camera=False)
    m.camera(at=(0, 3, 3), rotation=[-0.3827, 0, 0, 0.9239])
    m.add([[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material=m.material(**pbr((0.8, 0.8, 0.8), roughness=1)))
    m.light("point", (1, 0, 0), 2.0, translation=[-0.8, 0.7, 0])
    m.light("spot", (0, 1, 0), 6.0, {"innerConeAngle": 0.2, "outerConeAngle": 0.5}, translation=[0.7, 1.5, 0], rotation=[-0.7071, 0, 0, 0.7071])
    m.light("directional", (0, 0, 1), 0.6, rotation=[-0.5, -0.5, -0.5, 0.5])
    return m


def channel(m, node, path, times, values, interpolation="LINEAR"):
    animation = m.doc.setdefault("animations", [{"channels": [], "samplers": []}])[0]
    animation["samplers"].append({"input": m.accessor(times), "output": m.accessor(values), "interpolation": interpolation})
    animation["channels"].append({"sampler": len(animation["samplers"]) - 1, "target": {"node": node, "path": path}})


def animation():
    """At 0.5 s: left a square half way up, in the middle one turned by 45 degrees, right one of half the size."""
    m = lit(Model())
    mesh = m.add(QUAD * 0.3, node=False)
    up, turned, small = (m.node(mesh=mesh, translation=[x, 0, 0]) for x in (-0.8, 0, 0.8))
    channel(m, up, "translation", [0, 1], [[-0.8, 0, 0], [-0.8, 1, 0]])
    channel(m, turned, "rotation", [0, 1], [[0, 0, 0, 1], [0, 0, math.sin(math.pi / 4), math.cos(math.pi / 4)]])
    # A cubic spline with tangents of 0 is half way between its keys: 1 and 0.
    channel(m, small, "scale", [0, 1], [[0] * 3, [1] * 3, [0] * 3, [0] * 3, [0] * 3, [0] * 3], "CUBICSPLINE")
    return m


def skin():
    """A strip whose upper half is bent to the right by a joint."""
    m = lit(Model())
    rows = 9
    p = np.array([[x, y * 2 / (rows - 1) - 1, 0] for y in range(rows) for x in (-0.2, 0.2)])
    indices = [k for y in range(rows - 1) for k in (2 * y, 2 * y + 1, 2 * y + 3, 2 * y, 2 * y + 3, 2 * y + 2)]
    share = np.clip((p[:, 1] + 0.25) / 0.5, 0, 1)
    weights = np.stack([1 - share, share, 0 * share, 0 * share], -1)
    j = m.accessor([[0, 1, 0, 0]] * len(p), UBYTE)
    mesh = m.add(p, indices, node=False, JOINTS_0=j, WEIGHTS_0=m.accessor(weights))
    tip = m.node(root=False, rotation=[0, 0, -math.sin(math.pi / 6), math.cos(math.pi / 6)])
    root = m.node(children=[tip])
    skins = m.put("skins", {"joints": [root, tip], "inverseBindMatrices": m.accessor(np.tile(np.eye(4).reshape(1, 16), (2, 1)))})
    m.node(mesh=mesh, skin=skins, translation=[5, 5, 5])  # a skinned mesh is where its joints are
    return m


def morph():
    """A square pulled to a kite by half of its first target, its corner bent by the second."""
    m = lit(Model())
    mesh = m.add()
    d0, d1 = np.zeros((4, 3)), np.zeros((4, 3))
    d0[2], d1[0] = [0.5, 0.5, 0], [-0.2, 0.5, 0]
    m.doc["meshes"][mesh]["primitives"][0]["targets"] = [{"POSITION": m.accessor(d0)}, {"POSITION": m.accessor(d1)}]
    m.doc["meshes"][mesh]["weights"] = [0.5, 1]
    return m


# ---- A still life, for the documentation ----

def lathe(profile, n=64):
    """A surface of revolution about y from (radius, height) pairs: positions, normals, coordinates, indices."""
    r, y = np.array(profile, float).T
    dr, dy = np.gradient(r), np.gradient(y)
    length = np.hypot(dr, dy)
    p, normal, uv, indices = [], [], [], []
    for i in range(len(r)):
        for j in range(n + 1):
            f = 2 * math.pi * j / n
            p.append([r[i] * math.sin(f), y[i], r[i] * math.cos(f)])
            normal.append([dy[i] / length[i] * math.sin(f), -dr[i] / length[i], dy[i] / length[i] * math.cos(f)])
            uv.append([j / n * 4, 1 - i / (len(r) - 1)])
    for i in range(len(r) - 1):
        for j in range(n):
            a = i * (n + 1) + j
            indices += [a, a + 1, a + n + 2, a, a + n + 2, a + n + 1]
    return np.array(p), np.array(normal), np.array(uv), indices


def still_life():
    """A vase of brushed copper, a ball of glass, one lacquered, one of velvet and a lamp, on tiles."""
    m = Model(camera=False)
    m.camera(at=(0, 2.1, 7.4), yfov=0.5, rotation=[-0.104, 0, 0, 0.9946])
    m.doc["cameras"][0]["perspective"]["aspectRatio"] = 1.6
    tiles = np.zeros((64, 64, 3), int)
    tiles[:] = (196, 186, 170)
    tiles[:32, :32] = tiles[32:, 32:] = (92, 96, 106)
    joints = np.zeros((64, 64, 3))
    joints[..., 2] = 1
    joints[::32, :, 1], joints[31::32, :, 1] = 0.5, -0.5
    joints[:, ::32, 0], joints[:, 31::32, 0] = -0.5, 0.5
    joints /= np.linalg.norm(joints, axis=-1, keepdims=True)
    floor = m.material(pbrMetallicRoughness={"baseColorTexture": {"index": m.image(png(tiles))}, "metallicFactor": 0, "roughnessFactor": 0.25},
                       normalTexture={"index": m.image(png(np.round((joints * 0.5 + 0.5) * 255)))})
    m.add([[-8, 0, 8], [8, 0, 8], [8, 0, -8], [-8, 0, -8]], normals=[[0, 1, 0]] * 4, uv=np.array([[0, 8], [8, 8], [8, 0], [0, 0]], float), material=floor)
    m.add([[-8, 0, -6], [8, 0, -6], [8, 7, -6], [-8, 7, -6]], material=m.material(**pbr((0.35, 0.42, 0.5), roughness=0.9)))
    t = np.linspace(0, 1, 60)
    profile = np.stack([0.32 + 0.45 * np.sin(t * math.pi * 0.95) ** 2 - 0.12 * np.exp(-((t - 0.88) / 0.07) ** 2), 2.1 * t], -1)
    p, n, uv, i = lathe(profile)
    m.add(p, i, normals=n, uv=uv, at=[-1.55, 0, -0.6], material=m.material(**pbr((0.95, 0.55, 0.38), 1.0, 0.35, extensions={
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.7}}), doubleSided=True))
    p, n, uv, i = sphere(96)

    def globe(size, x, z, **material):
        m.add(p * size, i, normals=n, uv=uv, at=[x, size, z], material=m.material(**material))
    globe(0.62, 0.05, 0.9, **pbr((1, 1, 1), 0.0, 0.0, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1}, "KHR_materials_ior": {"ior": 1.5}}))
    globe(0.75, 1.5, -0.4, **pbr((0.45, 0.02, 0.03), 0.0, 0.6, extensions={"KHR_materials_clearcoat": {"clearcoatFactor": 1}}))
    globe(0.42, 1.7, 1.3, **pbr((0.05, 0.08, 0.2), 0.0, 0.9, extensions={"KHR_materials_sheen": {"sheenColorFactor": [0.5, 0.55, 0.8], "sheenRoughnessFactor": 0.5}}))
    globe(0.3, -0.75, 1.8, **pbr((0.9, 0.9, 0.92), 1.0, 0.08))
    m.add([[-1.2, 0, -0.8], [1.2, 0, -0.8], [1.2, 0, 0.8], [-1.2, 0, 0.8]], at=[-1.5, 4.2, 1.5], material=m.material(
        **pbr((0, 0, 0)), emissiveFactor=[1, 0.93, 0.82], extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 14}}))
    m.light("directional", (0.7, 0.8, 1), 0.35, rotation=[-0.45, 0.3, 0, 0.84])
    return m


# ---- Files ----

def external_buffer():
    """base_color_texture with its buffer and its picture in files of their own, whose names are percent-encoded."""
    m = base_color_texture()
    image = m.doc["images"][0]
    view = m.doc["bufferViews"][image.pop("bufferView")]
    data = bytes(m.bytes[view["byteOffset"]:view["byteOffset"] + view["byteLength"]])
    del image["mimeType"]
    image["uri"] = "the%20picture.png"
    return {"external_buffer.gltf": m.gltf("the%20buffer.bin").encode(), "the buffer.bin": bytes(m.bytes), "the picture.png": data}


def data_uri():
    """base_color_texture with all of it in the text."""
    m = base_color_texture()
    return {"data_uri.gltf": m.gltf(m.data_uri()).encode()}


MODELS = [triangles_u8, triangles_u16, triangles_u32, triangles_plain, strip, fan, points_and_lines, flat_normals, smooth_normals,
          interleaved, sparse, normalised, quantized, vertex_colors, two_uv_sets, normal_map, tangents, metallic_roughness,
          metallic_roughness_texture, base_color_texture, occlusion, emissive, emissive_texture, alpha_mask, alpha_blend, double_sided,
          texture_transform, wrap_modes, ior, transmission, volume, specular, clearcoat, sheen, anisotropy, anisotropy_texture, unlit, variants, instances,
          gpu_instancing, hierarchy, orthographic, no_camera, two_scenes, lights, animation, skin, morph, external_buffer, data_uri]
SHOWN = [still_life]  # looked at, not compared


def write(folder, names=()):
    """Writes the models of these names, or all; the paths of their main files."""
    os.makedirs(folder, exist_ok=True)
    paths = []
    for make in MODELS + SHOWN:
        if make.__name__ not in names and (names or make in SHOWN):
            continue
        made = make()
        files = made if isinstance(made, dict) else {make.__name__ + ".glb": made.glb()}
        for name, data in files.items():
            with open(os.path.join(folder, name), "wb") as f:
                f.write(data)
        paths.append(os.path.join(folder, next(iter(files))))
    return paths


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("\n".join(write(sys.argv[1], sys.argv[2:])))
