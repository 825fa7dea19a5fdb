"""Animated GIFs from matplotlib figures, without pyplot."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import PIL.Image
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

COLOURS = 64
"""Number of colours of a frame."""

DPI = 80.0


def gif(
    figure: Figure,
    update: Callable[[int], None],
    frames: int,
    *,
    moving: Sequence[Artist] = (),
    fps: float = 20.0,
) -> bytes:
    """Return an endless GIF of ``frames`` pictures.

    ``update(i)`` changes the artists of ``figure`` for frame i. If it changes only the artists ``moving``, the others
    are drawn once, below them.
    """
    import PIL.Image
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas: Any = FigureCanvasAgg(figure)
    figure.set_dpi(DPI)
    update(0)
    canvas.draw()
    figure.set_layout_engine("none")
    for artist in moving:
        artist.set_animated(True)
    canvas.draw()
    background = canvas.copy_from_bbox(figure.bbox)
    pictures: list[PIL.Image.Image] = []
    for i in range(frames):
        update(i)
        if moving:
            canvas.restore_region(background)
        else:
            canvas.draw()
        for artist in moving:
            artist.draw(canvas.get_renderer())
        pixels = bytes(canvas.buffer_rgba())
        pictures.append(PIL.Image.frombytes("RGBA", canvas.get_width_height(), pixels).convert("RGB"))
    palette = _palette(pictures)  # one for all frames, to avoid flicker
    frames_out = [picture.quantize(palette=palette, dither=PIL.Image.Dither.NONE) for picture in pictures]
    _keep_background(frames_out, pictures[0])
    stream = io.BytesIO()
    frames_out[0].save(
        stream,
        format="GIF",
        save_all=True,
        append_images=frames_out[1:],
        duration=round(1000.0 / fps),
        loop=0,
        optimize=True,
    )
    return stream.getvalue()


def still(content: bytes) -> bytes:
    """Return the first frame of an animation as PNG."""
    import PIL.Image

    stream = io.BytesIO()
    with PIL.Image.open(io.BytesIO(content)) as picture:
        picture.save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def _palette(pictures: list[PIL.Image.Image]) -> PIL.Image.Image:
    import PIL.Image

    some = pictures[:: max(len(pictures) // 4, 1)]
    width, height = some[0].size
    strip = PIL.Image.new("RGB", (width, height * len(some)))
    for i, picture in enumerate(some):
        strip.paste(picture, (0, i * height))
    return strip.quantize(COLOURS)


def _keep_background(frames: list[PIL.Image.Image], original: PIL.Image.Image) -> None:
    """Restore the exact colour of the corner, because quantising would turn white into grey."""
    index = frames[0].getpixel((0, 0))
    exact = original.getpixel((0, 0))
    for frame in frames:
        palette = frame.getpalette()
        if palette is not None and isinstance(index, int) and isinstance(exact, tuple):
            palette[3 * index : 3 * index + 3] = [int(value) for value in exact]
            frame.putpalette(palette)
