#!/usr/bin/env python3
"""The mean of pictures rendered to a target is the true one, though noise decides which parts get more samples.

Each pixel shines from a hundredth of its area, with 100 times its mean, so that few samples carry the light. If samples
decided about the number of their own pixels, parts that met little light by chance would stay so, parts that met much
would get more samples, and the pictures would be too dark: by 4 % if each part decided by itself (0.6 % by chance).
"""
import os
import statistics
import subprocess
import sys
import tempfile

WHIT = os.environ.get("WHIT")
SIZE, SEEDS = 32, 100
SHARE, DIM = 0.01, 0.1  # of a pixel that shines; radiance of the rest
# The mean radiance: 1 / SHARE from SHARE of the area, and DIM from the rest.
MEAN = 1 + DIM * (1 - SHARE)
ALLOWED = 4  # standard errors: by chance once in 16,000 runs


def scene():
    side = SHARE ** 0.5
    squares = [(x + 0.3, y + 0.4) for y in range(SIZE) for x in range(SIZE)]
    points = " ".join("%.6f %.6f 0" % (x + u, y + v) for x, y in squares for u, v in
                      ((0, 0), (side, 0), (side, side), (0, side)))
    indices = " ".join("%d %d %d %d %d %d" % tuple(4 * k + i for i in (0, 1, 2, 0, 2, 3)) for k in range(len(squares)))
    half = SIZE / 2
    return f"""\
Film "image" "integer xresolution" [{SIZE}] "integer yresolution" [{SIZE}]
Sampler "random"
Integrator "whitted" "integer maxdepth" [1]
LookAt {half} {half} -10  {half} {half} 0  0 1 0
Camera "orthographic" "float screenwindow" [{-half} {half} {-half} {half}]
WorldBegin
  LightSource "infinite" "rgb L" [{DIM} {DIM} {DIM}]
  AreaLightSource "diffuse" "rgb L" [{1 / SHARE} {1 / SHARE} {1 / SHARE}] "bool twosided" ["true"]
  Material "matte" "rgb Kd" [0 0 0]
  Shape "trianglemesh" "integer indices" [{indices}] "point P" [{points}]
WorldEnd
"""


def mean_of(path):
    """The mean of a little-endian PFM of three channels."""
    with open(path, "rb") as f:
        kind, size, scale = f.readline(), f.readline(), f.readline()
        data = f.read()
    assert kind == b"PF\n" and size.split() == [b"%d" % SIZE] * 2 and float(scale) < 0
    return statistics.fmean(memoryview(data).cast("f"))


def main():
    if not WHIT:
        return 77
    with tempfile.TemporaryDirectory() as folder:
        path, picture = os.path.join(folder, "scene.pbrt"), os.path.join(folder, "picture.pfm")
        with open(path, "w", encoding="utf-8") as f:
            f.write(scene())
        means = []
        for seed in range(SEEDS):
            subprocess.run([WHIT, "render", path, "--target-error", "200%", "--seed", str(seed), "--quiet",
                            "--nthreads", "1", "--display", "none", "--outfile", picture], check=True)
            means.append(mean_of(picture))
    off, error = statistics.fmean(means) - MEAN, statistics.stdev(means) / SEEDS ** 0.5
    print("mean of %d pictures: %+.2f %% off, %.2f %% by chance" % (SEEDS, 100 * off / MEAN, 100 * error / MEAN))
    if abs(off) > ALLOWED * error:
        print("the pictures are %s" % ("too dark" if off < 0 else "too bright"))
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
