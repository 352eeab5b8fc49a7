#!/usr/bin/env python3
"""`whit check` as a program: what it prints for machines, what it corrects, what silences it, how it exits."""
import json
import os
import re
import shutil
import stat
import subprocess
import tempfile
import unittest

WHIT = os.environ.get("WHIT")
ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
HEAD = """Camera "perspective" "float fov" 40
Film "image" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "point" "rgb I" [ 20 20 20 ]
Translate 0 0 5
"""
UNUSED = 'Texture "wood" "spectrum" "checkerboard"\n'
BALL = 'Shape "sphere"\nWorldEnd\n'


class Base(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, text, name="s.pbrt"):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as f:
            f.write(text)

    def read(self, name="s.pbrt"):
        with open(os.path.join(self.folder, name), encoding="utf-8") as f:
            return f.read()

    def whit(self, *args, stdin=None):
        done = subprocess.run([WHIT, "check", *args], cwd=self.folder, input=stdin or "", check=False, capture_output=True,
                              text=True, timeout=120)
        return done.returncode, done.stdout, done.stderr

    def found(self, *args):
        code, out, err = self.whit("--json", *args)
        self.assertEqual(err, "")
        return code, json.loads(out)

    def names(self, *args):
        return [d["name"] for d in self.found(*args)[1]["diagnostics"]]


class Check(Base):
    def test_json(self):
        self.write(HEAD + UNUSED + 'Material "matte" "rgb Kdd" [ 1 1 1 ]\n' + BALL)
        code, said = self.found("s.pbrt")
        self.assertEqual(code, 1)
        self.assertEqual(said["errors"], 0)
        self.assertEqual(said["warnings"], 2)
        texture, parameter = said["diagnostics"]
        self.assertEqual(texture, {"severity": "warning", "name": "unused-texture", "file": "s.pbrt", "line": 6,
                                   "column": 1, "endColumn": 8, "message": 'texture "wood" is not used', "hint": ""})
        # Material "matte" "rgb Kdd": the string begins in column 18, the name inside of it behind `"rgb `.
        self.assertEqual((parameter["name"], parameter["column"], parameter["endColumn"]), ("unknown-parameter", 18, 27))
        self.assertEqual(parameter["fix"], {"line": 7, "column": 23, "endColumn": 26, "written": "Kdd", "meant": "Kd"})
        self.write(HEAD + BALL)
        self.assertEqual(self.found("s.pbrt"), (0, {"diagnostics": [], "errors": 0, "warnings": 0, "notes": 0}))

    def test_every_diagnostic_has_a_name(self):
        for text, name in (('Shape "sphere" "float radius" -1', "mistake"), ('Shape "plymesh" "string filename" "no.ply"', "file"),
                           ('NamedMaterial "nobody"', "mistake"), ('Shape "sphere" "integer radius" 2', "wrong-type"),
                           ('Shape "sphere" "float radius" [ 1 2 ]', "warning")):
            with self.subTest(text):
                self.write(HEAD + text + "\n" + BALL)
                self.assertIn(name, self.names("s.pbrt"))

    def test_mistakes_cannot_be_silenced(self):
        self.write("# whit: allow mistake\n" + HEAD + 'NamedMaterial "nobody"\n' + BALL)
        self.assertEqual(sorted(self.names("s.pbrt")), ["mistake", "warning"])
        code, _, err = self.whit("--allow", "mistake", "s.pbrt")
        self.assertEqual((code, "mistakes cannot be allowed" in err), (2, True))
        code, _, err = self.whit("--allow", "unused-textur", "s.pbrt")
        self.assertEqual(code, 2)
        self.assertIn('did you mean "unused-texture"?', err)

    def test_comments_silence(self):
        allow = "# whit: allow unused-texture"
        cases = {  # text: how many of the two unused textures are still found
            allow + "\n" + HEAD + UNUSED + UNUSED.replace("wood", "rock"): 0,  # before the first statement
            HEAD + allow + "\n" + UNUSED + UNUSED.replace("wood", "rock"): 1,  # the next statement
            HEAD + UNUSED[:-1] + "  " + allow + "\n" + UNUSED.replace("wood", "rock"): 1,  # its line
            HEAD + allow + "\n\n# more\n" + UNUSED + UNUSED.replace("wood", "rock"): 1,  # comments between do not matter
            HEAD + UNUSED + UNUSED.replace("wood", "rock") + allow + "\n": 2,  # behind
            HEAD + allow.replace("unused-texture", "black-light, unused-texture") + "\n" + UNUSED + UNUSED.replace("wood", "rock"): 1,
        }
        for text, count in cases.items():
            with self.subTest(text):
                self.write(text + BALL)
                self.assertEqual(self.names("s.pbrt"), ["unused-texture"] * count)
        # One inside a string is none, nor one for another finding.
        self.write(HEAD + 'Texture "# whit: allow unused-texture" "spectrum" "checkerboard"\n# whit: allow black-light\n' + BALL)
        self.assertEqual(self.names("s.pbrt"), ["unused-texture"])
        self.write(HEAD + "# whit: allow unused-textures\n" + BALL)
        self.assertEqual(self.found("s.pbrt")[1]["diagnostics"][0]["column"], 15)

    def test_all_mistakes_of_a_statement(self):
        for other in ('"rgb Kd" [ 0.5 0.5 ]', '"rgb Kd" [ 0.5 0.5 oops ]', '"texture Kd" "gone"', '"spectrum Kd" "gone.spd"'):
            with self.subTest(other):
                self.write(HEAD + f'Material "plastic" "float roughness" -0.25 {other}\n' + BALL)
                said = self.found("s.pbrt")[1]["diagnostics"]
                self.assertIn('"roughness" of plastic must be at least 0, not -0.25', [d["message"] for d in said])
                self.assertGreaterEqual(len(said), 2, said)

    def test_fix(self):
        self.write(HEAD + 'Include "part.pbrt"\nWorldEnd\n')
        self.write('Material "mate" "rgb Kdd" [ 0.5 0.5 0.5 ]  # mate\nShap "sphere" "float raduis" 1\n', "part.pbrt")
        os.chmod(os.path.join(self.folder, "part.pbrt"), 0o640)
        code, _, err = self.whit("--fix", "s.pbrt")
        self.assertEqual(code, 0, err)
        self.assertEqual(self.read("part.pbrt"),
                         'Material "matte" "rgb Kd" [ 0.5 0.5 0.5 ]  # mate\nShape "sphere" "float radius" 1\n')
        self.assertEqual(stat.S_IMODE(os.stat(os.path.join(self.folder, "part.pbrt")).st_mode), 0o640)
        self.assertIn("part.pbrt:2:", err)
        # Nothing to correct changes nothing.
        before = os.stat(os.path.join(self.folder, "s.pbrt")).st_mtime_ns
        self.assertEqual(self.whit("--fix", "s.pbrt"), (0, "", ""))
        self.assertEqual(os.stat(os.path.join(self.folder, "s.pbrt")).st_mtime_ns, before)
        self.assertEqual(self.whit("--fix", stdin=HEAD + BALL)[0], 2)

    def test_fix_of_a_protected_file(self):
        text = HEAD + 'Shap "sphere"\nWorldEnd\n'
        self.write(text)
        os.chmod(os.path.join(self.folder, "s.pbrt"), 0o444)
        code, _, err = self.whit("--fix", "s.pbrt")
        self.assertEqual(code, 4, err)
        self.assertEqual(self.read(), text)

    def fixed(self, text):
        """The text after --fix."""
        self.write(text)
        self.whit("--fix", "s.pbrt")
        return self.read()

    def test_fix_leaves_what_is_in_doubt(self):
        plain = HEAD + "%s\n" + BALL
        for statement in (
                'MakeNamedMaterial "mata" "string type" "matte"\nMakeNamedMaterial "matb" "string type" "matte"\nNamedMaterial "matc"',
                'Shape "sphere" "float radius" 1 "float raduis" 3',  # would be given twice
                'Shape "sphere" "float radus" 1 "float raduis" 3',
                'Material "glass" "float roughness" 0.1',  # as near to uroughness as to vroughness
                'Material "mirror" "rgb Kd" [ 0.1 0.1 0.1 ]'):  # what matte has
            with self.subTest(statement):
                self.assertEqual(self.fixed(plain % statement), plain % statement)
        # A file of another version.
        text = 'Camera "perspective"\nColorSpace "srgb"\nWorldBegin\nShape "spher"\n'
        self.assertEqual(self.fixed(text), text)

    def test_fix_of_what_is_included_twice(self):
        part = 'NamedMaterial "wood"\nShape "sphere" "float raduis" 2\n'
        self.write(part, "part.pbrt")
        def made(name):
            return f'AttributeBegin\nMakeNamedMaterial "{name}" "string type" "matte"\nInclude "part.pbrt"\nAttributeEnd\n'
        # Right in one place: not for the other to correct; what is said of both is. Of parameters it is said once.
        self.fixed(HEAD + made("wood") + made("wool") + "WorldEnd\n")
        self.assertEqual(self.read("part.pbrt"), part)
        self.fixed(HEAD + made("wool") + made("wool") + "WorldEnd\n")
        self.assertEqual(self.read("part.pbrt"), part.replace("wood", "wool"))
        # Two scenes do not turn it back and forth.
        self.write(part.replace("raduis", "radius"), "part.pbrt")
        self.write(HEAD + made("wood") + "WorldEnd\n", "a.pbrt")
        self.write(HEAD + made("wool") + "WorldEnd\n", "b.pbrt")
        _, _, err = self.whit("--fix", "b.pbrt", "a.pbrt", "b.pbrt")
        self.assertEqual(err.count(": corrected "), 1, err)

    def test_fix_of_a_file_with_two_names(self):
        # It is written in place: longer, shorter, and across a page of memory.
        for size in (10, 4000, 4096, 9000):
            for written in ("Shap", "Shapee"):
                text = HEAD + "#" + "x" * size + "\n" + written + ' "sphere"\nWorldEnd\n'
                self.write(text)
                os.link(os.path.join(self.folder, "s.pbrt"), os.path.join(self.folder, "t.pbrt"))
                code, _, err = self.whit("--fix", "--json", "s.pbrt", "t.pbrt")
                self.assertEqual(code, 0, err)
                self.assertEqual(self.read("t.pbrt"), text.replace(written, "Shape"))
                os.remove(os.path.join(self.folder, "t.pbrt"))

    def test_fix_goes_on(self):
        wrong = HEAD + 'Shap "sphere"\nWorldEnd\n'
        for name in ("a.pbrt", "b.pbrt"):
            self.write(wrong, name)
        os.chmod(os.path.join(self.folder, "a.pbrt"), 0o444)
        code, out, err = self.whit("--fix", "--json", "a.pbrt", "none.pbrt", "b.pbrt")
        self.assertEqual(code, 4)
        self.assertIn("cannot correct a.pbrt: it is write-protected", err)
        self.assertEqual(self.read("b.pbrt"), HEAD + BALL)
        self.assertEqual({d["name"] for d in json.loads(out)["diagnostics"] if d["severity"] == "error"}, {"mistake", "file"})

    def test_strict_and_notes(self):
        self.write(HEAD + 'ObjectBegin "o"\nShape "sphere"\nObjectEnd\nScale -1 1 1\nObjectInstance "o"\nWorldEnd\n')
        code, said = self.found("s.pbrt")
        self.assertEqual((code, said["notes"], said["warnings"]), (0, 1, 0))
        code, said = self.found("--strict", "s.pbrt")
        self.assertEqual((code, said["errors"]), (1, 1))

    def test_text(self):
        self.write(HEAD + UNUSED + BALL)
        code, out, err = self.whit("s.pbrt")
        self.assertEqual((code, out), (1, ""))
        self.assertIn('s.pbrt:6:1: warning: texture "wood" is not used [unused-texture]\n', err)

    def test_list_is_in_the_docs(self):
        code, out, _ = self.whit("--list")
        self.assertEqual(code, 0)
        with open(os.path.join(ROOT, "docs", "check.md"), encoding="utf-8") as f:
            page = f.read()
        for line in out.splitlines():
            name, severity, what = line[:28].strip(), line[29:47].strip(), line[48:]
            row = [r for r in page.splitlines() if re.match(r"\| \[?`%s`" % re.escape(name), r)]
            self.assertEqual(len(row), 1, name)
            self.assertTrue(row[0].endswith(f"| {what} |"), row[0])
            if row[0].count("|") == 4:
                self.assertEqual(row[0].split("|")[2].strip().replace("`", ""), severity)

    def test_other_versions(self):
        self.write('Film "rgb"\nSampler "zsobol"\nCamera "perspective"\nColorSpace "aces2065-1"\nWorldBegin\n'
                   'Attribute "shape" "rgb reflectance" [1 0 0]\nMaterial "diffuse"\nMaterial "diffuse"\nShape "sphere"\n')
        said = self.found("s.pbrt")[1]["diagnostics"]
        versions = [d for d in said if "this is a pbrt-v4 file" in d["message"]]
        self.assertEqual(len(versions), 1, said)
        for part in ("ColorSpace", "Attribute", '"diffuse": in pbrt-v3 "matte" is like it', '"zsobol"'):
            self.assertEqual(versions[0]["hint"].count(part), 1, versions[0]["hint"])


class Schema:
    """What of JSON Schema (draft 7) the schema of SARIF needs; validate() gives what is wrong, with the way there."""

    KNOWN = {"$id", "$schema", "$ref", "additionalProperties", "allOf", "anyOf", "definitions", "enum", "format", "id",
             "items", "maximum", "minItems", "minimum", "not", "oneOf", "pattern", "properties", "required", "type",
             "uniqueItems"}
    TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "integer": int, "number": (int, float)}

    def __init__(self, root):
        self.root = root

    def validate(self, value, schema=None, at="$"):
        schema = self.root if schema is None else schema
        unknown = set(schema) - self.KNOWN
        if unknown:
            raise NotImplementedError(unknown)
        if "$ref" in schema:
            return self.validate(value, self.root["definitions"][schema["$ref"].rsplit("/", 1)[1]], at)
        wrong = []
        kind = self.TYPES.get(schema.get("type"))
        if kind and (not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool)):
            return [f"{at} is no {schema['type']}"]
        if "enum" in schema and value not in schema["enum"]:
            wrong.append(f"{at} is not of {schema['enum']}")
        if isinstance(value, str) and "pattern" in schema and not re.search(schema["pattern"], value):
            wrong.append(f"{at} does not match {schema['pattern']}")
        if isinstance(value, (int, float)) and not schema.get("minimum", value) <= value <= schema.get("maximum", value):
            wrong.append(f"{at} is out of range")
        if isinstance(value, list):
            wrong += self.validate_list(value, schema, at)
        if isinstance(value, dict):
            wrong += self.validate_object(value, schema, at)
        for part in schema.get("allOf", []):
            wrong += self.validate(value, part, at)
        for key in ("anyOf", "oneOf"):
            if key in schema and not any(not self.validate(value, part, at) for part in schema[key]):
                wrong.append(f"{at} is none of {key}")
        if "not" in schema and not self.validate(value, schema["not"], at):
            wrong.append(f"{at} is what it must not be")
        return wrong

    def validate_list(self, value, schema, at):
        wrong = [f"{at} has too few"] if len(value) < schema.get("minItems", 0) else []
        texts = [json.dumps(v, sort_keys=True) for v in value]
        if schema.get("uniqueItems") and len(set(texts)) < len(texts):
            wrong.append(f"{at} has something twice")
        for i, v in enumerate(value):
            wrong += self.validate(v, schema.get("items", {}), f"{at}[{i}]")
        return wrong

    def validate_object(self, value, schema, at):
        wrong = [f"{at} lacks {key}" for key in schema.get("required", []) if key not in value]
        known, other = schema.get("properties", {}), schema.get("additionalProperties", True)
        for key, v in value.items():
            if key in known:
                wrong += self.validate(v, known[key], f"{at}.{key}")
            elif other is False:
                wrong.append(f"{at} may not have {key}")
            elif isinstance(other, dict):
                wrong += self.validate(v, other, f"{at}.{key}")
        return wrong


class Sarif(Base):
    def validate(self, text):
        """By the schema of the standard, without its descriptions."""
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "sarif-2.1.0.schema.json"), encoding="utf-8") as f:
            schema = Schema(json.load(f))
        self.assertEqual(schema.validate(json.loads(text)), [])

    def test_the_validator_sees_mistakes(self):
        for text in ("[]", "{}", '{"version": "2.0", "runs": []}', '{"version": "2.1.0", "runs": [{}]}',
                     '{"version": "2.1.0", "runs": [{"tool": {"driver": {"name": 1}}}]}',
                     '{"version": "2.1.0", "runs": [], "more": 1}'):
            with self.subTest(text), self.assertRaises(AssertionError):
                self.validate(text)
        self.validate('{"version": "2.1.0", "runs": []}')

    def test_all_scenes_are_valid(self):
        self.write(HEAD + BALL)
        self.validate(self.whit("--format", "sarif", "s.pbrt")[1])
        folder = os.path.join(ROOT, "tests", "check")
        scenes = sorted(os.path.join(folder, n) for n in os.listdir(folder) if n.endswith(".pbrt"))
        self.validate(self.whit("--format", "sarif", *scenes)[1])
        bad = os.path.join(ROOT, "tests", "conformance", "bad")
        self.validate(self.whit("--format", "sarif", *sorted(os.path.join(bad, n) for n in os.listdir(bad) if n.endswith(".pbrt")))[1])

    def test_sarif(self):
        self.write(HEAD + UNUSED + 'Material "matte" "rgb Kdd" [ 1 1 1 ]\nShape "sphere" "float radius" -1\nWorldEnd\n', "a b.pbrt")
        code, out, err = self.whit("--format", "sarif", "a b.pbrt")
        self.assertEqual((code, err), (1, ""))
        self.validate(out)
        log = json.loads(out)
        self.assertEqual((log["version"], len(log["runs"])), ("2.1.0", 1))
        driver = log["runs"][0]["tool"]["driver"]
        self.assertEqual(driver["name"], "whit")
        ids = [rule["id"] for rule in driver["rules"]]
        self.assertEqual(len(ids), len(set(ids)))
        for rule in driver["rules"]:
            self.assertTrue(rule["shortDescription"]["text"] and rule["help"]["text"])
            self.assertIn(rule["defaultConfiguration"]["level"], ("note", "warning", "error"))
        results = log["runs"][0]["results"]
        self.assertEqual([r["ruleId"] for r in results], ["unused-texture", "unknown-parameter", "mistake"])
        for r in results:
            self.assertEqual(ids[r["ruleIndex"]], r["ruleId"])
            self.assertIn(r["level"], ("note", "warning", "error"))
            self.assertTrue(r["message"]["text"])
            place = r["locations"][0]["physicalLocation"]
            self.assertEqual(place["artifactLocation"]["uri"], "a%20b.pbrt")
            self.assertGreaterEqual(place["region"]["startLine"], 1)
            self.assertGreater(place["region"]["endColumn"], place["region"]["startColumn"])
        change = results[1]["fixes"][0]["artifactChanges"][0]["replacements"][0]
        self.assertEqual(change["insertedContent"]["text"], "Kd")
        self.assertEqual(change["deletedRegion"], {"startLine": 7, "startColumn": 23, "endLine": 7, "endColumn": 26})


if __name__ == "__main__":
    unittest.main()
