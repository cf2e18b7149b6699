"""Shapes of a lever, its pivoting cylinder and their bearings, mm: pins and pivots exact, widths schematic."""

import math

import numpy as np

from ...model.turning_cylinder.cylinder_and_pin_forces import LeverMachine, LeverSwing, numbers_of_machine
from ...model.turning_cylinder.lever_state import LeverNumbers
from ...model.turning_cylinder.levers_of_designs import lever_batch
from ...optimise.front.front import ParetoFront
from . import layers as on
from .linkage_shapes import pivot_bearing, round_ended_bar
from .shapes import Arc, Circle, Layer, Line, Outline, Point, Shape

Extent = tuple[float, float, float, float]
_MM = 1e3
_LEVER, _BARREL, _ROD, _PIN = 0.06, 0.075, 0.03, 0.014  # fraction of the greater of crank and frame
_HALF_RAM = 0.25  # half the length of a ram, as a fraction of the same
_NECK = 0.93  # length of the barrel as a fraction of the shortest length


def lever_shapes(machine: LeverMachine, swing: LeverSwing, angle: float) -> list[Shape]:
    """Return the fixed shapes, and the lever with its cylinder at an angle, rad."""
    return [*fixed_lever_shapes(machine, swing), *moving_lever_shapes(machine, swing, angle)]


def fixed_lever_shapes(machine: LeverMachine, swing: LeverSwing) -> list[Shape]:
    """Return bearings, path of the pin, and both ends dashed."""
    size = _longest_link_mm(machine)
    shapes: list[Shape] = []
    for pivot in (0j, _cylinder_pivot(machine)):
        shapes += pivot_bearing(_point_in_mm(pivot), 0.05 * size, is_below=True)
    last_angle = swing.start + 2.0 * math.pi if swing.of_full_turn else swing.end
    first, last = sorted(math.degrees(end + machine.sizes.pin_angle) for end in (swing.start, last_angle))
    shapes.append(Arc(on.PATHS, (0.0, 0.0), _MM * machine.sizes.crank, first, last))
    for layer, end in ((on.START, swing.start), (on.END, swing.end)):
        shapes += _link_shapes((layer,) * 3, machine, swing, end)
    return shapes


def moving_lever_shapes(machine: LeverMachine, swing: LeverSwing, angle: float) -> list[Shape]:
    """Return the lever with its cylinder at an angle, rad."""
    shapes = _link_shapes((on.ACTUATOR, on.ROD, on.CRANK), machine, swing, angle)
    pins = (0j, _cylinder_pivot(machine), machine.sizes.crank * np.exp(1j * (angle + machine.sizes.pin_angle)))
    circles = (Circle(on.PINS, _point_in_mm(pin), _PIN * _longest_link_mm(machine)) for pin in pins)
    return [*shapes, *_mass_centre_mark(machine, complex(np.exp(1j * angle))), *circles]


def lever_parts(machine: LeverMachine, swing: LeverSwing) -> dict[str, list[Shape]]:
    """Return piston rod, barrel or slotted arm, lever and pins in their own coordinates, by link name.

    The piston rod is drawn behind its pin, and barrel and arm in front of the cylinder's pivot, like the rod and slider
    of a linkage.
    """
    size, barrel = _longest_link_mm(machine), barrel_length(machine, swing)
    foot, pin = 1j * machine.sizes.offset, machine.sizes.crank * complex(np.exp(1j * machine.sizes.pin_angle))
    lengths = [float(machine.sizes.cylinder_length(end)) for end in (swing.start, swing.end)]
    longest = machine.sizes.closable_length_range[1] if swing.of_full_turn else max(lengths)
    end = max(longest, machine.ram) / _NECK if swing.of_full_turn else barrel
    circle: list[Shape] = [Circle(on.PINS, (0.0, 0.0), _PIN * size)]
    rod: Shape = (
        circle[0] if swing.of_full_turn else _strip_around_line(on.ROD, complex(barrel - longest), 0j, _ROD * size)
    )
    lug = [Line(on.ACTUATOR, (0.0, 0.0), _point_in_mm(foot))] if foot else []
    lever = round_ended_bar(on.CRANK, (0.0, 0.0), _point_in_mm(pin), _LEVER * size)
    return {
        "rod": [rod],
        "slider": [_strip_around_line(on.ACTUATOR, foot, foot + end, _BARREL * size), *lug],
        "crank": [lever, *_mass_centre_mark(machine, 1.0 + 0j)],
        **dict.fromkeys(("pivot", "crank-pin", "slider-pin"), circle),
    }


def _mass_centre_mark(machine: LeverMachine, direction: complex) -> list[Shape]:
    """Return the mark of the mass centre of a lever in a direction, a unit vector; none without mass."""
    if not machine.lever.mass:
        return []
    size, centre = _longest_link_mm(machine), centre_of_lever(machine) * direction
    ends = (centre - 0.04 * size * way / _MM for way in (1.0, -1.0, 1j, -1j))
    left, right, low, high = (_point_in_mm(end) for end in ends)
    return [Line(on.BODY, left, right), Line(on.BODY, low, high), Circle(on.BODY, _point_in_mm(centre), 0.025 * size)]


def lever_extent(machine: LeverMachine, swing: LeverSwing) -> Extent:
    """Return left, bottom, right and top of the lever and its cylinder over the swing, widths included, mm."""
    numbers = LeverNumbers._make(np.atleast_1d(number) for number in numbers_of_machine(machine, swing))
    return extent_of_levers(numbers, of_full_turn=swing.of_full_turn)


def extent_of_front(front: ParetoFront) -> Extent | None:
    """Return left, bottom, right and top of all levers of a front over their motion, mm; None for other mechanisms."""
    found, variants = [], np.array(front.variants or [0] * len(front))
    for variant in dict.fromkeys(variants.tolist()):
        part, designs = front.problem.part(variant), front.dimensions[variants == variant]
        if part.mechanism.lever is None or part.motion is None:
            return None
        numbers = lever_batch(part.mechanism, designs, part.motion, gradients=False)[0].plain
        found.append(extent_of_levers(numbers, of_full_turn=part.motion.of_full_turn))
    if not found:
        return None
    left, bottom, right, top = zip(*found, strict=True)
    return min(left), min(bottom), max(right), max(top)


def extent_of_levers(c: LeverNumbers, *, of_full_turn: bool = False) -> Extent:
    """Return left, bottom, right and top of all levers (n,) with their cylinders over their motion, mm."""
    share = np.linspace(0.0, 1.0, 91)[:, None]
    end = c.start + 2.0 * np.pi if of_full_turn else c.end
    turn = np.exp(1j * (c.start + (end - c.start) * share))
    mass = np.where(c.lever_mass > 0.0, c.lever_mass, np.inf)
    pivot, pin = c.frame * np.exp(1j * c.frame_angle), c.crank * np.exp(1j * c.pin_angle) * turn
    places = [0.0 * turn, pivot + 0.0 * turn, pin, (c.moment_along + 1j * c.moment_across) / mass * turn]
    size = np.maximum(c.crank, c.frame)
    if of_full_turn:  # the end of the slotted arm, and of the ram
        line, along = (pin - pivot) / np.abs(pin - pivot), np.exp(1j * c.frame_angle)
        ram = pivot + c.ram * along * (1j * (line / along).imag - 1.0)
        half = 1j * along * _HALF_RAM * size * (c.ram > 0.0)
        places += [pivot + np.maximum(c.crank + c.frame, c.ram) / _NECK * line, ram - half, ram + half]
    every, edge = np.stack(places), 0.12 * size
    x, y = every.real, every.imag
    low, high = (np.min(part - edge) for part in (x, y)), (np.max(part + edge) for part in (x, y))
    left, bottom, right, top = (_MM * float(end) for end in (*low, *high))
    return left, bottom, right, top


def _link_shapes(
    layers: tuple[Layer, Layer, Layer], machine: LeverMachine, swing: LeverSwing, angle: float
) -> list[Shape]:
    """Return barrel, piston rod and lever at an angle."""
    sizes, size = machine.sizes, _longest_link_mm(machine)
    motion = sizes.motion_at(np.array([angle]))
    pin, line = sizes.crank * complex(motion.radial[0]), complex(motion.line[0])
    foot = pin - float(motion.length[0]) * line
    lug = [Line(layers[0], _point_in_mm(_cylinder_pivot(machine)), _point_in_mm(foot))] if sizes.offset else []
    if swing.of_full_turn:  # a slotted arm, whose slot the pin never leaves
        end = foot + max(sizes.closable_length_range[1], machine.ram) / _NECK * line
        slotted = _strip_around_line(layers[0], foot, end, _BARREL * size)
        lever = round_ended_bar(layers[2], (0.0, 0.0), _point_in_mm(pin), _LEVER * size)
        return [slotted, *lug, lever, *_ram(layers[0], machine, line)]
    neck = foot + barrel_length(machine, swing) * line
    return [
        *lug,
        _strip_around_line(layers[1], neck, pin, _ROD * size),
        _strip_around_line(layers[0], foot, neck, _BARREL * size),
        round_ended_bar(layers[2], (0.0, 0.0), _point_in_mm(pin), _LEVER * size),
    ]


def _ram(layer: Layer, machine: LeverMachine, line: complex) -> list[Shape]:
    """Return the ram, which moves at right angles to the frame, and its pin on the line of the arm."""
    if not machine.ram:
        return []
    pivot, size = _cylinder_pivot(machine), _longest_link_mm(machine)
    along = pivot / abs(pivot)
    pin, place = pivot + machine.ram * line, pivot + machine.ram * along * (1j * (line / along).imag - 1.0)
    half = 1j * along * _HALF_RAM * size / _MM
    slot, circle = Line(layer, _point_in_mm(pin), _point_in_mm(place)), Circle(layer, _point_in_mm(pin), _PIN * size)
    return [_strip_around_line(layer, place - half, place + half, _BARREL * size), slot, circle]


def usual_angle(swing: LeverSwing) -> float:
    """Return the lever angle of a picture, rad: halfway through the swing, or the crank square to the frame."""
    return 0.5 * (swing.start + swing.end + (math.pi if swing.of_full_turn else 0.0))


def barrel_length(machine: LeverMachine, swing: LeverSwing) -> float:
    """Return the length of the drawn barrel, m."""
    if swing.of_full_turn:
        return _NECK * machine.sizes.closable_length_range[0]
    return _NECK * min(float(machine.sizes.cylinder_length(end)) for end in (swing.start, swing.end))


def _strip_around_line(layer: Layer, start: complex, end: complex, width: float) -> Outline:
    """Return a rectangle around a line between two points, m. width: mm."""
    across = 0.5j * width * (end - start) / abs(end - start) / _MM
    corners = (start - across, end - across, end + across, start + across)
    return Outline(layer, tuple(_point_in_mm(corner) for corner in corners), (0.0, 0.0, 0.0, 0.0))


def _longest_link_mm(machine: LeverMachine) -> float:
    return _MM * max(machine.sizes.crank, machine.sizes.frame)


def _cylinder_pivot(machine: LeverMachine) -> complex:
    return machine.sizes.frame * complex(math.cos(machine.sizes.frame_angle), math.sin(machine.sizes.frame_angle))


def centre_of_lever(machine: LeverMachine) -> complex:
    """Return the mass centre of a lever with mass in its own axes, m."""
    lever = machine.lever
    return complex(lever.moment_along, lever.moment_across) / lever.mass


def _point_in_mm(place: complex) -> Point:
    return _MM * place.real, _MM * place.imag
