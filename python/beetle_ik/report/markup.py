"""The marks that text of a report may contain, as HTML."""

import html
import re

_CODE = re.compile(r"`([^`]+)`")
_STRONG = re.compile(r"\*\*([^*]+)\*\*")
_EMPHASIS = re.compile(r"\*([^*\s](?:[^*]*[^*\s])?)\*")
_LINK = re.compile(r"\[([^\]]+)\]\((https?://[^)\s]+)\)")


def paragraphs(text: str) -> str:
    """Returns paragraphs and lists; see `Section` for the marks."""
    return "\n".join(_paragraph(part) for part in re.split(r"\n\s*\n", text.strip()) if part.strip())


def inline(text: str) -> str:
    """Returns one run of text: `code`, *emphasis*, **strong**, [words](address)."""
    pieces = _CODE.split(html.escape(text, quote=False))  # every second piece is code, without marks
    return "".join(f"<code>{piece}</code>" if i % 2 else _marked(piece) for i, piece in enumerate(pieces))


def slug(title: str) -> str:
    """Returns the address of a section with this title."""
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")


def _marked(text: str) -> str:
    text = _LINK.sub(r'<a href="\2">\1</a>', text)
    return _EMPHASIS.sub(r"<em>\1</em>", _STRONG.sub(r"<strong>\1</strong>", text))


def _paragraph(text: str) -> str:
    lines = [line.strip() for line in text.strip().splitlines()]
    if not lines[0].startswith("- "):
        return f"<p>{inline(' '.join(lines))}</p>"
    items: list[str] = []
    for line in lines:
        if line.startswith("- "):
            items.append(line[2:])
        else:
            items[-1] += f" {line}"
    return "<ul>" + "".join(f"<li>{inline(item)}</li>" for item in items) + "</ul>"
