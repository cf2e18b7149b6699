/** Dialog that asks for the service's token above the current view, whose input is kept. */

import { formOf, h } from "./dom.js";

/** @type {Promise<boolean> | null} */
let asking = null;

/** Ask for the token, once for all requests that lack it; true once it is valid, false if the user cancels. */
export function askForToken() {
  asking ??= ask().finally(() => (asking = null));
  return asking;
}

/** @returns {Promise<boolean>} */
function ask() {
  return new Promise((resolve) => {
    const field = h("input", {
      id: "token",
      type: "password",
      required: true,
      autofocus: true,
      autocomplete: "current-password",
    });
    const wrong = h("p", { class: "error", role: "alert" });
    const dialog = h(
      "dialog",
      {
        "aria-labelledby": "locked",
        onclose: () => {
          dialog.remove();
          resolve(dialog.returnValue === "in");
        },
      },
      h("h2", { id: "locked" }, "This service requires a token"),
      h(
        "p",
        {},
        "The service was restarted, or the browser has lost the token. It is at the end of the address that the service printed; what you have typed here is kept.",
      ),
      formOf(
        send,
        h(
          "div",
          { class: "row" },
          h("label", { for: "token" }, "Token"),
          field,
          h("button", { class: "primary" }, "Open"),
        ),
      ),
      wrong,
    );
    async function send() {
      const answer = await fetch(`./?token=${encodeURIComponent(field.value)}`, {
        headers: { Accept: "application/json" },
      }).catch(() => null);
      if (answer?.ok) dialog.close("in");
      else
        wrong.textContent = answer
          ? "That was not the token of this service."
          : "The service is not responding; try again when it is back up.";
    }
    document.body.append(dialog);
    dialog.showModal();
  });
}
