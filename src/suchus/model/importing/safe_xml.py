"""XML from outside: parsed without entities, within a size and a depth, or refused in one sentence."""

from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

from suchus.errors import UnreadableFile
from suchus.record import read_text

LARGEST = 16 * 2**20
"""Size of a file of a robot [byte]."""
_DEEPEST, _MOST = 200, 200_000  # levels of nesting; elements


def parse(path: Path) -> ElementTree.Element:
    """Return the root element of an XML file; nothing that it names is opened, no entity is expanded.

    Raises:
        UnreadableFile: it is no ordinary file, too large, no XML, declares a document type, or nests too deeply.
    """
    text = read_text(path, LARGEST)
    builder, parser = ElementTree.TreeBuilder(), expat.ParserCreate("utf-8")
    depth = count = 0

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > _DEEPEST:
            raise UnreadableFile(f"{path} nests more than {_DEEPEST} elements; no robot needs so many.")
        if count > _MOST:
            raise UnreadableFile(f"{path} holds more than {_MOST} elements; no robot needs so many.")
        if ":" in tag:
            raise UnreadableFile(
                f"{path} holds <{tag[:40]}>, an element of a macro language; expand it first, as with "
                "`xacro robot.urdf.xacro > robot.urdf`."
            )
        builder.start(tag, attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag)

    def doctype(*_: object) -> None:
        raise UnreadableFile(f"{path} declares a document type, in which entities could hide; remove <!DOCTYPE ...>.")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.StartDoctypeDeclHandler = doctype
    try:
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        raise UnreadableFile(f"{path} is no XML: {error}.") from error
    return builder.close()
