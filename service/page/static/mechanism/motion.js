/** Motion of a linkage from its lengths alone, where only the geometry is shown and the service is not needed. */

const POINTS = 360;

/**
 * Return the inner and outer slider position, mm, of a fully rotating linkage on the open branch: x = sqrt((l ∓ r)^2 − e^2).
 * @param {Page.Lengths} linkage
 */
export function deadCentresOf({ crank_mm: r, rod_mm: l, offset_mm: e }) {
  return { inner: Math.sqrt((l - r) ** 2 - e ** 2), outer: Math.sqrt((l + r) ** 2 - e ** 2) };
}

/**
 * Return the position of the slider, mm, and the transmission angle, deg, over a turn from 0 deg, evenly spaced:
 * x = r cos θ + sqrt(l^2 − (e − r sin θ)^2), cos μ = |e − r sin θ| / l. The linkage rotates fully, on the open branch.
 * @param {Page.Lengths} linkage
 */
export function motionOf({ crank_mm: r, rod_mm: l, offset_mm: e }) {
  const [slider_position_mm, transmission_angle_deg] = [new Array(POINTS), new Array(POINTS)];
  for (let n = 0; n < POINTS; n += 1) {
    const angle = (2 * Math.PI * n) / POINTS;
    const rise = e - r * Math.sin(angle); // of the rod, from crank pin to slider
    slider_position_mm[n] = r * Math.cos(angle) + Math.sqrt(l * l - rise * rise);
    transmission_angle_deg[n] = (Math.acos(Math.abs(rise) / l) * 180) / Math.PI;
  }
  return { slider_position_mm, transmission_angle_deg };
}
