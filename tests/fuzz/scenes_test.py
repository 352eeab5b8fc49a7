#!/usr/bin/env python3
"""Mutates valid scenes and renders them: no crash, no hang, no exit code but 0 to 5, no number in a picture that is none, no
picture that is black without a word where nobody would expect it.

    WHIT=build/release/whit tests/fuzz/scenes_test.py [--runs N] [--first I] [--keep DIR] [--memory MIB]

Run I is a function of I alone: one to four mutations (tokens lost, doubled and exchanged, numbers at their extremes, wrong
types, lists cut and grown, statements moved and borrowed from other scenes, bytes that are no text) of one scene of this
repository, often under another integrator with parameters that make sense or none, rendered with one sample a pixel and
some 64 pixels. --runs 1 --first I --keep DIR shows one again. As a test, 500 runs; --runs 100000 takes about an hour.

A picture is silently black when the scene's own is not, nothing was said, `whit check` finds nothing either that explains
it, and it is not black any more with all extreme numbers brought back to where scenes are.
"""
import argparse
import array
import concurrent.futures
import glob
import json
import math
import multiprocessing
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
WAIT = 600  # seconds by the clock: a hang that does nothing, on however busy a machine
SIZE = 32  # of a side, of which --quick renders a quarter

TOKEN = re.compile(rb'"[^"\n]*"|#[^\n]*|[\[\]]|[^\s"\[\]#]+|\s+|.', re.S)
NUMBER = re.compile(rb"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")
DECLARATION = re.compile(rb'"\s*(\w+)\s+([^"\s]+)\s*"$')
EXTREMES = [b"0", b"-0", b"1", b"-1", b"0.5", b"1e-45", b"1e-38", b"1e-30", b"1e-12", b"-1e-6", b"1e6", b"1e7", b"-1e12", b"1e14",
            b"1e20", b"-1e20", b"1e38", b"3.4e38", b"-3.4e38", b"1e39", b"1e308", b"1e400", b"1e-400", b"2147483647", b"2147483648",
            b"-2147483648", b"4294967296", b"65536", b"nan", b"inf", b"-inf", b"1e", b"0x10", b"7.5", b"-3"]
TYPES = [b"float", b"integer", b"bool", b"string", b"rgb", b"color", b"xyz", b"spectrum", b"blackbody", b"texture", b"point",
         b"point2", b"point3", b"vector", b"vector2", b"normal", b"normal3", b"double"]
INTEGRATORS = [b"ambientocclusion", b"directlighting", b"path", b"whitted", b"volpath"]
# Counts of bounces and directions that end within the time, and what is no count. A million bounces between mirrors are
# what a scene may ask for, and no hang.
INTEGRATOR_PARAMETERS = {
    b"integer maxdepth": [n for n in EXTREMES if n not in (b"1e6", b"65536")] + [b"100"], b"float rrthreshold": EXTREMES,
    b"integer nsamples": [b"1", b"2", b"100", b"0", b"-1", b"2147483648", b"nan"],
    b"bool cossample": [b'"true"', b'"false"', b'"maybe"', b"1"],
    b"string strategy": [b'"one"', b'"all"', b'"none"', b"1"],
    b"string lightsamplestrategy": [b'"uniform"', b'"power"', b'"spatial"', b'"Spatial"', b'""', b"0.5"],
    b"integer pixelbounds": [b"0 9 0 9", b"3 9", b"-2147483648 2147483647 0 9", b"9 3 0 9", b"5"]}


RESOLUTION = re.compile(rb'("\s*integer\s+[xy]resolution\s*"\s*\[?\s*)\d+')


class Scene:
    """A scene as tokens, white space included, and the folder that its files are in. Its picture is made small: what there is
    to find is in the statements, and a run shall take no longer than the program's start."""

    def __init__(self, path):
        self.folder = os.path.dirname(path)
        with open(path, "rb") as f:
            self.text = RESOLUTION.sub(rb"\g<1>%d" % SIZE, f.read())
        self.tokens = TOKEN.findall(self.text)


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


def tamed(text):
    """The text with all numbers that are large beyond reason made reasonable, and their signs kept."""
    def tame(token):
        if not NUMBER.match(token) or abs(float(token)) < 1e9:
            return token
        return b"-100" if token.startswith(b"-") else b"100"
    return b"".join(map(tame, TOKEN.findall(text)))


def picture_of(path):
    """The numbers of a PFM file."""
    with open(path, "rb") as f:
        f.readline(), f.readline(), f.readline()
        return array.array("f", f.read())


class Rendered:
    """What a run of the program came to: its exit code (None: it was ended), what it said, its picture (None: there is none)."""

    def __init__(self, code, said, picture):
        self.code, self.said, self.picture = code, said, picture

    def is_black(self):
        return self.picture is not None and not any(self.picture)


class Workplace:
    """A folder of one worker, with a folder for each of those that scenes come from, which have the files that these name."""

    def __init__(self, memory):
        self.memory = memory
        self.at = tempfile.TemporaryDirectory(prefix="whit fuzz ")
        self.scenes = corpus()
        self.own = {}  # by scene: what it renders as it is
        for folder in {s.folder for s in self.scenes}:
            os.makedirs(self.place(folder))
            for name in os.listdir(folder):
                if not name.endswith(".pbrt"):
                    os.symlink(os.path.join(folder, name), os.path.join(self.place(folder), name))

    def place(self, folder):
        return os.path.join(self.at.name, os.path.relpath(folder, ROOT).replace(os.sep, "_"))

    def limit(self):
        """Memory that is written to, not addresses: Embree and the allocators reserve far more of these than they use."""
        resource.setrlimit(resource.RLIMIT_DATA, (self.memory, self.memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))

    def call(self, *arguments):
        return subprocess.run([WHIT, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              timeout=WAIT, preexec_fn=self.limit, check=False)

    def write(self, scene, text):
        path = os.path.join(self.place(scene.folder), "scene.pbrt")
        with open(path, "wb") as f:
            f.write(text)
        return path

    def render(self, scene, text, flags=()):
        picture = os.path.join(self.at.name, "picture.pfm")
        if os.path.exists(picture):
            os.remove(picture)
        try:
            done = self.call(self.write(scene, text), "--quick", "--spp", "1", "--nthreads", "1", "--quiet", "--display", "none",
                             "--outfile", picture, *flags)
        except subprocess.TimeoutExpired:
            return Rendered(None, b"", None)
        return Rendered(done.returncode, done.stderr, picture_of(picture) if os.path.exists(picture) else None)

    def is_lit(self, scene):
        """Whether a scene of the repository has a picture that is not black."""
        if scene not in self.own:
            own = self.render(scene, scene.text)
            self.own[scene] = own.picture is not None and not own.is_black()
        return self.own[scene]

    def is_explained(self, scene, text):
        """Whether `whit check` has a word about a scene."""
        done = self.call("check", "--json", self.write(scene, text))
        return done.returncode != 0 or bool(json.loads(done.stdout)["diagnostics"])

    def is_silently_black(self, scene, text, rendered, flags):
        if rendered.code != 0 or rendered.said or not rendered.is_black() or not self.is_lit(scene):
            return False
        return not self.is_explained(scene, text) and not self.render(scene, tamed(text), flags).is_black()


def problem_of(place, scene, text, flags):
    """What is wrong with a run, "" when nothing is; and its exit code."""
    rendered = place.render(scene, text, flags)
    code = rendered.code
    if code is None:
        return "still running after %d s" % WAIT, code
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        return "still running after %d CPU seconds" % SECONDS, code
    if not 0 <= code <= 5:
        return "exit code %d: %s" % (code, rendered.said[-300:].decode(errors="replace")), code
    if code == 0 and rendered.picture is None:
        return "exit code 0, and no picture", code
    if rendered.picture is not None and not all(map(math.isfinite, rendered.picture)):
        return "the picture has a number that is none", code
    if place.is_silently_black(scene, text, rendered, flags):
        return "the picture is black, and nothing was said", code
    return "", code


def run(number, place, keep):
    rng = random.Random("scenes %d" % number)
    scene = rng.choice(place.scenes)
    text = Mutator(scene, place.scenes, rng).mutate()
    flags = ("--keep-going",) if rng.random() < 0.3 else ()
    problem, code = problem_of(place, scene, text, flags)
    if keep and (problem or keep.everything):
        os.makedirs(keep.folder, exist_ok=True)
        with open(os.path.join(keep.folder, "%d.pbrt" % number), "wb") as f:
            f.write(b"# run %d of %s %s: %s\n" % (number, scene.folder.encode(), " ".join(flags).encode(),
                                                  problem.encode().replace(b"\n", b" ")) + text)
    return problem, code


class Keep:
    def __init__(self, folder, everything):
        self.folder, self.everything = folder, everything


HERE = {}  # what a worker has


def start_worker(memory, keep):
    HERE.update(place=Workplace(memory), keep=keep)


def run_here(number):
    return run(number, **HERE)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--memory", type=int, default=2048, metavar="MIB", help="that a run may take (default: 2048)")
    parser.add_argument("--keep", metavar="DIR", help="leave the scenes of runs that fail there")
    args = parser.parse_args()
    if not os.access(WHIT, os.X_OK):
        print("the program is not built")
        return 77
    keep = Keep(args.keep, args.runs == 1) if args.keep else None
    codes, failures = {}, 0
    # Processes, for a small one is soon forked, and as a whole they are as quick as the cores.
    with concurrent.futures.ProcessPoolExecutor(args.jobs, multiprocessing.get_context("fork"), start_worker,
                                                (args.memory << 20, keep)) as pool:
        numbers = range(args.first, args.first + args.runs)
        for number, (problem, code) in zip(numbers, pool.map(run_here, numbers, chunksize=10)):
            codes[code] = codes.get(code, 0) + 1
            if problem:
                failures += 1
                print("run %d: %s" % (number, problem), flush=True)
    print("%d runs of %d scenes, exit codes %s, %d failures" %
          (args.runs, len(corpus()), dict(sorted(codes.items(), key=str)), failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
