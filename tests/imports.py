"""Which file imports which, checked: no circles of files, arrows between crates one way, sizes.

    python3 tests/imports.py            from the root of the repository; fails with every fault named

A *circle* is a set of files of one crate each of which imports, directly or through others, something of every other. An import is a
`use` or an inline path that begins with `crate`, `super`, `self`, a child module or an imported module. It points to the file in
which the name is defined: re-exports are followed. `mod x;` is no import. What `#[cfg(test)]` guards, and `tests.rs`, is not read.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# What each crate may depend on. `atlas` and `peers` are the earlier names of `dynamics` and `bench`.
BELOW = {
    "model": "",
    "solver": "model",
    "optim": "model solver",
    "dynamics": "model solver",
    "atlas": "model solver",
    "store": "",
    "figures": "",
    "study": "model solver optim dynamics atlas",
    "workbench": "model solver optim dynamics atlas study store figures",
    "paper": "model solver optim dynamics atlas study store figures workbench",
    "retune": "model solver optim dynamics atlas study store figures workbench paper",
    "bench": "model solver optim dynamics atlas study store figures workbench paper",
    "peers": "model solver optim dynamics atlas study store figures workbench paper",
}

MOST_LINES = 300
MOST_SHARE = 0.25

# Known exceptions, each with the size that it may have and the reason. One that is no longer needed is named, and goes.
LONG_FILES = {
    "crates/optim/src/goal.rs": (342, "becomes part of the serialisable Objective"),
    "crates/peers/src/panel.rs": (309, "becomes part of `figures`"),
}
LARGE_CRATES = {}

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


def circles(edges):
    """The sets of files that all reach one another (Tarjan's strongly connected components), each with a shortest circle."""
    index, low, stack, found = {}, {}, [], []

    def visit(file):
        index[file] = low[file] = len(index)
        stack.append(file)
        for other in sorted(edges.get(file, ())):
            if other not in index:
                visit(other)
                low[file] = min(low[file], low[other])
            elif other in stack:
                low[file] = min(low[file], index[other])
        if low[file] == index[file]:
            part = stack[stack.index(file) :]
            del stack[stack.index(file) :]
            if len(part) > 1:
                found.append((part, shortest(edges, set(part))))

    for file in sorted(edges):
        if file not in index:
            visit(file)
    return found


def shortest(edges, part):
    """A shortest circle within a set of files."""
    best = None
    for start in sorted(part):
        ways, reached = [[start]], {start}
        while ways:
            way = ways.pop(0)
            for other in sorted(edges.get(way[-1], set()) & part):
                if other == start and (best is None or len(way) < len(best)):
                    best = way
                if other not in reached:
                    reached.add(other)
                    ways.append([*way, other])
    return [*best, best[0]]


def dependencies(manifest):
    """The dependencies of a crate, those of single targets included, those of tests and build scripts not."""
    names, section = set(), ""
    for line in manifest.read_text(encoding="utf-8").splitlines():
        if line.startswith("["):
            section = line.strip().strip("[]")
            if match := re.fullmatch(r"(?:target\..*\.)?dependencies\.([\w-]+)", section):
                names.add(match.group(1))
        elif re.fullmatch(r"(?:target\..*\.)?dependencies", section):
            if match := re.match(r"([\w-]+)\s*[.=]", line):
                names.add(match.group(1))
    return names


def main():
    sys.setrecursionlimit(10_000)
    faults, rows = [], []
    crates = sorted(path.parent for path in ROOT.glob("crates/*/Cargo.toml"))
    packages = {re.search(r'(?m)^name\s*=\s*"([^"]+)"', (c / "Cargo.toml").read_text()).group(1): c.name for c in crates}
    for crate in crates:
        sources = sorted((crate / "src").rglob("*.rs"))
        lines = {file: len(file.read_text(encoding="utf-8").splitlines()) for file in sources}
        edges = {}
        for root in [crate / "src/lib.rs", crate / "src/main.rs", *sorted((crate / "src/bin").glob("*.rs"))]:
            if root.is_file():
                for file, other in load(root, None, root.parent).imports():
                    edges.setdefault(file, set()).add(other)
        short = lambda file: str(file.relative_to(crate / "src"))
        round_trips = circles(edges)
        for part, circle in round_trips:
            faults.append(
                f"{crate.name}: a circle of {len(part)} files ({', '.join(sorted(map(short, part)))}): "
                + " → ".join(map(short, circle))
            )
        used = {packages[name] for name in dependencies(crate / "Cargo.toml") if name in packages}
        if crate.name not in BELOW:
            faults.append(f"{crate.name}: a crate that tests/imports.py does not know: say in BELOW what it may depend on")
        else:
            for other in sorted(used - set(BELOW[crate.name].split())):
                faults.append(f"{crate.name} depends on {other}: this arrow points the wrong way")
        for file, count in lines.items():
            name = file.relative_to(ROOT).as_posix()
            most, _ = LONG_FILES.get(name, (MOST_LINES, ""))
            if count > most:
                faults.append(f"{name}: {count} lines, and {most} are allowed")
        rows.append((crate.name, len(sources), sum(lines.values()), max(lines.values(), default=0), len(round_trips), used))
    total = sum(row[2] for row in rows)
    print(f"{'crate':<11}{'files':>6}{'lines':>8}{'share':>8}{'longest':>9}{'circles':>9}  depends on")
    for name, files, count, longest, found, used in rows:
        share = count / total
        print(f"{name:<11}{files:>6}{count:>8}{share:>8.1%}{longest:>9}{found:>9}  {' '.join(sorted(used)) or '-'}")
        most, _ = LARGE_CRATES.get(name, (MOST_SHARE, ""))
        if share > most:
            faults.append(f"{name}: {share:.1%} of all lines, and {most:.0%} are allowed")
        if name in LARGE_CRATES and share <= MOST_SHARE:
            print(f"  {name} needs no exception any more")
    for name, (_, reason) in LONG_FILES.items():
        if not (ROOT / name).is_file() or len((ROOT / name).read_text().splitlines()) <= MOST_LINES:
            print(f"  {name} needs no exception any more ({reason})")
    for fault in faults:
        print(f"fault: {fault}")
    print(f"{total} lines in {len(rows)} crates, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
