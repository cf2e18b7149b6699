/** Events of a job, as they happen. */

import { address } from "./api.js";

const AGAIN = 2000; // ms until the next attempt after a refused connection

/**
 * Follow the events of a job after the event `after` until `signal` is aborted. Events also report that a cancelled job was resumed, so
 * only the job itself tells whether it has ended. told(event): called with {number, at, kind, data} of each event in order.
 * connected(yes): called when the connection is made or lost.
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
      // Browsers reconnect by themselves unless the response was not a stream, as from a service that is starting.
      if (opened.readyState === EventSource.CLOSED && !signal?.aborted)
        timer = setTimeout(open, AGAIN);
    };
  };
  signal?.addEventListener("abort", stop, { once: true });
  open();
  return stop;
}
