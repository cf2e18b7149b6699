"""Layers of a linkage drawing. CAD users switch layers on and off, so the names must never change."""

from .shapes import Layer

INK, MUTED, BLUE = "#1a1a1a", "#7a7a7a", "#0072b2"
_BLACK, _GREY, _BLUE = 7, 8, 5  # AutoCAD colour index; 7 is black on white and white on black

FRAME = Layer("FRAME", "bearing of the crank and guide of the slider", "continuous", MUTED, _GREY, 0.25)
CRANK = Layer("CRANK", "outline of the crank", "continuous", INK, _BLACK, 0.5)
ROD = Layer("ROD", "outline of the connecting rod", "continuous", INK, _BLACK, 0.5)
SLIDER = Layer("SLIDER", "outline of the slider", "continuous", INK, _BLACK, 0.5)
PINS = Layer("PINS", "circles about crank pivot, crank pin and slider pin", "continuous", INK, _BLACK, 0.35)
SKELETON = Layer("SKELETON", "crank and rod as lines from pivot to pivot", "centre", INK, _BLACK, 0.18)
PATHS = Layer("PATHS", "paths of the crank pin and the slider pin", "phantom", MUTED, _GREY, 0.18)
AXES = Layer("AXES", "slider line, and its parallel through the crank pivot", "centre", MUTED, _GREY, 0.18)
INNER = Layer("DEAD_CENTRE_INNER", "linkage at the inner dead centre", "dashed", MUTED, _GREY, 0.18)
OUTER = Layer("DEAD_CENTRE_OUTER", "linkage at the outer dead centre", "dashed", MUTED, _GREY, 0.18)
CYLINDER = Layer(
    "CYLINDER", "bore and head of the cylinder whose piston is the slider", "continuous", INK, _BLACK, 0.35
)
START = Layer("SWING_START", "linkage at the start of the swing", "dashed", MUTED, _GREY, 0.18)
END = Layer("SWING_END", "linkage at the end of the swing", "dashed", MUTED, _GREY, 0.18)
ACTUATOR = Layer("ACTUATOR", "cylinder that drives the slider, schematic", "continuous", INK, _BLACK, 0.35)
BODY = Layer("BODY", "body with its mass centre, on the crank", "continuous", INK, _BLACK, 0.25)
DIMENSIONS = Layer("DIMENSIONS", "crank, rod, offset and stroke", "continuous", BLUE, _BLUE, 0.18)
NOTES = Layer("NOTES", "title and notes", "continuous", INK, _BLACK, 0.25)

LAYERS = (AXES, PATHS, INNER, OUTER, FRAME, SLIDER, ROD, CRANK, PINS, SKELETON, DIMENSIONS, NOTES)
"""Layers of a linkage that rotates fully, in drawing order."""
GAS_LAYERS = (AXES, PATHS, INNER, OUTER, FRAME, CYLINDER, SLIDER, ROD, CRANK, PINS, SKELETON, DIMENSIONS, NOTES)
"""Layers of a linkage whose slider is a piston."""
SWING_LAYERS = (AXES, PATHS, START, END, FRAME, ACTUATOR, SLIDER, ROD, CRANK, BODY, PINS, SKELETON, DIMENSIONS, NOTES)
"""Layers of a swinging linkage; `ACTUATOR` is used if the slider drives, `BODY` if the crank has a mass."""
