"""What single pages state and no experiment measures stands on a page."""

from evidence import page_measures
from pages.stated import made, sources


def test_every_source_is_stated_on_a_page():
    assert set(page_measures.SOURCES) <= {source for name in made() for source in sources(name)}
