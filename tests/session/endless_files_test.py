#!/usr/bin/env python3
"""Files that have no end, or none that anybody wants to wait for, in every place where a scene names a file; and files
that are none of the scene's business, of which no line may get into a message.
"""
import json
import os
import resource
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")
SANITIZED = bool(os.environ.get("WHIT_SANITIZE"))
HEAD = """Camera "perspective"
Film "image" "integer xresolution" 8 "integer yresolution" 8
Sampler "halton" "integer pixelsamples" 1
Integrator "whitted"
WorldBegin
LightSource "point"
Translate 0 0 5
"""
MATTE = '\nShape "sphere"\nWorldEnd\n'
MODEL = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
         "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
         "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
         "textures": [{"source": 0}], "images": [{"uri": "here.png"}],
         "buffers": [{"uri": "here.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
         "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}]}


def model_with(part, uri):
    model = json.loads(json.dumps(MODEL))
    model[part][0]["uri"] = uri
    return json.dumps(model)


# Where a file is named: the scene's statement, and the ending that such files have.
PLACES = {
    "Include": ('Include "%s"' + MATTE, ".pbrt"),
    "mesh": ('Shape "plymesh" "string filename" "%s"\nWorldEnd\n', ".ply"),
    "texture": ('Texture "t" "color" "imagemap" "string filename" "%s" Material "matte" "texture Kd" "t"' + MATTE, ".png"),
    "jpeg": ('Texture "t" "color" "imagemap" "string filename" "%s" Material "matte" "texture Kd" "t"' + MATTE, ".jpg"),
    "tga": ('Texture "t" "color" "imagemap" "string filename" "%s" Material "matte" "texture Kd" "t"' + MATTE, ".tga"),
    "tiff": ('Texture "t" "color" "imagemap" "string filename" "%s" Material "matte" "texture Kd" "t"' + MATTE, ".tif"),
    "sky": ('LightSource "infinite" "string mapname" "%s"' + MATTE, ".exr"),
    "skybox": ('LightSource "skybox" "string mapname" "%s"' + MATTE, ".hdr"),
    "projection": ('LightSource "projection" "string mapname" "%s"' + MATTE, ".pfm"),
    "goniometric": ('LightSource "goniometric" "string mapname" "%s"' + MATTE, ".exr"),
    "spectrum": ('Material "matte" "spectrum Kd" "%s"' + MATTE, ".spd"),
    "bsdf": ('Material "fourier" "string bsdffile" "%s"' + MATTE, ".bsdf"),
    "model": ('Shape "gltf" "string filename" "%s"\nWorldEnd\n', ".gltf"),
    "binary model": ('Shape "gltf" "string filename" "%s"\nWorldEnd\n', ".glb"),
}


@unittest.skipUnless(WHIT, "the program is not built")
class EndlessFiles(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as f:
            f.write(content if isinstance(content, bytes) else content.encode())

    def whit(self, *args, **how):
        """Exit code and what was said; under half of a sparse file's size of memory, unless a sanitizer wants it all."""
        def limit():
            if not SANITIZED:
                resource.setrlimit(resource.RLIMIT_DATA, (2 << 30, 2 << 30))
        how.setdefault("stdin", subprocess.DEVNULL)
        done = subprocess.run([WHIT, *args], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60,
                              check=False, preexec_fn=limit, **how)
        return done.returncode, done.stderr.decode("utf-8", "replace")

    def render(self, scene, **how):
        return self.whit(scene, "--outfile", "picture.exr", "--quiet", "--display", "none", **how)

    def odd_files(self, ending):
        os.mkfifo(self.path("pipe" + ending))
        os.mkdir(self.path("folder" + ending))
        with open(self.path("sparse" + ending), "wb") as f:
            os.truncate(f.fileno(), 5 << 30)
        return ["/dev/zero", "pipe" + ending, "folder" + ending, "sparse" + ending]

    def test_named_in_a_scene(self):
        for place, (statement, ending) in PLACES.items():
            with tempfile.TemporaryDirectory() as self.folder:
                for name in self.odd_files(ending):
                    self.write("scene.pbrt", HEAD + statement % name)
                    code, said = self.render("scene.pbrt")
                    about = "%s as %s: %d: %s" % (name, place, code, said)
                    self.assertIn(code, (3, 4), about)
                    # The statement is on the line behind the head.
                    self.assertIn("scene.pbrt:8:", said, about)
                    self.assertNotIn("picture.exr", os.listdir(self.folder), about)

    def test_named_in_a_model(self):
        self.write("here.bin", b"\0" * 36)
        for part, ending in (("buffers", ".bin"), ("images", ".png")):
            for name in self.odd_files(ending):
                self.write("model.gltf", model_with(part, name))
                self.write("scene.pbrt", HEAD + 'Shape "gltf" "string filename" "model.gltf"\nWorldEnd\n')
                code, said = self.whit("scene.pbrt", "--outfile", "picture.exr", "--quiet", "--display", "none")
                self.assertIn(code, (3, 4), "%s: %s" % (name, said))
                # The first bytes of a longer buffer are a buffer: there it is the picture that is missing.
                self.assertIn("here.png" if name == "sparse.bin" else os.path.basename(name), said)

    def test_as_the_scene(self):
        for ending in (".pbrt", ".gltf", ".glb", ".ply"):
            for name in self.odd_files(ending):
                for command in ([], ["check"], ["--cat"], ["fmt"], ["explain"]):
                    code, said = self.whit(*command, name)
                    self.assertIn(code, (1,) if "check" in command else (3, 4), "%s %s: %s" % (command, name, said))
                    self.assertIn(os.path.basename(name), said)

    def test_pipes_of_ones_own_are_read(self):
        scene = (HEAD + MATTE).encode()
        for name in ("-", "/dev/stdin"):
            done = subprocess.run([WHIT, name, "--outfile", "picture.exr", "--quiet", "--display", "none"], input=scene,
                                  cwd=self.folder, stderr=subprocess.PIPE, timeout=60, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, b""), name)
        self.write("scene.pbrt", scene)
        shell = '"%s" <(cat scene.pbrt) --outfile other.exr --quiet --display none' % WHIT
        subprocess.run(["bash", "-c", shell], cwd=self.folder, timeout=60, check=True)

    @unittest.skipIf(SANITIZED, "needs a gigabyte, and time")
    def test_a_pipe_without_an_end(self):
        for args in (["-"], ["fmt"], ["--cat", "-"], ["check", "-"]):
            with open("/dev/zero", "rb") as zeros:
                code, said = self.whit(*args, stdin=zeros)
            self.assertEqual(code, 1 if "check" in args else 4, said)
            self.assertIn("it has more than 1073741824 bytes, the limit piped-bytes", said)

    def test_a_chain_of_files(self):
        # Each includes the next: 2,000 of them stand for the 100,000 that were tried.
        for i in range(2000):
            self.write("%d.pbrt" % i, 'Include "%d.pbrt"\n' % (i + 1))
        for command in ([], ["check"], ["--cat"], ["fmt", "--expand"]):
            code, said = self.whit(*command, "0.pbrt")
            self.assertEqual(code, 1 if "check" in command else 3, said)
            self.assertIn("255.pbrt:1:9: error: files include one another more than 256 deep, the limit include-depth", said)

    def test_files_that_double(self):
        for i in range(40):
            self.write("%d.pbrt" % i, ('Include "%d.pbrt"\n' % (i + 1)) * 2 if i < 39 else "Identity\n")
        for command in ([], ["check"], ["--cat"]):
            code, said = self.whit(*command, "0.pbrt")
            self.assertEqual(code, 1 if "check" in command else 3, said)
            self.assertIn("files are included more than 500000 times, the limit includes", said)
            self.assertEqual(said.count("the limit includes"), 1, said)

    def test_text_of_other_files(self):
        secrets = {"shadow": "root:$6$SECRET:19000:0:99999:7:::\ndaemon:*:19000\n",
                   "key": "-----BEGIN OPENSSH PRIVATE KEY-----\nSECRET\n",
                   "config.json": '{"auths": {"SECRET": {"auth": "SECRET"}}}',
                   "broken.json": '{"auths": SECRET',
                   "rc": "# comment\nexport TOKEN=SECRET\n",
                   "hosts": "127.0.0.1 SECRET\n",
                   "numbers": "1 2 SECRET\n"}
        for name, secret in secrets.items():
            self.write(name, secret)
            for _, (statement, ending) in PLACES.items():
                self.write("named" + ending, secret)
                self.write("scene.pbrt", HEAD + statement % ("named" + ending))
                _, said = self.render("scene.pbrt")
                self.assertNotIn("SECRET", said, "%s: %s" % (statement % name, said))
            for command in ([], ["check"], ["--cat"], ["fmt"], ["explain"]):
                code, said = self.whit(*command, name)
                self.assertIn(code, (1,) if "check" in command else (3, 4), said)
                self.assertNotIn("SECRET", said)
            for args in (["diff", "--policy", name, ".", "."], ["diff", name, name]):
                _, said = self.whit(*args)
                self.assertNotIn("SECRET", said, args)


if __name__ == "__main__":
    unittest.main()
