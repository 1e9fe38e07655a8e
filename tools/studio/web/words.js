/* What tools print, in words for people who do not know the tools: what it means, and what to do. */

const bare = (line) => line.replace(/^retex-[a-z]+: /, "").replace(/^(warning|error): /, "");

/* [pattern, what it means, whether it asks for something]; $1 and so on are parts of the line. */
const IMPORT = [
  [/^the room is .* high: they are taken as (\w+), and become metres/, "The lengths of this model look like $1; they were turned into metres. If doors and tables look too large or small, choose another unit."],
  [/^the room is ([\d.]+) units high: its unit is unknown/, "The room is $1 units high, and the file does not say what a unit is. Choose the unit, so that tiles get their true size.", true],
  [/^the room is ([\d.]+) m high and so is its furniture/, "The room is $1 m high. If that is too much, choose another unit.", true],
  [/stands on its xy plane: z is taken as up/, "The model was turned so that its floor lies flat."],
  [/^no camera in the model: .*the view is from inside/, "The file has no camera: you stand in the room. Move on in the step View."],
  [/^no camera in the model/, "The file has no camera: the whole model is in the picture. Move on in the step View."],
  [/^camera (\d+) of (\d+) is used/, "The file has $2 cameras; number $1 is used."],
  [/^no light in the model, and no opening/, "The file has no light, and nothing lets light in: a lamp was put below the ceiling."],
  [/^the picture will be black, or nearly so/, "Next to nothing lights this model: its pictures will be black, or nearly so. Give it a light in the program that made it, and open it again.", true],
  [/^other views: /, "There are other views than the first one: they are in the step View."],
  [/^the camera .* sees nothing, or a wall/, "The file's camera sees nothing, or a wall before it: another view was chosen."],
  [/^the light of the model comes by few ways/, "The light of this model comes through gaps, or from a lamp in a housing, and would be spots in pictures: soft light was added."],
  [/^the model has no sky/, "There was nothing behind the model: a soft sky was added."],
  [/^the light of the model reaches (\d+) %/, "The light of this model reaches only $1 % of the picture: soft light was added."],
  [/^an exposure of .* stops brings/, "The light was too bright or too dark for a picture: the brightness was set by a first look."],
  [/^nothing is seen in the picture/, "The first picture shows nothing: you stand in something, or look away from the model.", true],
  [/^the picture is black: no light/, "The first picture is black: no light reaches what is seen from here.", true],
  [/^targets that are ready: (.*); -t/, "Found for new textures: $1."],
  [/soft sky lights it/, "The file has no light: a soft sky lights it."],
  [/lie on others of the same corners/, "Some faces were there twice; one of each is kept."],
  [/are? where the same one is/, "Some objects were there twice; one of each is kept."],
  [/^there is no image [`'](.*?)[`']/, "The picture “$1” is missing. Put it beside the model and open the model again, or go on without it.", true],
  [/^the image [`'](.*?)[`'] cannot be read/, "The picture “$1” cannot be read. Save it as PNG or JPEG, or go on without it.", true],
  [/^(\d+) more images? lost/, "$1 more pictures are missing.", true],
  [/^the variant [`'](.*?)[`'] needs a scene of its own/, "The variant “$1” changes more than colours: choose it under Variant to have it."],
  [/^(\d+) variants?, from one render/, "The file has $1 variants that can be chosen after rendering."],
  [/^the extension (.*) is left out/, "The file uses “$1”, which is left out. The picture may look a little different."],
  [/^the lights of this format have no unit/, "The lights had no brightness that can be told: they were made bright enough."],
  [/^(\d+ materials?), \d+ mesh(?:es)?, (\d+ objects?), (\d+ triangles?)/, "$1, $2, $3."],
];

const ERRORS = [
  [/^(\d+x\d+) pixels are more than the \d+ of --max-pixels/, "$1 pixels are more than retex studio may render. Choose a smaller size, or start it with --max-pixels."],
  [/more than the (\d+ .B) of --max-memory/, "This needs more than the $1 of memory that it may have. Choose a smaller size in the step Render or fewer lamps and finishes in the step Light, or start retex studio with more: --max-memory."],
  [/too little memory|max-memory|out of memory/i, "There is too little memory for this. Close other programs, or choose a smaller size in the step Render."],
  [/ended by a signal: Killed/, "The system has ended this, mostly since memory ran out. Close other programs or choose a smaller size in the step Render, then go on."],
  [/ended by a signal|ended by SIG/, "This was ended by another program, or by a mistake of its own. Try again; if it happens again, tell the makers of retex."],
  [/no space left|disk is full|quota exceeded|file too large/i, "The disk is full. Make room on it, then try again; nothing was lost."],
  [/max-time|took longer than/i, "This took longer than allowed. Start it again to go on from where it was."],
  [/another project|another render|other options/i, "The unfinished render is of other settings. Start a new one."],
  [/more than 8 combinations|combinations/i, "There are too many combinations of finishes and lamps. Take some away in the step Light."],
  [/no surface|gets no surface|matches nothing/i, "A surface was not found in this view. Look at it in the step Surfaces, or remove it from the list."],
  [/has no (image|texture) coordinates|no UV/i, "A surface has no directions for a texture. Choose “Flat” or “Around a box” for it in the step Surfaces."],
  [/permission denied|read-only/i, "The folder cannot be written to. Copy the model into a folder of yours, and open it there."],
  [/no such file|cannot open|does not exist/i, "A file is no longer where it was. Put it back, or choose it again."],
];

function meant(table, text) {
  for (const [pattern, meaning, asks] of table) {
    const found = pattern.exec(text);
    if (found) return { text: meaning.replace(/\$(\d)/g, (_, k) => found[k] ?? ""), asks: !!asks, line: text };
  }
  return null;
}

/* The lines of an import: { text, asks, line } each; those that say nothing to the reader are left out. */
export function importReport(lines) {
  return lines.map(bare).filter((line) => line && !/^(wrote |--?\w)/.test(line))
    .map((line) => meant(IMPORT, line) || { text: `${line[0].toUpperCase()}${line.slice(1)}`, asks: false, line });
}

/* What is wrong with the first picture of a model that was read, or "". */
export const pictureTrouble = (lines) => importReport(lines).find(({ line }) => /^(nothing is seen in|the picture (is|will be) black)/.test(line))?.text || "";

/* Images or other parts are lost: the import can go on without them. */
export const isLoss = (lines) => lines.some((line) => /--partial/.test(line));

/* What an error of the server means, or its own words. */
export const plainly = (message) => meant(ERRORS, message)?.text || message;

/* An error of a tool: what to do, and the tool's own line. */
export function errorReport(lines, tool = "") {
  const line = bare(lines.filter((l) => l.trim() && !l.startsWith("{")).at(-1) || "");
  const found = meant(ERRORS, line);
  if (found) return found;
  return { text: line ? `This did not work: ${line}` : `${tool || "The program"} ended without saying why.`, asks: true, line };
}
