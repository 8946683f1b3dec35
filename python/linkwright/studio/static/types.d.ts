// What the server sends; the shapes are those of `drawing.py`, `shown.py`, `analyses.py` and `controls.py`. Nothing of it is sent to a browser.


/** A part of the drawing: which entries it has depends on its kind. */
export type Part = { kind: string, name: string, series?: number, at: string, link?: string | null, angle: number, from: string, to: string,
  ends: number[][] & number[], span: number[], bar: number[], offset: number, radius: number, radii: number[], crossed: boolean,
  outlines: number[][][], place: number[], along: number, rod?: number[] | null, corners: string[], heavy: boolean, slides: boolean,
  side: string, role: string };

export type Scene = { angles: Float64Array, times: Float64Array, speeds: Float64Array, points: Record<string, Float64Array>,
  headings: Record<string, Float64Array>, parts: Part[], box: number[], swings: boolean, true_speed: boolean,
  velocities: Record<string, Float64Array>, accelerations: Record<string, Float64Array>,
  forces: { name: string, point: string, force: Float64Array }[], handles: { point: string, entries: string[] }[],
  centres: Record<string, { at: string, angle: Float64Array, fixed: Float64Array, moving: Float64Array }> };

export type Words = { name: string, word: string, symbol: string, unit: string };
export type Curve = Words & { values: Float64Array, own?: boolean };
export type Plot = { key: string, title: string, unit: string, x: Curve, curves: Curve[], isHodograph?: boolean };
export type Shown = { name: string, scalars: (Words & { value: number })[], plots: Plot[] };
export type Figure = { name: string, title: string, caption: string, svg: string };
export type Chip = { name: string, word: string, lane: string, obstacle?: string, mend?: string, entries?: Record<string, any> };

export type Entry = { address: string, key: string, about: string, written: any, holds: string, unit?: string, bounds?: Record<string, number>,
  si?: number | null, choices?: string[], expected?: string };
export type Missing = { address: string, key: string, about: string, expected: string, usual: any, kinds: string[], choices?: string[],
  unit?: string };
export type Group = { address: string, key: string, about: string, entries: Entry[], groups: Group[], missing: Missing[] };
export type Problem = { key: string, found: string, expected: string, remedy: string, line: number | null };
export type Listed = { place: string, name: string, title: string };

export type Slopes = { response: string, word: string, symbol: string, unit: string, value: number, slopes: Record<string, number>, tie: string, responses: string[] };
export type Pin = { name: string, text: string, scalars: Record<string, number>, plots: Record<string, { x: Float64Array, curves: Record<string, Float64Array> }> };
