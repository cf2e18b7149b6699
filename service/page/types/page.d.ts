/** Shapes that several modules of the page share. */

declare namespace Page {
  /** What a view is shown with; `signal` ends what it began. */
  interface Visit {
    parts: string[];
    query: URLSearchParams;
    signal: AbortSignal;
  }
  interface View {
    title: string;
    show(place: HTMLElement, visit: Visit): Promise<void> | void;
  }
  interface Range {
    low: number;
    high: number;
  }
  interface Scale extends Range {
    ticks: number[];
    at(value: number): number;
    value(pixel: number): number;
    text(tick: number): string;
  }
  /** An axis of a chart on canvas: ticks with their texts. */
  interface Axis extends Omit<Scale, "ticks"> {
    ticks: [number, string][];
    column: Heading;
    /** In words, of an objective. */
    better?: string;
  }
  interface Heading {
    title: string;
    unit: string;
  }
  interface Room {
    left: number;
    right: number;
    top: number;
    bottom: number;
  }
  type Point = [number, number];
  type Canvas = CanvasRenderingContext2D;
  /** The colours of the style by name. */
  type Ink = Record<string, string>;
  /** A limit on a column: ends of numbers, null where it is open, or the words that are let through. */
  type Limit = { low: number | null; high: number | null; words?: undefined } | { words: string[]; low?: undefined; high?: undefined };
  /** A line drawn around designs: its corners in the units of two columns. */
  interface Lasso {
    x: string;
    y: string;
    line: Point[];
  }
  /** A design that is marked in a chart. */
  interface Mark {
    /** Of the front; without one it is another design, with `cells`. */
    row?: number;
    cells?: Api.Row;
    colour: string;
    width?: number;
    name?: string;
    /** Whether its values are written at the axes. */
    read?: boolean;
  }
  /** Least and greatest value of a curve, and where in the cycle. */
  interface Ends {
    low: { angle: number; value: number };
    high: { angle: number; value: number };
  }
  /** A design as its view shows it. */
  interface Machine {
    number?: number;
    name: string;
    series: number | string;
    row: Api.Row;
    /** Sentences on the allowable values that it violates. */
    violations: string[];
    /** Deviations from requirements that are allowed for it, by column. */
    allowed?: Record<string, number>;
    curves: Api.Curves;
    curveColumns: Api.Column[];
    /** Places in the cycle of the inner and the outer dead centre, or of both ends of a swing. */
    centres: Point;
    /** Exact slider positions there, mm; the curves have only points. */
    sliderEnds: Point;
    /** Crank angles between which it can move, deg; null for a whole turn. */
    arc?: Point | null;
    /** Crank revolutions per cycle; 0 for a swing. */
    turns: number;
    /** Extremes of its curves between their points too, by column; places in the cycle. Without them they are those of the points; null: none is shown. */
    exact?: Record<string, Ends | null>;
    /** Of its drawings: piston, cylinders, actuator, body on the crank. */
    outlines?: Api.Outlines;
    /** Of the cycle; null where it has no speed. */
    seconds?: number | null;
  }
  interface Lengths {
    crank_mm: number;
    rod_mm: number;
    offset_mm: number;
  }
  /** What a changed design has: its lengths, and of other numbers that were changed column, = and value. */
  interface Numbers extends Lengths {
    value?: string[];
    allow?: string[];
  }
  /** The place in the cycle that the parts of a view share, as it changes: of a turn the crank angle. */
  interface Turn {
    angle: number;
    playing: boolean;
    settled: boolean;
  }
}
