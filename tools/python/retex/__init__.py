"""Change the textures of a rendered picture without rendering it again.

A *set* is what one render leaves: open() opens one, or a *pack*, its compressed form. Its *targets* are the surfaces
whose textures can be replaced. Set.combine() makes a picture with new ones:

    import retex

    with retex.open("room.exr") as room:
        print([target.name for target in room.targets])
        picture = room.combine({"Floor": "oak.jpg", "Wall": "tomato"})
        retex.write(picture, "oak.png")

Pictures are numpy arrays of floats: rows from the top, then pixels, then channels; scene-linear, with Rec.709's
primaries. They lie in the library's memory, which is freed with the last array that shows it. write() and encode()
apply the display's curve.

All calls may be made from any thread, and long ones do not hold Python's lock. Pictures of one set may be made by
several threads at the same time; what changes a set waits until they are done. Every failure of the library is an
Error."""
from .library import Code, Error, RetexWarning
from .pictures import Picture, denoise_picture, encode, read, write
from .sets import Set, Target, open  # pylint: disable=redefined-builtin
from .texture import Source, Texture, edit_text, edit_view, load_preset, parse_edit, save_preset

__version__ = "0.1.0"
__all__ = ["Code", "Error", "Picture", "RetexWarning", "Set", "Source", "Target", "Texture",
           "denoise_picture", "edit_text", "edit_view", "encode", "load_preset", "open", "parse_edit", "read",
           "save_preset", "write"]
