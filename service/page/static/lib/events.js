/** Events of a job, as they happen. */

import { address } from "./api.js";

const AGAIN = 2000; // ms until the next try after the connection was refused

/**
 * Follow a job from its event `after` until it is stopped or `signal` is aborted. Whether the job has ended only the job itself
 * says: a cancelled job continues when it is resumed, and its events report that.
 * told(event) is called with {number, at, kind, data}, once for each, in order; connected(yes) as the connection comes and goes.
 * @param {number} job
 * @param {{ after?: number, signal?: AbortSignal, told: (event: Api.Event) => void, connected?: (yes: boolean) => void }} Followed
 * @returns {() => void}
 */
export function listenToJob(job, { after = 0, signal, told: onEvent, connected = () => {} }) {
  let last = after;
  /** @type {EventSource | null} */
  let source = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const stop = () => {
    source?.close();
    clearTimeout(timer);
  };
  const open = () => {
    const opened = new EventSource(address(`jobs/${job}/events`, { after: last }));
    source = opened;
    opened.onopen = () => connected(true);
    /** @param {MessageEvent<string>} message */
    const take = (message) => {
      const event = JSON.parse(message.data);
      if (event.number <= last) return;
      last = event.number;
      onEvent(event);
    };
    for (const kind of ["state", "progress", "message"]) opened.addEventListener(kind, take);
    opened.onerror = () => {
      connected(false);
      // A browser comes back by itself unless the answer was no stream, as from a service that is just starting.
      if (opened.readyState === EventSource.CLOSED && !signal?.aborted)
        timer = setTimeout(open, AGAIN);
    };
  };
  signal?.addEventListener("abort", stop, { once: true });
  open();
  return stop;
}
