"""A run on land or a swim as a film: the pictures of ``rendering``, which need no OpenGL, in one file."""

import io
from collections.abc import Iterator
from fractions import Fraction
from types import MappingProxyType
from typing import Final

import numpy as np
import xarray as xr
from jaxtyping import UInt8
from PIL import Image

from suchus.core.errors import SuchusError
from suchus.core.progress import Progress, silent
from suchus.robot.design import Robot
from suchus.robot.design.ground import Ground
from suchus.sim.record import ground_of
from suchus.visual.replay.frames import check_record, frames
from suchus.visual.replay.rendering import Renderer, Scenery
from suchus.visual.replay.scene import upward
from suchus.visual.skin import Poses

ENDINGS: Final = (".mp4", ".webm", ".webp")
"""Endings of films; the first two need the av library."""
WIDTH, HEIGHT = 960, 540
"""Width and height of a film [pixel]."""
_CODECS: Final = MappingProxyType(
    {".mp4": ("libx264", {"crf": "23"}), ".webm": ("libvpx-vp9", {"crf": "34", "b:v": "0", "deadline": "realtime"})}
)
_WEBP_STRIDE = 2  # frames from one of a WebP to the next; each is encoded alone
_WEBP_QUALITY = 60  # [%]


class NoVideo(SuchusError, ImportError):
    """The library that encodes films is not installed."""


def check_encoder(ending: str) -> None:
    """Refuse a kind of film that cannot be encoded on this machine.

    Args:
        ending: ending of the file, one of ``ENDINGS``.

    Raises:
        NoVideo: the av library is needed and not installed.
    """
    if ending not in _CODECS:
        return
    try:
        import av  # noqa: F401, PLC0415  an optional extra
    except ImportError as error:
        raise NoVideo(
            f"a film that ends in {ending} needs av; install it with: pip install 'suchus[capture]'; or end its "
            "name in .webp, which needs nothing more and plays in every browser."
        ) from error


def video(
    record: xr.Dataset, robot: Robot, *, ending: str = ".mp4", title: str = "", progress: Progress = silent
) -> bytes:
    """Return a run as a film at its own speed: the camera follows the robot, as in the environments.

    Args:
        record: record of one run on land, or of a swim on land's loop.
        robot: robot of the record.
        ending: ending of the file, one of ``ENDINGS``.
        title: text above, before the time.
        progress: called with the share that is done, 0 to 1.

    Raises:
        IncompatibleRecord: the record is no run on land, several runs, of another robot, or without a frame.
        NoVideo: the library that encodes such a film is not installed.
    """
    check_encoder(ending)
    run = frames(check_record(record, robot), robot)
    ground = ground_of(record) or Ground()
    stride = 1 if ending in _CODECS else _WEBP_STRIDE
    renderer = Renderer(robot, width=WIDTH, height=HEIGHT)

    def pictures() -> Iterator[UInt8[np.ndarray, "height width 3"]]:
        for i in range(0, len(run.mass), stride):
            progress("drawing", i / len(run.mass))
            scenery = Scenery(
                upward=upward(ground),
                level=None if run.level is None else float(run.level[i]),
                relief=ground.relief,
                text=f"{title}  {run.start + i / run.rate:.2f} s".strip(),
            )
            bones = Poses(run.bones.positions[i], run.bones.quaternions[i])
            yield renderer.render(bones, run.feet[i], run.mass[i], scenery)

    rate = Fraction(run.rate / stride).limit_denominator(1000)
    return _encoded(pictures(), rate, ending) if ending in _CODECS else _webp(pictures(), rate)


def _encoded(pictures: Iterator[np.ndarray], rate: Fraction, ending: str) -> bytes:
    """Return pictures as a video, by the av library.

    Args:
        pictures: red, green and blue, (height, width, 3) each.
        rate: pictures in a second [1/s].
        ending: ending of the file, which says the kind of video.
    """
    import av  # noqa: PLC0415  an optional extra

    codec, options = _CODECS[ending]
    file = io.BytesIO()
    with av.open(file, "w", format=ending.removeprefix(".")) as container:
        stream = container.add_stream(codec, rate=rate, options=dict(options))
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
        for picture in pictures:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(stream.encode())
    return file.getvalue()


def _webp(pictures: Iterator[np.ndarray], rate: Fraction) -> bytes:
    """Return pictures as an animated WebP that plays over and over; see ``_encoded``."""
    images = (Image.fromarray(picture) for picture in pictures)
    file = io.BytesIO()
    next(images).save(
        file,
        format="WEBP",
        save_all=True,
        append_images=images,
        duration=round(1000 / rate),
        loop=0,
        quality=_WEBP_QUALITY,
        method=2,
    )
    return file.getvalue()
