"""whit render --checkpoint and --resume: pictures after kills, signals, full disks; what is refused, and what is said."""
import os
import random
import re
import resource
import signal
import subprocess
import tempfile
import time
import unittest

WHIT = os.environ.get("WHIT", "")

# Three scenes: one with AOVs, one adaptive, one whose filter reaches over tiles. Each renders for about a second.
SCENE = """Film "image" "integer xresolution" [160] "integer yresolution" [120] "string filename" "picture.exr"
LookAt 0 2 -6  0 0.5 0  0 1 0
Camera "perspective" "float fov" [45]
Sampler "sobol" "integer pixelsamples" [{samples}]
{options}
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [20 18 15]
  Translate 1 4 -2
  Rotate 90 1 0 0
  Shape "disk" "float radius" [0.7]
AttributeEnd
Material "matte" "rgb Kd" [0.5 0.6 0.7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-5 0 -5 5 0 -5 5 0 5 -5 0 5]
Translate 0 1 0
Material "glass"
Shape "sphere"
Translate 2 0 1
Material "plastic"
Shape "sphere"
WorldEnd
"""
# Sanitizers make them thirty times slower.
SAMPLES, ERROR = (16, "5%") if os.environ.get("WHIT_SANITIZE") else (512, "0.9%")
SCENES = {
    "aovs": (SAMPLES, '', ["--aov", "albedo,N,shape,variance,samples"]),
    "adaptive": (16, '', ["--target-error", ERROR, "--seed", "3"]),
    "filtered": (SAMPLES, 'PixelFilter "gaussian" "float xwidth" [2] "float ywidth" [2]', []),
}


@unittest.skipUnless(WHIT, "the program is not built")
class Checkpoints(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, samples=64, options=""):
        with open(self.path(name), "w", encoding="utf-8") as f:
            f.write(SCENE.format(samples=samples, options=options))

    def read(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()

    def command(self, *args):
        return [WHIT, "scene.pbrt", "--display", "none", *args]

    def run_whit(self, *args, code=0, **more):
        done = subprocess.run(self.command(*args), cwd=self.folder.name, capture_output=True, text=True, timeout=300,
                              check=False, **more)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def hidden(self):
        return [name for name in os.listdir(self.folder.name) if name.startswith(".")]

    def killed(self, seconds, *args):
        """The exit code of a run that is killed after so long; None where it was done before."""
        process = subprocess.Popen(self.command(*args), cwd=self.folder.name, stderr=subprocess.DEVNULL)
        try:
            process.wait(timeout=seconds)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        return process.returncode

    def signal_once_rendering(self, process, number):
        """Before it renders a signal ends it, as any program: from then on it is caught, as the kernel tells."""
        while process.poll() is None:
            with open(f"/proc/{process.pid}/status", encoding="ascii") as f:
                caught = int(re.search(r"SigCgt:\s*([0-9a-f]+)", f.read())[1], 16)
            if caught >> (signal.SIGTERM - 1) & 1:
                break
            time.sleep(0.02)
        time.sleep(0.3)
        process.send_signal(number)

    def test_kills(self):
        """A picture after random kills is the picture without. WHIT_KILLS says how many in all (10; by hand 200)."""
        kills = int(os.environ.get("WHIT_KILLS", "10"))
        rng = random.Random(int(os.environ.get("WHIT_KILL_SEED", "1")))
        done = 0
        while done < kills:
            for name, (samples, options, flags) in SCENES.items():
                self.write("scene.pbrt", samples, options)
                started = time.monotonic()
                self.run_whit("-o", "whole.exr", "--quiet", *flags)
                length = time.monotonic() - started
                for _ in range(max(1, kills // (2 * len(SCENES)))):
                    killed = self.one_render_with_kills(rng, length, flags)
                    done += killed
                    self.assertEqual(self.read("picture.exr"), self.read("whole.exr"), name)
        print(f"{done} kills")

    def one_render_with_kills(self, rng, length, flags):
        for name in ("state", "picture.exr"):
            if os.path.exists(self.path(name)):
                os.remove(self.path(name))
        kills = 0
        while True:
            keep = ["--resume" if os.path.exists(self.path("state")) else "--checkpoint", "state"]
            # Four kills on the way, or more where little was kept.
            seconds = rng.uniform(0.1, 0.5) * max(length, 0.2)
            code = self.killed(seconds if kills < 4 else 300, *keep, "--every", "0.02s", "--quiet", *flags)
            if code == 0:
                return kills
            self.assertEqual(code, -signal.SIGKILL)
            kills += 1

    def test_more_samples(self):
        """64 and 192 are 256."""
        self.write("scene.pbrt", 64)
        self.run_whit("--checkpoint", "state", "-o", "some.exr")
        self.run_whit("--resume", "state", "--samples", "+192", "-o", "more.exr", "--type", "float")
        self.run_whit("--spp", "256", "--footprint-spp", "64", "-o", "whole.exr", "--type", "float")
        self.assertEqual(*(subprocess.run([WHIT, "diff", "more.exr", "whole.exr", "--json"], cwd=self.folder.name,
                                          capture_output=True, text=True, check=False).returncode for _ in "1"), 0)
        # Of a sampler whose samples are one set there are no more.
        self.run_whit("--sampler", "halton", "--checkpoint", "set", "--quiet")
        self.assertIn("cannot go on beyond their number",
                      self.run_whit("--sampler", "halton", "--resume", "set", "--samples", "+64", code=2))
        # Resuming what is whole writes the picture again, without another sample.
        said = self.run_whit("--resume", "state", "-o", "again.exr", "--type", "float")
        self.assertIn("256 samples per pixel", said)
        self.assertEqual(self.read("again.exr")[-20000:], self.read("more.exr")[-20000:])

    def test_signals(self):
        """They end the tile, write what there is with a note in the header, and exit with 5."""
        self.write("scene.pbrt", 1 << 20)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            name = number.name
            process = subprocess.Popen(self.command("--checkpoint", f"{name}.state", "-o", "stopped.exr"),
                                       cwd=self.folder.name, stderr=subprocess.PIPE, text=True)
            self.signal_once_rendering(process, number)
            said = process.communicate(timeout=60)[1]
            self.assertEqual(process.returncode, 5, said)
            self.assertRegex(said, rf"whit: stopped by {name} with [0-9.e-]+ % of the samples; --resume {name}.state goes on")
            self.assertIn(f"stopped by {name} with".encode(), self.read("stopped.exr"))
            self.assertEqual(self.hidden(), [])
        # The state is that of a render that has not ended: it is not written over.
        said = self.run_whit("--checkpoint", "SIGINT.state", code=4)
        self.assertIn("holds a render that has not ended; --resume SIGINT.state goes on with it", said)
        # What is to be pasted into a shell is one word there.
        os.rename(self.path("SIGINT.state"), self.path("a state"))
        self.assertIn("--resume 'a state' goes on with it", self.run_whit("--checkpoint", "a state", code=4))

    def test_a_signal_without_a_checkpoint(self):
        self.write("scene.pbrt", 1 << 20)
        for flags in ([], ["--target-error", "0.0001%"]):
            process = subprocess.Popen(self.command("-o", "stopped.exr", *flags), cwd=self.folder.name,
                                       stderr=subprocess.PIPE, text=True)
            self.signal_once_rendering(process, signal.SIGTERM)
            said = process.communicate(timeout=60)[1]
            self.assertEqual(process.returncode, 5, said)
            self.assertRegex(said, r"whit: stopped by SIGTERM with [0-9.e-]+ % of the samples\n")
            self.assertTrue(os.path.exists(self.path("stopped.exr")))

    def test_others_are_refused(self):
        """Another scene, binary or settings: with the difference named, and the state stays as it is."""
        self.write("scene.pbrt", 16)
        self.run_whit("--checkpoint", "state", "--quiet")
        state = self.read("state")
        for flags, said in ((["--spp", "8"], "--spp was none and is 8"),
                            (["--seed", "2"], "--seed was none and is 2"),
                            (["--cropwindow", "0", "0.5", "0", "1"], "--cropwindow was none and is 0,0.5,0,1"),
                            (["--integrator", "path"], "--integrator was none and is path"),
                            (["--aov", "albedo"], "--aov was none and is albedo"),
                            (["--target-error", "1%"], "--target-error was none and is 1%")):
            self.assertIn("which is of another render: " + said, self.run_whit("--resume", "state", *flags, code=2))
        # What samples do not depend on may be another.
        self.run_whit("--resume", "state", "--quiet", "--nthreads", "1", "--type", "float", "-o", "other.exr")
        self.write("scene.pbrt", 16, "# another comment")
        self.assertIn("the scene's text is another one", self.run_whit("--resume", "state", code=2))
        with open(self.path("state"), "wb") as f:
            f.write(state[:-100] + b"x" + state[-99:])
        self.assertIn("it is damaged: its checksum is wrong", self.run_whit("--resume", "state", code=4))
        self.assertIn("it is no checkpoint", self.run_whit("--resume", "scene.pbrt", code=4))
        self.assertIn("No such file", self.run_whit("--resume", "none", code=4))
        self.assertIn("is there already and no checkpoint", self.run_whit("--checkpoint", "scene.pbrt", code=4))

    def test_an_asset_that_changed(self):
        mesh = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 {} 0\n3 0 1 2\n")
        with open(self.path("scene.pbrt"), "w", encoding="utf-8") as f:
            f.write('Film "image" "integer xresolution" 8 "integer yresolution" 8\nWorldBegin\n'
                    'Shape "plymesh" "string filename" "a.ply"\nLightSource "infinite"\nWorldEnd\n')
        for height in (1, 2):
            with open(self.path("a.ply"), "w", encoding="utf-8") as f:
                f.write(mesh.format(height))
            if height == 1:
                self.run_whit("--checkpoint", "state", "--quiet")
        self.assertIn("the file a.ply is another one", self.run_whit("--resume", "state", code=2))

    def test_wrong_usage(self):
        self.write("scene.pbrt", 4)
        for flags, said in ((["--samples", "+4"], "--resume goes on with"),
                            (["--resume", "x", "--samples", "4"], 'write +192'),
                            (["--checkpoint", "x", "--every", "soon"], "write 30s"),
                            (["--checkpoint", "x", "scene.pbrt"], "several scenes")):
            self.assertIn(said, self.run_whit(*flags, code=2))

    def test_full_disk(self):
        """A file may not grow beyond some size at 20 moments: what was there before stays, and what was rendered is kept
        where the state fits."""
        self.write("scene.pbrt", 4)
        self.run_whit("-o", "picture.exr", "--quiet")
        before = self.read("picture.exr")
        self.run_whit("-o", "seeded.exr", "--seed", "1", "--quiet", "--checkpoint", "state")
        state, picture = len(self.read("state")), len(before)
        self.assertGreater(state, picture)
        os.remove(self.path("state"))
        kept = 0
        for step in range(20):
            limit = picture * step // 10 if step < 10 else picture + (state - picture) * (step - 10) // 9
            if os.path.exists(self.path("state")):
                os.remove(self.path("state"))
            done = subprocess.run(
                self.command("-o", "picture.exr", "--seed", "1", "--checkpoint", "state"), cwd=self.folder.name,
                capture_output=True, text=True, timeout=300, check=False,
                preexec_fn=lambda size=limit: resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY)))
            self.assertIn(done.returncode, (0, 4), (limit, done.stderr))
            self.assertEqual(self.hidden(), [])
            if done.returncode == 4:
                self.assertEqual(self.read("picture.exr"), before, limit)
                self.assertRegex(done.stderr, "cannot write .*File too large")
            else:
                self.assertEqual(self.read("picture.exr"), self.read("seeded.exr"))
                with open(self.path("picture.exr"), "wb") as f:
                    f.write(before)
            if limit < state:
                self.assertIn("warning: cannot write the checkpoint", done.stderr)
            else:
                kept += 1
        self.assertGreater(kept, 0)

    def test_the_folder_vanishes(self):
        """The picture is in the checkpoint, and the message says so."""
        self.write("scene.pbrt", 1 << 20)
        os.mkdir(self.path("out"))
        process = subprocess.Popen(self.command("-o", "out/picture.exr", "--checkpoint", "state", "--every", "0.1s"), cwd=self.folder.name,
                                   stderr=subprocess.PIPE, text=True)
        while not os.path.exists(self.path("state")) and process.poll() is None:
            time.sleep(0.02)
        os.rmdir(self.path("out"))
        self.signal_once_rendering(process, signal.SIGINT)
        said = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 4, said)
        self.assertIn("what was rendered is kept: the same command with --resume state and another --outfile writes it",
                      said)
        process = subprocess.Popen(self.command("-o", "picture.exr", "--resume", "state"), cwd=self.folder.name,
                                   stderr=subprocess.PIPE, text=True)
        self.signal_once_rendering(process, signal.SIGINT)
        share = float(re.search("with ([0-9.e-]+) %", process.communicate(timeout=60)[1])[1])
        self.assertGreater(share, float(re.search("([0-9.e-]+) %", said)[1]) if "%" in said else 0)
        self.assertTrue(os.path.exists(self.path("picture.exr")))


if __name__ == "__main__":
    unittest.main()
