// What the server sends; the shapes are those of `drawing.py`, `shown.py`, `analyses.py` and `controls.py`.

/**
 * A part of the drawing: which entries it has depends on its kind.
 * @typedef {{ kind: string, name: string, series?: number, at: string, link?: string | null, angle: number, from: string, to: string,
 *   ends: number[][] & number[], span: number[], bar: number[], offset: number, radius: number, radii: number[], crossed: boolean,
 *   outlines: number[][][], place: number[], along: number, rod?: number[] | null, corners: string[], heavy: boolean, slides: boolean,
 *   side: string, role: string }} Part
 */

/**
 * @typedef {{ angles: Float64Array, times: Float64Array, speeds: Float64Array, points: Record<string, Float64Array>,
 *   headings: Record<string, Float64Array>, parts: Part[], box: number[], swings: boolean, true_speed: boolean,
 *   velocities: Record<string, Float64Array>, accelerations: Record<string, Float64Array>,
 *   forces: { name: string, point: string, force: Float64Array }[], handles: { point: string, entries: string[] }[],
 *   centres: Record<string, { at: string, angle: Float64Array, fixed: Float64Array, moving: Float64Array }> }} Scene
 */

/**
 * @typedef {{ name: string, word: string, symbol: string, unit: string }} Words
 * @typedef {Words & { values: Float64Array, own?: boolean }} Curve
 * @typedef {{ key: string, title: string, unit: string, x: Curve, curves: Curve[], isHodograph?: boolean }} Plot
 * @typedef {{ name: string, scalars: (Words & { value: number })[], plots: Plot[] }} Shown
 * @typedef {{ name: string, title: string, caption: string, svg: string }} Figure
 * @typedef {{ name: string, word: string, lane: string, obstacle?: string, mend?: string, entries?: Record<string, any> }} Chip
 */

/**
 * @typedef {{ address: string, key: string, about: string, written: any, holds: string, unit?: string, bounds?: Record<string, number>,
 *   si?: number | null, choices?: string[], expected?: string }} Entry
 * @typedef {{ address: string, key: string, about: string, expected: string, usual: any, kinds: string[], choices?: string[],
 *   unit?: string }} Missing
 * @typedef {{ address: string, key: string, about: string, entries: Entry[], groups: Group[], missing: Missing[] }} Group
 * @typedef {{ key: string, found: string, expected: string, remedy: string, line: number | null }} Problem
 * @typedef {{ place: string, name: string, title: string }} Listed
 */

/**
 * @typedef {{ response: string, word: string, symbol: string, unit: string, value: number, slopes: Record<string, number>, tie: string, responses: string[] }} Slopes
 * @typedef {{ name: string, text: string, scalars: Record<string, number>, plots: Record<string, { x: Float64Array, curves: Record<string, Float64Array> }> }} Pin
 */

export {};
