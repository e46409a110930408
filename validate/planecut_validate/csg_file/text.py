"""Text of a `.csg` file to nodes, without recursion: files nest ten thousand groups deep."""

import re
from dataclasses import dataclass, field

_TOKEN = re.compile(
    r"""(?P<skip>[ \t\r]+|//[^\n]*)|(?P<line>\n)|(?P<comment>/\*.*?\*/)
      |(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)
      |(?P<name>[-+]?\$?[A-Za-z_]\w*)
      |(?P<string>"(?:[^"\\]|\\.)*")
      |(?P<mark>[()\[\]{},;=%\#*!:])""",
    re.VERBOSE | re.DOTALL,
)
_ESCAPE = re.compile(r"\\(?:x([0-7][0-9a-fA-F])|u([0-9a-fA-F]{4})|U([0-9a-fA-F]{6})|(.))", re.DOTALL)
_SHORT = {"n": "\n", "t": "\t", "r": "\r"}
_WORDS = {"true": True, "false": False, "undef": None}
# OpenSCAD writes these, and reads them as names that mean nothing.
_WORDS |= {sign + word: None for sign in ("", "-", "+") for word in ("inf", "nan")}
MODIFIERS = "%#*!"


@dataclass
class Node:
    """A module with its arguments: `named` by name, `given` by place. `line` counts from 1."""

    name: str
    line: int
    modifiers: str = ""
    named: dict = field(default_factory=dict)
    given: list = field(default_factory=list)
    children: list["Node"] = field(default_factory=list)

    def get(self, name: str, place: int | None = None):
        """The argument of that name, or the one at that place among those without a name."""
        if name in self.named:
            return self.named[name]
        return self.given[place] if place is not None and place < len(self.given) else None


class ScadError(ValueError):
    """What cannot be read or evaluated, with its line."""

    def __init__(self, line: int, message: str):
        super().__init__(f"line {line}: {message}")


def parse(text: str) -> list[Node]:
    """The nodes at the top of the file, disabled ones (`*`) left out. Raises `ScadError`."""
    tokens = _Tokens(text)
    top: list[Node] = []
    open_lists, open_lines = [top], []
    while True:
        kind, value = tokens.next()
        if kind is None:
            break
        if value == "}" and kind == "mark":
            if not open_lines:
                raise ScadError(tokens.line, "a } without {")
            open_lists.pop()
            open_lines.pop()
        elif value != ";" or kind != "mark":
            node, has_block = _node(tokens, kind, value)
            # A disabled subtree is read all the same, and goes nowhere.
            if "*" not in node.modifiers:
                open_lists[-1].append(node)
            if has_block:
                open_lists.append(node.children)
                open_lines.append(node.line)
    if open_lines:
        raise ScadError(open_lines[-1], "a { that is not closed")
    return top


def _node(tokens: "_Tokens", kind: str, value) -> tuple[Node, bool]:
    """A node up to its `;` or `{`, and whether a block follows."""
    modifiers = ""
    while kind == "mark" and value in MODIFIERS:
        modifiers += value
        kind, value = tokens.next()
    if kind != "name":
        raise ScadError(tokens.line, f"expected a module, found {value!r}")
    node = Node(value, tokens.line, modifiers)
    tokens.expect("(")
    _arguments(tokens, node)
    kind, end = tokens.next()
    if kind != "mark" or end not in "{;":
        raise ScadError(tokens.line, f"expected ; or {{ after {node.name}()")
    return node, end == "{"


def _arguments(tokens: "_Tokens", node: Node) -> None:
    kind, value = tokens.next()
    while not (kind == "mark" and value == ")"):
        if kind == "name" and tokens.peek_mark() == "=":
            name = value
            tokens.next()
            node.named[name] = _value(tokens, *tokens.next())
        else:
            node.given.append(_value(tokens, kind, value))
        kind, value = tokens.next()
        if kind != "mark" or value not in ",)":
            raise ScadError(tokens.line, f"expected , or ) in {node.name}()")
        if value == ",":
            kind, value = tokens.next()


def _value(tokens: "_Tokens", kind: str | None, value):
    """A number, a string, a word, or nested lists of them."""
    if kind != "mark" or value != "[":
        return _plain(tokens, kind, value)
    root: list = []
    stack = [root]
    while stack:
        kind, value = tokens.next()
        if kind == "mark" and value == "[":
            stack[-1].append([])
            stack.append(stack[-1][-1])
        elif kind == "mark" and value == "]":
            stack.pop()
        elif kind != "mark" or value not in ",:":
            stack[-1].append(_plain(tokens, kind, value))
    return root


def _plain(tokens: "_Tokens", kind: str | None, value):
    if kind == "number":
        return float(value)
    if kind == "string":
        return _ESCAPE.sub(_unescaped, value[1:-1])
    if kind == "name" and value in _WORDS:
        return _WORDS[value]
    raise ScadError(tokens.line, f"expected a value, found {value!r}")


def _unescaped(match: re.Match) -> str:
    code = match[1] or match[2] or match[3]
    return chr(int(code, 16)) if code else _SHORT.get(match[4], match[4])


class _Tokens:
    """Tokens one after the other; `line` is that of the last one."""

    def __init__(self, text: str):
        self._text, self._at, self.line = text, 0, 1

    def next(self) -> tuple[str | None, str | None]:
        while self._at < len(self._text):
            match = _TOKEN.match(self._text, self._at)
            if match is None:
                raise ScadError(self.line, f"unexpected {self._text[self._at]!r}")
            self._at = match.end()
            if match.lastgroup == "line":
                self.line += 1
            elif match.lastgroup == "comment":
                self.line += match[0].count("\n")
            elif match.lastgroup != "skip":
                return match.lastgroup, match[0]
        return None, None

    def peek_mark(self) -> str | None:
        """The next token where it is a mark."""
        at, line = self._at, self.line
        kind, value = self.next()
        self._at, self.line = at, line
        return value if kind == "mark" else None

    def expect(self, mark: str) -> None:
        kind, value = self.next()
        if kind != "mark" or value != mark:
            raise ScadError(
                self.line, f"expected {mark}, found {value!r}" if kind else f"expected {mark} before the end"
            )
