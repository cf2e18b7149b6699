"""Figures of fronts, designs and topics: their content as data, and its drawing."""
