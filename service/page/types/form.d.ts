/** Shapes of the form of a job. */

declare namespace Form {
  /** A place in a job, such as ["load", 0, "force"]. */
  type Path = readonly (string | number)[];
  /** A job as its file has it; what stands where, its schema says. */
  type Job = Record<string, unknown>;
  /** What was typed; source: where it began; key: of its submission. */
  interface Draft {
    job: Job;
    submission: Record<string, unknown>;
    source: string;
    key: string;
  }
  /** What a field is for; name: of the quantity that has a page of its own. */
  type Why = string | { sentence: string; name: string | null };
  interface Field {
    path: Path;
    key: string;
    node: HTMLElement;
    controls: HTMLElement[];
    error: HTMLElement;
    /** Called when the service has looked at the job. */
    tell?: () => void;
  }
  /** Where a control reads and writes, which may be renamed, and what its ids are made of, which may not. */
  interface Spot {
    path: Path;
    readonly id: Path;
  }
  /** A name that a formula may have; behind: what is typed with it. */
  interface Name {
    name: string;
    title: string;
    unit: string | null;
    behind?: string;
  }
  /** A part of a JSON Schema. */
  interface Schema {
    $ref?: string;
    $defs?: Record<string, Schema>;
    type?: string;
    description?: string;
    default?: unknown;
    examples?: unknown[];
    enum?: (string | number | boolean)[];
    pattern?: string;
    properties?: Record<string, Schema>;
    required?: string[];
    items?: Schema;
    anyOf?: Schema[];
    oneOf?: Schema[];
    /** Of a load's table: the key that tells it from others, its name in lists, its first values, and the motion that it is of, "" for any. */
    "x-load"?: { key: string; title: string; first: Record<string, unknown>; motion: string };
  }
  /** What control a part of the schema needs. */
  interface Described {
    control: "quantity" | "choice" | "whole" | "ratio" | "text" | "list" | "table" | "other";
    description: string;
    fallback?: unknown;
    example?: unknown;
    options?: (string | number | boolean)[];
    keys?: string[];
    kind?: string | null;
    percent?: boolean;
  }
  /** What a control is made of; those that a control does not need stay away. */
  interface Looks {
    label: string;
    why?: Why;
    required?: boolean;
    wide?: boolean;
    long?: boolean;
    control?: Described["control"];
    fallback?: unknown;
    example?: unknown;
    options?: (string | number | boolean)[];
    kind?: string | null;
    percent?: boolean;
    changed?: (value: string) => void;
  }
  /** The form of one job, as its fields see it. */
  interface Whole {
    schema: { property(path: Path): Schema | null; resolve(node: Schema): Schema };
    fields: Field[];
    quantities: Map<string, Api.Quantity>;
    submission: Record<string, unknown>;
    job: Job;
    at(path: Path): unknown;
    put(path: Path, value: unknown): void;
    submit(key: string, value: unknown): void;
    /** Call a key of the table at a path otherwise, for the fields within a node. */
    rename(path: Path, from: string, to: string, within: HTMLElement): void;
    register(one: Field): void;
    forget(which: (one: Field) => boolean): void;
    /** What the service said last of the job; null before it has. */
    said: Api.Preview | null;
    /** The names that formulas may have. */
    names(): Name[];
    quantity(name: string): Api.Quantity;
    /** The quantities that objectives and requirements may be about. */
    judging(): Api.Quantity[];
    why(name: string): Why;
    /** Draw all fields anew; focus: the id of the control that has it then. */
    redraw(focus?: string | null): void;
  }
}
