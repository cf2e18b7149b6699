"""Shaking force and moment on the frame: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(
    __name__,
    40,
    "shaking force and moment",
    explained_columns=(
        "peak_shaking_force_N",
        "rms_shaking_force_N",
        "peak_shaking_moment_Nm",
        "rms_shaking_moment_Nm",
    ),
    title="Shaking forces",
)
