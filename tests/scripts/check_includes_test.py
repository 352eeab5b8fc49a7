#!/usr/bin/env python3
"""tools/check-includes finds each kind of offence in a made-up tree, and nothing in one that is right."""
import os
import subprocess
import sys
import tempfile
import unittest

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "check-includes")

# The least tree in which every folder has a header to include.
HEADERS = ["core/base/vec.h", "core/plugin/light.h", "core/batch/batch.h", "core/lobe/lobe.h", "core/image/image.h",
           "core/color/color.h", "core/accel/accel.h", "core/scene/scene.h", "core/render/render.h",
           "core/session/session.h", "parser/scene_description.h",
           "parser/tokens.h", "plugins/shared/sky.h", "plugins/lights/lamp.h", "tools/whit/main.h", "tests/base/helper.h"]


def run(files):
    """Exit code and output lines of the script on a tree with these extra files."""
    with tempfile.TemporaryDirectory() as root:
        for path, text in {**{h: "#pragma once\n" for h in HEADERS}, **files}.items():
            path = os.path.join(root, path)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as f:
                f.write(text)
        done = subprocess.run([sys.executable, SCRIPT, root], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines()


class CheckIncludes(unittest.TestCase):
    def rejected(self, path, include, reason):
        code, lines = run({path: "#include <vector>\n\n#include %s\n" % include})
        self.assertEqual(code, 1, "%s including %s must fail" % (path, include))
        self.assertEqual(len(lines), 1, lines)
        self.assertTrue(lines[0].startswith("%s:3: includes %s: " % (path, include.strip('"<>'))), lines[0])
        self.assertIn(reason, lines[0])

    def accepted(self, path, *includes):
        self.assertEqual(run({path: "".join("#include %s\n" % i for i in includes)}), (0, []))

    def test_what_is_allowed(self):
        self.accepted("core/base/a.cpp", '"core/base/vec.h"', "<cmath>", "<stdint.h>", "<Imath/ImathVec.h>")
        self.accepted("core/plugin/a.h", '"core/base/vec.h"', '"core/batch/batch.h"', "<fmt/format.h>")
        self.accepted("core/batch/a.h", '"core/base/vec.h"', "<tbb/parallel_for.h>")
        self.accepted("core/lobe/a.h", '"core/base/vec.h"', '"core/batch/batch.h"', "<fmt/format.h>")
        self.accepted("core/plugin/b.h", '"core/lobe/lobe.h"')
        self.accepted("core/image/a.cpp", '"core/image/image.h"', '"core/plugin/light.h"', "<OpenImageIO/imageio.h>")
        self.accepted("core/color/a.cpp", '"core/image/image.h"', "<OpenColorIO/OpenColorIO.h>")
        self.accepted("core/accel/a.cpp", '"core/image/image.h"', '"core/color/color.h"', "<embree3/rtcore.h>",
                      "<embree4/rtcore.h>")
        self.accepted("core/scene/a.cpp", '"core/accel/accel.h"', '"parser/scene_description.h"',
                      "<nlohmann/json.hpp>", "<fmt/format.h>")
        self.accepted("core/render/a.cpp", '"core/scene/scene.h"', '"core/accel/accel.h"', "<oneapi/tbb.h>")
        self.accepted("parser/a.cpp", '"parser/tokens.h"', '"core/base/vec.h"', "<Imath/half.h>", "<sys/mman.h>")
        self.accepted("plugins/lights/a.cpp", '"core/plugin/light.h"', '"core/batch/batch.h"', '"core/image/image.h"',
                      '"core/color/color.h"', '"core/base/vec.h"', '"plugins/shared/sky.h"')
        self.accepted("plugins/shared/a.cpp", '"plugins/shared/sky.h"', '"core/plugin/light.h"', '"core/image/image.h"')
        self.accepted("tools/whit/a.cpp", '"core/render/render.h"', '"parser/tokens.h"', "<CLI/CLI.hpp>",
                      "<whatever.hpp>")
        self.accepted("tests/base/a.cpp", '"core/render/render.h"', "<gtest/gtest.h>", "<embree3/rtcore.h>")

    def test_base_is_std_and_imath(self):
        self.rejected("core/base/a.h", "<fmt/format.h>", "core/base may include std, Imath")
        self.rejected("core/base/a.h", "<tbb/parallel_for.h>", "core/base may include std, Imath")
        self.accepted("core/base/mapped_file.cpp", "<unistd.h>")
        self.rejected("core/base/a.h", "<unistd.h>", "core/base is portable")
        self.rejected("core/base/a.h", '"core/plugin/light.h"', "core/base may include no other folder")

    def test_core_looks_down_only(self):
        order = ["core/base/vec.h", "core/batch/batch.h", "core/plugin/light.h", "core/image/image.h", "core/color/color.h",
                 "core/accel/accel.h", "core/scene/scene.h", "core/render/render.h", "core/session/session.h"]
        for below, low in enumerate(order):
            for high in order[below + 1:]:
                self.rejected(os.path.dirname(low) + "/a.cpp", '"%s"' % high, "may include")
        self.rejected("core/batch/a.cpp", '"core/plugin/light.h"', "core/batch may include core/base")
        self.rejected("core/batch/a.cpp", '"core/lobe/lobe.h"', "core/batch may include core/base")

    def test_parser(self):
        for header in HEADERS:
            if header.startswith("core/") and not header.startswith("core/base"):
                self.rejected("parser/a.cpp", '"%s"' % header, "parser may include core/base")
        self.rejected("parser/a.cpp", "<fmt/format.h>", "parser may include std, Imath")
        self.rejected("parser/a.cpp", "<nlohmann/json.hpp>", "parser may include std, Imath")

    def test_session_and_scene_alone_see_the_parser(self):
        self.accepted("core/session/a.cpp", '"parser/tokens.h"', '"core/render/render.h"', '"core/color/color.h"')
        self.rejected("core/scene/a.cpp", '"parser/tokens.h"', "only parser/scene_description.h")
        for folder in ["base", "plugin", "batch", "lobe", "image", "color", "accel", "render"]:
            self.rejected("core/%s/a.cpp" % folder, '"parser/scene_description.h"', "core/%s may include" % folder)
        self.rejected("plugins/lights/a.cpp", '"parser/scene_description.h"', "plugins may include")

    def test_one_place_a_library(self):
        libraries = {"<embree3/rtcore.h>": "core/accel", "<embree4/rtcore.h>": "core/accel",
                     "<OpenImageIO/imageio.h>": "core/image", "<OpenColorIO/OpenColorIO.h>": "core/color"}
        folders = [os.path.dirname(h) for h in HEADERS if not h.startswith(("tools", "tests"))]
        for include, home in libraries.items():
            for folder in folders:
                if folder != home:
                    self.rejected(folder + "/a.cpp", include, "only %s includes" % home)
        self.rejected("core/render/a.cpp", "<nlohmann/json.hpp>", "core/render may include")
        self.rejected("core/render/a.cpp", "<CLI/CLI.hpp>", "core/render may include")
        self.rejected("core/render/a.cpp", "<Eigen/Core>", "a new library needs a rule")

    def test_plugins(self):
        self.rejected("plugins/lights/a.cpp", '"plugins/lights/lamp.h"', "plugins do not know each other")
        self.rejected("plugins/lights/a.cpp", '"core/accel/accel.h"', "plugins may include")
        self.rejected("plugins/lights/a.cpp", '"core/scene/scene.h"', "plugins may include")
        self.rejected("plugins/lights/a.cpp", '"core/render/render.h"', "plugins may include")
        for folder in ("plugins/lights", "plugins/shared"):
            self.rejected(folder + "/a.cpp", "<immintrin.h>", "no intrinsics")
        self.rejected("plugins/shared/a.cpp", '"plugins/lights/lamp.h"', "nothing includes a plugin")
        self.rejected("plugins/shared/a.cpp", '"core/scene/scene.h"', "plugins/shared may include")

    def test_core_never_includes_a_plugin_a_tool_or_a_test(self):
        for folder in ["core/plugin", "core/scene", "core/render", "parser"]:
            self.rejected(folder + "/a.cpp", '"plugins/lights/lamp.h"', "nothing includes a plugin")
            self.rejected(folder + "/a.cpp", '"plugins/shared/sky.h"', "nothing includes a plugin")
            self.rejected(folder + "/a.cpp", '"tools/whit/main.h"', "may include")
            self.rejected(folder + "/a.cpp", '"tests/base/helper.h"', "may include")

    def test_names_start_at_the_root(self):
        self.rejected("core/image/a.cpp", '"image.h"', 'from the root of the repository: "core/image/image.h"')
        self.rejected("core/image/a.cpp", '"../base/vec.h"', "from the root of the repository")
        self.rejected("core/image/a.cpp", '"core/../core/base/vec.h"', "without '..'")

    def test_sources_are_not_included(self):
        code, lines = run({"core/base/b.cpp": "", "core/base/a.cpp": '#include "core/base/b.cpp"\n'})
        self.assertEqual(code, 1)
        self.assertIn("never included", lines[0])

    def test_a_new_core_folder_needs_a_rule(self):
        code, lines = run({"core/misc/a.h": ""})
        self.assertEqual(code, 1)
        self.assertIn("core/misc/a.h:1: no rule covers this folder", lines[0])
        self.assertEqual(run({"core/a.h": ""})[0], 1)

    def test_comments_and_odd_spacing(self):
        self.assertEqual(run({"core/base/a.h": '// #include "core/render/render.h"\n'
                                               '/* x\n#include "core/render/render.h"\n*/\n'
                                               'const char* s = "/*";  // not a comment\n'})[0], 0)
        code, lines = run({"core/base/a.h": 'const char* s = "/*";\n  #  include   "core/render/render.h"  // x\n'})
        self.assertEqual((code, len(lines)), (1, 1))
        self.assertTrue(lines[0].startswith("core/base/a.h:2: "), lines)
        self.assertEqual(run({"core/base/a.h": "#include HEADER\n"})[0], 1)

    def test_every_offence_is_reported(self):
        code, lines = run({"core/base/a.h": "#include <fmt/format.h>\n#include <tbb/tbb.h>\n",
                           "parser/a.cpp": '#include "core/render/render.h"\n'})
        self.assertEqual((code, len(lines)), (1, 3))


if __name__ == "__main__":
    unittest.main()
