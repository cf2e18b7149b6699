"""Motor sizing of one design: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(
    __name__,
    30,
    "power, RMS torque over time, reflected inertia",
    explained_columns=("peak_power_W", "mean_power_W", "peak_reflected_inertia_kg_m2"),
    title="Motor",
)
