/** Questions in a dialog. */

import { sentenceOf } from "./refusals.js";
import { fill, first, formOf, h } from "./dom.js";
import { attempt } from "./notices.js";

/**
 * Ask in a dialog. yes: title of the confirming button. danger: whether it deletes something; the focus is then on the other button.
 * act(values): called with the texts of the fields by name. After a refusal, the dialog stays open and shows it.
 * @param {{ title: string, content: Dom.Child, yes: string, act: (values: Record<string, string>) => unknown, danger?: boolean }} options
 */
export function askFirst({ title, content, yes, act, danger = false }) {
  const opener = document.activeElement;
  const problem = h("p", { class: "bad", role: "alert" });
  const button = h("button", { class: danger ? "danger" : "primary" }, yes);
  const confirm = async () => {
    await act(/** @type {Record<string, string>} */ (Object.fromEntries(new FormData(form))));
    dialog.close();
  };
  const form = formOf(
    () => attempt(confirm, (refusal) => fill(problem, sentenceOf(refusal)), button),
    h("h2", { id: "question" }, title),
    content,
    problem,
    h(
      "div",
      { class: "row" },
      h(
        "button",
        { type: "button", autofocus: danger, onclick: () => dialog.close() },
        danger ? "Keep it" : "Cancel",
      ),
      button,
    ),
  );
  const dialog = h(
    "dialog",
    {
      "aria-labelledby": "question",
      onclose: () => {
        dialog.remove();
        const act = opener instanceof HTMLElement ? opener.dataset.act : null;
        const again = opener?.isConnected
          ? opener
          : act && first(document.body, `[data-act="${CSS.escape(act)}"]`);
        const menu = again ? again.closest("details:not([open])") : null;
        const back = menu ? first(menu, "summary") : again;
        if (back instanceof HTMLElement) back.focus();
      },
    },
    form,
  );
  document.body.append(dialog);
  dialog.showModal();
}
