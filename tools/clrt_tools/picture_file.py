# SPDX-License-Identifier: Apache-2.0
"""Reads pictures with what is known about their noise: linear float files (EXR, PFM, HDR, TIFF), clrt's film files, and files
made to be looked at (PNG, JPEG), of which nothing is known."""
import dataclasses
from typing import Optional

import numpy

from clrt_tools import film_file

# clrt's default; taken where a file does not say how many replicates its variance comes from.
DEFAULT_REPLICATES = 4


class UnreadableFile(Exception):
    """A file that is no picture these tools can use; the message says what was expected and what was found."""


@dataclasses.dataclass(frozen=True)
class Window:
    """Where the pixels lie: the data window within the whole picture."""
    x: int
    y: int
    width: int
    height: int
    full_width: int
    full_height: int

    def __str__(self):
        text = f"{self.width}x{self.height}"
        if (self.width, self.height) == (self.full_width, self.full_height) and self.x == self.y == 0:
            return text
        return f"{text} from {self.x},{self.y} of {self.full_width}x{self.full_height}"


@dataclasses.dataclass
class Picture:
    """Linear RGB radiance, rows from the top."""
    path: str
    window: Window
    mean: numpy.ndarray                          # (height, width, 3), double
    variance: Optional[numpy.ndarray] = None     # of the mean of each pixel and channel
    degrees: float = 0                           # of freedom of each pixel's variance
    replicates: Optional[numpy.ndarray] = None   # (count, height, width, 3): independent pictures, their mean is the picture
    samples: Optional[int] = None                # a pixel
    seed: Optional[str] = None
    noise: str = "not known"                     # where the variance comes from, in words
    encoding: Optional[str] = None               # of a file of whole numbers, in words; None: linear radiance


def read_picture(path):
    """Reads a picture or a film file. Raises UnreadableFile."""
    try:
        if film_file.is_film(path):
            return _picture_of_film(path)
        return _read_image(path)
    except film_file.FilmError as error:
        raise UnreadableFile(f"{path}: {error}") from error
    except OSError as error:
        raise UnreadableFile(f"{path}: expected a picture, found none that can be read ({error.strerror})") from error


def _picture_of_film(path):
    film = film_file.read_film(path)
    means, count = film.means, len(film.means)
    x0, y0, x1, y1 = film.window
    picture = Picture(path, Window(x0, y0, x1 - x0, y1 - y0, *film.size), means.mean(axis=0),
                      samples=film.samples, seed=film.seed)
    if count < 2:
        picture.noise = "not known (one replicate)"
        return picture
    picture.replicates = means
    picture.variance = means.var(axis=0, ddof=1) / count
    picture.degrees = count - 1
    picture.noise = f"spread of {count} replicates"
    return picture


def _read_image(path):
    import OpenImageIO
    with open(path, "rb"):
        pass  # the system's own words where there is nothing to read
    settings = OpenImageIO.ImageSpec()
    settings.attribute("oiio:UnassociatedAlpha", 1)
    image = OpenImageIO.ImageInput.open(path, settings)
    if image is None:
        raise UnreadableFile(f"{path}: expected a picture or a film file, found: {OpenImageIO.geterror().strip()}")
    try:
        spec = image.spec()
        bits = {OpenImageIO.UINT8: 8, OpenImageIO.UINT16: 16}.get(spec.format.basetype)
        if not bits and spec.format.basetype not in (OpenImageIO.HALF, OpenImageIO.FLOAT, OpenImageIO.DOUBLE):
            raise UnreadableFile(f"{path}: expected floating point, 8 or 16 bits a channel, found {spec.format} channels")
        values = image.read_image(OpenImageIO.FLOAT)
        if values is None:
            raise UnreadableFile(f"{path}: damaged or truncated: {image.geterror().strip()}")
    finally:
        image.close()
    values = values.reshape(spec.height, spec.width, spec.nchannels)
    return _picture_of_display(path, spec, values, bits) if bits else _picture_of_channels(path, spec, values)


def _window(spec):
    return Window(spec.x, spec.y, spec.width, spec.height, spec.full_width, spec.full_height)


def _picture_of_display(path, spec, values, bits):
    """A file made to be looked at: its values decoded as sRGB (IEC 61966-2-1), over black where it has alpha."""
    colours = 3 if spec.nchannels >= 3 else 1
    encoded = values[..., :colours].astype(float)
    linear = numpy.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    if spec.nchannels in (2, 4):
        linear *= values[..., -1:]
    return Picture(path, _window(spec), numpy.repeat(linear, 3 // colours, axis=-1), encoding=f"{bits}-bit, decoded as sRGB")


def _picture_of_channels(path, spec, values):
    names = list(spec.channelnames)

    def layer(channels):
        return values[..., [names.index(c) for c in channels]].astype(float) if set(channels) <= set(names) else None

    mean = layer("RGB")
    if mean is None:
        raise UnreadableFile(f"{path}: expected channels R, G and B, found {', '.join(names) or 'none'}")
    picture = Picture(path, _window(spec), mean, seed=spec.get_string_attribute("clrt.seed") or None)
    samples = layer(["samples"])
    if samples is not None:
        picture.samples = int(numpy.median(samples))
    picture.variance = layer(["variance.R", "variance.G", "variance.B"])
    if picture.variance is not None:
        _name_noise(picture, spec.get_string_attribute("clrt.replicates"))
    return picture


def _name_noise(picture, replicates):
    """The variance layer's degrees of freedom."""
    count = int(replicates) if replicates.isdigit() else DEFAULT_REPLICATES
    if picture.samples:
        count = min(count, picture.samples)
    picture.degrees = max(count - 1, 1)
    said = "" if replicates else ", assumed"
    picture.noise = f"variance layer ({count} replicates{said}), pixels taken as independent"


def join_halves(first, second):
    """Two independent halves of one reference: their mean, and half their difference squared as its variance."""
    picture = Picture(f"{first.path} + {second.path}", first.window, 0.5 * (first.mean + second.mean))
    picture.variance = 0.25 * (first.mean - second.mean) ** 2
    picture.degrees = 1
    picture.noise = "difference of two halves, pixels taken as independent"
    if first.samples and second.samples:
        picture.samples = first.samples + second.samples
    return picture
