/* What each step is for, in some sentences. */
export const HELP = {
  open: ["A model is a room that somebody has built in a 3D program. Save it there as glTF (.glb), the form that carries most; .obj, .fbx and others work as well.",
    "Pictures that belong to the model should lie beside it. Nothing leaves this computer."],
  view: ["You see the room as it will be rendered, first with grain. It becomes clear when you stop moving.",
    "Keep views that you like: each can be rendered."],
  surfaces: ["A surface is what you want to see with other pictures: a floor, a wall, a carpet. Up to eight can be chosen.",
    "If a click takes too much, choose “Flat part”; if it takes too little, “Level” or “Material”. The keys 1 to 4 do the same.",
    "The grid shows how large pictures will be: each field is a metre."],
  light: ["Lamps that you choose here can be dimmed, coloured and turned off after rendering. Finishes say how a surface shines.",
    "Both make rendering longer. Leave them alone if you do not need them."],
  render: ["Rendering takes minutes or hours, once. You can stop it and go on another day.",
    "“How long will it take?” renders two small pictures and reckons from them."],
  play: ["Drag a picture onto a surface of the room. Its size comes from its name, such as “oak 120cm” or “tile 60x60”, or you say it once.",
    "The controls beside the room turn and shift the picture, and change lamps and finishes."],
  take: ["The picture is what you see, in full quality. The catalogue has one picture for each texture of a folder.",
    "Looks are kept in the project. “Commands” has the same work for a shell."],
};
