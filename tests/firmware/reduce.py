"""A header reduced to bare declarations: no function has a body, and of a structure's members only the constants
stay that say what it is."""

import re


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


def statements(text):
    """The statements of a namespace, each (head, body): the text before its braces and in them, or None."""
    start = position = depth = 0
    opened = None
    while position < len(text):
        c = text[position]
        if c in "({[":
            if c == "{" and depth == 0 and opened is None:
                opened = position
            depth += 1
        elif c in ")}]":
            depth -= 1
        ended = depth == 0 and (c == ";" or (c == "}" and not re.match(r"\s*;", text[position + 1:])))
        position += 1
        if ended:
            if opened is None:
                yield text[start:position - 1].strip(), None
            else:
                end = text.rindex("}", start, position)
                yield text[start:opened].strip(), text[opened + 1:end]
            start, opened = position, None
    assert not text[start:].strip(), text[start:]


def bare(head, body):
    """A statement's declaration, or "" where it only adds to one that stands without it."""
    if body is None:
        return head + ";"
    namespace = re.fullmatch(r"namespace(\s+\w+)?", head)
    if namespace:
        return f"{head} {{\n{''.join(bare(*s) + chr(10) for s in statements(body))}}}"
    after_template = re.sub(r"^(template\s*<[^;{]*?>\s*(requires\s*(\([^)]*\)|[\w:]+)\s*)?)*", "", head)
    if re.match(r"(struct|class|enum)\b", after_template):
        told = "".join(f"{s};" for s, _ in statements(body) if re.match(r"static constexpr (bool|TextureText)\b", s))
        return f"{head}{{{told}}};" if told else f"{head};"
    if ")" in after_template:
        return head + ";"
    return f"{head}{{{body}}};"  # a constant


def reduce(text):
    text = without_comments(text)
    directive = re.compile(r"^#(?:.*\\\n)*.*$", re.M)
    directives = "".join(lines + "\n" for lines in directive.findall(text))
    code = directive.sub("", text).replace("QRAY_NOINLINE ", "")  # which no declaration has
    return directives + "\n" + "".join(bare(*s) + "\n" for s in statements(code))
