"""Which file of a crate imports which: `imports(crate)`, for `tests/imports.py`.

An import is a `use` or an inline path that begins with `crate`, `super`, `self`, a child module or an imported module. It points to
the file in which the name is defined: re-exports are followed. `mod x;` is no import. Items under `#[cfg(test)]`, and `tests.rs`, are
not read. The reader knows as much Rust as that takes and no more; macros are read as written.
"""

import re

IDENT = r"(?:r#)?[A-Za-z_]\w*"
ITEM = re.compile(
    r"(?:pub(?:\s*\([^)]*\))?\s+)?(?:default\s+|unsafe\s+|async\s+|extern\s+(?:\"\"\s+)?)*"
    r"(?:(?P<kind>fn|struct|enum|trait|type|union|static(?:\s+mut)?|const(?:\s+fn)?)\s+(?P<name>" + IDENT + r")"
    r"|macro_rules!\s*(?P<macro>" + IDENT + r"))"
)
PATH = re.compile(r"(?<![\w:$'])(" + IDENT + r")((?:\s*::\s*" + IDENT + r")+)")


def blank(text):
    """The text with comments, strings and characters emptied; `#[path = "…"]` keeps its string."""
    keep = r"#\[path\s*=\s*\"[^\"]*\"\]"
    lexemes = re.compile(
        keep + r"|//[^\n]*|/\*(?:[^*]|\*(?!/))*\*/|b?r(#*)\"(?:.|\n)*?\"\1|b?\"(?:[^\"\\]|\\(?:.|\n))*\"|b?'(?:[^'\\\n]|\\[^\n]+?)'"
    )

    def emptied(match):
        found = match.group(0)
        if found.startswith("#[path"):
            return found
        lines = "\n" * found.count("\n")
        return lines if found.startswith("/") else '""' + lines

    return lexemes.sub(emptied, text)


def closing(text, start):
    """The end of the bracket that opens at `start`."""
    depth = 0
    for i in range(start, len(text)):
        depth += (text[i] in "{[(") - (text[i] in "}])")
        if depth == 0:
            return i + 1
    return len(text)


def item_end(text, start):
    """The end of the item that begins at `start`: its block, or its semicolon."""
    i = start
    while i < len(text):
        if text[i] == "{":
            return closing(text, i)
        if text[i] in "[(":
            i = closing(text, i)
        elif text[i] in ";}":
            return i + 1
        else:
            i += 1
    return i


def without_tests(text):
    """The text without the items that are only compiled for tests."""
    guard = re.compile(r"#\[cfg\(test\)\]\s*")
    while match := guard.search(text):
        i = match.end()
        while text.startswith("#[", i):
            i = closing(text, i + 1)
            i += len(text[i:]) - len(text[i:].lstrip())
        is_use = re.match(r"(?:pub(?:\s*\([^)]*\))?\s+)?use\b", text[i:])
        end = text.find(";", i) + 1 if is_use else item_end(text, i)
        text = text[: match.start()] + "\n" * text[match.start() : end].count("\n") + text[end:]
    return text


def use_tree(tree, prefix=()):
    """The paths of a `use`: (path, name in this module); the name `*` for all of a module."""
    tree = tree.strip()
    if not tree:
        return
    brace = tree.find("{")
    if brace >= 0 and tree.endswith("}"):
        head = tuple(part.strip() for part in tree[:brace].split("::") if part.strip())
        depth, begin, inner = 0, 0, tree[brace + 1 : -1]
        for i, character in enumerate(inner + ","):
            depth += (character == "{") - (character == "}")
            if character == "," and depth == 0:
                yield from use_tree(inner[begin:i], prefix + head)
                begin = i + 1
        return
    path, _, alias = tree.partition(" as ")
    path = prefix + tuple(part.strip() for part in path.split("::") if part.strip())
    if path[-1] == "self" and len(path) > 1:
        path = path[:-1]
    yield path, alias.strip() or path[-1]


class Module:
    """A module: its file, the names defined in it, its `use`s, its inline paths and its children."""

    def __init__(self, file, parent=None):
        self.file, self.parent = file, parent
        self.root = parent.root if parent else self
        self.names, self.uses, self.paths, self.children = set(), {}, [], {}
        self.globs = []

    def read(self, text, folder):
        """Takes the items of `text`; the files of child modules lie in `folder`."""
        i, depth, rest = 0, 0, []
        token = re.compile(r"[{}]|\b(?:mod|use)\b|" + ITEM.pattern)
        while match := token.search(text, i):
            rest.append(text[i : match.start()])
            found, i = match.group(0), match.end()
            if found in "{}":
                depth += (found == "{") - (found == "}")
            elif found == "use" and re.match(r"\s", text[i : i + 1]):
                end = text.find(";", i)
                for path, name in use_tree(re.sub(r"\s+", " ", text[i:end])):
                    if name == "*":
                        self.globs.append(path[:-1])
                    else:
                        self.uses[name] = path
                    self.paths.append(path[:-1] if name == "*" else path)
                i = end + 1
            elif found == "mod":
                child = re.match(r"\s+(" + IDENT + r")\s*([;{])", text[i:])
                if child:
                    i = self.child(text, match.start(), i, child, folder)
            elif depth == 0:
                self.names.add(match.group("name") or match.group("macro"))
        rest.append(text[i:])
        for match in PATH.finditer(" ".join(rest)):
            self.paths.append((match.group(1), *re.split(r"\s*::\s*", match.group(2))[1:]))

    def child(self, text, start, i, match, folder):
        """Reads a child module; returns where the text goes on."""
        name = match.group(1)
        if match.group(2) == "{":
            begin = i + match.end() - 1
            end = closing(text, begin)
            self.children[name] = Module(self.file, self)
            self.children[name].read(text[begin + 1 : end - 1], folder / name)
            return end
        given = re.search(r"#\[path\s*=\s*\"([^\"]*)\"\]\s*(?:pub(?:\s*\([^)]*\))?\s+)?$", text[:start])
        places = [self.file.parent / given.group(1)] if given else [folder / f"{name}.rs", folder / name / "mod.rs"]
        for place in places:
            if place.is_file() and place.name != "tests.rs":
                self.children[name] = load(place, self, place.parent if place.name == "mod.rs" else folder / name)
        return i + match.end()

    def find(self, path, seen=()):
        """The module or (module, name) that a path leads to from here; `None` where it leaves the crate."""
        if (self, path) in seen:
            return None
        seen = (*seen, (self, path))
        first, rest = path[0], path[1:]
        if first == "crate":
            return self.root.down(rest, seen)
        if first == "self":
            return self.down(rest, seen)
        if first == "super":
            return self.parent.find(("self", *rest), seen) if self.parent else None
        if first in self.children or first in self.uses or first in self.names:
            return self.down(path, seen)
        return None

    def down(self, path, seen):
        if not path:
            return self
        if path[0] == "super":
            return self.parent.down(path[1:], seen) if self.parent else None
        if path[0] in self.children:
            return self.children[path[0]].down(path[1:], seen)
        if path[0] in self.names:
            return self, path[0]
        if path[0] in self.uses:
            used = self.uses[path[0]]
            # `use x::x;` of another crate leads nowhere here.
            if used[0] == path[0] and used[0] not in self.children:
                return None
            return self.find((*used, *path[1:]), seen)
        for glob in self.globs:
            if isinstance(place := self.find(glob, seen), Module) and (found := place.down(path, seen)) is not None:
                if not (isinstance(found, Module) and found is place):
                    return found
        return None

    def imports(self):
        """The files that this module and those inside its file import."""
        for path in self.paths:
            found = self.find(path)
            file = found.file if isinstance(found, Module) else found[0].file if found else None
            if file and file != self.file:
                yield self.file, file
        for child in self.children.values():
            yield from child.imports()


def load(file, parent, folder):
    module = Module(file, parent)
    module.read(without_tests(blank(file.read_text(encoding="utf-8"))), folder)
    return module


def imports(crate):
    """The files that each file of a crate imports. Every program of `src/bin` is a crate of its own."""
    edges = {}
    for root in [crate / "src/lib.rs", crate / "src/main.rs", *sorted((crate / "src/bin").glob("*.rs"))]:
        if root.is_file():
            for file, other in load(root, None, root.parent).imports():
                edges.setdefault(file, set()).add(other)
    return edges
