#!/usr/bin/env python3
"""Makes man pages: tools/man_page.py VERSION DATE FILE, to standard output.

A header (include/thread.h) becomes libthread(3): what stands over a declaration, or behind it, is its text, a comment between dashes
a heading. Markdown (docs/plan-format.md) becomes thread-plan(5): the rows of tables are paragraphs with their first column as the tag.
A page (docs/thread.1, or what man_page.awk makes of a command's help) stays, but for version and date. All are folded as mandoc -T
lint asks: lines of at most 78 bytes, no empty paragraphs.
"""
import re
import sys
import unicodedata

TITLES = {".h": 'LIBTHREAD 3 "%s" "thread %s" "Library functions"', ".md": 'THREAD-PLAN 5 "%s" "thread %s" "File formats"'}


def plain(text):
    """Words as roff reads them, in ASCII."""
    text = re.sub(r"\s+", " ", text).strip().replace("\\", "\\e").replace("-", "\\-")
    text = re.sub(r"[\u2080-\u209c]", lambda below: unicodedata.normalize("NFKC", below[0]), text)
    return re.sub(r"[^ -~]", lambda letter: "\\[u%04X]" % ord(letter[0]), text)


def bold(text):
    return '.B "%s"' % plain(text).replace('"', "\\(dq")


def uncommented(text):
    return re.sub(r"\n *\* ?", "\n", text[2:-2])


# ---- a header ----

COMMENT = re.compile(r"[ \n]*(/\*.*?\*/)", re.S)


def members(kind, body):
    """The members of a struct or the values of an enumeration, with what is said of each."""
    declaration = r"[^;/]*;" if kind == "struct" else r"[A-Z_]+[^,/]*?(?=,|\s*/\*|\s*$),?"
    for declared, said in re.findall(r"\s*(%s)\s*(/\*.*?\*/)?" % declaration, body, re.S):
        yield from (".TP", bold(declared.rstrip(",")))
        if said:
            yield plain(uncommented(said))


def header(text):
    text = re.sub(r"#ifdef __cplusplus.*?#endif\n", "", text, flags=re.S)
    first, *rest = uncommented(COMMENT.findall(text)[1]).split("\n\n")
    name, _, description = first.partition("\n")
    yield from (".SH NAME", "libthread \\- " + plain(name.split(": ", 1)[1]).rstrip("."), ".SH SYNOPSIS", ".B #include <thread.h>", ".PP",
                bold("cc program.c $(pkg-config --cflags --libs thread)"), ".SH DESCRIPTION")
    for paragraph in [description, *rest]:
        yield from (".PP", plain(paragraph))
    text = text[text.index("typedef enum"):text.rindex("#endif")]
    above = ""
    for comment, declaration, said in re.findall(
            r"\s*(?:(/\*.*?\*/)\n|((?:typedef (?:enum|struct) {.*?} \w+;)|[^/#]*?;)(?: *(/\*.*?\*/))?)", text, re.S):
        if comment:
            heading = re.match(r"/\* ---- (.*) ---- \*/", comment)
            above = "" if heading else comment
            if heading:
                yield ".SH " + heading[1].upper()
            continue
        struct = re.match(r"typedef (\w+) {(.*)} (\w+);", declaration, re.S)
        yield from (".TP", bold("%s %s" % (struct[1], struct[3]) if struct else declaration.replace("THREAD_API ", "")))
        if above or said:
            yield plain(" ".join(uncommented(c) for c in (above, said) if c))
        if struct:
            yield from (".RS", *members(struct[1], struct[2]), ".RE")
        above = ""


# ---- Markdown ----

def words(text):
    """Words of Markdown: code is bold, emphasis italic, of links the text is left."""
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", plain(text))
    text = re.sub(r"`([^`]*)`|\*\*(.+?)\*\*", lambda m: "\\fB%s\\fR" % (m[1] or m[2]), text)
    return re.sub(r"(?<![\w*])\*([^* ][^*]*)\*", r"\\fI\1\\fR", text)


def cells(row):
    return [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", row.strip())[1:-1]]


def table(rows):
    """The tag is the first column, then come the others, those between in brackets."""
    for row in rows[2:]:
        tag, *between, last = cells(row)
        yield from (".TP", words(tag)) if tag else (".IP",)
        yield words(" ".join(["(%s)" % ", ".join(filter(None, between))] * any(between) + [last]))


def markdown(text):
    title, _, text = text.partition("\n")
    yield from (".SH NAME", "thread\\-plan \\- the file plan.json of thread(1)", ".SH DESCRIPTION")
    for block in re.split(r"\n\n+(?=(?:[^`]|`(?!``))*(?:```(?:[^`]|`(?!``))*```(?:[^`]|`(?!``))*)*$)", text.strip()):
        lines = block.split("\n")
        if block.startswith("```"):
            yield from (".PP", ".nf", *("\\&" + line.replace("\\", "\\e").replace("-", "\\-") for line in lines[1:-1]), ".fi")
        elif block.startswith("#"):
            marks, _, heading = block.partition(" ")
            yield (".SH " if len(marks) == 2 else ".SS ") + words(heading.upper() if len(marks) == 2 else heading)
        elif block.startswith("|"):
            yield from table(lines)
        elif block.startswith("- "):
            for item in re.split(r"\n(?=- )", block):
                yield from (".IP \\(bu 2", words(item[2:]))
        else:
            yield from (".PP", words(block))


# ---- all ----

def folded(lines):
    """Folds what is filled; a request, the tag behind .TP and what .nf shows stay in their lines."""
    kept, before = False, ""
    out = []
    for line in lines:
        if line in (".nf", ".fi"):
            kept = line == ".nf"
        if line.startswith((".SH", ".SS", ".PP")) and out and out[-1] == ".PP":
            out.pop()
        if not line or line == ".PP" and out[-1].startswith((".SH", ".SS")):
            continue
        if kept or line.startswith(".") or before in (".TP", ".TQ"):
            out.append(line)
        else:
            part = ""
            for word in line.split():
                if part and len(part) + len(word) > 77 or re.search(r"[a-z0-9)\]]\.$", part) and word[0].isupper():
                    out.append(part)
                    part = ""
                part = part + " " + word if part else ("\\&" if word[0] in ".'" else "") + word
            if part:
                out.append(part)
        before = line
    return out


def main():
    version, date, path = sys.argv[1:]
    with open(path, encoding="utf-8") if path != "-" else sys.stdin as file:
        text = file.read()
    kind = path[path.rfind("."):]
    if kind in TITLES:
        lines = [".TH " + TITLES[kind] % (date, version), *(header if kind == ".h" else markdown)(text)]
        lines += [".SH SEE ALSO", ".BR thread (1)"]
    else:
        lines = re.sub(r'^(\.TH \S+ 1) "" "thread[^"]*"', r'\1 "%s" "thread %s"' % (date, version), text).splitlines()
    print("\n".join(folded(lines)))


main()
