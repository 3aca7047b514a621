import pytest
from validation_rows import OUT, ROOT, SOURCES, is_whole, tests_there_are

from validation_page import write_table


@pytest.fixture(scope="session")
def _validated(request):
    """Begin a whole validation without rows; at its end, if nothing failed, no other row stays on the page."""
    whole, done = is_whole(request.config), []
    if whole:
        for path in OUT.glob("*.json"):
            path.unlink()
    yield done
    asked = [item for item in request.session.items if "validation_table" in item.fixturenames]
    if whole and len(done) == len(asked) and not request.session.testsfailed:
        write_table(OUT, ROOT / "docs", SOURCES, whole=True)


@pytest.fixture
def validation_table(request, _validated):
    """Write the page after every case: a run that is killed, or of a part, leaves the rows that it did not renew."""
    yield
    _validated.append(request.node.nodeid)
    if any(OUT.glob("*.json")):
        write_table(OUT, ROOT / "docs", SOURCES, tests=tests_there_are())
