"""Columns besides quantities in the table for a fully rotating crank."""

SLOW_STROKE, LOADED_STROKE = "slow_stroke", "loaded_stroke"
OUTER_DEAD_CENTRE, INNER_DEAD_CENTRE = "outer_dead_centre_deg", "inner_dead_centre_deg"
PEAK_TORQUE_ANGLE = "peak_torque_angle_deg"
OF_A_TURN = (SLOW_STROKE, LOADED_STROKE, OUTER_DEAD_CENTRE, INNER_DEAD_CENTRE, PEAK_TORQUE_ANGLE)
