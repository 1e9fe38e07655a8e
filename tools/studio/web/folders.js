/* A folder is chosen in a dialog. */
import * as api from "./api.js";
import { button, h, refill } from "./dom.js";

/* The path of the chosen folder, or "". what: of what kind files are counted, and their names. */
export function chooseFolder(title, what, names) {
  return new Promise((resolve) => {
    let chosen = "";
    const list = h("ul", { class: "rows" }), path = h("p", { class: "path" }), about = h("p", { class: "hint", role: "status" });
    const take = button("Take this folder", () => {
      chosen = at;
      dialog.close();
    }, { class: "primary", id: "take-folder" });
    const dialog = h("dialog", { class: "folders", "aria-label": title, onclose: () => {
      dialog.remove();
      resolve(chosen);
    } }, h("h2", {}, title), path, list, about, h("div", { class: "buttons" }, take, button("Cancel", () => dialog.close(), { id: "no-folder" })));
    let at = "";
    const go = async (to) => {
      try {
        const found = await api.getFolder(to), count = found.entries.filter((e) => e.kind === what).length;
        at = found.path;
        path.textContent = found.path || "The model's folder";
        about.textContent = count ? `${count} ${count === 1 ? what : names} here.` : `No ${names} here; those in its folders count as well.`;
        refill(list, found.parent === null ? null : h("li", {}, button("One folder up", () => go(found.parent), { class: "row", id: "folder-up" }, "undo")),
          found.entries.filter((e) => e.kind === "folder").map((e, k) => h("li", {}, button(e.name, () => go(e.path), { class: "row", id: `folder-${k}` }, "folder"))));
      } catch (error) {
        about.textContent = error.message;
      }
    };
    document.body.append(dialog);
    dialog.showModal();
    go("");
  });
}
