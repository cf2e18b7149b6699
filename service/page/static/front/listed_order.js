/** Order of the designs in the last view of a front, sorted and within the limits: the order for stepping through them. */

/** @param {string | number} job */
const key = (job) => `listed ${job}`;

/** Store the numbers of designs in their order; null deletes them. @param {string | number} job @param {number[] | null} numbers */
export function storeOrder(job, numbers) {
  try {
    if (numbers === null) sessionStorage.removeItem(key(job));
    else sessionStorage.setItem(key(job), JSON.stringify(numbers));
  } catch {
    // Without enough storage in the browser, designs are listed by number.
  }
}

/**
 * Return the position of a design in the stored list: {place, count, before, after}, with null neighbours at the ends; without a list, or
 * outside it, its position in the whole front.
 * @param {string | number} job @param {number} number @param {number} all
 */
export function neighbours(job, number, all) {
  const numbers = storedOrder(job);
  const place = numbers.indexOf(number);
  if (place >= 0)
    return {
      place: place + 1,
      count: numbers.length,
      before: numbers[place - 1] ?? null,
      after: numbers[place + 1] ?? null,
      listed: true,
    };
  return {
    place: number,
    count: all,
    before: number > 1 ? number - 1 : null,
    after: number < all ? number + 1 : null,
    listed: false,
  };
}

/** @param {string | number} job @returns {number[]} */
function storedOrder(job) {
  try {
    const numbers = JSON.parse(sessionStorage.getItem(key(job)) ?? "[]");
    return Array.isArray(numbers) ? numbers : [];
  } catch {
    return [];
  }
}

/**
 * Return the lines for some designs from an exported table, in the order of their numbers. Throws an Error for a table of another form.
 * @param {string} table @param {number[]} numbers
 */
export function linesOf(table, numbers) {
  const [head, ...lines] = table.trimEnd().split(/\r?\n/);
  const lineOf = new Map(lines.map((line) => [Number.parseInt(line, 10), line]));
  const wanted = numbers.map((number) => lineOf.get(number));
  if (!head.startsWith("number") || lineOf.size !== lines.length || wanted.includes(undefined))
    throw new Error(
      "The table of the service does not have one line for each design; download the whole table instead.",
    );
  return `${[head, ...wanted].join("\n")}\n`;
}
