import assert from "node:assert/strict";
import test from "node:test";

globalThis.localStorage = { getItem: () => null };
const { inWords } = await import("../../../../../service/page/static/lib/words.js");

const SAID = [
  [
    "with a least transmission angle of 40 deg it is at most 1.2862; got equals 1.5; lower it to that, or lower constraints.transmission_angle to 27.4576 deg at most",
    "with a least transmission angle of 40° it is at most 1.2862; got exactly 1.5; lower it to that, or lower the requirement on transmission angle to 27.4576° at most",
  ],
  [
    "within the ranges at most 522.162 mm is possible; got min 900 mm and max 950 mm; ask for less",
    "within the ranges at most 522.162 mm is possible; got at least 900 mm and at most 950 mm; ask for less",
  ],
  [
    "it is at most 1.2; got min 1.5 and max 1.6; lower it",
    "it is at most 1.2; got at least 1.5 and at most 1.6; lower it",
  ],
  [
    "drive.rated_torque: a motor gives it continuously, and greatest_torque briefly; got 20 N m, more than 10 N m; swap the two, or correct one",
    "rated torque: a motor gives it continuously, and greatest torque briefly; got 20 N m, more than 10 N m; swap the two, or correct one",
  ],
  [
    "the others lose in peak_torque max and rms_torque max",
    "the others lose in the peak torque limit and the rms torque limit",
  ],
  ["it is above 1; got max 0.5; raise it", "it is above 1; got at most 0.5; raise it"],
  [
    "a quantity with a fixed value cannot also be an objective; got constraints.time_ratio with equals; leave out one of the two",
    "a quantity with a fixed value cannot also be an objective; got “exactly” among the requirements; leave out one of the two",
  ],
  [
    'it needs masses that move or have weight, or loads; got none, or only zeros; for example, add [mechanism] slider = { mass = "0.8 kg" } with a speed, or a [[load]]',
    "it needs masses that move or have weight, or loads; got none, or only zeros; give it under “Masses and loads”",
  ],
  [
    'it needs a crank speed; got none; for example, add [mechanism] speed = "300 rpm"',
    "it needs a crank speed; got none; give it under “Motion”",
  ],
  [
    'unknown key "designs"; it belongs in [optimiser]; move it there',
    'unknown entry "designs"; it belongs in “Search”; move it there',
  ],
  [
    "crank and rod belong below the heading [tolerances]; got them in load #2; write [tolerances] above crank, or move them there",
    "crank and rod belong under “Tolerances”; move them there",
  ],
  [
    "each load must begin with [[load]], in double brackets; got a single one; write [[load]] for [load]",
    "must be a list; got a single entry; put it in a list",
  ],
  [
    "there must be only one [mechanism], in single brackets; got a list of 2; write [mechanism] for [[mechanism]]",
    "must be a single entry; got a list of 2; keep one of them",
  ],
  [
    "a self-locking margin needs friction; got none; for example, add [friction] guide = 0.1, or use transmission_angle",
    "a self-locking margin needs friction; got none; give it under “Friction”, or use transmission_angle",
  ],
  [
    "it needs a material and pins; got none; for example, add [sections] with pins and [sections.material], as in docs/sizing.md",
    "it needs a material and pins; got none; give it under “Material and pins”",
  ],
  [
    "forward dynamics needs a motor; got a mechanism without a drive; add a [drive]",
    "forward dynamics needs a motor; got a mechanism without a drive; give it under “Motor and flywheel”",
  ],
  [
    'for a slow loaded stroke require slow_stroke = "outward" among the constraints; if it should be fast, require slow_stroke = "inward"',
    "for a slow loaded stroke choose “outward” as the slow stroke, under Motion; if it should be fast, choose “inward” as the slow stroke, under Motion",
  ],
  [
    'slow_stroke = "inward" leaves only offsets from 0 to 20 mm of the range',
    "a slow stroke that is the inward one leaves only offsets from 0 to 20 mm of the range",
  ],
  [
    'masses are given without gravity, so nothing has weight; add gravity = "9.81 m/s^2", or gravity = 0',
    "masses are given without gravity, so nothing has weight; give the gravity under “Masses and loads”, 0 for none",
  ],
  [
    "position, velocity and acceleration diagrams at --at",
    "position, velocity and acceleration diagrams at a crank angle",
  ],
  ["flywheel that limits the speed --fluctuation", "flywheel that limits the speed fluctuation"],
  [
    "start from rest under [drive], steady running",
    "start from rest under “Motor and flywheel”, steady running",
  ],
];

for (const [sentence, words] of SAID) {
  test(`"${sentence.slice(0, 40)} ..." has the words of the page`, () =>
    assert.equal(inWords(sentence), words));
}
