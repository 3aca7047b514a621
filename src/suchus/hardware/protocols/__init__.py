"""The shelf of servo protocols: one file, one protocol, declared as ``protocol``."""

from collections.abc import Mapping
from functools import lru_cache
from operator import attrgetter
from types import MappingProxyType

from suchus.core.catalog import Catalog
from suchus.core.errors import BrokenFile, InvalidDesign, SuchusError, UnknownName
from suchus.hardware.bus.protocol import BusProtocol, ChannelProtocol, ServoProtocol
from suchus.hardware.bus.tables import Table
from suchus.robot.motors import motors

__all__ = [
    "PROTOCOLS",
    "bus_protocol",
    "bus_protocols",
    "channel_protocol",
    "servo_table",
    "servo_tables",
]

PROTOCOLS: Catalog[ServoProtocol] = Catalog(
    "protocol", "suchus.hardware.protocols", "suchus.hardware.bus.protocol:ServoProtocol", name_of=attrgetter("name")
)
"""The protocols of servos by name."""


def bus_protocol(name: str) -> BusProtocol:
    """Return a protocol whose servos hang on a bus and answer.

    Raises:
        UnknownName: there is no such protocol.
        BrokenFile: it is the user's, and cannot be loaded or used.
        InvalidDesign: it has no packets.
    """
    protocol = PROTOCOLS[name]
    if not isinstance(protocol, BusProtocol):
        raise InvalidDesign(
            f"no bus speaks the protocol {name!r}, which has no packets; buses speak {', '.join(bus_protocols())}."
        )
    _checked_tables(protocol)
    return protocol


def bus_protocols() -> Mapping[str, BusProtocol]:
    """Return the protocols of buses by name; those of the user's that cannot be used are left out."""
    return {
        name: protocol
        for name, protocol in PROTOCOLS.items()
        if isinstance(protocol, BusProtocol) and _is_usable(protocol)
    }


def channel_protocol(name: str) -> ChannelProtocol:
    """Return a protocol of boards that give pulses.

    Raises:
        UnknownName: there is no such protocol.
        BrokenFile: it is the user's, and cannot be loaded.
        InvalidDesign: it is no protocol of such boards.
    """
    protocol = PROTOCOLS[name]
    if not isinstance(protocol, ChannelProtocol):
        names = [name for name, protocol in PROTOCOLS.items() if isinstance(protocol, ChannelProtocol)]
        raise InvalidDesign(f"{name!r} is no protocol of boards that give pulses; there is {', '.join(names)}.")
    return protocol


def servo_tables() -> Mapping[str, Table]:
    """Return the register tables of all servos that are spoken with, by model.

    Raises:
        InvalidDesign: two protocols have a table of one model.
    """
    return _tables_of_all(tuple(bus_protocols().values()))


def servo_table(model: str) -> Table:
    """Return the register table of a model.

    Raises:
        UnknownName: no protocol has a table of it.
    """
    tables = servo_tables()
    if model not in tables:
        raise UnknownName("model", model, tables)
    return tables[model]


@lru_cache(maxsize=8)
def _tables_of_all(protocols: tuple[BusProtocol, ...]) -> Mapping[str, Table]:
    """Return the tables of several protocols by model."""
    tables_by_model: dict[str, Table] = {}
    for protocol in protocols:
        for model, table in _tables(protocol).items():
            if model in tables_by_model:
                raise InvalidDesign(
                    f"the protocols {tables_by_model[model].protocol!r} and {protocol.name!r} both have a register "
                    f"table of the model {model!r}; give one of them other families, or its table another model."
                )
            tables_by_model[model] = table
    return MappingProxyType({model: tables_by_model[model] for model in _in_order_of_motors(tables_by_model)})


def _in_order_of_motors(tables: Mapping[str, Table]) -> list[str]:
    """Return the models in the order of the motors that suchus knows, then the others."""
    shipped_models = [name for name in motors() if name in tables]
    return [*shipped_models, *(model for model in tables if model not in shipped_models)]


@lru_cache(maxsize=64)
def _tables(protocol: BusProtocol) -> Mapping[str, Table]:
    """Return the tables of a protocol's servos by model: of the motors that suchus knows, and of its own.

    Raises:
        InvalidDesign: a table lacks what a drive needs, or there is none of the default model.
    """
    motor_protocol = protocol.servo_protocol or protocol.name
    shipped_motors = [motor for motor in motors().values() if motor.protocol == motor_protocol]
    of_families = [motor for motor in (*shipped_motors, *protocol.motors) if motor.family.startswith(protocol.families)]
    tables = map(protocol.table, of_families)
    by_model = {table.model: table for table in tables}
    if protocol.default_model not in by_model:
        raise InvalidDesign(
            f"the protocol {protocol.name!r} has the default model {protocol.default_model!r}, of which it has no "
            f"register table; it has tables of {', '.join(by_model) or 'none'}."
        )
    return by_model


def _checked_tables(protocol: BusProtocol) -> Mapping[str, Table]:
    """Return the tables of a protocol.

    Raises:
        BrokenFile: the protocol is the user's, and its tables cannot be made.
    """
    try:
        return _tables(protocol)
    except Exception as error:
        source = PROTOCOLS.sources()[protocol.name]
        if source.shipped:
            raise
        text = str(error) if isinstance(error, SuchusError) else f"{type(error).__name__}: {error}."
        raise BrokenFile(f"{source.place} cannot be used: {text}") from error


def _is_usable(protocol: BusProtocol) -> bool:
    """Return whether the tables of a protocol can be made."""
    try:
        _checked_tables(protocol)
    except BrokenFile:
        return False
    return True
