/* What a person must know, and can do something about, above the picture: the server is gone, the model has changed. */
import { commandsOf, folderOf, shellLine } from "./commands.js";
import { button, download, h, icon, ICONS } from "./dom.js";
import { importAgain } from "./step_open.js";

const restart = ({ model }) => shellLine("retex", ["studio", ...(model ? [`${model.folder}/${model.name}`] : [])]);

/* The project as a file, for when there is nobody to save it. */
const keep = (app) => download(`${folderOf(app.model.path)}.json`, JSON.stringify(app.project, null, 1));

function lost(app) {
  const isUnsaved = app.model && app.saved !== "saved";
  return [
    h("p", {}, h("b", {}, "retex studio does not answer. "), app.isMoved ? "It was started again at another address: go on there. " : "If it was ended, start it again: ", app.isMoved ? null : h("code", {}, restart(app))),
    isUnsaved ? h("p", {}, "Your last changes are only in this window. They are saved when it answers again; or keep them as a file, and put it beside the model.") : h("p", {}, "Your project is saved."),
    isUnsaved ? button("Keep my changes as a file", () => keep(app), { id: "keep-file" }, "take") : null,
  ];
}

function modelChanged(app) {
  const away = () => {
    app.modelChanged = false;
    app.tell();
  };
  return [
    h("p", {}, h("b", {}, `“${app.model.name}” has changed. `), "Another program has saved it anew."),
    button(app.kind === "model" ? "Import again" : "Show it as it is now", () => importAgain(app), { id: "bar-import", class: "primary" }),
    button("Not now", away, { id: "bar-away" }),
  ];
}

/* The bar's content, or null. */
export function bar(app) {
  const body = app.lost ? lost(app) : app.modelChanged && app.model && !app.importing ? modelChanged(app) : null;
  return body && [icon(ICONS.warn), h("div", {}, body)];
}

/* What would be run of what somebody else may have made. */
export function foreignText(app) {
  const { folders } = app.project.textures, lines = commandsOf(app.project).map(({ line }) => line);
  return [
    h("p", {}, h("b", {}, app.model.name), ` may come from somebody else: ${app.foreign}. With it, these commands may run, and write into `, h("code", {}, folderOf(app.model.name)), ":"),
    h("pre", { tabIndex: 0 }, lines.join("\n")),
    folders.length ? [h("p", {}, "These folders of pictures would be shown:"), h("pre", { tabIndex: 0 }, folders.join("\n"))] : null,
    h("p", {}, "Nothing has been run yet. If you do not know where it comes from, end here."),
  ];
}

/* What ending the program does. */
export function quitText(app) {
  const renders = [...app.jobs.values()].some((j) => j.tool === "retex-render" && ["running", "waiting"].includes(j.state));
  return [
    h("p", {}, "Your project is saved; open it again whenever you like."),
    renders ? h("p", {}, "A render is not complete yet. Its finished part is kept, and the button “Go on” in the step Render goes on from there.") : null,
  ];
}

export const endedText = (app) => [h("p", {}, "You can close this window. To go on another time:"), h("pre", { tabIndex: 0 }, restart(app))];
