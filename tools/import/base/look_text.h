/* Numbers of a scene that are found by looking at it, see import/look.h: they are written first, and their digits are
 * replaced in place. */
#ifndef RETEX_IMPORT_LOOK_TEXT_H
#define RETEX_IMPORT_LOOK_TEXT_H

#define LOOK_FOLDER ".look" /* in the scene's folder: small copies of its pictures, by the same names */
#define LOOK_EXPOSURE "retex_exposure "
#define LOOK_EXPOSURE_FORMAT "%+7.2f"
#define LOOK_ADDED_SKY "Added_sky"
#define LOOK_ADDED_LAMP "Added_lamp"
#define LOOK_DECLARE(name) "#declare " name " = "
#define LOOK_ADDED_FORMAT "%10.3f"

#endif
