/** The numbers of a design in groups, each with its title and the columns that belong to it. */

const QUALITY = ["status", "residual"];

/**
 * Return [{title, columns}]: every column of a design but those of constraints and of the optimum, by the groups that the service gives.
 * @param {Api.Column[]} columns
 */
export function groupsOf(columns) {
  /** @type {Map<string, { title: string, columns: Api.Column[] }>} */
  const groups = new Map();
  for (const column of columns
    .filter(({ key }) => !key.startsWith("slack_") && !QUALITY.includes(key))
    .sort((a, b) => (a.group_place ?? 0) - (b.group_place ?? 0))) {
    const title = column.group ?? "Further quantities";
    const { columns: found } = groups.get(title) ?? { columns: /** @type {Api.Column[]} */ ([]) };
    found.push(column);
    groups.set(title, { title, columns: found });
  }
  return [...groups.values()];
}
