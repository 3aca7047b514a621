"""Faults of an emulated bus and of its servos; faults of the body are those of the simulation (``Fault``)."""

from dataclasses import dataclass

from suchus.core.checks import Checks


@dataclass(frozen=True, slots=True, kw_only=True)
class Trouble:
    """Trouble of the wire and of single servos, drawn with a seed; none by default."""

    latency: float = 0.0
    """How long each request and each reply is on its way [s]: goals act so much later, readings are so much older."""
    noise: float = 0.0
    """Standard deviation of the angles that servos tell [rad]."""
    resolution: float = 0.0
    """Step in which servos take and tell angles, where it is coarser than that of their registers [rad]."""
    lost: float = 0.0
    """Share of the packets that are lost, requests and replies alike [-]."""
    corrupt: float = 0.0
    """Share of the replies in which a bit is flipped [-]."""
    dropped: float = 0.0
    """Share of the replies that lack a byte [-]."""
    mute: tuple[int, ...] = ()
    """Numbers of servos that do not answer [-]."""
    twin: tuple[int, ...] = ()
    """Numbers that two servos have, so that their replies collide [-]."""
    hot: tuple[int, ...] = ()
    """Numbers of servos whose temperature rises by ``heating`` [-]."""
    heating: float = 2.0
    """How fast hot servos warm up, beside what their own load does [K/s]."""
    wet: tuple[int, ...] = ()
    """Numbers of servos in a module that takes in water: an alert at first, then silence and no torque [-]."""
    sag: float = 0.0
    """Voltage that the battery loses in a second [V/s]."""
    at: float = 0.0
    """When servos become mute, hot, wet or broken and the battery begins to sag [s]."""
    seed: int = 0
    """Seed of what is random [-]."""

    def __post_init__(self) -> None:
        """Refuse rates, delays and fractions out of range."""
        with Checks("trouble", self) as check:
            check.number("latency", 0.0, 1.0, "s")
            check.number("noise", 0.0, 1.0, "rad")
            check.number("resolution", 0.0, 1.0, "rad")
            for share in ("lost", "corrupt", "dropped"):
                check.number(share, 0.0, 1.0, "")
            check.number("heating", 0.0, 100.0, "K/s")
            check.number("sag", 0.0, 100.0, "V/s")
            check.number("at", 0.0, 86400.0, "s")
            check.whole("seed", 0, 2**32 - 1)
