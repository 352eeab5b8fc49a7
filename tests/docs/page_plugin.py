"""What the tests of pages share that add a plugin: the page's blocks, and how to compile and link its files like those of
the build, in a folder of their own, so that neither the source tree nor the build changes. $WHIT_BINARY_DIR is the build.
"""
import json
import os
import re
import shlex
import subprocess

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
BUILD = os.environ.get("WHIT_BINARY_DIR", ROOT + "/build/release")


def blocks_of(page):
    """The fenced blocks that a comment marks, as {mark: text}."""
    with open(page, encoding="utf-8") as f:
        return dict(re.findall(r"^<!-- (.*?) -->\n```\w*\n(.*?)^```$", f.read(), re.DOTALL | re.MULTILINE))


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, **options)


def must(command, **options):
    done = run(command, **options)
    if done.returncode != 0:
        raise AssertionError("%s\nexit %d\n%s%s" % (" ".join(command)[:500], done.returncode, done.stdout, done.stderr))
    return done


def compile_command(source, target, like="plugins/materials/matte.cpp"):
    """The command that compiles a file of the page: that of a file like it, with other files."""
    with open(BUILD + "/compile_commands.json", encoding="utf-8") as f:
        entry = next(e for e in json.load(f) if e["file"].endswith("/" + like))
    command = shlex.split(entry["command"])
    command[command.index("-o") + 1] = target
    command[command.index("-c") + 1] = source
    return command, entry["directory"]


def link_command(target, extra_objects, output):
    """The command that links a target of the build, with more objects and another output."""
    lines = must(["ninja", "-C", BUILD, "-t", "commands", target]).stdout.splitlines()
    parts = shlex.split(lines[-1].removeprefix(": && "))
    command = parts[:parts.index("&&")] if "&&" in parts else parts
    place = command.index("-o") + 1
    command[place] = output
    return command[:place - 1] + extra_objects + command[place - 1:]
