"""What geometry cannot say, and the user may."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Words:
    """Answers to what geometry cannot say; None: guess, and show the guess."""

    front: str | None = None
    """A body at the front end."""
    heading: float | None = None
    """Direction of the front, from the file's x axis to the left [degree]."""
    neck: str | None = None
    """The body in which the axis ends in front, where it forks."""
    tail: str | None = None
    """The body in which the axis ends behind, where it forks."""
    leave: tuple[str, ...] = ()
    """Bodies to leave out with all that hangs on them, such as arms."""
    foot_radius: float | None = None
    """Radius of every foot [m]."""
