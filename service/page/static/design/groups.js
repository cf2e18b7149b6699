/** The numbers of a design in groups, each with its title and the columns that belong to it. */

const GROUPS = [
  ["Dimensions", ["crank_mm", "rod_mm", "offset_mm"]],
  ["Motion", ["stroke_mm", "time_ratio", "slow_stroke", "loaded_stroke", "inner_dead_centre_deg", "outer_dead_centre_deg", "inner_dead_centre_position_mm", "outer_dead_centre_position_mm",
    "peak_slider_speed_m_s", "peak_slider_acceleration_m_s2"]],
  ["Transmission and proportions", ["least_transmission_angle_deg", "self_locking_margin_deg", "rod_to_crank", "rod_to_offset", "footprint_m2"]],
  ["Drive", ["peak_torque_Nm", "peak_torque_angle_deg", "peak_torque_outward_Nm", "peak_torque_inward_Nm", "rms_torque_Nm", "mean_torque_Nm", "peak_power_W", "mean_power_W",
    "peak_reflected_inertia_kg_m2"]],
  ["Forces", ["peak_pivot_force_N", "peak_crank_pin_force_N", "peak_slider_pin_force_N", "peak_guide_force_N", "peak_shaking_force_N", "rms_shaking_force_N",
    "peak_shaking_moment_Nm", "rms_shaking_moment_Nm"]],
  ["Accuracy", ["position_error_mm", "position_error_rss_mm"]],
];
const QUALITY = ["status", "residual"];

/** Return [{title, columns}]: every column of a design but those of constraints and of the optimum. What nobody knows comes last. */
export function groupsOf(columns) {
  const left = new Map(columns.filter(({ key }) => !key.startsWith("slack_") && !QUALITY.includes(key)).map((column) => [column.key, column]));
  const take = (key) => {
    const column = left.get(key);
    left.delete(key);
    return column;
  };
  const groups = GROUPS.map(([title, keys]) => ({ title, columns: keys.map(take).filter(Boolean) }));
  const chosen = [...left.values()].filter(({ key }) => key.startsWith("choice_"));
  chosen.forEach(({ key }) => left.delete(key));
  groups[0].columns.push(...chosen);
  if (left.size) groups.push({ title: "Further quantities", columns: [...left.values()] });
  return groups.filter((group) => group.columns.length);
}
