"""whit-farm: pictures are those of a single render, with workers that are killed on the way, files that travel, and job arrays."""
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python"))
import package  # noqa: E402  (finds the package)
from viewer import Viewer  # noqa: E402
from whit import farm  # noqa: E402
from whit._farm_job import Job, folder_of  # noqa: E402
from whit._farm_plan import TimeModel  # noqa: E402

# Every part takes about as long as its start: many parts of small pictures.
MODEL = TimeModel(0.001, 0.5)
SBATCH = """#!/bin/bash
# Stands in for Slurm's: runs the tasks of an array one after another, each in a shell of its own.
set -e
last=$(sed -nE 's/^#SBATCH --array=0-([0-9]+)$/\\1/p' "$1")
for ((task = 0; task <= last; ++task)); do SLURM_ARRAY_TASK_ID=$task bash "$1"; done
"""


class Farm(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="whit farm ")  # a path with spaces
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        os.environ["WHIT"] = package.WHIT
        os.environ["WHIT_FARM_CACHE"] = self.path("cache")
        self.write("scene.pbrt", package.SCENE)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as f:
            f.write(text)

    def whole(self, *flags):
        subprocess.run([package.WHIT, self.path("scene.pbrt"), *flags, "--quiet", "--display", "none", "-o", self.path("whole.exr")],
                       check=True, cwd=self.folder)

    def expect_the_same(self, name="farm.exr"):
        with open(self.path(name), "rb") as a, open(self.path("whole.exr"), "rb") as b:
            self.assertEqual(a.read(), b.read())

    def test_two_of_four_workers_are_killed(self):
        # They are killed once two parts are there; what they rendered then runs again, on the others.
        flags = ["--spp", "64", "--aov", "N,shape,variance"]
        self.whole(*flags)
        killed = []

        def progress(share):
            if not killed and share > 0.05:
                # A program that a worker is about to start still has the worker's name, and is no child of this process.
                mine = [p for p in _processes_with("spawn_main") if _parent_of(p) == os.getpid()]
                for pid in mine[-2:]:
                    os.kill(pid, signal.SIGKILL)
                    killed.append(pid)

        report = farm.render(self.path("scene.pbrt"), self.path("farm.exr"), flags=flags, workers=4, model=TimeModel(0.01, 0.2),
                             progress=progress)
        self.assertEqual(len(killed), 2)
        self.assertGreater(len(report.parts), 8)
        self.assertEqual(len(report.part_seconds), len(report.parts))
        self.expect_the_same()

    def test_renders_that_are_killed_run_again(self):
        # The system does that where memory is short. The workers stay.
        flags = ["--spp", "64"]
        self.whole(*flags)
        killed = []

        def progress(share):
            for pid in [] if killed else _processes_with("--sample-range"):
                if _descends_from(pid, os.getpid()):
                    os.kill(pid, signal.SIGKILL)
                    killed.append(pid)

        farm.render(self.path("scene.pbrt"), self.path("farm.exr"), flags=flags, workers=2, model=TimeModel(0.01, 0.2),
                    progress=progress)
        self.assertGreater(len(killed), 0)
        self.expect_the_same()

    def test_renders_that_are_killed_each_time_end_it(self):
        self.write("whit", '#!/bin/bash\n[[ " $* " == *" --sample-range "* ]] && kill -KILL $$\nexec "%s" "$@"\n' % package.WHIT)
        os.chmod(self.path("whit"), 0o755)
        os.environ["WHIT"] = self.path("whit")
        with self.assertRaisesRegex(farm.FarmError, "ended by SIGKILL"):
            farm.render(self.path("scene.pbrt"), self.path("farm.exr"), workers=1, model=MODEL)

    def test_the_command(self):
        self.whole("--spp", "8", "--seed", "5")
        done = subprocess.run([sys.executable, "-m", "whit.farm", self.path("scene.pbrt"), "-o", self.path("farm.exr"), "--workers",
                               "1", "--json", self.path("r.json"), "--keep", self.path("parts"), "--", "--spp", "8", "--seed", "5"],
                              capture_output=True, text=True, check=False, cwd=self.folder,
                              env={**os.environ, "PYTHONPATH": package.FOLDER})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, r"\d+ parts on 1 workers in .* joined in")
        self.expect_the_same()
        with open(self.path("r.json"), encoding="utf-8") as f:
            report = json.load(f)
        self.assertEqual(len(os.listdir(self.path("parts"))), len(report["parts"]))

    def test_a_viewer_sees_the_picture(self):
        # While parts come in, and the whole in the end, which is opened once.
        viewer = Viewer()
        self.addCleanup(viewer.close)
        self.whole("--spp", "64")
        looked = []
        report = farm.render(self.path("scene.pbrt"), self.path("farm.exr"), flags=["--spp", "64"], workers=2,
                             model=TimeModel(0.01, 0.2), display_server=viewer.address, warn=self.fail,
                             progress=lambda _: looked.append(len(viewer.updates)))
        self.expect_the_same()
        self.assertEqual([m[1:] for m in viewer.made], [(40, 30)])
        self.assertGreater(looked[-1], 0)  # before all parts were there
        self.assertGreater(report.preview_seconds, 0)
        self.assertEqual(viewer.updates[-1][:2], ("B", (0, 0, 40, 30)))

    def test_no_viewer_is_one_warning(self):
        self.whole("--spp", "64")
        said = []
        farm.render(self.path("scene.pbrt"), self.path("farm.exr"), flags=["--spp", "64"], workers=2, model=TimeModel(0.01, 0.2),
                    display_server="127.0.0.1:9", warn=said.append)
        self.expect_the_same()
        self.assertEqual(len(said), 1, said)
        self.assertIn("cannot reach display server 127.0.0.1:9", said[0])

    def test_to_an_accuracy_with_a_worker_that_is_killed(self):
        # It is killed in the third pass; its share then runs again, on the other.
        flags = ["--target-error", "1.5%", "--aov", "N,shape,variance,samples"]
        self.whole(*flags)
        killed, viewer = [], Viewer()
        self.addCleanup(viewer.close)

        def progress(share):
            if not killed and len(os.listdir(self.path("parts"))) and share > 0.1:
                mine = [p for p in _processes_with("spawn_main") if _parent_of(p) == os.getpid()]
                os.kill(mine[-1], signal.SIGKILL)
                killed.append(mine[-1])

        report = farm.render(self.path("scene.pbrt"), self.path("farm.exr"), flags=flags, workers=2, progress=progress,
                             parts_in=self.path("parts"), display_server=viewer.address, warn=self.fail)
        self.assertEqual(len(killed), 1)
        self.assertEqual((report.code, report.outcome["met"]), (0, True))
        self.assertGreater(len(report.passes), 3)
        self.assertEqual(sum(len(p.share_seconds) for p in report.passes), len(os.listdir(self.path("parts"))))
        self.expect_the_same()
        self.assertEqual(len(viewer.made), 1)
        self.assertGreater(len(viewer.updates), 3)

    def test_an_accuracy_that_is_not_reached(self):
        # As on one machine: the picture is there, and the exit code is 5.
        flags = ["--target-error", "0.01%", "--max-samples", "16"]
        subprocess.run([package.WHIT, self.path("scene.pbrt"), *flags, "--quiet", "--display", "none", "-o", self.path("whole.exr")],
                       check=False, cwd=self.folder)
        said = _said_by([self.path("scene.pbrt"), "-o", self.path("farm.exr"), "--json", self.path("r.json"), "--", *flags], 5, self)
        self.assertIn("not met with --max-samples", said)
        self.expect_the_same()
        with open(self.path("r.json"), encoding="utf-8") as f:
            self.assertEqual(json.load(f)["code"], 5)

    def test_files_travel_to_workers_of_which_one_is_killed(self):
        # Whichever it is, the files and the passes that it had are elsewhere too.
        import distributed
        for flags in (["--target-error", "2%"], ["--spp", "64"]):
            self.whole(*flags)
            with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, memory_limit=0,
                                          silence_logs="CRITICAL") as cluster:
                killed = []

                def progress(share):
                    if not killed:
                        killed.append(cluster.workers[0].pid)
                        os.kill(killed[0], signal.SIGKILL)

                farm.render(self.path("scene.pbrt"), self.path("farm.exr"), flags=flags, scheduler=cluster.scheduler_address,
                            workers=2, model=TimeModel(0.01, 0.2), progress=progress)
                self.assertEqual(len(killed), 1)
            self.expect_the_same()

    def test_what_only_one_machine_can_do(self):
        for words, expected in ((["--", "--time-limit", "5s"], "--time-limit is of one machine's clock"),
                                (["--slurm-script", self.path("j.sh"), "--", "--target-error", "1%"], "neither a job array"),
                                (["--simulate", "8", "--", "--target-error=1%"], "nor a schedule"),
                                (["--", "--target-error", "none"], "is no error above 0")):
            with self.subTest(words=words):
                self.assertIn(expected, _said_by([self.path("scene.pbrt"), *words], 2, self))

    def test_files_travel_once_by_what_is_in_them(self):
        # The scheduler is somebody else's, so the workers are not thought to see this folder.
        import distributed
        self.write("scene.pbrt", package.SCENE.replace("WorldEnd", 'Include "more/things.pbrt"\nWorldEnd'))
        self.write("more/things.pbrt", 'Translate 0 2 0\nShape "plymesh" "string filename" "more/a triangle.ply"\n')
        self.write("more/a triangle.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                   "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                   "-1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        self.whole()
        job = Job(self.path("scene.pbrt"), "scene.pbrt", ()).with_files()
        self.assertEqual(sorted(f.name for f in job.files), ["more/a triangle.ply", "more/things.pbrt", "scene.pbrt"])
        with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as cluster:
            farm.render(self.path("scene.pbrt"), self.path("farm.exr"), scheduler=cluster.scheduler_address, workers=2, model=MODEL)
        self.expect_the_same()
        self.assertTrue(os.path.exists(os.path.join(folder_of(job), "more", "a triangle.ply")))

    def test_a_job_array(self):
        self.whole("--spp", "8")
        script = self.path("job.sh")
        job = Job(self.path("scene.pbrt"), self.path("scene.pbrt"), ("--spp", "8"))
        parts = farm.cut(40, 30, 8, 2, MODEL)
        self.assertGreater(len(parts), 3)
        self.write("job.sh", farm.slurm_script(job, parts, 1, self.path("farm.exr"), self.path("parts"), package.WHIT))
        self.write("sbatch", SBATCH)
        done = subprocess.run(["bash", script, "merge"], capture_output=True, text=True, check=False)
        self.assertIn("0.part", done.stderr)  # none is there yet
        self.assertEqual(done.returncode, 4)
        subprocess.run(["bash", self.path("sbatch"), script], check=True)
        subprocess.run(["bash", self.path("sbatch"), script], check=True)  # again: each goes on from its end
        subprocess.run(["bash", script, "merge"], check=True)
        self.expect_the_same()

    def test_what_is_wrong_is_said(self):
        self.write("bad.pbrt", package.SCENE.replace("[35]", "[400]"))
        for words, code, expected in (
                ([self.path("bad.pbrt")], 3, "fov"), ([self.path("none.pbrt")], 4, "no such file"),
                ([self.path("scene.pbrt"), "--scheduler", "tcp://127.0.0.1:9"], 4, "127.0.0.1:9"),
                ([self.path("scene.pbrt"), "--cluster", "slurm", "--cluster-options", "{"], 2, "JSON"),
                ([self.path("scene.pbrt"), "--", "--aov", "nothing"], 2, "nothing")):
            with self.subTest(words=words):
                said = _said_by(words, code, self)
                self.assertIn(expected, said)

    def test_a_schedule_is_simulated(self):
        done = subprocess.run([sys.executable, "-m", "whit.farm", self.path("scene.pbrt"), "--simulate", "8"], capture_output=True,
                              text=True, check=False, env={**os.environ, "PYTHONPATH": package.FOLDER})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(re.findall(r"(?m)^ *(\d+) workers", done.stdout), ["4", "8", "16"])


def _said_by(words, code, test):
    done = subprocess.run([sys.executable, "-m", "whit.farm", "--workers", "1", *words], capture_output=True, text=True, check=False,
                          env={**os.environ, "PYTHONPATH": package.FOLDER}, timeout=120)
    test.assertEqual(done.returncode, code, done.stderr)
    test.assertNotIn("Traceback", done.stderr)
    return done.stderr


def _processes_with(word):
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/cmdline", encoding="utf-8", errors="replace") as f:
                if word in f.read():
                    found.append(int(pid))
        except OSError:
            pass  # it has ended
    return sorted(found)


def _parent_of(pid):
    """None where the process has ended."""
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as f:
            return int(f.read().rpartition(")")[2].split()[1])
    except OSError:
        return None


def _descends_from(pid, ancestor):
    while pid and pid > 1:
        pid = _parent_of(pid)
        if pid == ancestor:
            return True
    return False


if __name__ == "__main__":
    unittest.main()
