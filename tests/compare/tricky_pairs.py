"""Pairs of pictures that comparers are wrong about, and what a person would say of each.

`pairs(whit, folder)` makes them; tricky_pairs_test.py asks whit about them, and writes the table of docs/diff.md.
"""
import os
import subprocess
from collections import namedtuple

import numpy as np
import OpenImageIO as oiio

WIDTH, HEIGHT = 96, 64

# One pair: how A came of B, flags, the exit code that a person would expect (0 same, 1 differs, 4 cannot be compared), what the
# answer must name, and why that is right.
Pair = namedtuple("Pair", "name a b flags expected names why")


def scene():
    """Linear light: a wall with stripes, a shadow, and a disc of 5 % of the picture. Values of 0.05 to 1.3."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.float64)
    wall = 0.5 + 0.3 * np.sin(x / 9) * np.cos(y / 7) + 0.2 * (x / WIDTH)
    wall[(x + y) % 23 < 3] *= 0.4
    wall[y > 44] *= 0.3
    rgb = np.stack([wall, wall * 0.9, wall * 0.75 + 0.05], -1)
    disc = (x - 30) ** 2 + (y - 24) ** 2 < 9.9 ** 2  # pi 9.9^2 = 308 of 6144 pixels: 5 %
    rgb[disc] = rgb[disc] * [0.4, 1.1, 0.6] + 0.1
    return rgb.astype(np.float32), disc


def write(path, pixels, names=("R", "G", "B"), kind="float", crop=None, tile=0, compression="zip", space=None):
    """`crop`: (x, y, full width, full height) of the first pixel."""
    pixels = np.ascontiguousarray(pixels, np.float32).reshape(pixels.shape[0], pixels.shape[1], -1)
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, kind)
    spec.channelnames = tuple(names)
    if crop:
        spec.x, spec.y, spec.full_width, spec.full_height = crop
    if tile:
        spec.tile_width = spec.tile_height = tile
    if path.endswith(".exr"):
        spec.attribute("compression", compression)
    if space:
        spec.attribute("oiio:ColorSpace", space)
    out = oiio.ImageOutput.create(path)
    if not out or not out.open(path, spec):
        raise OSError(oiio.geterror())
    if not (out.write_image(pixels) if not tile else out.write_tiles(0, width, 0, height, 0, 1, pixels)):
        raise OSError(out.geterror())
    out.close()


def write_parts(path, parts):
    """An OpenEXR file of several parts: (name, channel names, pixels)."""
    specs = []
    for name, channels, pixels in parts:
        spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], len(channels), "float")
        spec.channelnames = tuple(channels)
        spec.attribute("oiio:subimagename", name)
        specs.append(spec)
    out = oiio.ImageOutput.create(path)
    if not out.open(path, tuple(specs)):
        raise OSError(oiio.geterror())
    for k, (_, _, pixels) in enumerate(parts):
        if k:
            out.open(path, specs[k], "AppendSubimage")
        out.write_image(np.ascontiguousarray(pixels, np.float32))
    out.close()


def srgb(linear):
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def moved(rgb, by):
    """Right by so many pixels, between pixels as the straight line between them; the edge goes on."""
    low, part = int(np.floor(by)), by - np.floor(by)
    at = np.arange(rgb.shape[1]) - low
    column = np.clip(at, 0, rgb.shape[1] - 1)
    before = np.clip(at - 1, 0, rgb.shape[1] - 1)
    return (1 - part) * rgb[:, column] + part * rgb[:, before]


def with_pixel(rgb, x, y, value):
    rgb = rgb.copy()
    rgb[y, x] = value
    return rgb


def two_seeds(whit, folder, samples):
    """Renders of a small Cornell box that differ by their seeds."""
    paths = []
    for seed in (1, 2):
        path = os.path.join(folder, "seed-%d-%d.exr" % (samples, seed))
        subprocess.run([whit, os.path.join(folder, "box.pbrt"), "--outfile", path, "--spp", str(samples), "--seed", str(seed),
                        "--aov", "variance,shape", "--display", "none", "--quiet"], check=True)
        paths.append(path)
    return paths


BOX = """
Film "image" "integer xresolution" 100 "integer yresolution" 100
Sampler "random" Integrator "path" "integer maxdepth" 3
LookAt 0 1 -3.4  0 1 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
AttributeBegin AreaLightSource "diffuse" "rgb L" [12 11 9] Translate 0 1.98 0 Rotate 90 1 0 0 Shape "disk" "float radius" 0.3 AttributeEnd
Material "matte" "rgb Kd" [0.7 0.7 0.7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-1 0 -1  1 0 -1  1 0 1  -1 0 1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-1 2 -1  1 2 -1  1 2 1  -1 2 1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-1 0 1  1 0 1  1 2 1  -1 2 1]
Material "matte" "rgb Kd" [0.7 0.1 0.1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-1 0 -1  -1 0 1  -1 2 1  -1 2 -1]
Material "matte" "rgb Kd" [0.1 0.6 0.1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [1 0 -1  1 0 1  1 2 1  1 2 -1]
Material "plastic"
Translate 0.2 0.4 0.1
Shape "sphere" "float radius" 0.4
WorldEnd
"""


def pairs(whit, folder):
    """Writes the pictures of all pairs to the folder."""
    rgb, disc = scene()
    alpha, normals = np.ones((HEIGHT, WIDTH, 1), np.float32), np.zeros((HEIGHT, WIDTH, 3), np.float32)
    normals[..., 2], normals[..., 0] = 0.8, 0.6
    reference = os.path.join(folder, "reference.exr")
    write(reference, rgb)
    count = [0]
    all_pairs = []

    def file(pixels, ending=".exr", **how):
        count[0] += 1
        path = os.path.join(folder, "p%02d%s" % (count[0], ending))
        write(path, pixels, **how)
        return path

    def pair(name, a, expected, why, names="", b=reference, flags=""):
        a = a if isinstance(a, str) else file(a)
        b = b if isinstance(b, str) else file(b)
        all_pairs.append(Pair(name, a, b, flags, expected, names, why))

    # Numbers.
    pair("equal files", reference, 0, "nothing differs", "every number is equal")
    nan = with_pixel(rgb, 40, 20, np.nan)
    pair("a NaN", nan, 1, "a broken pixel, however few", "NaN.*nan")
    pair("the same NaN in both", nan, 1, "both are broken", "NaN.*nan", b=nan)
    pair("the same NaN in both, allowed", nan, 0, "asked for", b=nan, flags="--allow-nonfinite")
    pair("an infinity", with_pixel(rgb, 40, 20, np.inf), 1, "a broken pixel", r"infinite.*\(40, 20\)")
    zero = rgb * (rgb > 0.3)
    pair("-0 for 0", np.where(zero == 0, np.float32(-0.0), zero), 0, "the same number", "every number is equal", b=zero,
         flags="--exact")
    pair("half against float", file(rgb, kind="half"), 0, "rounded to 11 bits, nothing to see")
    ulp = np.nextafter(rgb, np.float32(np.inf))
    pair("one ulp everywhere", ulp, 0, "another compiler's rounding")
    pair("one ulp everywhere, exactly", ulp, 1, "asked for", "100 % of the pixels are not equal", flags="--exact")
    # Small things.
    dead = with_pixel(rgb, 70, 50, 0)
    pair("a black pixel", dead, 0, "one of 6144 is within the default limits, and the text counts it", "a pixel differs")
    pair("a black pixel, looked for", dead, 1, "no pixel may be off by 0.1", r"off by.*\(70, 50\)", flags="--hard-fail 0.1")
    black = rgb.copy()
    black[26:29, 57:60] = 0
    pair("3 x 3 black", black, 1, "9 of the 64 pixels of a block", "block")
    line = rgb.copy()
    line[20] = 0
    pair("a black line", line, 1, "an eighth of the blocks it goes through", "block")
    pair("a firefly", with_pixel(rgb, 12, 12, 500), 1, "one pixel changes the mean by 14 %", "block|mean")
    # Layers.
    rgba = ("R", "G", "B", "A")
    pair("alpha 0 for 1", file(np.dstack([rgb, 0 * alpha]), names=rgba), 1, "the colours are equal, the picture is gone",
         "layer A", b=file(np.dstack([rgb, alpha]), names=rgba))
    with_normals = ("R", "G", "B", "N.X", "N.Y", "N.Z")
    pair("normals negated", file(np.dstack([rgb, -normals]), names=with_normals), 1, "an AOV is wrong", "layer N",
         b=file(np.dstack([rgb, normals]), names=with_normals))
    second = ("R", "G", "B", "beauty.R", "beauty.G", "beauty.B")
    pair("another layer of colours differs", file(np.dstack([rgb, rgb * 1.2]), names=second), 1, "all layers count",
         "layer beauty", b=file(np.dstack([rgb, rgb]), names=second))
    pair("a layer is missing", reference, 4, "nothing to compare it with", "alone has N.X",
         b=file(np.dstack([rgb, normals]), names=with_normals))
    pair("a layer is missing, colours asked for", reference, 0, "asked for", flags="--channels R,G,B",
         b=file(np.dstack([rgb, normals]), names=with_normals))
    pair("X, Y, Z for R, G, B", file(rgb, names=("X", "Y", "Z")), 4, "the same numbers mean something else", "alone has X, Y, Z")
    pair("grey for colours", file(rgb[..., :1], names=("Y",)), 4, "Y is not R, G and B", "alone has Y")
    pair("channels in another order", file(rgb[..., ::-1], names=("B", "G", "R")), 0, "names say which is which",
         "every number is equal")
    # Windows and files.
    crop = (10, 8, WIDTH, HEIGHT)
    pair("a crop of it", file(rgb[8:40, 10:60], crop=crop), 0, "compared where both have pixels", "both have pixels")
    wrong = rgb.copy()
    wrong[20:30, 20:30] *= 1.5
    pair("a crop of it, wrong inside", file(wrong[8:40, 10:60], crop=crop), 1, "compared where both have pixels", "block|mean")
    pair("another size", rgb[:-1], 4, "pixels have no partners", "different sizes")
    pair("tiles against scanlines", file(rgb, tile=32), 0, "the same numbers", "every number is equal")
    pair("another compression", file(rgb, compression="piz"), 0, "the same numbers", "every number is equal")
    parts = os.path.join(folder, "parts.exr")
    write_parts(parts, [("rgb", ("R", "G", "B"), rgb), ("N", ("N.X", "N.Y", "N.Z"), -normals)])
    pair("two parts, one of them wrong", parts, 1, "all parts count", "layer N",
         b=file(np.dstack([rgb, normals]), names=with_normals))
    # Where it is.
    pair("shifted by a pixel", moved(rgb, 1), 1, "displaced", r"shift|\+1.00 right")
    pair("shifted by half a pixel", moved(rgb, 0.5), 1, "displaced", r"right")
    pair("mirrored", rgb[:, ::-1], 1, "displaced, and named", "mirrored")
    pair("flipped", rgb[::-1], 1, "displaced, and named", "flipped")
    # How bright it is.
    brighter = rgb.copy()
    brighter[disc] *= 1.01
    pair("+1 % in one object", brighter, 0, "0.05 % of the mean: within the default limits")
    pair("+1 % in one object, against noise", brighter, 1, "there is no noise that could explain it", "more than noise",
         flags="--noise")
    pair("+0.9 % everywhere", rgb * np.float32(1.009), 0, "below the limit of 1 % of the mean")
    pair("+1.1 % everywhere", rgb * np.float32(1.011), 1, "above it", "mean is off by 1.1 %")
    pair("gamma applied twice", srgb(rgb), 1, "brighter and flatter", "mean|relmse|block")
    pair("-1.5 for -1", 0 * rgb - 1.5, 1, "half as much again, whatever the sign", "block", b=0 * rgb - 1)
    pair("a picture smaller than a block", rgb[:4, :4] * 1.3, 1, "it is one block", "block", b=rgb[:4, :4])
    # Encodings.
    clipped = np.clip(rgb, 0, 1)
    png = file(srgb(clipped), ".png", kind="uint8")
    pair("the PNG of it", png, 0, "sRGB is taken to linear light first", "from sRGB to linear light", b=clipped)
    pair("a PNG of linear numbers", file(clipped, ".png", kind="uint8"), 1, "too dark, as the eye says", "mean|block", b=clipped)
    pair("a PNG of linear numbers, said so", file(clipped, ".png", kind="uint8"), 0, "asked for", b=clipped,
         flags="--colorspace linear")
    pair("8 bits against 16", png, 0, "rounded to 8 bits", "display values", b=file(srgb(clipped), ".png", kind="uint16"))
    # Noise.
    with open(os.path.join(folder, "box.pbrt"), "w", encoding="utf-8") as f:
        f.write(BOX)
    for samples, plain in ((1, 1), (16, 1), (256, 0)):
        a, b = two_seeds(whit, folder, samples)
        title = "two seeds at %d sample%s" % (samples, "" if samples == 1 else "s")
        pair(title, a, plain, "noise, more than the default limits; the text says that it can be" if plain else
             "noise, within the default limits", "can be noise" if plain else "", b=b)
        pair(title + ", asked about noise", a, 0, "noise alone", "within the noise", b=b, flags="--noise")
    return all_pairs
