/** The numbers of a design in groups, each with its title and the columns that belong to it. */

const QUALITY = ["status", "residual"];

/** Return [{title, columns}]: every column of a design but those of constraints and of the optimum, by the groups that the service gives. */
export function groupsOf(columns) {
  const groups = new Map();
  for (const column of columns.filter(({ key }) => !key.startsWith("slack_") && !QUALITY.includes(key)).sort((a, b) => a.group_place - b.group_place)) {
    if (!groups.has(column.group)) groups.set(column.group, { title: column.group, columns: [] });
    groups.get(column.group).columns.push(column);
  }
  return [...groups.values()];
}
