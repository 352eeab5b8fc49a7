#!/usr/bin/env python3
"""Damages glTF models and renders them: no crash, no hang, no exit code but 0, 3, 4 and 5, no more than 2 GiB.

    WHIT=build/release/whit tests/cli/damaged_models_test.py [--runs N] [--first I] [--keep DIR]

Run I is a function of I alone: one to three injuries (cut short, bytes changed, numbers at their extremes, counts and offsets
that lie, indices of nothing, cycles of nodes, wrong types, keys lost and doubled) of one model of tests/gltf or, where they
are installed, of Debian's assimp-testmodels. --runs 1 --first I --keep DIR shows one again. As a test, 200 runs.
"""
import argparse
import concurrent.futures
import glob
import json
import os
import random
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import threading

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "gltf"))
import make_models  # noqa: E402

WHIT = os.path.abspath(os.environ.get("WHIT", os.path.join(ROOT, "build", "release", "whit")))
PUBLIC = "/usr/share/assimp/models"
SECONDS = 10  # of CPU
WAIT = 120  # by the clock, on however busy a machine
MEMORY = 2 << 30
GOOD = {0, 3, 4, 5}  # a sanitizer's finding is exit code 1, which no render has

EXTREMES = [0, -1, 1, 2, 255, 65535, 2 ** 31 - 1, 2 ** 31, 2 ** 32 - 1, 2 ** 32, 4e9, 2 ** 53, 2 ** 63, 2 ** 64, -2 ** 31, 0.5, -0.0, 1e-45,
            1e-30, 1e12, 1e20, 3.4e38, 1e39, 1e300, -1e300]
NAMES = ["count", "byteLength", "byteOffset", "byteStride", "bufferView", "buffer", "componentType", "mesh", "node", "skin", "camera",
         "source", "sampler", "material", "indices", "input", "output", "POSITION", "mode", "index", "scene", "texCoord"]
WORDS = ["", "VEC9", "SCALAR", "MAT4", "../../etc/passwd", "%2e%2e/x.bin", "data:;base64,!!!", "data:application/octet-stream;base64,AAAA", "BLEND",
         "\u0000", "x" * 5000, "file:///etc/passwd", "rotation", "TRIANGLES", "KHR_draco_mesh_compression"]


def corpus(folder):
    """(bytes, folder of what they name) for every model."""
    own = os.path.join(folder, "models")
    paths = make_models.write(own)
    paths += sorted(glob.glob(PUBLIC + "/**/*.gltf", recursive=True) + glob.glob(PUBLIC + "/**/*.glb", recursive=True))
    out = []
    for path in paths:
        with open(path, "rb") as f:
            out.append((f.read(), os.path.dirname(path)))
    return out


def document(data):
    """The JSON of a model and what stands behind it, or None."""
    try:
        if data[:4] != b"glTF":
            return json.loads(data), None
        length = struct.unpack_from("<I", data, 12)[0]
        return json.loads(data[20:20 + length]), data[20 + length:]
    except (ValueError, struct.error):
        return None


def model(doc, rest):
    text = json.dumps(doc).encode("utf-8", "surrogatepass")
    if rest is None:
        return text
    text += b" " * (-len(text) % 4)
    return struct.pack("<IIIII", 0x46546C67, 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest


def places(value):
    """(container, key) of everything in a document."""
    found, todo = [], [value]
    while todo:
        at = todo.pop()
        keys = list(at) if isinstance(at, dict) else range(len(at)) if isinstance(at, list) else []
        for key in keys:
            found.append((at, key))
            todo.append(at[key])
    return found


def hurt_document(doc, rng):
    where = places(doc)
    numbers = [(c, k) for c, k in where if isinstance(c[k], (int, float)) and not isinstance(c[k], bool)]
    kind = rng.randrange(8)
    if kind == 0 and numbers:
        c, k = rng.choice(numbers)
        c[k] = rng.choice(EXTREMES)
    elif kind == 1:  # the numbers that memory depends on
        named = [(c, k) for c, k in numbers if k in NAMES]
        if named:
            c, k = rng.choice(named)
            c[k] = rng.choice(EXTREMES)
    elif kind == 2 and isinstance(doc.get("nodes"), list) and doc["nodes"]:  # a cycle, or a second parent
        node = rng.choice(doc["nodes"])
        if isinstance(node, dict) and isinstance(node.setdefault("children", []), list):
            node["children"].append(rng.randrange(len(doc["nodes"])))
    elif kind == 3:
        c, k = rng.choice(where)
        c[k] = rng.choice([None, True, [], {}, "x", 7, [1, 2, 3], {"index": 0}])
    elif kind == 4:
        c, k = rng.choice(where)
        del c[k]
    elif kind == 5:
        lists = [(c, k) for c, k in where if isinstance(c[k], list) and c[k]]
        if lists:
            c, k = rng.choice(lists)
            c[k] = c[k] * rng.choice([2, 50])
    elif kind == 6:
        strings = [(c, k) for c, k in where if isinstance(c[k], str)]
        if strings:
            c, k = rng.choice(strings)
            c[k] = rng.choice(WORDS)
    else:
        at = doc
        for _ in range(rng.choice([10, 100, 600])):
            at["extras"] = {}
            at = at["extras"]


def hurt_bytes(data, rng):
    if rng.random() < 0.4:
        return data[:rng.randrange(len(data) + 1)]
    out = bytearray(data)
    for _ in range(rng.choice([1, 4, 40])):
        if out:
            out[rng.randrange(len(out))] = rng.randrange(256)
    return bytes(out)


def damaged(run, models):
    rng = random.Random(run)
    data, folder = rng.choice(models)
    for _ in range(rng.randint(1, 3)):
        parsed = document(data)
        if parsed and isinstance(parsed[0], dict) and rng.random() < 0.75:
            hurt_document(parsed[0], rng)
            data = model(*parsed)
        else:
            data = hurt_bytes(data, rng)
    return data, folder


def render(path, folder, out):
    """Exit code, peak memory in bytes, CPU seconds and what was said; -1000 for a hang that does nothing."""
    with open(out + ".log", "w+b") as log:
        child = subprocess.Popen([WHIT, path, "--quick", "--spp", "1", "--nthreads", "1", "--cropwindow", "0.4", "0.6", "0.4", "0.6", "--time", "0.3",
                                  "-o", out + ".exr", "--allow-outside"], cwd=folder, stdout=log, stderr=log, stdin=subprocess.DEVNULL,
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (10 * SECONDS, 10 * SECONDS)))
        timer = threading.Timer(WAIT, child.kill)
        timer.start()
        _, status, usage = os.wait4(child.pid, 0)
        timer.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        log.seek(0)
        return child.returncode, usage.ru_maxrss * 1024, usage.ru_utime + usage.ru_stime, log.read().decode(errors="replace")


def one(run, models, keep):
    data, folder = damaged(run, models)
    with tempfile.TemporaryDirectory() as own:
        # Beside links to what the model names.
        for name in os.listdir(folder):
            os.symlink(os.path.join(folder, name), os.path.join(own, name))
        path = os.path.join(own, f"damaged_{run}" + (".glb" if data[:4] == b"glTF" else ".gltf"))
        with open(path, "wb") as f:
            f.write(data)
        if keep:
            shutil.copy(path, keep)
        code, memory, seconds, said = render(path, own, os.path.join(own, "out"))
    sanitized = bool(os.environ.get("WHIT_SANITIZE"))
    problem = ""
    if code not in GOOD:
        problem = f"exit code {code}"
    elif seconds > SECONDS * (10 if sanitized else 1):
        problem = f"{seconds:.1f} s of CPU"
    elif memory > MEMORY:
        problem = f"{memory / 2 ** 20:.0f} MiB"
    elif code != 0 and "error" not in said and "whit:" not in said:
        problem = f"exit code {code} without a word"
    return run, code, problem, said


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--keep")
    flags = parser.parse_args()
    codes, failures = {}, 0
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        models = corpus(folder)
        runs = range(flags.first, flags.first + flags.runs)
        for run, code, problem, said in pool.map(lambda i: one(i, models, flags.keep), runs):
            codes[code] = codes.get(code, 0) + 1
            if problem:
                failures += 1
                print(f"run {run}: {problem}\n{said[-2000:]}")
            elif flags.keep:
                print(said)
    print(f"{len(models)} models, {flags.runs} runs, exit codes {dict(sorted(codes.items()))}, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
