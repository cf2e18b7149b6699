"""Loads on the slider, along its line, and torques on the crank; several loads add up.

Forces are positive outward (away from the crank pivot), torques counter-clockwise.

If a load depends on the slider position, the position is counted from a `Datum`: the crank pivot (distance along the
slider line), the inner dead centre (outward), or the outer dead centre (inward). Each module except `load`, `cylinder`
and `registry` defines one kind of load; compressors and engines share `cylinder`.
"""
