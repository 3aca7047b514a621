"""Formulas become MathML at build: no script and no font from elsewhere; GitHub shows the same sources as they are.

A fence ``math`` is a displayed formula, a dollar sign outside a pair of backticks an inline one.
"""

import re
from html import escape

from latex2mathml.converter import convert

_DISPLAY = re.compile(r"^```math\n(.*?)^```$", re.S | re.M)
_INLINE = re.compile(r"\$`([^`]+)`\$")
_MARK = "FORMULA{:04d}MARK"


class Formulas:
    """The formulas of one page, kept aside while Markdown works on the rest."""

    def __init__(self) -> None:
        self._made: list[str] = []

    def take(self, markdown: str) -> str:
        """Return the page with a mark in place of each formula."""
        shown = _DISPLAY.sub(lambda found: f"\n{self._keep(found[1], 'block')}\n", markdown)
        return _INLINE.sub(lambda found: self._keep(found[1], "inline"), shown)

    def put(self, html: str) -> str:
        """Return the rendered page with MathML in place of each mark."""
        for index, made in enumerate(self._made):
            mark = _MARK.format(index)
            html = html.replace(f"<p>{mark}</p>", made).replace(mark, made)
        return html

    def _keep(self, latex: str, display: str) -> str:
        self._made.append(mathml(latex.strip(), display))
        return _MARK.format(len(self._made) - 1)


def mathml(latex: str, display: str) -> str:
    """Return a formula as MathML; its source is what is read out where MathML is not known."""
    source = latex.replace("{aligned}", "{align*}")
    made = convert(source, display=display)
    markup = made.replace("<math ", f'<math alttext="{escape(" ".join(latex.split()), quote=True)}" ', 1)
    if display == "inline":
        return markup
    return f'<div class="formula" role="region" aria-label="Formula" tabindex="0">{markup}</div>'
