"""Crank-speed law that a servo should follow, for given lengths."""

from ....objectives.kinds import ANGULAR_ACCELERATION, ANGULAR_SPEED, LENGTH, SPEED, TIME, TORQUE
from ....optimise.motion_law.input_words import RANGE, LawObjective, Timing
from ..design_question import DesignQuestion, Premise, QuestionCommand
from ..inputs import Input

QUESTION = DesignQuestion(
    __name__,
    4,
    shows="crank-speed law for a servo: least peak torque, least RMS torque or shortest cycle, with proof",
    inputs=(
        Input(
            "objective",
            title="To be least",
            help='What the law minimises: "peak torque", "rms torque", or "cycle time" at a torque limit.',
            usual="peak torque",
            words=LawObjective,
            loose=True,
        ),
        Input(
            "cycle_time",
            TIME,
            "Cycle time",
            "Time of a turn. [default: from the job's speed]",
            sign="positive",
            example="25 ms",
        ),
        Input(
            "timing",
            title="Cycle time is",
            help='Whether the cycle time must be "equal", or may be shorter, "at most".',
            usual="equal",
            words=Timing,
            loose=True,
        ),
        Input(
            "torque_limit",
            TORQUE,
            "Torque, at most",
            "Greatest torque of the drive at the crank.",
            sign="positive",
        ),
        Input(
            "least_speed",
            ANGULAR_SPEED,
            "Crank speed, at least",
            f"Least crank speed. [default: mean speed / {RANGE:g}]",
            sign="positive",
        ),
        Input(
            "greatest_speed",
            ANGULAR_SPEED,
            "Crank speed, at most",
            f"Greatest crank speed, at most that of the motor in [drive]. [default: {RANGE:g} x mean speed]",
            sign="positive",
        ),
        Input(
            "slider_speed",
            SPEED,
            "Slider speed, at most",
            "Greatest speed of the slider.",
            sign="positive",
        ),
        Input(
            "window",
            LENGTH,
            "Working window",
            "Distance before the dead centre that the job's slider names (outer by default), on the stroke towards it.",
            sign="positive",
            example="20 mm",
        ),
        Input(
            "window_speed",
            SPEED,
            "Slider speed in the window, at most",
            "Greatest speed of the slider within the working window.",
            sign="positive",
            example="80 mm/s",
        ),
        Input(
            "crank_acceleration",
            ANGULAR_ACCELERATION,
            "Crank acceleration, at most",
            "Greatest angular acceleration of the crank, either way.",
            sign="positive",
        ),
    ),
    command=QuestionCommand(
        help="""Find the crank-speed law over a turn that a servo or electronic cam should follow.

    Lengths and loads are those of JOB; the inertia of motor and flywheel in its [drive] is included. The answer
    compares the law with constant speed at the same cycle time, and has a proven bound. Does not support
    friction in joints, viscous loads, several cylinders or cycles of 720 deg.""",
        endpoint="find_motion_law",
        job="Job file that supplies speed, masses, loads and drive.",
        curves="the cam table: time, crank angle, speed, acceleration",
        sizes=True,
        figure=("law", "speed, torque and slider speed against constant speed"),
    ),
    title="Servo motion",
    premise=Premise("joints and guide without friction", lambda _, machine: not machine.friction.acts),
)
