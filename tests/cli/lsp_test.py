#!/usr/bin/env python3
"""A session with `whit lsp` as an editor has it: open, break, fix, complete, hover, go to a definition through an Include,
rename, format, colours, code actions, and what else there is; and what no editor should send."""
import json
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from lsp_client import Client, apply_edits, position, uri_of  # noqa: E402

WHIT = os.environ["WHIT"]

MAIN = """\
# A scene.
# Of two files.
Camera "perspective" "float fov" 40
Film "image" "integer xresolution" 8 "integer yresolution" 8 "string filename" "scene.exr"
WorldBegin
LightSource "infinite" "rgb L" [ 1 .5 .25 ]
Include "materials.pbrt"
AttributeBegin
  Translate 1 2 3
  Scale 2 2 2
  NamedMaterial "red"
  Shape "sphere" "float radius" 0.5
AttributeEnd
WorldEnd
"""
MATERIALS = """\
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [ 4 2 0 ]
MakeNamedMaterial "red" "string type" "matte" "texture Kd" "checks"
"""
CAPABILITIES = {
    "textDocument": {"completion": {"completionItem": {"snippetSupport": True}}, "hover": {"contentFormat": ["markdown"]},
                     "documentSymbol": {"hierarchicalDocumentSymbolSupport": True}},
    "workspace": {"workspaceEdit": {"documentChanges": False}},
}


def write(folder, name, text):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8", newline="") as f:
        f.write(text)
    return path


def place(text, what, after=0):
    """Line and character (UTF-16) of the first occurrence of `what`, and so many characters on."""
    at = text.index(what) + after
    before = text[:at]
    line = before.count("\n")
    return line, len(before[before.rfind("\n") + 1:].encode("utf-16-le")) // 2


def checked(path):
    """What `whit check` says: (line, column) and message of each problem."""
    done = subprocess.run([WHIT, "check", path], capture_output=True, text=True)
    out = []
    for line in done.stderr.split("\n"):
        for severity in ("error", "warning"):
            if line.startswith(path) and f": {severity}: " in line:
                where, message = line.split(f": {severity}: ", 1)
                out.append((int(where.split(":")[-2]), severity, message))
    return sorted(out)


def labels(items):
    return [i["label"] for i in items["items"]]


class Session:
    def __init__(self, folder):
        self.folder = folder
        self.main = write(folder, "scene.pbrt", MAIN)
        self.materials = write(folder, "materials.pbrt", MATERIALS)
        self.c = Client(CAPABILITIES, folder)
        self.uri = self.c.open(self.main)
        self.materials_uri = uri_of(self.materials)

    def complete(self, text, what, after=0):
        """Completions in the main file, were it this text, behind `what`."""
        self.c.edit(self.uri, (text,))
        found = self.c.at("completion", self.uri, place(text, what, len(what) + after))
        return found

    def hover(self, text, what, after=1, uri=None):
        found = self.c.at("hover", uri or self.uri, place(text, what, after))
        return found and found["contents"]["value"]


def test_diagnostics(s):
    c = s.c
    assert c.capabilities["positionEncoding"] == "utf-16"
    c.wait_diagnostics(s.uri, lambda d: d == [])
    broken = MAIN.replace('"float radius"', '"float raduis"')
    at = place(broken, "raduis")
    c.edit(s.uri, ("raduis", place(MAIN, "radius"), place(MAIN, "radius", 6)))
    found = c.wait_diagnostics(s.uri, lambda d: len(d) == 1)
    assert "raduis" in found[0]["message"] and "radius" in found[0]["message"]
    assert found[0]["range"]["start"] == position((at[0], at[1] - 7)), found  # the whole string "float raduis"
    assert found[0]["range"]["end"] == position((at[0], at[1] + 7)), found
    actions = c.whole("codeAction", s.uri, range={"start": position(at), "end": position(at)}, context={"diagnostics": found})
    assert [a["kind"] for a in actions] == ["quickfix", "source.fixAll"], actions
    assert actions[0]["diagnostics"] == found
    for action in actions:
        assert apply_edits(broken, action["edit"]["changes"][s.uri]) == MAIN
    c.edit(s.uri, ("radius", at, (at[0], at[1] + 6)))
    c.wait_diagnostics(s.uri, lambda d: d == [])


def test_two_slips_are_fixed_at_once(s):
    text = MAIN.replace("Translate", "Translat").replace('"sphere"', '"spere"')
    s.c.edit(s.uri, (text,))
    s.c.wait_diagnostics(s.uri, lambda d: len(d) == 2)
    every = {"start": position((0, 0)), "end": position((0, 0))}
    actions = s.c.whole("codeAction", s.uri, range=every, context={"diagnostics": [], "only": ["source.fixAll"]})
    assert len(actions) == 1 and apply_edits(text, actions[0]["edit"]["changes"][s.uri]) == MAIN
    s.c.edit(s.uri, (MAIN,))
    s.c.wait_diagnostics(s.uri, lambda d: d == [])


def test_include_that_is_open_and_not_saved(s):
    c = s.c
    # A piece of a scene alone has no WorldBegin, and needs none: it belongs to the scene that includes it.
    c.open(s.materials)
    c.edit(s.materials_uri, ('"rde"', place(MATERIALS, '"red"'), place(MATERIALS, '"red"', 5)))
    found = c.wait_diagnostics(s.uri, lambda d: len(d) == 1)
    assert 'no material named "red"' in found[0]["message"] and found[0]["severity"] == 1
    c.edit(s.materials_uri, (MATERIALS + 'Texture "x" "float" "constannt"\n',))
    c.wait_diagnostics(s.uri, lambda d: d == [])
    # Beside what is wrong with it, nothing uses it.
    found = c.wait_diagnostics(s.materials_uri, lambda d: {f["code"] for f in d} == {"mistake", "unused-texture"})
    assert all(f["range"]["start"]["line"] == 2 for f in found)
    assert any("constannt" in f["message"] for f in found)
    # What is closed is on the disk as it was.
    c.close(s.materials_uri)
    c.wait_diagnostics(s.materials_uri, lambda d: d == [])
    # With the main file closed too, the piece still finds it on the disk.
    c.close(s.uri)
    c.open(s.materials, MATERIALS + "Nonsense\n")
    found = c.wait_diagnostics(s.materials_uri, lambda d: len(d) == 1)
    assert "Nonsense" in found[0]["message"]
    c.close(s.materials_uri)
    c.wait_diagnostics(s.materials_uri, lambda d: d == [])
    c.open(s.main)


def test_what_reading_files_finds(s):
    """What `whit check` finds in files is there when nobody has typed for a while."""
    text = MAIN.replace('Shape "sphere" "float radius" 0.5', 'Shape "plymesh" "string filename" "bad.ply"')
    write(s.folder, "bad.ply", "no mesh\n")
    path = write(s.folder, "bad.pbrt", text)
    uri = s.c.open(path)
    expected = checked(path)
    assert len(expected) == 1, expected
    found = s.c.wait_diagnostics(uri, lambda d: len(d) == 1)
    assert [(d["range"]["start"]["line"] + 1, "error" if d["severity"] == 1 else "warning") for d in found] == [e[:2] for e in expected]
    s.c.close(uri)
    s.c.wait_diagnostics(uri, lambda d: d == [])


def test_completion(s):
    # Statements of the block, and no others.
    found = labels(s.complete(MAIN.replace("Film", "Fi\nFilm"), "Fi"))
    assert "Film" in found and "Camera" in found and "Translate" in found and "Shape" not in found
    text = MAIN.replace("  NamedMaterial", "  Sh\n  NamedMaterial")
    found = s.complete(text, "  Sh")
    assert "Shape" in labels(found) and "Film" not in labels(found)
    shape = next(i for i in found["items"] if i["label"] == "Shape")
    assert shape["insertTextFormat"] == 2 and shape["textEdit"]["newText"] == 'Shape "${1:sphere}"$0'
    assert shape["textEdit"]["range"] == {"start": position((10, 2)), "end": position((10, 4))}
    # Plugins, with what they are.
    found = s.complete(MAIN.replace('"sphere"', '"'), 'Shape "')
    assert "trianglemesh" in labels(found) and "matte" not in labels(found)
    sphere = next(i for i in found["items"] if i["label"] == "sphere")
    assert sphere["textEdit"]["newText"] == 'sphere"' and "radius" in sphere["documentation"]["value"]
    # Parameters that are not given yet, with type and default; those of the material in force too.
    text = MAIN.replace('"float radius" 0.5', '"float radius" 0.5 "')
    found = s.complete(text, '0.5 "')
    assert "radius" not in labels(found) and "zmin" in labels(found)
    assert "Kd" in labels(found) and "sigma" in labels(found)  # of the matte material "red"
    phimax = next(i for i in found["items"] if i["label"] == "phimax")
    assert phimax["textEdit"]["newText"] == 'float phimax" ${1:360}$0' and "degrees" in phimax["detail"]
    kd = [i["textEdit"]["newText"] for i in found["items"] if i["label"] == "Kd"]
    assert kd == ['rgb Kd" [ ${1:0.5 0.5 0.5} ]$0', 'texture Kd" "${1:checks}"$0'], kd
    # Names in scope, through the Include.
    found = s.complete(MAIN.replace('NamedMaterial "red"', 'NamedMaterial "r"'), 'NamedMaterial "r')
    assert labels(found) == ["red"] and found["items"][0]["textEdit"]["newText"] == 'red"'
    assert "matte" in found["items"][0]["documentation"]["value"]
    found = s.complete(MAIN.replace("0.5\n", '0.5 "texture Kd" ""\n'), '"texture Kd" "')
    assert labels(found) == ["checks"]
    # Not before it.
    assert labels(s.complete(MAIN.replace("Include", 'NamedMaterial ""\nInclude'), 'NamedMaterial "')) == []
    # Choices and files.
    extra = 'Texture "t" "float" "imagemap" "string wrap" ""\n'
    assert "clamp" in labels(s.complete(MAIN.replace("AttributeEnd", extra + "AttributeEnd"), '"string wrap" "'))
    found = labels(s.complete(MAIN.replace('Include "materials.pbrt"', 'Include ""'), 'Include "'))
    assert "materials.pbrt" in found and "scene.pbrt" not in found, found
    extra = 'Shape "plymesh" "string filename" ""\n'
    found = labels(s.complete(MAIN.replace("AttributeEnd", extra + "AttributeEnd"), 'plymesh" "string filename" "'))
    assert "bad.ply" in found and "materials.pbrt" not in found, found
    extra = 'Material "uber" "bool remaproughness" "'
    assert labels(s.complete(MAIN.replace("  NamedMaterial", extra + "\n  NamedMaterial"), 'remaproughness" "')) == ["true", "false"]
    # One goes on from a folder, whose string is therefore not closed.
    os.mkdir(os.path.join(s.folder, "meshes"))
    write(os.path.join(s.folder, "meshes"), "cube.PLY", "")
    extra = 'Shape "plymesh" "string filename" "me"\n'
    text = MAIN.replace("AttributeEnd", extra + "AttributeEnd")
    found = s.complete(text, 'filename" "me')
    folder = next(i for i in found["items"] if i["label"] == "meshes/")
    assert apply_edits(text, [folder["textEdit"]]) == text.replace('"me"', '"meshes/"')
    text = text.replace('"me"', '"meshes/"')
    found = s.complete(text, '"meshes/')
    assert [apply_edits(text, [i["textEdit"]]) for i in found["items"]] == [text.replace("meshes/", "meshes/cube.PLY")]
    # Nothing in a comment.
    assert labels(s.complete(MAIN, "# A sc")) == []
    s.c.edit(s.uri, (MAIN,))


def test_completion_for_plain_clients(folder):
    c = Client({}, folder)
    text = MAIN.replace('"float radius" 0.5', '"')
    uri = c.open(os.path.join(folder, "scene.pbrt"), text)
    found = c.at("completion", uri, place(text, 'sphere" "', 9))
    texts = {i["label"]: i["textEdit"]["newText"] for i in found["items"]}
    assert texts["radius"] == 'float radius" 1' and texts["Kd"] == 'texture Kd" "checks"', texts
    symbols = c.whole("documentSymbol", uri)
    assert all("location" in s for s in symbols)
    assert c.end() == 0


def test_hover(s):
    text = s.hover(MAIN, "sphere")
    assert "sphere" in text and "radius" in text
    assert "scene length" in s.hover(MAIN, "float radius") and "default 1" in s.hover(MAIN, "float radius")
    # Points are columns: Translate 1 2 3, then Scale 2: x' = 2 x + 1.
    rows = [line.split() for line in s.hover(MAIN, "Shape").split("\n")]
    assert ["2", "0", "0", "1"] in rows and ["0", "0", "2", "3"] in rows, rows
    rows = [line.split() for line in s.hover(MAIN, "Translate").split("\n")]
    assert ["1", "0", "0", "1"] in rows, rows
    # sRGB of 0.5 is 188 (0.7354 * 255 = 187.5), of 0.25 it is 137 (0.5371 * 255 = 136.96).
    assert "#ffbc89" in s.hover(MAIN, "rgb L")
    assert "string type" in s.hover(MAIN, '"red"')
    text = MAIN.replace('"rgb L" [ 1 .5 .25 ]', '"blackbody L" [ 2000 1 ]')
    s.c.edit(s.uri, (text,))
    # Red is more than green, and blue is next to nothing.
    found = re.search(r"linear RGB (\S+) (\S+) (\S+), sRGB `#[0-9a-f]{6}`", s.hover(text, "2000"))
    assert float(found[1]) > 2 * float(found[2]) > 8 * float(found[3]), found
    s.c.edit(s.uri, (MAIN,))


def test_definition_and_references(s):
    c = s.c
    found = c.at("definition", s.uri, place(MAIN, '"red"', 2))
    assert found == [{"uri": s.materials_uri, "range": {"start": position(place(MATERIALS, '"red"')),
                                                         "end": position(place(MATERIALS, '"red"', 5))}}], found
    found = c.at("definition", s.uri, place(MAIN, "materials.pbrt", 2))
    assert found[0]["uri"] == s.materials_uri and found[0]["range"]["start"] == position((0, 0))
    found = c.at("references", s.uri, place(MAIN, '"red"', 2), context={"includeDeclaration": True})
    assert sorted(f["uri"] for f in found) == sorted([s.uri, s.materials_uri])
    assert len(c.at("references", s.uri, place(MAIN, '"red"', 2), context={"includeDeclaration": False})) == 1
    found = c.at("documentHighlight", s.uri, place(MAIN, '"red"', 2))
    assert [f["kind"] for f in found] == [2]
    links = c.whole("documentLink", s.uri)
    assert [link["target"] for link in links] == [s.materials_uri]


def test_rename(s):
    c = s.c
    found = c.at("prepareRename", s.uri, place(MAIN, '"red"', 2))
    assert found == {"range": {"start": position(place(MAIN, '"red"', 1)), "end": position(place(MAIN, '"red"', 4))},
                     "placeholder": "red"}
    changes = c.at("rename", s.uri, place(MAIN, '"red"', 2), newName='dark "red"')["changes"]
    assert apply_edits(MAIN, changes[s.uri]) == MAIN.replace('"red"', '"dark \\"red\\""')
    assert apply_edits(MATERIALS, changes[s.materials_uri]) == MATERIALS.replace('"red"', '"dark \\"red\\""')
    for what, name in (("perspective", "x"), ('"red"', ""), ('"red"', "a\nb")):
        error = c.fails("textDocument/rename", {"textDocument": {"uri": s.uri}, "position": position(place(MAIN, what, 2)),
                                                "newName": name})
        assert error["code"] in (-32803, -32602)
    # A name that a block gives anew is another one outside.
    text = """WorldBegin
MakeNamedMaterial "m" "string type" "matte"
AttributeBegin
MakeNamedMaterial "m" "string type" "glass"
NamedMaterial "m"
AttributeEnd
NamedMaterial "m"
WorldEnd
"""
    uri = c.open(write(s.folder, "scopes.pbrt", text))
    edits = c.at("rename", uri, (4, 16), newName="n")["changes"][uri]
    assert sorted(e["range"]["start"]["line"] for e in edits) == [3, 4], edits
    edits = c.at("rename", uri, (1, 20), newName="n")["changes"][uri]
    assert sorted(e["range"]["start"]["line"] for e in edits) == [1, 6], edits
    c.close(uri)


def test_layout(s):
    c = s.c
    ugly = MAIN.replace("  Translate 1 2 3", "Translate    1.0 2 3 # there")
    c.edit(s.uri, (ugly,))
    formatted = apply_edits(ugly, c.whole("formatting", s.uri, options={"tabSize": 2, "insertSpaces": True}))
    expected = subprocess.run([WHIT, "fmt"], input=ugly, capture_output=True, text=True, check=True).stdout
    assert formatted == expected, formatted
    c.edit(s.uri, (expected,))
    assert c.whole("formatting", s.uri, options={"tabSize": 2, "insertSpaces": True}) == []
    # As `whit fmt` does, it asks .editorconfig.
    config = write(s.folder, ".editorconfig", "root = true\n[*.pbrt]\nindent_style = tab\n")
    formatted = apply_edits(expected, c.whole("formatting", s.uri, options={"tabSize": 2, "insertSpaces": True}))
    assert "\n\tTranslate 1 2 3" in formatted, formatted
    os.remove(config)
    c.edit(s.uri, (MAIN,))
    symbols = c.whole("documentSymbol", s.uri)
    assert [x["name"] for x in symbols] == ["perspective", "image", "WorldBegin"], symbols
    world = symbols[-1]["children"]
    assert [x["name"] for x in world] == ["infinite", "materials.pbrt", "AttributeBegin"]
    assert [x["name"] for x in world[-1]["children"]] == ["sphere"]
    folds = c.whole("foldingRange", s.uri)
    assert [(f["startLine"], f["endLine"], f["kind"]) for f in folds] == [
        (0, 1, "comment"), (4, 12, "region"), (7, 11, "region")], folds


def decoded(tokens, legend):
    line = character = 0
    out = []
    for i in range(0, len(tokens), 5):
        down, right, length, kind, _ = tokens[i:i + 5]
        character = right if down else character + right
        line += down
        out.append((line, character, length, legend[kind]))
    return out


def test_tokens(s):
    legend = s.c.capabilities["semanticTokensProvider"]["legend"]["tokenTypes"]
    every = decoded(s.c.whole("semanticTokens/full", s.uri)["data"], legend)
    assert every[0] == (0, 0, len("# A scene."), "comment")
    assert (2, 0, 6, "keyword") in every and (2, 7, 13, "class") in every
    line, character = place(MAIN, '"float radius"')
    assert (line, character, 6, "type") in every and (line, character + 7, 7, "property") in every
    assert (line, character + 15, 3, "number") in every
    some = decoded(s.c.whole("semanticTokens/range", s.uri, range={"start": position((5, 0)), "end": position((7, 0))})["data"], legend)
    assert some == [t for t in every if 5 <= t[0] < 7], some


def test_colours(s):
    found = s.c.whole("documentColor", s.uri)
    assert len(found) == 1 and found[0]["range"]["start"] == position(place(MAIN, "1 .5 .25"))
    colour = found[0]["color"]
    assert abs(colour["red"] - 1) < 1e-6 and abs(colour["green"] - 0.7354) < 1e-3  # 1.055 * .5^(1/2.4) - .055
    shown = s.c.whole("colorPresentation", s.uri, color=colour, range=found[0]["range"])
    assert shown[0]["label"] == "1 0.5 0.25", shown
    # A colour brighter than any that can be chosen stays as bright.
    bright = MAIN.replace("1 .5 .25", "40 20 10")
    s.c.edit(s.uri, (bright,))
    found = s.c.whole("documentColor", s.uri)[0]
    assert found["color"] == colour
    green = {"red": 0, "green": 1, "blue": 0, "alpha": 1}
    shown = s.c.whole("colorPresentation", s.uri, color=green, range=found["range"])
    assert apply_edits(bright, [shown[0]["textEdit"]]) == bright.replace("40 20 10", "0 40 0")
    s.c.edit(s.uri, (MAIN,))


def test_positions(s):
    """Characters beyond ASCII, and lines that end otherwise."""
    text = 'WorldBegin\r\n# caf\u00e9 \U0001f600\r\nTexture "\U0001f600\u00e9" "float" "constant" Nonsense\r\nWorldEnd\r\n'
    path = write(s.folder, "wide.pbrt", text)
    uri = s.c.open(path)
    # Two units of UTF-16 for the face, one for the e.
    at = len('Texture "XXe" "float" "constant" ')
    found = s.c.wait_diagnostics(uri, lambda d: any("Nonsense" in x["message"] for x in d))
    where = [x["range"] for x in found if "Nonsense" in x["message"]][0]
    assert where == {"start": position((2, at)), "end": position((2, at + 8))}, where
    s.c.edit(uri, ("", (2, at - 1), (2, at + 8)))
    s.c.wait_diagnostics(uri, lambda d: not any("Nonsense" in x["message"] for x in d))
    assert s.c.at("prepareRename", uri, (2, 10))["range"] == {"start": position((2, 9)), "end": position((2, 12))}
    s.c.close(uri)
    c = Client({"general": {"positionEncodings": ["utf-8", "utf-16"]}}, s.folder)
    assert c.capabilities["positionEncoding"] == "utf-8"
    c.open(path)
    found = c.wait_diagnostics(uri, lambda d: any("Nonsense" in x["message"] for x in d))
    where = [x["range"] for x in found if "Nonsense" in x["message"]][0]
    assert where["start"] == position((2, at + 3))  # four bytes and two, instead of two units and one
    assert c.end() == 0


def test_two_includes_of_a_file(s):
    """Of a file that is included twice everything is said once."""
    write(s.folder, "twice.pbrt", 'Shape "sphere" "float raduis" 1\n')
    text = 'WorldBegin\nLightSource "point"\nInclude "twice.pbrt"\nInclude "twice.pbrt"\nWorldEnd\n'
    path = write(s.folder, "includes.pbrt", text)
    uri = s.c.open(path)
    piece = uri_of(os.path.join(s.folder, "twice.pbrt"))
    s.c.wait_diagnostics(piece, lambda d: len(d) >= 1)
    s.c.close(uri)
    s.c.wait_diagnostics(piece, lambda d: d == [])


def test_manners(folder):
    """What is not the protocol gets an error, and the server goes on."""
    c = Client(initialize=False)
    assert c.fails("textDocument/hover", {})["code"] == -32002
    c.request("initialize", {"capabilities": {}})
    assert c.fails("initialize", {"capabilities": {}})["code"] == -32600
    assert c.fails("no/such/method", {})["code"] == -32601
    assert c.fails("textDocument/hover", {"textDocument": {"uri": "file:///nowhere"}, "position": position((0, 0))})["code"] == -32602
    assert c.fails("textDocument/hover", [1])["code"] == -32602
    uri = c.open(os.path.join(folder, "scene.pbrt"))
    assert c.fails("textDocument/hover", {"textDocument": {"uri": uri}, "position": {"line": -1, "character": 0}})["code"] == -32602
    assert c.fails("textDocument/hover", {"textDocument": {"uri": uri}, "position": {"line": "x"}})["code"] == -32602
    for line in (1e30, 0.5, -1e300, [0]):  # of which the first fits no integer
        assert c.fails("textDocument/hover", {"textDocument": {"uri": uri}, "position": {"line": line, "character": 0}})["code"] == -32602
    c.at("hover", uri, (10 ** 6, 10 ** 6))
    for garbage in (b"Content-Length: 5\r\n\r\n{{{{{", b"Content-Length: 2\r\n\r\n[]", b"Content-Length: nonsense\r\n\r\n",
                    b"Content-Length: 99999999999999999999\r\n\r\n", b"GET / HTTP/1.1\r\nHost: x\r\n\r\n",
                    b"Content-Length: 4\r\n\r\n\xff\xfe\x00\x00", b'Content-Length: 25\r\n\r\n{"id": [], "method": "x"}',
                    b"Content-Length: 7\r\n\r\n" + b"[" * 7, b"x" * 10000 + b"\r\n\r\n"):
        before = len(c.errors)
        c.send_bytes(garbage)
        c.at("hover", uri, (0, 0))
        assert len(c.errors) >= before, garbage
    assert len(c.errors) >= 7, c.errors
    # Blocks in one another, deeper than any stack.
    deep = c.open(os.path.join(folder, "deep.pbrt"), "WorldBegin\n" + "AttributeBegin\n" * 100000)
    c.whole("documentSymbol", deep)
    assert len(c.whole("semanticTokens/full", deep)["data"]) == 5 * 100001
    c.wait_diagnostics(deep, lambda d: len(d) > 0)
    c.close(deep)
    # In one write, so that the second is there before the first is answered.
    body = [json.dumps({"jsonrpc": "2.0", "id": 1000 + i, "method": "textDocument/semanticTokens/full",
                        "params": {"textDocument": {"uri": uri}}}).encode() for i in range(50)]
    body.append(json.dumps({"jsonrpc": "2.0", "method": "$/cancelRequest", "params": {"id": 1049}}).encode())
    c.send_bytes(b"".join(b"Content-Length: %d\r\n\r\n" % len(b) + b for b in body))
    answers = [c.wait(1000 + i) for i in range(50)]
    assert all("result" in a for a in answers[:49])
    assert "result" in answers[49] or answers[49]["error"]["code"] == -32800
    c.request("shutdown", None)
    assert c.fails("textDocument/hover", {})["code"] == -32600
    c.notify("exit", None)
    assert c.process.wait(60) == 0
    # An end without manners is another exit code.
    for goodbye in (lambda c: c.notify("exit", None), lambda c: c.process.stdin.close()):
        c = Client()
        goodbye(c)
        assert c.process.wait(60) == 1


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = os.path.realpath(folder)
        s = Session(folder)
        for test in (test_diagnostics, test_two_slips_are_fixed_at_once, test_include_that_is_open_and_not_saved,
                     test_what_reading_files_finds, test_completion, test_hover, test_definition_and_references, test_rename,
                     test_layout, test_tokens, test_colours, test_positions, test_two_includes_of_a_file):
            print(test.__name__, flush=True)
            test(s)
        assert s.c.end() == 0
        for test in (test_completion_for_plain_clients, test_manners):
            print(test.__name__, flush=True)
            test(folder)


if __name__ == "__main__":
    main()
