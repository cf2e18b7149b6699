"""The page's typeface: Inter, from its package, with the characters that the page needs."""

import io
from functools import cache
from importlib.resources import files
from threading import Lock

_LETTERS = (range(0x20, 0x7F), range(0xA0, 0x100), range(0x391, 0x3CA))  # Latin and Greek
_SIGNS = (range(0x2010, 0x2027), range(0x2070, 0x2090), range(0x2190, 0x219A), range(0x2200, 0x2266))
_FEATURES = ("kern", "tnum")  # kerning, tabular figures
_LICENCE = (13, 14)  # licence text and address among the font's names, which subsetting drops by default
_ONE = Lock()


def typeface() -> bytes:
    """Return Inter in weights from 100 to 900 as WOFF, a tenth of the original size.

    It is created once, in a second. Inter is by the Inter Project Authors, under the SIL Open Font License 1.1; the
    licence text is in its package, and the font refers to it. WOFF2 would be a third smaller, but takes three times as
    long to create and needs another package.
    """
    with _ONE:
        return _subset_font()


@cache
def _subset_font() -> bytes:
    from fontTools.subset import Options, Subsetter, load_font

    options = Options(layout_features=[*_FEATURES])
    options.name_IDs = [*options.name_IDs, *_LICENCE]
    font_file = files("fontpkg_inter").joinpath("files", "Inter[opsz,wght].ttf").read_bytes()
    font = load_font(io.BytesIO(font_file), options)
    subsetter = Subsetter(options)
    subsetter.populate(unicodes=[code for part in (*_LETTERS, *_SIGNS) for code in part])
    subsetter.subset(font)
    font.flavor = "woff"
    file = io.BytesIO()
    font.save(file)
    return file.getvalue()
