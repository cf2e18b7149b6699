"""Lever moved by a cylinder that pivots about a fixed point; the crank is the lever."""

from ....model.machine.mounting import Mounting
from ....model.swing.swing_types import LeverLaw
from ....objectives.kinds import ACCELERATION, ANGLE, FORCE, LENGTH, MASS, PRESSURE, TIME
from ..design_question import DesignQuestion, Premise, QuestionCommand
from ..inputs import Input

QUESTION = DesignQuestion(
    __name__,
    5,
    shows="lever moved by a cylinder that turns about a fixed pivot, as on lids, tippers and booms",
    inputs=(
        Input(
            "frame_angle",
            ANGLE,
            "Direction of the cylinder's pivot",
            "Direction from O to the cylinder's pivot A. [default: 90 deg behind the pin in the middle of the swing]",
            example="-60 deg",
        ),
        Input(
            "start",
            ANGLE,
            "From",
            "Lever angle at the start. [default: of the job]",
            option="from",
            example="-20 deg",
        ),
        Input("end", ANGLE, "To", "Lever angle at the end. [default: of the job]", option="to", example="50 deg"),
        Input("pin_angle", ANGLE, "Angle of the pin", "Angle from the lever's own line to its pin B.", usual="0 deg"),
        Input("law", help="Law of the cylinder's length over time; slow ignores inertia.", words=LeverLaw),
        Input(
            "duration", TIME, help="Duration of one stroke, for a law other than slow.", sign="positive", example="4 s"
        ),
        Input("mass", MASS, "Carried mass", "Mass that the lever carries.", sign="zero or more", example="80 kg"),
        Input(
            "centre",
            LENGTH,
            "Position of the carried mass along the lever",
            "Distance of the carried mass from O along the lever.",
            example="0.7 m",
        ),
        Input(
            "centre_across",
            LENGTH,
            "Its place across",
            "Distance of the carried mass from the lever's own line, to the left.",
            "0 mm",
        ),
        Input(
            "gravity",
            ACCELERATION,
            "Gravity, downward",
            "Gravity along -y. [default: of the job; 9.81 m/s^2 without one]",
            sign="zero or more",
            example="9.81 m/s^2",
        ),
        Input(
            "closed_length",
            LENGTH,
            "Closed length",
            "Least length of the cylinder between its pins; needs its stroke.",
            sign="positive",
            example="650 mm",
        ),
        Input("cylinder_stroke", LENGTH, "Stroke", "Stroke of the cylinder.", sign="positive", example="430 mm"),
        Input(
            "dead_length",
            LENGTH,
            "Dead length",
            "Instead of a closed length: closed length minus stroke, or minus travel if no stroke is given.",
            sign="positive",
            example="210 mm",
        ),
        Input(
            "mounting",
            help="Clevis, at the end of the barrel, or trunnion, along it. [default: of the job; clevis without one]",
            words=Mounting,
        ),
        Input("bore", LENGTH, "Bore", "Bore of the cylinder; gives pressures.", sign="positive", example="40 mm"),
        Input(
            "piston_rod",
            LENGTH,
            "Piston rod",
            "Diameter of the steel piston rod; gives the margin against buckling.",
            sign="positive",
            example="25 mm",
        ),
        Input(
            "supply_pressure",
            PRESSURE,
            "Supply pressure",
            "Greatest pressure above the pressure on the other side; needs the bore.",
            sign="positive",
            example="160 bar",
        ),
        Input(
            "seal_friction",
            FORCE,
            "Friction of the seal",
            "Friction force of the seal against the motion of the cylinder.",
            "0 N",
            sign="zero or more",
        ),
        Input(
            "barrel_mass",
            MASS,
            "Mass of the barrel",
            "Mass of the barrel, a uniform bar as long as the closed cylinder, or as its least length in the swing.",
            "0 kg",
            sign="zero or more",
        ),
        Input(
            "piston_rod_mass",
            MASS,
            "Mass of the piston rod",
            "Mass of the piston rod, a uniform bar as long as the barrel.",
            "0 kg",
            sign="zero or more",
        ),
        Input(
            "length_tolerance",
            LENGTH,
            "Tolerance of the cylinder length",
            "Tolerance of the cylinder's length, for the error of the lever angle. [default: of the job's actuator]",
            sign="zero or more",
            example="1 mm",
        ),
    ),
    command=QuestionCommand(
        help="""Analyse a lever moved by a cylinder that turns about a fixed pivot.

    This is the linkage with its rod fixed, as on lids, tippers and booms: the crank is the lever from its pivot O to
    the pin B, the rod is the frame from O to the cylinder's pivot A, the offset the distance of the cylinder's line
    from A, positive where the line passes left of A on the way to B. Lever angles are counter-clockwise from +x. The
    cylinder moves the lever only between dead points, where O, A and B are in line. Loads on the slider, friction in
    joints, and masses of rod and slider do not apply.""",
        endpoint="analyse_lever",
        job="Job file that supplies mass and centre of the crank, gravity, tolerances, and the swing in [motion]; with "
        "--design, a run.",
        alone="Without JOB, the lever has only the carried mass.",
        curves="the curves from start to end",
        figure=("lever", "the lever at both ends, force and length"),
    ),
    premise=Premise(
        "a lever moved by a cylinder", lambda problem, _: problem.motion is not None and problem.motion.of_lever
    ),
)
