"""A swing in motion: the page looks up the linkage on its way forth and back."""

from __future__ import annotations

import io
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.swing.law import travel_speed_acceleration
from slidercrank.model.swing.swing import Swing
from slidercrank.service.motion.animated_gif import FRAMES, animated_gif
from slidercrank.service.motion.player_page import player_page
from tests.model.swing.swings import Case, random_swings
from tests.service.motion.test_motion import data_of

CASES = random_swings(20, seed=71)
SUPPORT = Linkage(1.4, 1.8, -0.05)
TILT = Swing(start=math.radians(11.16), end=math.radians(101.16), driver="slider")


@pytest.mark.parametrize("case", CASES, ids=range(len(CASES)))
def test_the_page_has_the_linkage_at_even_times_forth_and_back(case: Case) -> None:
    mechanism, linkage, swing = case
    data = data_of(player_page(mechanism, linkage, name="Support", swing=swing))
    r, l, e = (1e3 * float(value) for value in (linkage.crank, linkage.rod, linkage.offset))
    angles, rod, slider = np.radians(data["angles"]), np.radians(data["rod"]), np.array(data["slider"])
    near = 1e-6 * (r + l)
    np.testing.assert_allclose(r * np.cos(angles) + l * np.cos(rod), slider, atol=near)
    np.testing.assert_allclose(r * np.sin(angles) + l * np.sin(rod), e, atol=near)
    assert (data["crank"], data["offset"]) == (pytest.approx(r), pytest.approx(e))
    assert math.degrees(swing.start) == pytest.approx(data["angles"][0])
    assert math.degrees(swing.end) == pytest.approx(data["angles"][180])
    # The driver's place is that of the law of motion, forth and once more back.
    place = angles if swing.driver == "crank" else slider
    s = travel_speed_acceleration(swing.law, np.arange(181) / 180.0, swing.law_pieces)[0]
    np.testing.assert_allclose(place[:181], place[0] + (place[180] - place[0]) * s, atol=1e-6 * np.ptp(place))
    back = np.append(place[180:], place[0])
    np.testing.assert_allclose(back, place[180] + (place[0] - place[180]) * s, atol=1e-6 * np.ptp(place))
    assert data["perSecond"] == pytest.approx(0.0 if swing.duration is None else 0.5 / swing.duration)
    page = player_page(mechanism, linkage, name="", swing=swing).decode()
    assert ('id="push"' in page, 'id="barrel"' in page) == (swing.driver == "slider",) * 2
    assert ("power_W" in data["curves"]) == (swing.duration is not None)


def test_what_the_actuator_and_the_body_are_drawn_for() -> None:
    body = Mechanism(crank=RigidLink(mass=10.0, centre=0.5))
    pages = [player_page(machine, SUPPORT, name="", swing=TILT).decode() for machine in (Mechanism(), body)]
    crank = [page.partition('id="crank" ')[2].partition("</g>")[0] for page in pages]
    assert [one.count("<circle") for one in crank] == [0, 1]
    assert f'<circle cx="{500.0:g}"' in crank[1]


def test_the_picture_goes_forth_and_back_between_both_ends() -> None:
    swing = replace(TILT, law="cycloidal", duration=20.0)
    content = animated_gif(Mechanism(), SUPPORT, name="$x Größe", swing=swing)
    assert len(content) < 1_000_000
    with Image.open(io.BytesIO(content)) as picture:
        assert getattr(picture, "n_frames", 1) == FRAMES
        frames = []
        for step in range(FRAMES):
            picture.seek(step)
            frames.append(np.asarray(picture.convert("RGB")).astype(int)[:-36])  # without what is read out
    # The way back has the pictures of the way forth in the other order, as the law is the same in both directions.
    for step in range(1, FRAMES // 2):
        assert np.abs(frames[step] - frames[-step]).max() == 0
    differences = [np.abs(one - other).sum() for one, other in pairwise(frames[:31])]
    assert max(differences[12:18]) > 3 * max(differences[0], differences[-1])  # at rest at the ends


def test_what_cannot_swing_is_refused() -> None:
    for make in (player_page, animated_gif):
        with pytest.raises(AssemblyError, match="must close over the whole swing"):
            make(Mechanism(), Linkage(0.1, 0.06, 0.0), name="x", swing=Swing(start=0.0, end=1.4))
        with pytest.raises(InputError, match="dead point"):
            make(Mechanism(), SUPPORT, name="x", swing=replace(TILT, start=-1.0))
