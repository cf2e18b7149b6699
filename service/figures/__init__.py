"""Figures of fronts, designs and topics: their content as data, and the drawing code."""
