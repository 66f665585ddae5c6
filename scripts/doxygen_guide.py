"""Prints a guide (Markdown) or a header as Doxygen reads it: the input filter that docs/Doxyfile names.

In the tree, guides link to each other by path and heading, as code hosts resolve them, and set
formulas between lines of $$. Doxygen knows labels and \\f[ instead. A link to a file that is not on
the site becomes its text.

In headers, docs/FILE.md#HEADING in a comment becomes a link, the first comment describes the file,
and a member gets the unit and meaning that the list of its struct (fields, columns) gives.
"""

import posixpath
import re
import sys

LINK = re.compile(r"(`+[^`]*`+)|(!?)\[((?:`[^`]*`|[^\[\]`])*)\]\(([^)\s]+)\)")
GUIDE = re.compile(r"README\.md|CONTRIBUTING\.md|robots/README\.md|docs/(decisions/)?[\w-]+\.md")

PLACEHOLDER = re.compile(r"(?<![\w`])<(\w+)>(?![^`\n]*`[^`\n]*$)")


def label(path: str, heading: str = "") -> str:
    """Label of a guide, or of a heading in it."""
    if path == "README.md" and not heading:
        return "index"
    page = "guide-" + re.sub(r"\W+", "-", path.removesuffix(".md"))
    return f"{page}--{heading}" if heading else page


def slug(title: str) -> str:
    """Anchor that code hosts give a heading."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def link(match: re.Match, path: str) -> str:
    code, image, text, target = match.groups()
    if code and code.startswith("`::"):
        return f"<code>\\{code[1:-1]}</code>"
    if code or re.match(r"\w+:", target):
        return match.group(0)
    text = text.replace("\\|", "&#124;")
    if image:
        return f"![{text}]({posixpath.basename(target)})"
    file, _, heading = target.partition("#")
    file = posixpath.normpath(posixpath.join(posixpath.dirname(path), file)) if file else path
    if file == "docs/decisions":
        file = "docs/decisions/001-baseline-instruction-set.md"
    return f"[{text}](@ref {label(file, heading)})" if GUIDE.fullmatch(file) else text


def convert(source: str, path: str) -> str:
    """The guide at `path`, relative to the root of the tree, as Doxygen reads it."""
    blocks = re.split(r"((?:^(?: {4}[^\n]*)?\n)+|^```.*?^```\n)", source, flags=re.M | re.S)
    for i in range(0, len(blocks), 2):
        blocks[i] = LINK.sub(lambda match: link(match, path), blocks[i])
        blocks[i] = re.sub(
            r"^(#+) +(.+)$",
            lambda match: f"{match[0]} {{#{label(path, '' if match[1] == '#' else slug(match[2]))}}}",
            blocks[i],
            flags=re.M,
        )
        blocks[i] = re.sub(
            r'<a id="([^"]+)"></a>', lambda match: f"@anchor {label(path, match[1])}\n", blocks[i]
        )
        blocks[i] = re.sub(r"(?<=\w)@(?=[A-Z])", r"\\@", blocks[i])
    text = "".join(blocks).replace("{#index}", "{#mainpage}")
    return re.sub(r"^\$\$$(.*?)^\$\$$", r"\\f[\1\\f]", text, flags=re.M | re.S)


def said(arguments: str) -> str:
    """Documentation of a member from the arguments of its line in a list, after the name."""
    limits = re.search(r"Range\{(.*?)\}", arguments)
    unit, *rest = re.findall(r'((?:"[^"\n]*"\s*)+)', arguments)
    text = "".join(re.findall(r'"([^"\n]*)"', rest[0] if rest else unit))
    unit = unit.strip().strip('"') if rest else ""
    unit = "" if unit == "1" else unit
    unit = ", ".join(filter(None, [unit, f"in [{limits[1]}]" if limits else ""]))
    return re.sub(r"([@<>\\])", r"\\\1", f"{unit}: {text}" if unit else text)


def list_docs(source: str) -> dict[tuple[str, str], str]:
    """(struct, member) -> documentation, from the lists in a header."""
    docs = {}
    struct = ""
    for line in re.finditer(
        r"^struct (\w+)|^void (\w+)::"
        r'|\bv\([\w.]+, "(?:(\w+)\.)?(\w+)",(.*?)\);$'
        r'|\bvisit\("\w+",([^;]*), r\.(\w+)\);',
        source,
        flags=re.M | re.S,
    ):
        opened, outside, group, member, arguments, column, column_member = line.groups()
        if opened or outside:
            struct = opened or outside
        elif column:
            docs[struct, column_member] = said(column)
        else:
            owner = re.search(rf"^  (\w+) {group};", source, flags=re.M) if group else None
            docs[owner[1] if owner else struct, member] = said(arguments)
    return docs


def document_members(source: str) -> str:
    """The header with the documentation from its lists behind each member that has none."""
    docs = list_docs(source)
    struct = ""

    def documented(match: re.Match) -> str:
        nonlocal struct
        if match["struct"]:
            struct = match["struct"]
            return match[0]
        names = [name.strip() for name in match["names"].split(",")]
        if any((struct, name) not in docs for name in names):
            return match[0]
        start = match["start"] or ""
        text = " ".join(
            f"{match['type']} {name}{start}; /**< {docs[struct, name]} */" for name in names
        )
        return "  " + text + "\n" * match[0].count("\n")

    return re.sub(
        r"^struct (?P<struct>\w+)"
        r"|^  (?P<type>[\w:]+(?:<.*>)?) (?P<names>\w+(?:,\s+\w+)*)(?P<start> = [^;]*|{})?;$",
        documented,
        source,
        flags=re.M,
    )


def convert_header(source: str) -> str:
    """A C++ header, with the guides that its /// comments cite as links and no HTML in them."""
    source = re.sub(
        r"\A((?://.*\n)+)#pragma once",
        lambda head: "/// @file\n" + head[1].replace("//", "///", 1).replace("\n//", "\n///"),
        source,
    )
    source = re.sub(
        r"^ *///.*$", lambda line: PLACEHOLDER.sub(r"\\<\1\\>", line[0]), source, flags=re.M
    )
    source = document_members(source)
    source = re.sub(r"^  .*&&?\)( noexcept)? = default;$", "", source, flags=re.M)
    source = re.sub(
        r"^(template <>\nstruct EnumNames)", r"/** Names in files. */ \1", source, flags=re.M
    )
    source = re.sub(
        r"(?<!///)(\n  )(template <class Self, class Visit>\n  static void fields\()",
        r"\1/** Calls visit for each of its lines: base/fields.hpp. */ \2",
        source,
    )
    source = re.sub(
        r"^( +)(static constexpr .* kNames =)", r"\1/** In their order. */ \2", source, flags=re.M
    )
    return re.sub(
        r"(?<=[ (])(docs/[\w/-]+\.md)#([\w-]+)",
        lambda match: f'@ref {label(match[1], match[2])} "{match[1]}"',
        source,
    )


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as guide:
        if sys.argv[1].endswith(".md"):
            sys.stdout.write(convert(guide.read(), posixpath.relpath(sys.argv[1])))
        else:
            sys.stdout.write(convert_header(guide.read()))
