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
    type Bookmarks = Schemas["BookmarkList"];
    type Change = Schemas["ChangeModel"];
    type Certificate = Schemas["CertificateModel"];
    type Cycle = Schemas["CycleModel"];
    type Outlines = Schemas["OutlinesModel"];
    type Event = Schemas["EventModel"];
    type Example = Schemas["ExampleModel"];
    type Front = Schemas["FrontModel"];
    type FrontPoints = Schemas["FrontPoints"];
    type FrontProgress = Schemas["FrontProgress"];
    type Function = Schemas["FunctionModel"];
    type HistoryEntry = Schemas["HistoryEntryModel"];
    type Job = Schemas["JobStateModel"];
    type JobRow = Schemas["JobRow"];
    type JobPage = Schemas["JobPage"];
    type Kept = Schemas["BookmarkedDesign"];
    type Limit = Schemas["LimitModel"];
    type MadeWish = Schemas["WishRecordModel"];
    type Objective = Schemas["StoredObjective"];
    type Preset = Schemas["PresetModel"];
    type Preview = Schemas["PreviewModel"];
    type Progress = Schemas["JobProgress"];
    type Quantity = Schemas["QuantityModel"];
    type Requirement = Schemas["Requirement"];
    type Requirements = Schemas["RequirementsModel"];
    type SwingPreview = Schemas["SwingPreview"];
    type Block = Schemas["AnswerBlock"];
    type NumberPart = Schemas["NumberPart"];
    type Topic = Schemas["TopicModel"];
    type Understood = Schemas["Understood"];
    type Units = Schemas["UnitTable"]["inch"];
    type WhatIf = Schemas["WhatIfModel"];
    type Wished = Schemas["WishedModel"];
    type Wrong = Schemas["WrongModel"];
    /** A design: its cells by the keys of columns. */
    type Row = Record<string, Cell>;
    type Extremes = Schemas["Extremes"];
    type Inverse = Schemas["CrankAngles"];
    /** What /rounded gives, which its description leaves open. */
    interface Rounded {
      met: boolean;
      message: string;
      allowed: Record<string, number>;
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
    /** Curves over a turn of the crank, at evenly spaced angles from 0 deg; null where a value is not defined. */
    type Curves = Record<string, (number | null)[]>;
  }
}
