#!/usr/bin/env python3
"""docs/python.md and the docstrings of the package: every block and every example runs; docs/notebook.ipynb does, too."""
import contextlib
import doctest
import importlib
import os
import pathlib
import pkgutil
import re
import sys
import tempfile
import unittest

from package import FOLDER, ROOT, whit

PAGE = pathlib.Path(ROOT) / "docs" / "python.md"
NOTEBOOK = pathlib.Path(ROOT) / "docs" / "notebook.ipynb"


def modules():
    return [whit] + [importlib.import_module("whit." + m.name) for m in pkgutil.iter_modules(whit.__path__)
                     if m.name != "_whit"]


class Docs(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def test_the_page(self):
        """Blocks run one after another in the repository; `out` is a folder that is theirs."""
        blocks = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
        self.assertGreater(len(blocks), 5)
        names = {"out": self.folder}
        with contextlib.chdir(ROOT), open(os.devnull, "w", encoding="utf-8") as nowhere:
            with contextlib.redirect_stdout(nowhere), contextlib.redirect_stderr(nowhere):
                for number, block in enumerate(blocks, 1):
                    exec(compile(block, "docs/python.md, block %d" % number, "exec"), names)
        for name in ("shadows.exr", "shadows.png", "cost.html", "diff.html"):
            self.assertGreater((self.folder / name).stat().st_size, 1000, name)

    def test_docstrings(self):
        examples = 0
        for module in modules():
            found = doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE)
            self.assertEqual(found.failed, 0, module.__name__)
            examples += found.attempted
        self.assertGreater(examples, 20)

    def test_every_argument_is_on_the_page_or_in_help(self):
        import inspect

        for function in (whit.render, whit.cost, whit.diff):
            for name in inspect.signature(function).parameters:
                self.assertRegex(function.__doc__, r"\b%s\b" % name, function.__name__)


class Notebook(unittest.TestCase):
    def test_it_runs_and_shows_pictures(self):
        try:
            import nbclient
            import nbformat
        except ImportError:
            self.skipTest("no nbclient (tools/install-deps test)")
        notebook = nbformat.read(NOTEBOOK, as_version=4)
        # The kernel is to be this Python.
        os.environ["PATH"] = os.path.dirname(sys.executable) + os.pathsep + os.environ["PATH"]
        os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [os.environ.get("PYTHONPATH"), FOLDER]))
        with tempfile.TemporaryDirectory() as folder:
            nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3",
                                    resources={"metadata": {"path": folder}}).execute()
        shown = [kind for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs
                 for kind in output.get("data", {})]
        # A picture, a heat map; a curve.
        self.assertGreaterEqual(shown.count("image/png"), 2)
        self.assertGreaterEqual(shown.count("image/svg+xml"), 1)


if __name__ == "__main__":
    unittest.main()
