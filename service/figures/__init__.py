"""Figures of fronts, designs and topics: what they show, as data, and how it is drawn."""
