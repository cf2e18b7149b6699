/**
 * Shapes of what the API takes and gives. They come from its own description: `make lint` writes openapi.d.ts anew each time,
 * so that a field which the service renames or drops is an error in the modules that use it.
 */

import type { components, paths } from "../../../.javascript/openapi";

type Schemas = components["schemas"];
type Cell = number | string | null;

/** The parts of a path: "jobs/7/front" is ["jobs", "7", "front"]. */
type Parts<Path extends string> = Path extends `${infer Head}/${infer Rest}` ? [Head, ...Parts<Rest>] : [Path];

/** Whether the parts of a path are those of a pattern, whose "{number}" stands for anything. */
type Match<Asked, Known> = [Asked, Known] extends [[infer A, ...infer Rest], [infer K, ...infer More]]
  ? K extends `{${string}}` | A ? Match<Rest, More> : A extends K ? Match<Rest, More> : false
  : [Asked, Known] extends [[], []] ? true : false;

/** The address in the description of a path such as `jobs/${number}/front`; never for one that is not there. */
type Found<Path extends string> = {
  [Known in keyof paths]: Known extends `/api/v1/${infer Rest}` ? (Match<Parts<Path>, Parts<Rest>> extends true ? Known : never) : never;
}[keyof paths];

/** A path with something in the places of "{number}". */
type Filled<Pattern extends string> = Pattern extends `${infer Head}{${string}}${infer Rest}` ? `${Head}${string}${Filled<Rest>}` : Pattern;

type Content<Response> = Response extends { content: { "application/json": infer Body } } ? Body : null;
type Answered<Operation> = Operation extends { responses: infer All }
  ? All extends { 200: infer Response } | { 201: infer Response } | { 202: infer Response } ? Content<Response> : null
  : never;

declare global {
  namespace Api {
    /** Texts that may be paths. */
    type Text = { [Known in keyof paths]: Known extends `/api/v1/${infer Rest}` ? Filled<Rest> : never }[keyof paths];
    /** The answer to what is asked at a path; of no use where the API has no such path, or it is asked in another way. */
    type Answer<Method extends "get" | "post" | "patch" | "delete", Asked extends string> =
      [Found<Asked>] extends [never] ? "no such path" : paths[Found<Asked>] extends Record<Method, infer Operation> ? Answered<Operation> : "no such path";
    /** What stands behind the "?" of an address; what is null is left out. */
    type Query = Record<string, string | number | boolean | null | undefined | readonly string[]>;

    // A column that the page makes itself has no group.
    type Column = Omit<Schemas["ColumnModel"], "group" | "group_place"> & Partial<Schemas["ColumnModel"]>;
    type Columns = Schemas["ColumnsModel"];
    type Certificate = Schemas["CertificateModel"];
    type Cycle = Schemas["CycleModel"];
    type Outlines = Schemas["OutlinesModel"];
    type Event = Schemas["EventShown"];
    type Example = Schemas["ExampleModel"];
    type Front = Schemas["FrontModel"];
    type FrontPoints = Schemas["FrontPoints"];
    type FrontSoFar = Schemas["FrontSoFar"];
    type Function = Schemas["FunctionModel"];
    type Job = Schemas["JobShown"];
    type JobRow = Schemas["JobRow"];
    type JobPage = Schemas["JobPage"];
    type Kept = Schemas["KeptDesign"];
    type Limit = Schemas["LimitModel"];
    type MadeWish = Schemas["MadeWishModel"];
    type Objective = Schemas["ObjectiveModel"];
    type Preset = Schemas["PresetModel"];
    type Preview = Schemas["PreviewModel"];
    type Progress = Schemas["JobProgress"];
    type Quantity = Schemas["QuantityModel"];
    type Requirement = Schemas["RequirementModel"];
    type Requirements = Schemas["RequirementsModel"];
    type SwingPreview = Schemas["SwingPreview"];
    type Told = Schemas["BlockModel"];
    type Topic = Schemas["TopicModel"];
    type Understood = Schemas["Understood"];
    type Units = Schemas["UnitTable"]["inch"];
    type WhatIf = Schemas["WhatIfModel"];
    type Wished = Schemas["WishedModel"];
    type Wrong = Schemas["WrongModel"];
    /** A design: its cells by the keys of columns. */
    type Row = Record<string, Cell>;
    /** What /analysis gives for "extremes", which its description leaves open: values whose keys end with their units. */
    interface Extremes {
      curves: Record<string, Record<string, unknown> & { title: string }>;
      strokes: Record<string, unknown> & { outward: Record<string, unknown>; inward: Record<string, unknown> };
    }
    /** What /swing gives, which its description leaves open: numbers whose keys end with their units beside these. */
    type Swing = Record<string, unknown> & {
      driver: string;
      law: string;
      duration_s: number | null;
      holds_by_friction: boolean;
      extremes: Extremes["curves"];
      notes: string[];
    };
    /** What /inverse gives, which its description leaves open. */
    interface Inverse {
      solutions: { crank_angle_deg: number; stroke: string | null; crank_speed_rpm: number | null; crank_acceleration_rad_s2: number | null }[];
      note: string;
      slider_velocity_m_s: number | null;
      slider_acceleration_m_s2: number | null;
    }
    /** What /rounded gives, which its description leaves open. */
    interface Rounded {
      met: boolean;
      message: string;
      designs: RoundedRow[];
      notes: string[];
    }
    type RoundedRow = Row & { missed: string[]; misses: Miss[]; tightest: string | null };
    interface Miss {
      quantity: string;
      title: string;
      kind: string;
      amount: number;
      unit: string;
      side: "above" | "below";
      allowed: number;
    }
    /** What /analysis gives for "sensitivity", which its description leaves open: rates such as crank_per_mm beside the rest. */
    interface Sensitivity {
      quantities: Sensitive[];
    }
    type Sensitive = Record<string, Cell> & { quantity: string; title: string; unit: string; value: number | null };
    /** What /analysis gives for "tolerances", which its description leaves open. */
    interface Tolerances {
      worst_case_mm: number;
      worst_case_angle_deg: number;
      exact_worst_case_mm: number | null;
      exact_worst_case_angle_deg: number;
      root_sum_square_mm: number;
      root_sum_square_angle_deg: number;
      monte_carlo: {
        samples: number;
        stuck: number;
        percentiles_greatest_mm: Record<string, number>;
        histogram: { edges_mm: number[]; counts: number[] } | null;
      };
      yields: { limit: string; limit_mm: number; yield_percent: number; yield_low_percent: number; yield_high_percent: number }[];
      contributions: Contribution[];
    }
    interface Contribution {
      source: string;
      limit_mm: number | null;
      limit_deg: number | null;
      share_of_worst_case_percent: number;
      share_of_variance_percent: number;
    }
    /** Curves over a turn of the crank, at evenly spaced angles from 0 deg; null where a value is not defined. */
    type Curves = Record<string, (number | null)[]>;
  }
}
