"""The documents as a site with mdBook, and the links of all documents checked.

    python3 docs/site.py            checks that every link of the documents leads somewhere (part of `just lint`)
    python3 docs/site.py MDBOOK     also builds the site into target/site/book, and checks the links of its pages (`just site`)

The pages keep their places: links between documents stay as they are. A document that a page links to becomes a page, another file is
copied, and what is too large or a folder is linked to in the repository. Formulas between dollars become MathJax's.
"""

import html
import posixpath
import re
import shutil
import string
import subprocess
import sys
import unicodedata
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
REPOSITORY = re.search(r'(?m)^repository = "([^"]+)"', (ROOT / "Cargo.toml").read_text()).group(1)
LARGEST = 3_000_000

PARTS = [
    ("", ["README.md", "docs/tutorial.md", "docs/tuning.md", "docs/nomenclature.md"]),
    ("Why it can be trusted", ["docs/theory.md", "docs/bounds.md", "docs/proof.md", "docs/decisions.md", "results/robustness/README.md"]),
    ("Other programs", ["docs/python.md", "docs/matlab.md", "docs/scale.md", "docs/performance.md"]),
    ("Development", ["ARCHITECTURE.md", "CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md"]),
    ("Results", ["gallery.md"]),
]
PICTURES = [
    "results/ssvi/band.svg", "results/losses/losses.svg", "results/retune/retention.svg", "results/fronts/k2.svg",
    "results/fronts/stroke.svg", "results/branches/isola/branches.svg", "results/paper/figure3.svg", "results/paper/figure6.svg",
]

CODE = re.compile(r"(^(?P<fence>`{3,})[^\n]*\n.*?^(?P=fence)`*$|`[^`\n]+`|<!--.*?-->)", re.S | re.M)
LINK = re.compile(r"(?<=\]\()([^()\s]+)(?=\))")


def outside_code(text, change):
    """The text with what is neither code nor a comment changed."""
    pieces, at = [], 0
    for match in CODE.finditer(text):
        pieces += [change(text[at:match.start()]), match.group()]
        at = match.end()
    return "".join(pieces + [change(text[at:])])


def links(text):
    """The links of a document, those in code left out."""
    found = []
    outside_code(text, lambda piece: found.extend(LINK.findall(piece)) or piece)
    return found


def is_elsewhere(link):
    return re.match(r"[a-z]+:", link) is not None


def target(page, link):
    """The file that a link of a page leads to, and the place in it."""
    path, _, place = link.partition("#")
    return posixpath.normpath(posixpath.join(posixpath.dirname(page), path)) if path else page, place


def anchor(heading):
    """The place of a heading, as GitHub and mdBook name it."""
    kept = (c for c in heading.strip().lower() if c in " -_" or unicodedata.category(c)[0] in "LN")
    return "".join(kept).replace(" ", "-")


def heading(page, text):
    """What a page is called: by its first heading, or by its file."""
    found = re.search(r"(?m)^# (.*)$", text)
    return found.group(1) if found else Path(page).stem.capitalize()


def anchors(text):
    """The places of a document."""
    found = []
    headings = r"(?m)^#+ (.*)$"
    outside_code(re.sub(r"`([^`\n]+)`", r"\1", text), lambda piece: found.extend(re.findall(headings, piece)) or piece)
    return {anchor(heading) for heading in found}


def documents():
    """All documents of the repository by their places in it."""
    names = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"],
                           cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    return {name: (ROOT / name).read_text() for name in names if name and (ROOT / name).is_file()}


def broken_links(texts):
    """The links of the documents that lead nowhere."""
    faults = []
    for page, text in texts.items():
        for link in links(text):
            if is_elsewhere(link):
                continue
            path, place = target(page, link)
            if not (ROOT / path).exists():
                faults.append(f"{page}: {link}: no such file")
            elif place and place not in anchors(texts.get(path, "")):
                faults.append(f"{page}: {link}: no such heading")
    return faults


def mathjax(text):
    """Formulas between dollars in MathJax's marks. What Markdown would read as its own is escaped."""

    def escaped(formula):
        return "".join("\\" + c if c in string.punctuation else c for c in formula)

    def change(piece):
        piece = re.sub(r"\$\$(.+?)\$\$", lambda m: "\\\\[" + escaped(m.group(1)) + "\\\\]", piece, flags=re.S)
        return re.sub(r"\$([^$\n]+)\$", lambda m: "\\\\(" + escaped(m.group(1)) + "\\\\)", piece)

    return outside_code(text, change)


def pages_of(texts):
    """The documents of the site: those of the parts, and those that they lead to."""
    first = [page for _, pages in PARTS for page in pages]
    found, ways = dict.fromkeys(first), list(first)
    while ways:
        page = ways.pop(0)
        for link in links(texts[page]):
            path, _ = target(page, link)
            if not is_elsewhere(link) and path in texts and path not in found:
                found[path] = None
                ways.append(path)
    return first, [page for page in found if page not in first]


def write(source, texts):
    """The sources of the site; mdBook calls a README `index.html`."""
    texts = texts | {"gallery.md": gallery()}
    first, more = pages_of(texts)
    pages = {*first, *more}
    for page in pages:

        def moved(match, page=page):
            link = match.group()
            path, place = target(page, link)
            if is_elsewhere(link) or link.startswith("#"):
                return link
            if path in pages:
                return re.sub(r"README\.md", "index.md", link)
            file = ROOT / path
            if file.is_file() and file.stat().st_size <= LARGEST:
                (source / path).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(file, source / path)
                return link
            return f"{REPOSITORY}/tree/main/{path}" + (f"#{place}" if place else "")

        text = mathjax(outside_code(texts[page], lambda piece: LINK.sub(moved, piece)))
        (source / page).parent.mkdir(parents=True, exist_ok=True)
        (source / page).write_text(text)
    title = {page: heading(page, texts[page]) for page in pages}
    lines = ["# Summary", ""]
    for part, names in PARTS:
        lines += [f"# {part}", ""] if part else []
        lines += [f"- [{title[page]}]({page})" for page in names] + [""]
    lines += [f"- [{title[page]}]({page})" for page in more]
    (source / "SUMMARY.md").write_text("\n".join(lines) + "\n")


def gallery():
    """Pictures of the results with the words that stand in them."""
    said = ["# Gallery", "", "Figures of `results`, each with what it says to those who cannot see it.", ""]
    for picture in PICTURES:
        svg = (ROOT / picture).read_text()
        title, words = (html.unescape(re.search(rf"<{tag}[^>]*>(.*?)</{tag}>", svg, re.S).group(1)) for tag in ("title", "desc"))
        folder = posixpath.dirname(picture)
        more = f"{folder}/README.md" if (ROOT / folder / "README.md").is_file() else folder
        said += [f"## {title}", "", f"![{title}]({picture})", "", f"{words} [More]({more})", ""]
    return "\n".join(said)


def broken_pages(book):
    """The links of the pages that were built from documents that lead nowhere."""
    faults, count = [], 0
    places = {}
    for page in sorted(book.rglob("*.html")):
        text = page.read_text(errors="replace")
        if "mdbook" not in text or page.name in ("print.html", "toc.html", "404.html"):
            continue  # a page of the results, which the site has as it is, or one of mdBook's own
        for link in re.findall(r'(?:href|src)="([^"]+)"', re.sub(r"<(script|code)\b.*?</\1>", "", text, flags=re.S)):
            link = html.unescape(link)
            if is_elsewhere(link) or link.startswith(("//", "data:")):
                continue
            path, _, place = link.partition("#")
            file = (page.parent / path).resolve() if path else page
            file = file / "index.html" if file.is_dir() else file
            count += 1
            if not file.is_file():
                faults.append(f"{page.relative_to(book)}: {link}: no such file")
            elif place and file.suffix == ".html":
                if file not in places:
                    places[file] = set(re.findall(r'\bid="([^"]+)"', file.read_text(errors="replace")))
                if place not in places[file]:
                    faults.append(f"{page.relative_to(book)}: {link}: no such place")
    return faults, count


def end_with(faults):
    if faults:
        sys.exit("\n".join([*sorted(set(faults)), f"{len(set(faults))} links lead nowhere"]))


def main():
    texts = documents()
    end_with(broken_links(texts))
    print(f"{sum(len(links(text)) for text in texts.values())} links of {len(texts)} documents lead somewhere")
    if len(sys.argv) > 1:
        site = ROOT / "target" / "site"
        shutil.rmtree(site / "src", ignore_errors=True)
        (site / "src").mkdir(parents=True)
        write(site / "src", texts)
        (site / "book.toml").write_text(
            '[book]\ntitle = "Retune"\nlanguage = "en"\n\n[output.html]\nmathjax-support = true\nsmart-punctuation = false\n'
            f'git-repository-url = "{REPOSITORY}"\n')
        subprocess.run([sys.argv[1], "build", str(site)], check=True)
        faults, count = broken_pages(site / "book")
        end_with(faults)
        print(f"target/site/book/index.html: {count} links of its pages lead somewhere")


if __name__ == "__main__":
    main()
