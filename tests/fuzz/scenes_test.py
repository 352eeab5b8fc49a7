#!/usr/bin/env python3
"""Mutates valid scenes and renders them: no crash, no hang, no exit code but 0 to 5, no number in a picture that is none.

    WHIT=build/release/whit tests/fuzz/scenes_test.py [--runs N] [--first I] [--keep DIR]

Run I is a function of I alone: one to four mutations (tokens lost, doubled and exchanged, numbers at their extremes, wrong
types, lists cut and grown, statements moved and borrowed from other scenes, bytes that are no text) of one scene of this
repository, often under another integrator with parameters that make sense or none, rendered at a quarter of its size with
one sample a pixel. --runs 1 --first I --keep DIR shows one again.
As a test, 500 runs.
"""
import argparse
import concurrent.futures
import glob
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
WHIT = os.environ.get("WHIT", os.path.join(ROOT, "build", "release", "whit"))
FOLDERS = ("scenes", "scenes/analytic", "tests/conformance/scenes", "tests/field")
SECONDS = 10  # of CPU: a hang
WAIT = 120  # seconds by the clock: a hang that does nothing, on however busy a machine
MEMORY = 6 << 30  # of addresses: what a mutated resolution or count asks for must not bring the machine down

TOKEN = re.compile(rb'"[^"\n]*"|#[^\n]*|[\[\]]|[^\s"\[\]#]+|\s+|.', re.S)
NUMBER = re.compile(rb"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")
DECLARATION = re.compile(rb'"\s*(\w+)\s+([^"\s]+)\s*"$')
EXTREMES = [b"0", b"-0", b"1", b"-1", b"0.5", b"1e-45", b"1e-38", b"1e-30", b"1e-12", b"-1e-6", b"1e6", b"1e7", b"-1e12", b"1e14",
            b"1e20", b"-1e20", b"1e38", b"3.4e38", b"-3.4e38", b"1e39", b"1e308", b"1e400", b"1e-400", b"2147483647", b"2147483648",
            b"-2147483648", b"4294967296", b"65536", b"nan", b"inf", b"-inf", b"1e", b"0x10", b"7.5", b"-3"]
TYPES = [b"float", b"integer", b"bool", b"string", b"rgb", b"color", b"xyz", b"spectrum", b"blackbody", b"texture", b"point",
         b"point2", b"point3", b"vector", b"vector2", b"normal", b"normal3", b"double"]
INTEGRATORS = [b"ambientocclusion", b"directlighting", b"path", b"whitted", b"volpath"]
# Counts of directions that end within the time, and what is no count.
INTEGRATOR_PARAMETERS = {
    b"integer maxdepth": EXTREMES, b"float rrthreshold": EXTREMES,
    b"integer nsamples": [b"1", b"2", b"100", b"0", b"-1", b"2147483648", b"nan"],
    b"bool cossample": [b'"true"', b'"false"', b'"maybe"', b"1"],
    b"string strategy": [b'"one"', b'"all"', b'"none"', b"1"],
    b"string lightsamplestrategy": [b'"uniform"', b'"power"', b'"spatial"', b'"Spatial"', b'""', b"0.5"],
    b"integer pixelbounds": [b"0 9 0 9", b"3 9", b"-2147483648 2147483647 0 9", b"9 3 0 9", b"5"]}


class Scene:
    """A scene as tokens, white space included, and the folder that its files are in."""

    def __init__(self, path):
        self.folder = os.path.dirname(path)
        with open(path, "rb") as f:
            self.tokens = TOKEN.findall(f.read())


class Mutator:
    def __init__(self, scene, corpus, rng):
        self.tokens, self.corpus, self.rng = list(scene.tokens), corpus, rng
        self.mutations = [self.lose, self.double, self.exchange, self.number, self.number, self.number, self.scale, self.retype,
                          self.cut_list, self.grow_list, self.rename, self.borrow_word, self.lose_line, self.double_line,
                          self.move_line, self.borrow_line, self.end_early, self.noise]

    def mutate(self):
        for _ in range(self.rng.randint(1, 4)):
            if self.tokens:
                self.rng.choice(self.mutations)()
        if self.rng.random() < 0.6:
            self.integrator()
        return b"".join(self.tokens)

    def places(self, wanted, tokens=None):
        return [i for i, t in enumerate(self.tokens if tokens is None else tokens) if wanted(t)]

    def pick(self, wanted):
        found = self.places(wanted)
        return self.rng.choice(found) if found else None

    def any_token(self):
        return self.pick(lambda t: not t.isspace() and not t.startswith(b"#"))

    def lose(self):
        if (i := self.any_token()) is not None:
            del self.tokens[i]

    def double(self):
        if (i := self.any_token()) is not None:
            self.tokens[i:i] = [self.tokens[i], b" "]

    def exchange(self):
        i, j = self.any_token(), self.any_token()
        if i is not None:
            self.tokens[i], self.tokens[j] = self.tokens[j], self.tokens[i]

    def number(self):
        if (i := self.pick(NUMBER.match)) is not None:
            self.tokens[i] = self.rng.choice(EXTREMES)

    def scale(self):
        if (i := self.pick(NUMBER.match)) is not None:
            self.tokens[i] = b"%.9g" % (float(self.tokens[i]) * self.rng.choice((-1, 1)) * 10 ** self.rng.uniform(-12, 12))

    def retype(self):
        if (i := self.pick(DECLARATION.match)) is not None:
            self.tokens[i] = b'"%s %s"' % (self.rng.choice(TYPES), DECLARATION.match(self.tokens[i]).group(2))

    def a_list(self):
        """The first and last position inside of some brackets."""
        i = self.pick(lambda t: t == b"[")
        if i is None:
            return None
        end = next((j for j in range(i, len(self.tokens)) if self.tokens[j] == b"]"), len(self.tokens))
        return i + 1, end

    def cut_list(self):
        if (found := self.a_list()) is not None:
            first, last = found
            del self.tokens[self.rng.randint(first, last):last]

    def grow_list(self):
        if (found := self.a_list()) is not None:
            first, last = found
            self.tokens[last:last] = [b" "] + self.tokens[first:last]

    def rename(self):
        """A quoted word for another of the same scene: names of nothing, plugins of another category."""
        i, j = (self.pick(lambda t: t.startswith(b'"')) for _ in range(2))
        if i is not None:
            self.tokens[i] = self.tokens[j]

    def borrow_word(self):
        other = self.rng.choice(self.corpus).tokens
        same = (lambda t: t.startswith(b'"')) if self.rng.random() < 0.7 else (lambda t: t[:1].isupper())
        i, theirs = self.pick(same), self.places(same, other)
        if i is not None and theirs:
            self.tokens[i] = other[self.rng.choice(theirs)]

    @staticmethod
    def lines(tokens):
        """Pairs of first and last position of what stands between line breaks."""
        breaks = [-1] + [i for i, t in enumerate(tokens) if b"\n" in t] + [len(tokens)]
        return [(a + 1, b) for a, b in zip(breaks, breaks[1:]) if b > a + 1]

    def a_line(self):
        found = self.lines(self.tokens)
        return self.rng.choice(found) if found else (0, 0)

    def lose_line(self):
        first, last = self.a_line()
        del self.tokens[first:last]

    def double_line(self):
        first, last = self.a_line()
        self.tokens[last:last] = [b"\n"] + self.tokens[first:last]

    def move_line(self):
        first, last = self.a_line()
        line = self.tokens[first:last]
        del self.tokens[first:last]
        to, _ = self.a_line()
        self.tokens[to:to] = line + [b"\n"]

    def borrow_line(self):
        other = self.rng.choice(self.corpus).tokens
        first, last = self.rng.choice(self.lines(other))
        to, _ = self.a_line()
        self.tokens[to:to] = other[first:last] + [b"\n"]

    def integrator(self):
        """An integrator of its own at the end of the camera's part, with some of what the integrators know."""
        named = self.rng.sample(sorted(INTEGRATOR_PARAMETERS), self.rng.randint(0, 3))
        parameters = b" ".join(b'"%s" [%s]' % (n, self.rng.choice(INTEGRATOR_PARAMETERS[n])) for n in named)
        begin = next((i for i, t in enumerate(self.tokens) if t == b"WorldBegin"), 0)
        self.tokens[begin:begin] = [b'Integrator "%s" %s\n' % (self.rng.choice(INTEGRATORS), parameters)]

    def end_early(self):
        del self.tokens[self.rng.randrange(len(self.tokens)):]

    def noise(self):
        self.tokens.insert(self.rng.randrange(len(self.tokens) + 1), self.rng.randbytes(self.rng.randint(1, 8)))


def corpus():
    scenes = []
    for folder in FOLDERS:
        for path in sorted(glob.glob(os.path.join(ROOT, folder, "*.pbrt"))):
            scenes.append(Scene(path))
    return scenes


def link_files(folder, to):
    """Gives a folder what the scenes of another refer to by name."""
    for name in os.listdir(folder):
        if not name.endswith(".pbrt"):
            os.symlink(os.path.join(folder, name), os.path.join(to, name))


def is_finite(path):
    """Whether every number of an EXR or PFM is one."""
    import numpy as np  # pylint: disable=import-outside-toplevel
    import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
    pixels = oiio.ImageBuf(path).get_pixels(oiio.FLOAT)
    return pixels is not None and bool(np.isfinite(pixels).all())


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))


def run(number, scenes, keep):
    """What is wrong with a run; "" when nothing is. The exit code comes with it."""
    rng = random.Random("scenes %d" % number)
    scene = rng.choice(scenes)
    text = Mutator(scene, scenes, rng).mutate()
    with tempfile.TemporaryDirectory(prefix="whit fuzz ") as folder:
        link_files(scene.folder, folder)
        path, picture = os.path.join(folder, "scene.pbrt"), os.path.join(folder, "picture.exr")
        with open(path, "wb") as f:
            f.write(text)
        command = [WHIT, path, "--quick", "--spp", "1", "--nthreads", "1", "--quiet", "--display", "none", "--outfile", picture]
        if rng.random() < 0.3:
            command.append("--keep-going")
        problem, code = "", None
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                  timeout=WAIT, preexec_fn=limit, check=False)
            code = done.returncode
            if code in (-signal.SIGXCPU, -signal.SIGKILL):
                problem = "still running after %d CPU seconds" % SECONDS
            elif not 0 <= code <= 5:
                problem = "exit code %d: %s" % (code, done.stderr[-300:].decode(errors="replace"))
            elif code == 0 and not os.path.exists(picture):
                problem = "exit code 0, and no picture"
        except subprocess.TimeoutExpired:
            problem = "still running after %d s" % WAIT
        if not problem and os.path.exists(picture) and not is_finite(picture):
            problem = "the picture has a number that is none"
        if keep and (problem or keep.everything):
            os.makedirs(keep.folder, exist_ok=True)
            with open(os.path.join(keep.folder, "%d.pbrt" % number), "wb") as f:
                f.write(b"# run %d of %s\n# %s\n" % (number, scene.folder.encode(), " ".join(command[1:]).encode()) + text)
    return problem, code


class Keep:
    def __init__(self, folder, everything):
        self.folder, self.everything = folder, everything


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--keep", metavar="DIR", help="leave the scenes of runs that fail there")
    args = parser.parse_args()
    if not os.access(WHIT, os.X_OK):
        print("the program is not built")
        return 77
    scenes = corpus()
    keep = Keep(args.keep, args.runs == 1) if args.keep else None
    codes, failures = {}, 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        numbers = range(args.first, args.first + args.runs)
        for number, (problem, code) in zip(numbers, pool.map(lambda n: run(n, scenes, keep), numbers)):
            codes[code] = codes.get(code, 0) + 1
            if problem:
                failures += 1
                print("run %d: %s" % (number, problem), flush=True)
    print("%d runs of %d scenes, exit codes %s, %d failures" %
          (args.runs, len(scenes), dict(sorted(codes.items(), key=str)), failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
