"""Swimming: the fields around the tethered body, forces over a cycle, the free swim, and its films."""

from collections.abc import Sequence
from math import isfinite
from textwrap import fill as fill_text

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator

from suchus.article.paper import CLAIMS
from suchus.article.verdict import Reading, Rule
from suchus.article.verdict.ladder import Voice
from suchus.flow import ALONG_THE_SKIN
from suchus.visual.figures.fields import (
    PRESSURE,
    VORTICITY,
    draw_body,
    draw_field,
    draw_streamlines,
    move_body,
    smooth,
    span,
)
from suchus.visual.figures.film import film
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_QUARTERS = ("T/4", "T/2", "3T/4", "T")
_FILM_DPI = 68
_FILM_SECONDS = 2.4

_MAX_SERVOS = 6
"""Servos whose loads are drawn at most [-]."""


def draw_ladder(claim_voices: Sequence[tuple[Rule, tuple[Voice, ...]]]) -> Figure:
    """Draw the result of each model for each claim: green where the statement holds, red where not, grey for none.

    Args:
        claim_voices: rules with what their rungs say.
    """
    models = [voice.rung.model for voice in claim_voices[0][1]]
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=10.5, height=6.6)
        ax = axes[0, 0]
        for row, (rule, voices) in enumerate(claim_voices):
            for column, voice in enumerate(voices):
                fill, mark = _VOICE_STYLES[voice.says]
                ax.add_patch(Rectangle((column - 0.48, row - 0.46), 0.96, 0.92, facecolor=fill, edgecolor="none"))
                number = format(Reading(voice.value), rule.form) if isfinite(voice.value) else "–"
                ends = f"{format(Reading(voice.low), rule.form)} to {format(Reading(voice.high), rule.form)}"
                ax.text(column, row - 0.16, f"{mark} {number}".strip(), ha="center", va="center", fontsize=11)
                if isfinite(voice.value) and voice.low != voice.high:
                    ax.text(column, row + 0.24, ends, ha="center", va="center", fontsize=8)
        ax.set_xlim(-0.5, len(models) - 0.5)
        ax.set_ylim(len(claim_voices) - 0.5, -0.5)
        ax.set_xticks(range(len(models)), [fill_text(model, 16) for model in models], fontsize=10)
        ax.xaxis.tick_top()
        labels = [fill_text(CLAIMS[rule.claim].quantity, 24) for rule, _ in claim_voices]
        ax.set_yticks(range(len(claim_voices)), labels, fontsize=10)
        ax.tick_params(length=0)
        for side in ax.spines.values():
            side.set_visible(False)
    return captioned(
        figure,
        "What six models of the water say of each claim. \N{CHECK MARK} on green: the statement holds; "
        "\N{MULTIPLICATION SIGN} on red: it does not; ? on yellow: in a part of the spread; grey: the model cannot "
        "carry the claim, did not settle or could not run. Below each number its spread over halves, sides and grids.",
    )


_VOICE_STYLES = {"holds": ("#cfe8d5", "\N{CHECK MARK}"), "does not hold": ("#f3d0c9", "\N{MULTIPLICATION SIGN}"),
         "undecided": ("#f6e8b8", "?"), "no word": ("#ececec", "")}  # fmt: skip


def draw_quarters(record: xr.Dataset) -> Figure:
    """Draw pressure, vorticity and streamlines around the tethered body at the four quarters of a cycle, as Fig. 17.

    Args:
        record: record of the experiment ``swimming``.
    """
    # the jump at the tail's edge exceeds all other values: end the scales where the two sides still differ
    limits = {
        "pressure": span(record.held_pressure.values, 0.985),
        "vorticity": span(record.held_vorticity.values, 0.97),
    }
    difference = record.held_difference.interp(held_phase=record.held_instant.values).values
    with styled(axes__grid=False):
        figure, axes = panels(4, 2, width=10.5, height=11.2, sharex=True, sharey=True)
        images = {}
        for i, quarter in enumerate(_QUARTERS):
            for ax, quantity, colours in zip(axes[i], ("pressure", "vorticity"), (PRESSURE, VORTICITY), strict=True):
                images[quantity] = draw_field(ax, record, "held", quantity, i, limits[quantity], colours)
                draw_body(ax, record, "held", i)
            draw_streamlines(axes[i, 1], record, "held", i)
            axes[i, 0].set_title(f"{quarter}: tail, convex − concave: {_signed(difference[i])} Pa", fontsize=12)
            axes[i, 1].set_title(f"{quarter}", fontsize=12)
            axes[i, 0].set_ylabel("y [m]")
            for ax in axes[i]:
                ax.set_xlim(-0.3, float(record.held_x[-1]))
                ax.set_ylim(-0.55, 0.55)
        for ax, quantity, unit in zip(axes[3], ("pressure", "vorticity"), ("Pa", "1/s"), strict=True):
            ax.set_xlabel("x [m], head to tail")
            figure.colorbar(
                images[quantity],
                ax=ax,
                label=f"{quantity} [{unit}]",
                location="bottom",
                shrink=0.8,
                aspect=30,
                extend="both",
            )
    return captioned(
        figure,
        "The water around the body fixed at its snout, at the four quarters of (20) as it runs from head to tail. "
        "Left: pressure, purple above and brown below that of the far water; the numbers are the mean pressure along "
        "the convex side of the tail less that along the concave side. Right: vorticity, red counter-clockwise, and "
        "streamlines.",
    )


def draw_sides(record: xr.Dataset) -> Figure:
    """Draw the pressure on the two sides of the tail at the four quarters, and where their difference sits.

    Args:
        record: record of the experiment ``swimming``.
    """
    quarter_record = record[["held_place", "held_bend"]].interp(held_phase=record.held_instant.values)
    positions, bend = quarter_record.held_place.values, quarter_record.held_bend.values
    with styled():
        figure, axes = panels(1, 4, width=10.5, height=3.1, sharey=True)
        for i, (ax, quarter) in enumerate(zip(axes[0], _QUARTERS, strict=True)):
            convex = "left" if bend[i] > 0 else "right"
            for side, colour in (("right", COLOURS["ours"]), ("left", COLOURS["limbs_only"])):
                values = record.held_sides.isel(held_instant=i).sel(held_side=side)
                label = f"{side}, convex" if side == convex else side
                ax.plot(record.held_tail, values, color=colour, label=label)
            ax.axvline(float(positions[i]), color=COLOURS["neutral"], linestyle=(0, (2, 2)), linewidth=1.2)
            ax.axhline(0.0, color="#999999", linewidth=0.8)
            ax.set_title(quarter, fontsize=12)
            ax.set_xlabel("place on the tail [-]")
            ax.set_xticks([0.0, 0.5, 1.0])
            ax.legend(fontsize=9, loc="best")
        axes[0, 0].set_ylabel("pressure [Pa]")
    return captioned(
        figure,
        "Pressure on the right and on the left of the tail of the fixed robot, from its root (0) to its tip (1); "
        "right is above in the pictures of the flow. Dotted the mean place of the difference between the two sides. "
        f"{ALONG_THE_SKIN}",
    )


def draw_forces(record: xr.Dataset) -> Figure:
    """Draw forces over the last cycle, ours and, if it swam, as printed, and what the servos carry.

    Args:
        record: record of the experiment ``swimming``.
    """
    with styled():
        figure, axes = panels(1, 2, width=10.5, height=4.4)
        ax = axes[0, 0]
        ax.axhline(0.0, color="#999999", linewidth=0.8)
        for name, label, colour in (
            ("held", "head to tail", COLOURS["ours"]),
            ("printed", "as printed, tail to head", COLOURS["limbs_only"]),
        ):
            if f"{name}_thrust" not in record:
                continue
            thrust = record[f"{name}_thrust"]
            mean = float(record[f"{name}_cycle_thrust"][1:].mean())
            ax.plot(record[f"{name}_phase"], thrust, color=colour, label=f"{label}: {mean:+.1f}")
            ax.axhline(mean, color=colour, linestyle=(0, (4, 2)), linewidth=1.2)
        ax.set_ylabel("force forward [N/m]")
        ax = axes[0, 1]
        for limit in (-1.0, 1.0):
            limit_label = "limit" if limit > 0 else None
            ax.axhline(limit, color=COLOURS["alarm"], linewidth=1.2, linestyle=(0, (4, 2)), label=limit_label)
        shares = record.held_servo_torque / record.servo_limit
        peak_loads = abs(shares).max("held_phase")
        servos = peak_loads.held_servo.values[np.sort(np.argsort(-peak_loads.values)[:_MAX_SERVOS])]
        for servo in servos:
            ax.plot(record.held_phase, shares.sel(held_servo=servo), label=str(servo).replace("_", " "))
        ax.set_ylabel("torque of the water over servo limit [-]")
        for ax in axes[0]:
            ax.set_xlabel("phase of the last cycle [cycle]")
            _add_headroom(ax)
            ax.legend(loc="upper left", ncols=2, fontsize=9.5)
            ax.set_xlim(0.0, 1.0)
    return captioned(
        figure,
        "Fixed at the snout. Left: force along the body over the last cycle per metre of depth, for the wave from head "
        f"to tail{' and as printed' * ('printed_thrust' in record)}; dashed and in numbers the means of all cycles but "
        "the first. Right: what the water asks of the servos at their shafts, every section as high as the robot "
        "there, over each servo's limit (red); a flow that cannot pass over and under the body overstates "
        f"it{_servo_note(record)}. On the right: "
        f"{ALONG_THE_SKIN[0].lower()}{ALONG_THE_SKIN[1:]}",
    )


def _servo_note(record: xr.Dataset) -> str:
    """Return a note for the caption if only some servos are drawn."""
    return f"; shown are the {_MAX_SERVOS} with the most load" if record.sizes["held_servo"] > _MAX_SERVOS else ""


def draw_free(record: xr.Dataset) -> Figure:
    """Draw the free swim: its wake, its speed over the cycles, and what trunk and tail each do.

    Args:
        record: record of the experiment ``swimming``.
    """
    with styled(axes__grid=False):
        figure, axes = panels(2, 1, width=10.5, height=8.2, height_ratios=[1.35, 1])
        ax = axes[0, 0]
        limit = span(record.free_vorticity.values[-1], 0.97)
        image = draw_field(ax, record, "free", "vorticity", -1, limit, VORTICITY)
        draw_body(ax, record, "free", -1)
        _frame_free(ax, record)
        figure.colorbar(image, ax=ax, label="vorticity [1/s]", shrink=0.85, extend="both")
        ax = axes[1, 0]
        ax.grid(True)
        colours = (COLOURS[role] for role in ("ours", "spine", "tail", "limbs_only", "ours", "limbs_only"))
        for arm, colour, marker in zip(record.arm.values, colours, "os^vDX", strict=False):
            dashes = (0, (5, 2)) if str(arm).startswith("exact") else "-"
            label = f"{arm}, from head to tail" if str(arm) == "exact wave" else str(arm)
            ax.plot(
                record.cycle, record.arm_speed.sel(arm=arm), color=colour, marker=marker, linestyle=dashes, label=label
            )
        for model, dots in zip(record.model.values, ((0, (1, 1.5)), (0, (3, 1, 1, 1))), strict=True):
            speed = float(record.model_speed.sel(model=model))
            ax.axhline(speed, color=COLOURS["neutral"], linestyle=dots, label=f"{model} model, round body")
        ax.xaxis.set_major_locator(MaxNLocator(integer=True))
        ax.set_xlabel("cycle [-]")
        ax.set_ylabel("mean speed [m/s]")
        ax.axhline(0.0, color="#999999", linewidth=0.8)
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=3, fontsize=11)
    return captioned(
        figure,
        "Free swimming from rest. Above: vorticity at the end, red counter-clockwise. Below: mean speed of each cycle, "
        "forward positive; dashed a midline that follows (20) exactly, grey the slender-body models of the round "
        "body.",
    )


def film_vorticity(record: xr.Dataset) -> bytes:
    """Return the last cycle of the free swim as a film of its vorticity.

    Args:
        record: record of the experiment ``swimming``.
    """
    return _film(record, "vorticity", "1/s", VORTICITY, 0.97, "Vorticity over the last cycle of the free swim, red "
                 "counter-clockwise; the picture travels with the body, which swims to the left.")  # fmt: skip


def film_pressure(record: xr.Dataset) -> bytes:
    """Return the last cycle of the free swim as a film of its pressure.

    Args:
        record: record of the experiment ``swimming``.
    """
    return _film(record, "pressure", "Pa", PRESSURE, 0.985, "Pressure over the last cycle of the free swim, purple "
                 "above and brown below that of the far water; the picture travels with the body.")  # fmt: skip


def _film(record: xr.Dataset, quantity: str, unit: str, colours: str, fraction: float, caption: str) -> bytes:
    """Return the last cycle of the free swim as a film of one field.

    Args:
        record: record of the experiment ``swimming``.
        quantity: ``vorticity`` or ``pressure``.
        unit: unit of the quantity.
        colours: name of the colour map.
        fraction: quantile of the absolute values at which the colour scale ends [-].
        caption: caption of the film.
    """
    values, phase = record[f"free_{quantity}"].values, record.free_frame.values
    with styled(axes__grid=False, figure__dpi=_FILM_DPI):
        figure, axes = panels(1, 1, width=9.6, height=4.3)
        ax = axes[0, 0]
        image = draw_field(ax, record, "free", quantity, 0, span(values, fraction), colours)
        body = draw_body(ax, record, "free", 0)
        _frame_free(ax, record)
        figure.colorbar(image, ax=ax, label=f"{quantity} [{unit}]", shrink=0.85, extend="both")

        def show(i: int) -> None:
            image.set_data(smooth(values[i]))
            move_body(body, record, "free", i)
            ax.set_title(f"t = {phase[i]:.2f} T", fontsize=12)

        return film(figure, show, len(values), seconds=_FILM_SECONDS, caption=caption)


def _frame_free(ax: Axes, record: xr.Dataset) -> None:
    ax.set_xlim(float(record.free_x[0]), float(record.free_x[-1]))
    ax.set_ylim(-0.55, 0.55)
    ax.set_xlabel("x [m]; it swims to the left")
    ax.set_ylabel("y [m]")


def _signed(value: float) -> str:
    return f"{value:+.0f}".replace("-", "\N{MINUS SIGN}")


def _add_headroom(ax: Axes) -> None:
    y_min, y_max = ax.get_ylim()
    ax.set_ylim(y_min, y_max + 0.35 * (y_max - y_min))
