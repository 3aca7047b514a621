"""In the browser: a robot that walks live, and records played back. Only what ``viewer.pages`` imports needs viser."""

from suchus.apps.viewer.session import Instant, Session, Settings

__all__ = ["Instant", "Session", "Settings"]
